"""An arm whose position is searched, with its wrist straight: A4 and A6 keep their reference, in both languages."""

from __future__ import annotations

import numpy as np
import pytest
from softkin import Status

from tests.machines.chain_machines import WRIST_BEYOND_QUARTIC
from tests.machines.made import made
from tests.text.controller import OK

pytestmark = pytest.mark.slow

_MOVED = 1e-6


@pytest.mark.parametrize("name", WRIST_BEYOND_QUARTIC)
@pytest.mark.parametrize("turn", [0.0, 180.0])
def test_the_wrist_stands_still(name: str, turn: float) -> None:
    machine, rng = made(name), np.random.default_rng(3)
    joints = rng.uniform(-170.0, 170.0, (60, 6))
    joints[:, 4] = turn
    axes = machine.axes(joints)
    regular = np.linalg.svd(np.array([machine.robot.jacobian(row) for row in axes.tolist()])[:, :3, :3])[1].min(axis=1)
    axes = axes[regular > 0.05 * machine.reach]
    assert len(axes) > 30
    positions, rotations, configurations, _ = machine.robot.forward_batch(axes)
    back, statuses = machine.robot.inverse_batch(positions, rotations, configurations, axes)
    assert (statuses == Status.OK).all() and np.abs(back - axes).max() <= _MOVED
    controller = machine.controller()
    for row, position, rotation, configuration in zip(axes, positions, rotations, configurations, strict=True):
        status, answer = controller.inverse(position.tolist(), rotation.tolist(), configuration.tolist(), row.tolist())
        assert status == OK and np.abs(np.array(answer[:6]) - row).max() <= _MOVED
