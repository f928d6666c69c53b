"""An arm held at an angle, nearly stretched above its first axis: every answer meets the pose, in both languages.

There the elbow has half of its digits, and the distance from the first axis is as small as what that leaves open.
"""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from tests.machines.collection import COSTLY
from tests.machines.grid import every_pose_is_met
from tests.machines.made import Array, Made, made
from tests.text.controller import OK

pytestmark = pytest.mark.slow(*COSTLY)

EVERY = pytest.mark.parametrize("name", ("seven axes", "arm in metres with a held turn of its upper arm"))
_SMALL = (0.0, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3)
_CLOSED = 1e-10


def nearly_stretched(machine: Made) -> Array:
    """Axes whose second and third joints are nearly zero, or half a turn; the arm beside and in line."""
    shoulder, side = (*_SMALL, 180.0), (0.0, 37.0, 90.0, -90.0)
    rows = [(20.0, a2, e1, a3, 50.0, 40.0, -10.0) for a2, e1, a3 in product(shoulder, side, _SMALL)]
    return machine.axes(np.array(rows)[:, : len(machine.mechanism.joints)])


@EVERY
@pytest.mark.parametrize("away", (0.0, 140.0))
def test_every_answer_meets_the_pose(name: str, away: float) -> None:
    machine = made(name)
    axes = nearly_stretched(machine)
    references = axes + away * (np.array([j not in machine.mechanism.held_joints for j in machine.mechanism.joints]))
    every_pose_is_met(machine, axes, references, _CLOSED)


def test_the_block_meets_the_pose() -> None:
    machine = made("arm in metres with a held turn of its upper arm")
    axes, controller = nearly_stretched(machine), machine.controller()
    for row in axes:
        frame, configuration = machine.robot.forward(row.tolist())
        status, answer = controller.inverse(frame.position, frame.rotation, configuration, row.tolist())
        assert status == OK
        pose = np.array([frame.position]), np.array([frame.rotation])
        assert machine.error(np.array([answer[: len(row)]]), *pose).max() <= _CLOSED
