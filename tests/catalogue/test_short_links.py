"""A short link on a long one: stretched and folded poses have rounding of the long one, and are reached."""

import numpy as np
import pytest
from softkin import Status

from derive.description.mechanism import Mechanism
from tests.catalogue.machines import LENGTHS, MECHANISMS, machine

LINKED = tuple(
    m for m in MECHANISMS if m.branches and not m.positive and sum(p.role in LENGTHS for p in m.parameters) > 1
)
SHORTEST, LONGEST = 0.0, 4.3
"""Powers of ten: from one unit of length to twenty thousand."""
MACHINES, POSES = 12, 60
NEAR = 1e-10
"""The error of a pose, per size of the machine."""


@pytest.mark.parametrize("linked", LINKED, ids=lambda m: m.name)
def test_a_boundary_pose_is_reached(linked: Mechanism) -> None:
    """Half of the joints are at a right angle or beside one, on the branch that forward kinematics reports."""
    rng = np.random.default_rng(51)
    needed = {p.name: p.nominal for p in linked.parameters if p.default is None}
    for count in range(MACHINES):
        own = [p for p in linked.parameters if p.role in LENGTHS]
        given = needed | {p.name: min(10.0 ** rng.uniform(SHORTEST, LONGEST), p.high) for p in own}
        one = machine(linked, f"lengths {count}", given)
        robot = one.changed(check_limits=False)
        shape = (POSES, len(robot.AXES))
        beside = rng.choice([0.0, 0.0, 1.0, -1.0], shape) * 10.0 ** -rng.integers(1, 14, shape).astype(float)
        axes = 90.0 * rng.integers(-2, 3, shape) + beside
        axes = np.where(rng.random(shape) < 0.5, rng.uniform(-180.0, 180.0, shape), axes)
        positions, rotations, configurations, statuses = robot.forward_batch(axes)
        assert (statuses == Status.OK).all()
        found, statuses = robot.inverse_batch(positions, rotations, configurations, axes)
        assert (statuses == Status.OK).all(), (given, axes[statuses != Status.OK][0].tolist())
        assert one.miss(found, positions, rotations).max() < NEAR
