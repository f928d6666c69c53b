"""Three parallel axes: the elbow exactly stretched or folded while the shoulder is nearly singular, whatever the wrist
does."""

from __future__ import annotations

import numpy as np
import pytest
import softkin
from softkin import Status

LINKS = {"d1": 89.0, "a2": -425.0, "a3": -392.0, "d4": 109.0, "d5": 94.0, "d6": 82.0}


@pytest.mark.slow
@pytest.mark.parametrize("elbow", [0.0, 180.0])
@pytest.mark.parametrize("beside", [40.0, 4.0, 0.4, 0.04])
def test_poses_at_two_edges_come_back(elbow: float, beside: float) -> None:
    """beside: of the wrist point from the plane in which the shoulder is singular. Below that two roots of rounding
    meet.
    """
    robot = softkin.Ac6ThreeParallel(**LINKS)
    rng = np.random.default_rng(1)
    axes = rng.uniform(-170.0, 170.0, (3000, 6))
    axes[:, 2] = elbow
    upper, fore = np.radians(axes[:, 1]), np.radians(axes[:, 1] + elbow)
    sine = (beside - LINKS["a2"] * np.cos(upper) - LINKS["a3"] * np.cos(fore)) / LINKS["d5"]
    axes, sine, fore = (v[np.abs(sine) < 1.0] for v in (axes, sine, fore))
    axes[:, 3] = np.degrees(np.arcsin(sine) - fore)
    assert len(axes) > 200
    positions, rotations, _, _ = robot.forward_batch(axes)
    found, statuses = robot.inverse_all_batch(positions, rotations, axes)
    away = np.abs((found - axes[:, None, :] + 180.0) % 360.0 - 180.0)
    own = (
        (statuses == Status.OK) & (away[:, :, 0] < 0.01) & (away[:, :, 4] < 0.01)
    )  # the branch of this shoulder and wrist
    assert own.any(axis=1).all()
    frames = robot.forward_batch(found[statuses == Status.OK])
    pose = np.nonzero(statuses == Status.OK)[0]
    assert np.abs(frames[0] - positions[pose]).max() < 1e-10 * 1000.0
    assert np.abs(frames[1] - rotations[pose]).max() < 1e-10
