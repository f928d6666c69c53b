"""Machines of a user's own, in JavaScript as in Python: natural names, gears, held joints, lengths in the description."""

from __future__ import annotations

import numpy as np
import pytest
import softkin

from tests.javascript.modules import written
from tests.javascript.node import ask
from tests.machines.made import Made, made

NAMES = (
    "numbers for lengths",
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
    parameters = {key: value for key, value in robot.parameters.items()}
    answers = ask(written(machine.built.parts["javascript"]), [{"parameters": parameters, "calls": calls}])["answers"][
        0
    ]
    assert answers["made"] == {"status": 0}
    for (axes, frame), found in zip(poses, answers["found"], strict=True):
        expected = robot.inverse_all(frame, axes)
        assert [int(s.status) for s in expected] == [s["status"] for s in found["slots"]]
        for one, other in zip(expected, found["slots"], strict=True):
            if one.axes is not None:
                least = min((1.0, *map(abs, robot.singularity(one.axes).margins.values())))
                assert other["axes"] == pytest.approx(one.axes, abs=1e-12 * 1e3 / max(least, 1e-6))


def _is_possible(robot: softkin.Mechanism, axes: tuple[float, ...]) -> bool:
    try:
        robot.forward(axes)
    except softkin.KinematicsError:
        return False
    return True
