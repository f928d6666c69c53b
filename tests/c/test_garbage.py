"""Whatever a call is given, it ends in a status, and writes results only where that is 0; the sanitizers are silent."""

import random
from typing import Any

import numpy as np
import pytest
import softkin

from derive.emit.c.description import inputs
from tests.c.machine import ask, described
from tests.c.programs import compiled, files_of, part_of, program_of, refused_in, written
from tests.catalogue.extreme import extreme_dimensions
from tests.catalogue.refusals import status_of
from tests.corpus.dimensions import DIMENSIONS
from tests.linuxcnc import module
from tests.mechanisms import kinematics_of, named

pytestmark = pytest.mark.broad

NAN, INFINITY = float("nan"), float("inf")
ODD = (NAN, INFINITY, -INFINITY, 1e300, -1e300, 1e9, 1.0000001e9, 5e-324, -0.0, 1e-160)
NAME = "Kin_Scara4_ZCcoupled_Type1"
GIVEN = {"link_length_1": 300.0, "link_length_2": 250.0}


def _calls(name: str, count: int) -> list[list[Any]]:
    """Calls with numbers of all sizes, some of which are none."""
    known, rng = described(program_of(name)), random.Random(name)
    size = len(known.axes)

    def numbers(many: int) -> list[float]:
        return [rng.choice(ODD) if rng.random() < 0.3 else 10.0 ** rng.uniform(-3, 4) for _ in range(many)]

    def frame() -> dict[str, Any]:
        turned = rng.choice(softkin_rotations)
        rotation = turned if rng.random() < 0.7 else [numbers(3) for _ in range(3)]
        return {"position": numbers(3), "rotation": rotation}

    softkin_rotations = ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
                         [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # fmt: skip
    calls: list[list[Any]] = []
    for _ in range(count):
        given = rng.choice([None, [rng.randint(-128, 127) if rng.random() < 0.2 else 0 for _ in range(known.bytes)]])
        calls += [[call, numbers(size)] for call in ("forward", "jacobian", "singularity", "limits")]
        calls += [["forward", numbers(size), frame()], ["inverse", frame(), given, rng.choice([None, numbers(size)])]]
        calls += [["inverseAll", frame(), rng.choice([None, numbers(size)])]]
    return calls


@pytest.mark.parametrize("name", DIMENSIONS)
def test_every_call_ends_in_a_status(name: str) -> None:
    """Of the nominal machine, and of machines as small, large and unequal as the ranges permit, and beyond these."""
    kin, robot = kinematics_of(named(name)), softkin.catalogue()[name]
    names = inputs(kin).names
    given = [DIMENSIONS[name], *extreme_dimensions(named(name), 4)]
    few = 3 if kin.search_given is None else 1
    machines = [
        {"parameters": {names.get(key, key): value for key, value in one.items()},
         "calls": _calls(name, few * (3 if one is given[0] else 1))}
        for one in given
    ]  # fmt: skip
    for one, machine, answer in zip(given, machines, ask(program_of(name), machines), strict=True):
        assert answer["made"]["status"] == (0 if _is_allowed(robot, one) else 1), one
        for call, found in zip(machine["calls"], answer["found"], strict=True):
            assert found["status"] in range(5), call
            for slot in found.get("slots", [found]):
                assert slot["status"] == 0 or slot["reason"], call
            if not all(abs(value) <= 1e9 for value in _read(call)):
                assert found["status"] != 0, call


def _read(call: list[Any]) -> list[float]:
    """The numbers of a call that every machine reads."""
    return call[1] if call[0] in ("jacobian", "forward") and len(call) == 2 else []


def _is_allowed(robot: type[softkin.Mechanism], given: dict[str, float]) -> bool:
    own = {key: value for key, value in given.items() if key in {p.name for p in robot.PARAMETERS}}
    return status_of(robot, **own) is softkin.Status.OK


@pytest.mark.parametrize(
    "given",
    [
        {}, {"link_length_1": 300.0}, {**GIVEN, "link_length_2": NAN}, {**GIVEN, "link_length_2": 0.0},
        {**GIVEN, "link_length_2": 2e9}, {**GIVEN, "link_length_2": -1.0}, {**GIVEN, "link_length_1": INFINITY},
        {**GIVEN, "check_limits": 2.0}, {**GIVEN, "check_limits": NAN}, {**GIVEN, "offset_a1": INFINITY},
        {**GIVEN, "lower_a1": 10.0, "upper_a1": -10.0}, {**GIVEN, "lower_a1": INFINITY},
        {**GIVEN, "upper_a1": -INFINITY}, {**GIVEN, "upper_a1": NAN}, {**GIVEN, "link_length_1": 1e-300},
    ],
    ids=str,
)  # fmt: skip
def test_a_machine_that_cannot_be_is_refused(given: dict[str, float]) -> None:
    """With a reason and the parameters that are at fault; the machine that there was goes on."""
    calls = [["forward", [10.0, 20.0, 3.0, 40.0]]]
    machines = [{"parameters": one, "calls": calls} for one in (GIVEN, given)]
    first, second = ask(program_of(NAME), machines)
    assert second["made"]["status"] == 1 and second["made"]["reason"]
    assert second["made"]["parameters"].startswith(("link_length_", "check_", "lower_", "upper_", "offset_"))
    assert second["found"] == first["found"] and first["found"][0]["status"] == 0
    (never,) = ask(program_of(NAME), machines[1:])
    assert never["found"][0]["status"] == 1 and never["found"][0]["reason"] == "not initialized"


@pytest.mark.parametrize("option", ["-ffast-math", "-Ofast", "-ffinite-math-only", "-D_M_FP_FAST"])
def test_no_build_that_takes_nan_for_a_number(option: str) -> None:
    """An option that removes the tests for NaN ends the compilation of every source, that of LinuxCNC too."""
    linuxcnc = module.part_of(NAME)["files"]
    folder = written({**files_of(part_of(NAME)), **linuxcnc})
    sources = {path: () for path in files_of(part_of(NAME)) if path.endswith(".c")}
    for source, include in {**sources, **dict.fromkeys(linuxcnc, module.includes("2_9"))}.items():
        assert "they remove the tests for NaN" in refused_in(folder, option, *include, "-c", source), source


@pytest.mark.slow
@pytest.mark.parametrize("options", ["-O3 -funsafe-math-optimizations", "-Ofast -fno-fast-math"])
def test_a_build_that_is_allowed_refuses_nan(options: str) -> None:
    """Other options change digits, and no refusal."""
    axes, frame = [10.0, 20.0, 3.0, 40.0], {"position": [400.0, 0.0, 0.0], "rotation": np.eye(3).tolist()}
    calls: list[list[Any]] = [["forward", axes], ["inverse", frame, None, axes]]
    for odd in (NAN, INFINITY, -INFINITY, 1.1e9):
        calls += [["forward", [odd, *axes[1:]]], ["inverse", frame, None, [*axes[:3], odd]]]
        calls += [["inverse", {**frame, "position": [odd, 0.0, 0.0]}, None, axes]]
    (answer,) = ask(compiled(part_of(NAME), tuple(options.split())), [{"parameters": GIVEN, "calls": calls}])
    assert [found["status"] != 0 for found in answer["found"]] == [False] * 2 + [True] * 12
