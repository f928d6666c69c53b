"""All solutions of a closure by brute force: Newton's method from many starts, whatever the mechanism."""

from __future__ import annotations

import numpy as np

from tests.mechanisms.closure import Array, derivative
from tests.mechanisms.machines import Machine

STARTS = 32
"""Newton's method starts from so many places, twice as many for every branch after the first."""
STEPS = 25
SAME = 1e-6
"""Solutions nearer than this (radians, or per reach) are one."""


def solutions(machine: Machine, position: Array, rotation: Array) -> list[Array]:
    """The joint values that reach a pose, angles in [-pi, pi), without the mirrors that the machine does not have."""
    closure = machine.closure
    rng = np.random.default_rng(77)
    scale = np.where(closure.angles, 1.0, machine.reach)
    starts = STARTS * 2 ** max(0, len(machine.mechanism.branches) - 1)
    joints = rng.uniform(-1, 1, (starts, len(scale))) * np.where(closure.angles, np.pi, 2 * machine.reach)
    joints = _newton(machine, joints, position, rotation, STEPS)
    joints = principal(machine, joints, position, rotation)
    found: list[Array] = []
    solved = joints[_solved(machine, joints, position, rotation)]
    for row in solved[machine.is_own(solved, position)]:
        if not any(np.abs(distance(machine, row, other)).max() < SAME for other in found):
            found.append(row)
    return found


def principal(machine: Machine, joints: Array, position: Array, rotation: Array) -> Array:
    """The same solutions with angles in [-pi, pi); an axis that carries another one along moves it back with it."""
    wrapped = joints.copy()
    angles = machine.closure.angles
    wrapped[:, angles] = (joints[:, angles] + np.pi) % (2 * np.pi) - np.pi
    return _newton(machine, wrapped, position, rotation, 3)


def distance(machine: Machine, first: Array, second: Array) -> Array:
    """The difference of joint values: angles on the circle, lengths per reach."""
    difference = first - second
    wrapped = (difference + np.pi) % (2 * np.pi) - np.pi
    return np.where(machine.closure.angles, wrapped, difference / machine.reach)


def _newton(machine: Machine, joints: Array, position: Array, rotation: Array, steps: int) -> Array:
    count = len(joints)
    positions, rotations = np.tile(position, (count, 1)), np.tile(rotation, (count, 1, 1))

    def equations(q: Array) -> Array:
        return machine.closure.equations(q, positions, rotations)

    for _ in range(steps):
        slopes = derivative(equations, joints)
        normal = slopes.transpose(0, 2, 1) @ slopes
        damped = normal + 1e-12 * np.eye(joints.shape[1]) * (1.0 + np.trace(normal, axis1=1, axis2=2))[:, None, None]
        step = np.linalg.solve(damped, slopes.transpose(0, 2, 1) @ equations(joints)[:, :, None])
        joints = joints - step[:, :, 0]
    return joints


def _solved(machine: Machine, joints: Array, position: Array, rotation: Array) -> Array:
    count = len(joints)
    with np.errstate(invalid="ignore"):
        residual = np.abs(machine.closure.equations(joints, np.tile(position, (count, 1)), np.tile(rotation, (count, 1, 1))))
        small = residual.max(axis=1) < 1e-9 * machine.reach
        return small & np.all(machine.closure.positive(joints) > 0, axis=1)
