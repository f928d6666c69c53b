"""Arms with three parallel axes and links of one length lose no pose where singularities meet, and meet every pose.

The wrist is told by few entries of the rotation and by one coordinate. Near one they have lost the digits of its
angles; the other entries have them.
"""

from __future__ import annotations

import numpy as np
import pytest

from tests.machines.grid import corners, every_pose_is_met
from tests.machines.made import made
from tests.machines.parallel_machines import PARALLEL

pytestmark = pytest.mark.slow

_CLOSED = 1e-10


@pytest.mark.parametrize("name", PARALLEL)
def test_no_pose_is_lost_where_singularities_meet(name: str) -> None:
    """Every pose is answered, and every answer meets its pose."""
    machine = made(name)
    axes = corners(machine)
    every_pose_is_met(machine, axes, axes, _CLOSED)


ALONE = {
    "arm whose first axes are parallel, with a polar radius as long as a link": (
        180.0, -90.0, -90.0, 89.99999999256325, -90.0, 6.370457883843592e-06,
    ),
    "arm with three parallel axes, in one plane": (
        89.99982319804025, -180.0000686302135, -4.524475368456007e-05,
        5.311361262737903e-06, 179.99985037604125, 180.00007583435203,
    ),
}  # fmt: skip
"""Joints (degrees). The first: the wrist is 1.3e-10 off an axis, and an arm of length zero has no direction.

The second: the wrist is next to axis 1, axis 6 nearly parallel to axis 4, and the elbow stretched; there the first
order leads half of the way to the only solution.
"""


@pytest.mark.parametrize("name", ALONE)
def test_a_pose_where_three_singularities_meet(name: str) -> None:
    """The pose is answered, and every answer meets it."""
    machine = made(name)
    axes = np.array([ALONE[name]]) + machine.closure.offsets
    every_pose_is_met(machine, axes, axes, _CLOSED)
