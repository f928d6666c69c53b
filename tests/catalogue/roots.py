"""All solutions of a closure by brute force: Newton's method from many starts, whatever the mechanism."""

from __future__ import annotations

import numpy as np

from tests.catalogue.closure import STEP, Array
from tests.catalogue.machines import Machine

STARTS = 32
MANY_STARTS = 120
"""Of a machine with several branches."""
STEPS = 25
SAME = 1e-6
"""Solutions nearer than this (radians, or per reach) are one."""
SOLVED = 1e-11


def solutions(machine: Machine, position: Array, rotation: Array) -> list[Array]:
    """The joint values that reach a pose, angles in [-pi, pi), without the mirrors that the machine does not have."""
    closure = machine.closure
    rng = np.random.default_rng(77)
    scale = np.where(closure.angles, 1.0, machine.reach)
    starts = MANY_STARTS if machine.robot.BRANCHES > 1 else STARTS
    joints = rng.uniform(-1, 1, (starts, len(scale))) * np.where(closure.angles, np.pi, 2 * machine.reach)
    if machine.mechanism.is_platform and machine.robot.BRANCHES == 0:  # of many mirror images one is wanted
        where = np.tile(position, (starts, 1)), np.tile(machine.closure.reachable(rotation[None]), (starts, 1, 1))
        joints, _ = machine.closure.joints_at(*where, rng)
    joints = principal(machine, solved_from(machine, joints, position, rotation), position, rotation)
    found: list[Array] = []
    for row in joints[machine.is_own(joints, position, rotation)]:
        if not any(np.abs(distance(machine, row, other)).max() < SAME for other in found):
            found.append(row)
    return found


def solved_from(machine: Machine, joints: Array, position: Array, rotation: Array) -> Array:
    """The solutions that Newton's method finds from these starts."""
    joints = _newton(machine, joints, position, rotation, STEPS)
    return joints[_solved(machine, joints, position, rotation)]


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
    count, width = joints.shape
    for _ in range(steps):
        shifts = np.vstack([np.zeros(width), STEP * np.eye(width)])
        shifted = (joints[:, None] + 1j * shifts).reshape(-1, width)
        equations = _equations(machine, shifted, position, rotation)
        values = equations.reshape(count, width + 1, equations.shape[1])
        slopes = np.moveaxis(values[:, 1:].imag / STEP, 1, 2)
        normal = slopes.transpose(0, 2, 1) @ slopes
        damped = normal + 1e-12 * np.eye(width) * (1.0 + np.trace(normal, axis1=1, axis2=2))[:, None, None]
        step = np.linalg.solve(damped, slopes.transpose(0, 2, 1) @ values[:, 0].real[:, :, None])
        joints = joints - step[:, :, 0]
    return joints


def _equations(machine: Machine, joints: Array, position: Array, rotation: Array) -> Array:
    """The commanded part of the closure at one pose, lengths per reach."""
    count = len(joints)
    found = machine.closure.equations(joints, np.tile(position, (count, 1)), np.tile(rotation, (count, 1, 1)))
    entries = 0 if machine.mechanism.is_platform else 3 * len(machine.closure.columns)
    lengths = found.shape[1] - entries
    return np.hstack([found[:, :lengths] / machine.reach, found[:, lengths:]])


def _solved(machine: Machine, joints: Array, position: Array, rotation: Array) -> Array:
    with np.errstate(invalid="ignore"):
        small = np.abs(_equations(machine, joints, position, rotation)).max(axis=1) < SOLVED
        return small & np.all(machine.closure.positive(joints) > 0, axis=1)
