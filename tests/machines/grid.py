"""Where machines are asked: at right angles, next to them, and anywhere; and what they must answer there."""

from itertools import product

import numpy as np
from numpy.typing import NDArray
from softkin import Status

from tests.catalogue.loop_machines import LoopClosure
from tests.machines.made import Array, Made
from tests.random_axes import random_axes

MOST = 300
"""Rows of a grid, drawn where it has more."""
_CORNERS, _REGULAR = 240, 0.05


def grid(machine: Made) -> Array:
    """Joints at multiples of a quarter turn and of a length, and anywhere; of a loop, anywhere."""
    rng = np.random.default_rng(4)
    if machine.mechanism.rods:
        return random_axes(machine.robot, MOST, rng, 300.0, machine.reach, machine.closure.offsets)
    angles, slides = (-180.0, -90.0, 0.0, 90.0, 180.0), (-0.5, 0.0, 0.3)
    rows = np.array(list(product(*[angles if a else slides for a in machine.closure.angles])))
    if len(rows) > MOST:
        rows = rows[rng.choice(len(rows), MOST, replace=False)]
    sizes = np.where(machine.closure.angles, 200.0, 0.9)
    return machine.axes(np.concatenate([rows, rng.uniform(-1.0, 1.0, (100, rows.shape[1])) * sizes]))


def corners(machine: Made) -> Array:
    """Joints 1e-9 to 0.1 degrees beside multiples of 90 degrees, all by the same or each by another power of ten."""
    rng, angles = np.random.default_rng(9), machine.closure.angles
    shape = (_CORNERS, len(angles))
    away = 10.0 ** rng.uniform(-9.0, -1.0, shape) * rng.choice([-1.0, 1.0], shape)
    away[::2] = 10.0 ** rng.uniform(-9.0, -1.0, (_CORNERS // 2, 1)) * rng.uniform(-1.0, 1.0, (_CORNERS // 2, shape[1]))
    joints = np.where(angles, 90.0 * rng.integers(-2, 3, shape) + away, rng.uniform(-1.0, 1.0, shape))
    axes = machine.axes(joints)
    found = axes[is_own(machine, axes)]
    assert len(found) > _CORNERS / 5
    return found


def every_pose_is_met(machine: Made, axes: Array, references: Array, within: float) -> None:
    """Each pose has an answer on a branch, and each answer meets its pose. within: the largest error, in reaches."""
    positions, rotations = machine.closure.poses(axes)
    slots, statuses = machine.robot.inverse_all_batch(positions, rotations, references)
    found = statuses == Status.OK
    assert len(found) and found.any(axis=1).all()
    assert machine.worst(slots, statuses, positions, rotations) <= within


def is_own(machine: Made, axes: Array) -> NDArray[np.bool_]:
    """Whether every positive quantity of the machine is; of a loop, whether it closes away from singular poses."""
    if isinstance(machine.closure, LoopClosure):
        own = np.isfinite(machine.closure.poses(axes)[0]).all(axis=1)
        own[own] = [min(np.abs(margins(machine, row))) > _REGULAR for row in axes[own].tolist()]
        return np.asarray(own)
    return np.all(machine.closure.positive(machine.closure.joints(axes)) > 1e-6, axis=1)


def margins(machine: Made, axes: list[float]) -> list[float]:
    """The singularity margins at axis values."""
    return list(machine.robot.singularity(axes).margins.values())
