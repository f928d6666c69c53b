"""Machines of a user's own, in C as in Python: held joints, gears, natural names."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import softkin

from derive.description.mechanism import Mechanism
from derive.description.validate import validate
from derive.emit.c import package
from tests.c.machine import ask, described
from tests.c.programs import compiled
from tests.machines.made import Made, made
from tests.machines.odd_names import ODD
from tests.mechanisms import kinematics_of

NAMES = (
    "seven axes beside each other, the first held",
    "palletizer with both motors at the base",
)


@pytest.mark.parametrize("name", NAMES)
def test_a_machine_of_the_user(name: str) -> None:
    """Every slot of random poses is that of Python, and its own axes are among them."""
    machine: Made = made(name)
    robot = machine.robot
    count = len(robot.AXES)
    rows = machine.axes(
        np.random.default_rng(5).uniform(-1.0, 1.0, (60, count)) * np.where(machine.closure.angles, 90.0, 0.3)
    )
    poses = [(axes, robot.forward(axes)[0]) for axes in map(tuple, rows.tolist()) if _is_possible(robot, axes)]
    assert len(poses) > 10
    calls = [["inverseAll", {"position": f.position, "rotation": f.rotation}, axes] for axes, f in poses]
    machines = [{"parameters": dict(robot.parameters), "calls": calls}]
    (answer,) = ask(compiled(package.part(kinematics_of(machine.mechanism))), machines)
    assert answer["made"] == {"status": 0}
    for (axes, frame), found in zip(poses, answer["found"], strict=True):
        expected = robot.inverse_all(frame, axes)
        assert [int(s.status) for s in expected] == [s["status"] for s in found["slots"]]
        for one, other in zip(expected, found["slots"], strict=True):
            if one.axes is not None:
                least = min((1.0, *map(abs, robot.singularity(one.axes).margins.values())))
                assert other["axes"] == pytest.approx(one.axes, abs=1e-12 * 1e3 / max(least, 1e-6))


def test_a_reference_that_is_needed() -> None:
    """A held joint has no value without a reference: that is said, and not guessed."""
    machine = made("seven axes beside each other, the first held")
    frame = {"position": [0.0] * 3, "rotation": np.eye(3).tolist()}
    calls = [["inverse", frame, None, None], ["inverseAll", frame, None]]
    given = {"parameters": dict(machine.robot.parameters), "calls": calls}
    (answer,) = ask(compiled(package.part(kinematics_of(machine.mechanism))), [given])
    one, every = answer["found"]
    assert one["status"] == every["status"] == 2
    assert one["reason"].startswith("a reference is needed: it holds the value of ")


def _is_possible(robot: softkin.Mechanism, axes: tuple[float, ...]) -> bool:
    try:
        robot.forward(axes)
    except softkin.KinematicsError:
        return False
    return True


@pytest.mark.parametrize("name", ("words of the languages", "coordinates of a loop"))
def test_natural_names(name: str) -> None:
    """A machine whose inputs are called as no variable can be moves as its twin with plain names."""
    axes = [[10.0 * k, 20.0 - 7.0 * k, 5.0 + 3.0 * k, 4.0 * k] for k in range(6)]
    (names, odd), (_, twin) = (_forward(validate(m), axes) for m in (ODD[name].mechanism(), ODD[name].twin()))
    assert [answer["status"] for answer in odd] == [answer["status"] for answer in twin]
    for one, other in zip(odd, twin, strict=True):
        if one["status"] == 0:
            assert one["frame"]["position"] == pytest.approx(other["frame"]["position"], rel=1e-12, abs=1e-9)
    assert odd[0]["status"] == 0
    stated = [p.given_name for p in ODD[name].mechanism().parameters]
    words = {"self": "self", "configuration": "configuration", "int": "int_length"}  # of Python; of C
    assert names[: len(stated)] == [words.get(n) or ODD[name].python.get(n, n) for n in stated]


def _forward(mechanism: Mechanism, axes: list[list[float]]) -> tuple[list[str], list[dict[str, Any]]]:
    """The names of the parameters, and forward kinematics with nominal dimensions."""
    part = package.part(kinematics_of(mechanism))
    assert part is not None
    program = compiled(part)
    given = {p["name"]: p["nominal"] for p in described(program).parameters}
    calls = [["forward", row[: len(mechanism.joints)]] for row in axes]
    return list(given), ask(program, [{"parameters": given, "calls": calls}])[0]["found"]
