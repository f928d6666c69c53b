"""Next to poses in which several joints stand at a multiple of 90 degrees, where singularities meet, no pose is lost.

An elbow that is nearly straight folds the arm that another joint turns; a root has half of its digits there.
"""

from __future__ import annotations

import numpy as np
import pytest
from softkin import Frame

from tests.machines.collection import MACHINES
from tests.machines.grid import corners, every_pose_is_met
from tests.machines.made import made

pytestmark = pytest.mark.slow

_EVERY = 12
_CLOSED = 1e-9
"""An angle that only an entry of a rotation near one tells is known to half of the digits."""


@pytest.mark.parametrize("name", MACHINES)
def test_no_pose_is_lost_where_singularities_meet(name: str) -> None:
    """As a batch every pose is met; one by one, in all solutions, so is each twelfth."""
    machine = made(name)
    axes = corners(machine)
    every_pose_is_met(machine, axes, axes, _CLOSED)
    positions, rotations = machine.closure.poses(axes)
    for row in range(0, len(axes), _EVERY):
        frame = Frame(tuple(positions[row]), tuple(map(tuple, rotations[row])))
        answers = [s.axes for s in machine.robot.inverse_all(frame, axes[row]) if s.axes is not None]
        assert answers
        poses = (
            np.repeat(positions[row : row + 1], len(answers), axis=0),
            np.repeat(rotations[row : row + 1], len(answers), axis=0),
        )
        assert machine.error(np.array(answers), *poses).max() <= _CLOSED
