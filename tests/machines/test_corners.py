"""Next to poses in which several joints stand at a multiple of 90 degrees, where singularities meet, no pose is lost.

An elbow that is nearly straight folds the arm that another joint turns; a root has half of its digits there. Joints are
1e-9 to 0.1 degrees away from such a pose, all by the same or each by another power of ten.
"""

from __future__ import annotations

import numpy as np
import pytest
from softkin import Frame, Status

from tests.machines.collection import MACHINES
from tests.machines.grid import is_own
from tests.machines.made import Array, Made, made

_POSES, _EVERY = 240, 6
_CLOSED = 1e-9
"""An angle that only an entry of a rotation near one tells is known to half of the digits."""


def _corners(machine: Made) -> Array:
    """Axis values."""
    rng, angles = np.random.default_rng(9), machine.closure.angles
    shape = (_POSES, len(angles))
    away = 10.0 ** rng.uniform(-9.0, -1.0, shape) * rng.choice([-1.0, 1.0], shape)
    away[::2] = 10.0 ** rng.uniform(-9.0, -1.0, (_POSES // 2, 1)) * rng.uniform(-1.0, 1.0, (_POSES // 2, shape[1]))
    joints = np.where(angles, 90.0 * rng.integers(-2, 3, shape) + away, rng.uniform(-1.0, 1.0, shape))
    axes = machine.axes(joints)
    return axes[is_own(machine, axes)]


@pytest.mark.parametrize("name", MACHINES)
def test_no_pose_is_lost_where_singularities_meet(name: str) -> None:
    machine = made(name)
    axes = _corners(machine)
    assert len(axes) > _POSES / 5
    positions, rotations = machine.closure.poses(axes)
    slots, statuses = machine.robot.inverse_all_batch(positions, rotations, axes)
    found = statuses == Status.OK
    assert found.any(axis=1).all()
    for slot in range(slots.shape[1]):
        rows = found[:, slot]
        assert machine.error(slots[rows, slot], positions[rows], rotations[rows]).max(initial=0.0) <= _CLOSED
    for row in range(0, len(axes), _EVERY):
        frame = Frame(tuple(positions[row]), tuple(map(tuple, rotations[row])))
        answers = [s.axes for s in machine.robot.inverse_all(frame, axes[row]) if s.axes is not None]
        assert answers
        poses = (
            np.repeat(positions[row : row + 1], len(answers), axis=0),
            np.repeat(rotations[row : row + 1], len(answers), axis=0),
        )
        assert machine.error(np.array(answers), *poses).max() <= _CLOSED
