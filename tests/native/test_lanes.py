"""Several poses at a time: what the lanes compute alone, and that a row is answered alike wherever it stands."""

import math
import subprocess
from pathlib import Path

import numpy as np
import pytest
from sympy import sin

from derive.emit.native import sources as native_sources
from derive.frames import Rz, Tx, Ty, Tz
from derive.kinematics.build import build
from derive.mechanism import Mechanism, Task, branch, length, linear, rotary
from tests.native.build import SOURCES, STRICT, compiler
from tests.native.machines import SOME, native
from tests.random_axes import random_axes

CODE = """
#include <stdio.h>
#include "lanes.h"
int main(void) {
  double a, b;
  while (scanf("%lf %lf", &a, &b) == 2) {
    printf("%.17g %.17g %.17g\\n", softkin_lane_angle(a, b), softkin_lane_turn(a, b), softkin_on_turn(a, b));
  }
  return 0;
}
"""
OPTIMIZED = ("-O3", "-fPIC")
INFORMED = "-fopt-info-vec-optimized"
LAST_DIGITS = 3 * 2.0**-52
AROUND = [("lane", "missed", "misses", "statuses", "across"), ("lane", "axes", "given", "machine", "k")]
EDGES = (0.0, -0.0, 1.0, -1.0, math.sqrt(2.0) - 1.0, 1e-300, -1e-300, 1e9, -1e9, 5e-324)


@pytest.fixture(scope="module")
def answers(tmp_path_factory: pytest.TempPathFactory) -> list[tuple[float, ...]]:
    """Two numbers, the angle that the lanes find for them, and the turns that lanes and single calls choose."""
    folder = tmp_path_factory.mktemp("lanes")
    (folder / "lanes.c").write_text(CODE)
    own = [str(folder / "lanes.c"), str(SOURCES / "softkin.c"), f"-I{SOURCES}", "-o", str(folder / "lanes"), "-lm"]
    subprocess.run([*compiler(), *STRICT, *OPTIMIZED, *own], check=True)
    random = np.random.default_rng(1)
    pairs = [(a, b) for a in EDGES for b in EDGES]
    pairs += list(zip(*random.normal(0.0, 1.0, (2, 2000)), strict=True))
    pairs += list(zip(*(random.choice([-1.0, 1.0], (2, 500)) * 10 ** random.uniform(-12, 9, (2, 500))), strict=True))
    pairs += [(centre + 180.0 * k + e, centre) for centre in (0.0, 33.3, -2000.0) for k in range(-9, 10)
              for e in (-1e-8, -1e-9, 0.0, 1e-9, 1e-8)]  # fmt: skip
    given = "".join(f"{float(a)!r} {float(b)!r}\n" for a, b in pairs)
    done = subprocess.run([str(folder / "lanes")], input=given, capture_output=True, text=True, check=True)
    lines = [tuple(map(float, line.split())) for line in done.stdout.splitlines()]
    return [(*pair, *line) for pair, line in zip(pairs, lines, strict=True)]


def test_angles(answers: list[tuple[float, ...]]) -> None:
    """In all octants, to the last digits; zeros have no sign."""
    for y, x, angle, *_ in answers:
        assert abs(angle - math.atan2(y + 0.0, x + 0.0)) <= LAST_DIGITS * max(abs(angle), 5e-324)


def test_turns(answers: list[tuple[float, ...]]) -> None:
    """Bit for bit those of a single call, on the edges of a turn, too."""
    for *_, in_lanes, alone in answers:
        assert in_lanes == alone


@pytest.mark.parametrize("module", ["articulatedrobot_6dof", "scara4_zccoupled_type1", "p2c_type1", "delta_p3c_type3"])
def test_no_branch(module: str, tmp_path: Path) -> None:
    """The compiler takes several lanes in one instruction, in every loop over poses: a branch would hinder it."""
    command = compiler()
    version = subprocess.run([*command, "--version"], capture_output=True, text=True, check=True).stdout
    if "Free Software Foundation" not in version:
        return  # another compiler says it in other words
    source = SOURCES / f"{module}-lanes.c"
    done = subprocess.run(
        [*command, *STRICT, *OPTIMIZED, INFORMED, "-c", str(source), "-o", str(tmp_path / "lanes.o")],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    places = [i for i, line in enumerate(source.read_text().splitlines(), 1) if "lane < SOFTKIN_LANES" in line]
    assert places and all(f"{source.name}:{place}:" in done.stderr for place in places)


@pytest.mark.parametrize("names", AROUND)
def test_names_of_the_loop(names: tuple[str, ...], tmp_path: Path) -> None:
    """A machine whose dimensions are called as what stands around its formulas: none hides another."""
    first, second, slide = rotary("A1", "arm 1"), rotary("A2", "arm 2"), linear("Z", "slide")
    one, other, x, y, z = own = [length(name, name, nominal=300.0) for name in names]
    mechanism = Mechanism(
        name="Kin_Around", family="odd", source="the tests", summary="An arm.", joints=(first, second, slide),
        parameters=tuple(own), chain=Tx(x) * Ty(y) * Tz(z) * Rz(first) * Tx(one) * Rz(second) * Tx(other) * Tz(slide),
        task=Task("xyz"), branches=(branch("elbow", sin(second), right=1, left=-1),),
    )  # fmt: skip
    for path, text in native_sources(build(mechanism)).items():
        (tmp_path / Path(path).name).write_text(text)
    source = tmp_path / "around-lanes.c"
    assert [name for name in names if f"k->{name}" not in source.read_text()] == []
    options = ["-Wshadow", f"-I{tmp_path}", f"-I{SOURCES}", "-fsyntax-only"]
    subprocess.run([*compiler(), *STRICT, *options, str(source)], check=True)


@pytest.mark.parametrize("name", SOME)
def test_rows_do_not_depend_on_each_other(name: str) -> None:
    """One row, some rows, and the same rows among many: the same bytes."""
    robot = native(name)
    axes = random_axes(robot, 41, np.random.default_rng(7), 150.0, 150.0)
    positions, rotations, configurations, _ = robot.forward_batch(axes)
    whole = robot.inverse_batch(positions, rotations, configurations, axes)
    every = None if robot._machine.is_searched else robot.inverse_all_batch(positions, rotations, axes)
    for first, last in ((0, 1), (3, 4), (5, 12), (1, 18), (40, 41), (33, 41)):
        part = slice(first, last)
        own = robot.inverse_batch(positions[part], rotations[part], configurations[part], axes[part])
        assert [v.tobytes() for v in own] == [v[part].tobytes() for v in whole]
        if every is not None:
            own = robot.inverse_all_batch(positions[part], rotations[part], axes[part])
            assert [v.tobytes() for v in own] == [v[part].tobytes() for v in every]
