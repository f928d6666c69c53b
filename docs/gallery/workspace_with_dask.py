"""A workspace with Dask: a million poses, spread over the cores of a laptop; a cluster takes the same tasks."""

import sys

import dask
import numpy as np
import softkin

ROWS = 50_000
"""The poses of one task: few, so that their solutions need little memory."""


@dask.delayed
def reached(robot, seed, count):
    """How many of random positions in a cube are reached: a machine is a value, and is sent to every process."""
    positions = np.random.default_rng(seed).uniform(-600.0, 600.0, (count, 3))
    rotations = np.broadcast_to(np.diag((1.0, -1.0, -1.0)), (count, 3, 3))
    _, statuses = robot.inverse_all_batch(positions, rotations)
    return int((statuses == softkin.Status.OK).any(axis=1).sum())


if __name__ == "__main__":
    poses = int(sys.argv[2]) if len(sys.argv) > 2 else 10**6
    arm = softkin.ArticulatedRobot6DOF(d1=400.0, a1=25.0, a2=455.0, a3=35.0, d4=420.0, d6=80.0)
    tasks = [reached(arm, seed, ROWS) for seed in range(poses // ROWS)]
    total = sum(dask.compute(*tasks, scheduler="processes"))
    print(f"{total} of {poses} poses are reached: {100.0 * total / poses:.1f} %")
