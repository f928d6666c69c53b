"""What a singular pose allows: a self-motion that changes nothing, or a fold where the workspace ends."""

import numpy as np

from tests.catalogue.closure import Array
from tests.catalogue.machines import Machine
from tests.catalogue.roots import distance, ends_from
from tests.orthonormal import rodrigues

RATHER_FAR = 0.4
"""How far (radians, or reaches) the search for another posture of the same pose starts from the first."""
LEAST = 0.1
SECOND_ORDER = 1e-3


def null_vectors(machine: Machine, axes: Array) -> tuple[Array, Array]:
    """The joint motion that changes nothing to first order, and the twist that no joint motion makes; per reach."""
    jacobian = machine.closure.jacobian(axes, machine.closure.poses(axes)[0])
    rows = np.ones(jacobian.shape[1])
    rows[: len(machine.closure.task)] = 1 / machine.reach
    left, values, right = np.linalg.svd(jacobian * rows[:, None] * np.where(machine.closure.angles, 1.0, machine.reach))
    assert (values[:, -1] < 1e-9).all()
    motion = right[:, -1]
    return motion / np.abs(motion).max(axis=1, keepdims=True), left[:, :, -1]


def is_free(machine: Machine, axes: Array) -> Array:
    """Which rows have another posture rather far away, along the motion that changes nothing."""
    motion, _ = null_vectors(machine, axes)
    joints, frames = machine.closure.joints(axes), machine.closure.poses(axes)
    found = np.zeros(len(axes), dtype=bool)
    for way in (RATHER_FAR, -RATHER_FAR):
        starts = joints + way * motion * np.where(machine.closure.angles, 1.0, machine.reach)
        others, is_solution = ends_from(machine, starts, *frames)
        apart = np.abs(distance(machine, joints, others)).max(axis=1)
        found |= is_solution & (apart > LEAST) & (apart < 3 * RATHER_FAR)
    return found


def inward(machine: Machine, axes: Array) -> tuple[Array, Array]:
    """A twist of the pose at a fold towards the side on which it has two postures: shifts per reach, then turns."""
    motion, twist = null_vectors(machine, axes)
    joints = machine.closure.joints(axes)
    size = SECOND_ORDER * motion * np.where(machine.closure.angles, 1.0, machine.reach)
    positions, rotations = machine.closure.frames(joints)
    bent = np.zeros_like(twist)
    for way in (size, -size):  # what is of first order cancels
        there, turned = machine.closure.frames(joints + way)
        spin = np.einsum("nij,nkj->nik", turned, rotations)
        turns = np.stack([spin[:, i, j] - spin[:, j, i] for i, j in ((2, 1), (0, 2), (1, 0))], axis=1)
        bent += np.hstack([(there - positions)[:, machine.closure.task] / machine.reach, turns / 2])[:, : bent.shape[1]]
    side = np.sign(np.sum(bent * twist, axis=1, keepdims=True))
    assert (side != 0).all()
    towards = side * twist
    count = len(machine.closure.task)
    shifts, turns = np.zeros((len(axes), 3)), np.zeros((len(axes), 3))
    shifts[:, machine.closure.task] = towards[:, :count]
    turns[:, : towards.shape[1] - count] = towards[:, count:]
    return shifts, turns


def twisted(
    machine: Machine, frames: tuple[Array, Array], shifts: Array, turns: Array, size: float
) -> tuple[Array, Array]:
    """Poses moved by some size of a twist."""
    angles = np.linalg.norm(turns, axis=1)
    rotation = rodrigues(turns / np.maximum(angles, 1e-300)[:, None], size * angles)
    return frames[0] + size * machine.reach * shifts, rotation @ frames[1]
