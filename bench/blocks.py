"""`python -m bench.blocks`: what a call of a generated block costs, beside a block that is written by hand.

Both are Structured Text, and run in the harness of the tests at the same poses. The one by hand solves one branch, and
checks nothing but reach. The *call* is all of CartesianToAxes with a configuration that names the branches; the
*algebra* is the private method that solves a branch, with the functions that it calls, without the choice of turns
(Softkin_NearestPeriod). Its tests of reach are counted.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from bench.counting import Counts, counted, counting_library
from derive.description.mechanism import Mechanism
from derive.emit.softmotion.inputs import wanted_name
from derive.ir.symbols import SCALE
from derive.kinematics.parameters import machine_parameters
from derive.kinematics.sampling import sample_axes
from tests.harness.library import Library
from tests.mechanisms import catalogue
from tests.text import values
from tests.text.controller import OK, Controller
from tests.text.units import file_of, shared_texts, text_of

FOLDER = Path(__file__).resolve().parent / "hand"
POSES = 40
TURNS = "softkin_nearestperiod"
_SOLVING = "solvebranch"
_SIZE = 500.0
"""The size of all four machines, in their unit of length."""


@dataclass(frozen=True)
class Kind:
    """A kind of machine, in both texts."""

    name: str
    mechanism: str
    by_hand: str
    branch: tuple[int, ...]
    """The bytes of the branch that is written by hand."""
    most: int
    """Floating operations of a call, at most."""
    reads_rotation: bool = False
    type2: tuple[bool, ...] = ()
    """The texts by hand: without and with a test of type 2 singularities; empty where there is no such test."""


KINDS = (
    Kind("SCARA", "Kin_Scara4_ZCcoupled_Type1", "Hand_Scara4", (1,), 110, reads_rotation=True),
    Kind("rotary delta", "Kin_Delta_P3C_Type3", "Hand_Delta", (1, 1, 1), 170, type2=(False, True)),
    Kind("five-bar", "Kin_P2C_Type1", "Hand_FiveBar", (1, 1), 90, type2=(False, True)),
    Kind("six-axis", "Kin_ArticulatedRobot_6DOF", "Hand_SixAxis", (1, 1, 1), 220, reads_rotation=True),
)


@dataclass(frozen=True)
class Measured:
    """The largest numbers at all poses of a kind."""

    call: int
    calls: int
    """Calls of functions and methods in a call, without CartesianToAxes itself."""
    algebra: int
    by_hand: tuple[int, ...]
    """Of the text by hand; where it has a test of type 2 singularities without and with it."""
    missed: float
    """By how much the pose at the worst answer by hand misses, in parts of the machine."""
    poses: int

    @property
    def ratio(self) -> float:
        """The algebra to that by hand, which does the same."""
        return self.algebra / self.by_hand[-1]


def main() -> None:
    """Measure and print."""
    print("Floating operations (additions, multiplications, divisions, roots) of one solution, the most of all poses.")
    print(f"{'':14}{'call':>6}{'at most':>9}{'calls':>7}{'algebra':>9}{'by hand':>9}{'ratio':>7}{'poses':>7}")
    for kind in KINDS:
        found = measured(kind)
        print(
            f"{kind.name:14}{found.call:6d}{kind.most:9d}{found.calls:7d}{found.algebra:9d}"
            f"{found.by_hand[-1]:9d}{found.ratio:7.2f}{found.poses:7d}"
            + (f"   by hand without its type 2 test {found.by_hand[0]}" if kind.type2 else "")
        )


@cache
def measured(kind: Kind) -> Measured:
    """Both texts of a kind at the same poses, all on the branch that is written by hand."""
    mechanism = next(m for _, m in catalogue() if m.name == kind.mechanism)
    texts = {file_of(mechanism): text_of(mechanism), kind.by_hand: (FOLDER / f"{kind.by_hand}.st").read_text()}
    library = counting_library({**shared_texts(), **texts})
    given = {p.name: p.nominal for p in machine_parameters(mechanism)}
    given |= {j.offset.name: 7.0 * (k + 1) for k, j in enumerate(mechanism.joints)}
    machine, own = Controller(library, mechanism), library.new(kind.by_hand)
    assert machine.initialise(given) == OK
    _set(own, mechanism, given)
    generated, by_hand, errors = list[Counts](), list[list[int]](), list[float]()
    for axes, (position, rotation, data) in _poses(kind, mechanism, machine, given):
        (status, found), counts = counted(machine.inverse, position, rotation, data, axes)
        assert status == OK
        answers = [_solved(library, own, position, rotation, kind, t) for t in kind.type2 or (False,)]
        generated.append(counts)
        by_hand.append([c.floating() for _, c in answers])
        errors += [_missed(machine, a, kind, (position, rotation)) for a, _ in answers]
    return Measured(
        call=max(c.floating() for c in generated),
        calls=max(sum(c.calls.values()) - 1 for c in generated),
        algebra=max(_algebra(c) for c in generated),
        by_hand=tuple(max(column) for column in zip(*by_hand, strict=True)),
        missed=max(errors),
        poses=len(generated),
    )


def _algebra(counts: Counts) -> int:
    """The operations of the branch alone, and of the functions that it calls."""
    others = {name for name in counts.operations if not name.startswith("softkin_") and name != _SOLVING}
    return counts.floating(*others, TURNS, "softkin_makerotation")


def _set(own: Any, mechanism: Mechanism, given: Mapping[str, float]) -> None:
    """The inputs of the block by hand, which bear the names of the generated one, and its Initialize."""
    for parameter in machine_parameters(mechanism):
        if hasattr(own, name := wanted_name(parameter)):
            kind = type(getattr(own, name))
            setattr(own, name, kind(given[parameter.name]))
    own.call("Initialize")


def _poses(
    kind: Kind, mechanism: Mechanism, machine: Controller, given: Mapping[str, float]
) -> list[tuple[Sequence[float], Any]]:
    """Axis values all over the ranges on the branch by hand, each with its pose and its configuration without turns."""
    sampled = sample_axes(mechanism, {n: np.asarray(v) for n, v in (given | {SCALE.name: _SIZE}).items()}, 4000, 2)
    drawn = np.stack([sampled[j.axis.name] for j in mechanism.joints], axis=1)
    found: list[tuple[Sequence[float], Any]] = []
    for axes in drawn.tolist():
        status, pose = machine.forward(axes)
        size = len(mechanism.branches)
        if status == OK and pose[2][:size] == kind.branch:
            data = pose[2][:size] + (0,) * (len(pose[2]) - size)
            if machine.inverse(*pose[:2], data, axes)[0] == OK:
                found.append((axes, (*pose[:2], data)))
        if len(found) == POSES:
            break
    return found


def _solved(
    library: Library, own: Any, position: Any, rotation: Any, kind: Kind, tests_type2: bool
) -> tuple[tuple[float, ...], Counts]:
    found = values.new(library, values.AXES_TYPE)
    arguments: dict[str, Any] = {"a": found, "v": values.vector(library, position)}
    if kind.reads_rotation:
        arguments["rot"] = [entry for row in rotation for entry in row]
    if kind.type2:
        arguments["xTestType2"] = tests_type2
    solved, counts = counted(own.call, "Solve", **arguments)
    assert solved is True, "the text by hand does not reach"
    return values.axes_of(found), counts


def _missed(machine: Controller, axes: Sequence[float], kind: Kind, wanted: tuple[Any, Any]) -> float:
    """By how much the pose at the axes misses: parts of the machine's length, entries of the rotation."""
    count = len(machine.mechanism.joints)
    status, pose = machine.forward(axes[:count])
    assert status == OK
    assert pose[2][: len(kind.branch)] == kind.branch, f"another branch: {pose[2]}"
    lengths = [abs(a - b) / _SIZE for a, b in zip(pose[0], wanted[0], strict=True)]
    rows = zip(pose[1], wanted[1], strict=True)
    return max(*lengths, *(abs(a - b) for row, other in rows for a, b in zip(row, other, strict=True)))


if __name__ == "__main__":
    main()
