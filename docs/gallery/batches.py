"""Batches: a hundred thousand frames there and back, with a status for each."""

import numpy as np
import softkin

arm = softkin.ArticulatedRobot6DOF(d1=400.0, a1=25.0, a2=455.0, a3=35.0, d4=420.0, d6=80.0)
axes = np.random.default_rng(1).uniform(-170.0, 170.0, (100_000, 6))
positions, rotations, configurations, statuses = arm.forward_batch(axes)
found, outcomes = arm.inverse_batch(positions, rotations, configurations, axes)
print("solved:", int((outcomes == softkin.Status.OK).sum()))
print("typical error below 1e-9 deg:", bool(np.median(np.abs(found - axes)) < 1e-9))
positions[:10_000] *= 10.0  # out of reach
_, outcomes = arm.inverse_batch(positions, rotations, configurations, axes)
for status in softkin.Status:
    print(f"{status.name:15}", int((outcomes == status).sum()))
