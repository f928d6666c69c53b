"""All solutions of a closure by brute force: Newton's method from many starts, whatever the mechanism."""

import numpy as np
from numpy.typing import NDArray

from tests.catalogue.closure import STEP, Array
from tests.catalogue.machines import Machine

STARTS = 32
MANY_STARTS = 120
"""Of a machine with several branches."""
STEPS = 25
SAME = 1e-6
"""Solutions nearer than this (radians, or per reach) are one."""
SOLVED = 1e-11
STANDING = 1e-14
"""A step of Newton's method, in radians and lengths, that is next to nothing."""


def solutions(machine: Machine, position: Array, rotation: Array, held: Array) -> list[Array]:
    """The joint values that reach a pose, in [-pi, pi), mirrors left out; held joints stay where they are in `held`."""
    closure = machine.closure
    rng = np.random.default_rng(77)
    scale = np.where(closure.turning, 1.0, machine.reach)
    starts = MANY_STARTS if machine.robot.BRANCHES > 1 else STARTS
    joints = rng.uniform(-1, 1, (starts, len(scale))) * np.where(closure.turning, np.pi, 2 * machine.reach)
    if machine.mechanism.is_platform and machine.robot.BRANCHES == 0:  # of many mirror images one is wanted
        where = np.tile(position, (starts, 1)), np.tile(machine.closure.reachable(rotation[None]), (starts, 1, 1))
        joints, _ = machine.closure.joints_at(*where, rng)
    joints = np.where(machine.solved, joints, held)
    joints = principal(machine, solved_from(machine, joints, position, rotation), position, rotation)
    found: list[Array] = []
    for row in joints[machine.is_own(joints, position, rotation)]:
        if not any(np.abs(distance(machine, row, other)).max() < SAME for other in found):
            found.append(row)
    return found


def solved_from(machine: Machine, joints: Array, position: Array, rotation: Array) -> Array:
    """The solutions that Newton's method finds from these starts."""
    joints, is_solution = ends_from(machine, joints, position, rotation)
    return joints[is_solution]


def ends_from(machine: Machine, joints: Array, position: Array, rotation: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Where Newton's method ends from these starts, for one pose or for that of each row, and which are solutions."""
    joints = _newton(machine, joints, position, rotation, STEPS)
    return joints, _solved(machine, joints, position, rotation)


def principal(machine: Machine, joints: Array, position: Array, rotation: Array) -> Array:
    """The same solutions with angles in [-pi, pi); an axis that carries another one along moves it back with it."""
    wrapped = joints.copy()
    angles = machine.closure.turning & machine.solved
    wrapped[:, angles] = (joints[:, angles] + np.pi) % (2 * np.pi) - np.pi
    return _newton(machine, wrapped, position, rotation, 3)


def distance(machine: Machine, first: Array, second: Array) -> Array:
    """The difference of joint values: angles on the circle, lengths per reach."""
    difference = first - second
    wrapped = (difference + np.pi) % (2 * np.pi) - np.pi
    return np.where(machine.closure.turning, wrapped, difference / machine.reach)


def _newton(machine: Machine, joints: Array, position: Array, rotation: Array, steps: int) -> Array:
    """The end of each row; where a step was next to nothing, the next one changes no digit."""
    joints, width = joints.copy(), joints.shape[1]
    shifts = np.vstack([np.zeros(width), STEP * np.eye(width)])
    positions = np.broadcast_to(position, (len(joints), 3))
    rotations = np.broadcast_to(rotation, (len(joints), 3, 3))
    moving = np.arange(len(joints))
    for _ in range(steps):
        shifted = (joints[moving, None] + 1j * shifts).reshape(-1, width)
        there = np.repeat(positions[moving], width + 1, axis=0), np.repeat(rotations[moving], width + 1, axis=0)
        equations = _equations(machine, shifted, *there)
        values = equations.reshape(len(moving), width + 1, equations.shape[1])
        slopes = np.moveaxis(values[:, 1:].imag / STEP, 1, 2) * machine.solved
        normal = slopes.transpose(0, 2, 1) @ slopes
        damped = normal + 1e-12 * np.eye(width) * (1.0 + np.trace(normal, axis1=1, axis2=2))[:, None, None]
        step = np.linalg.solve(damped, slopes.transpose(0, 2, 1) @ values[:, 0].real[:, :, None])[:, :, 0]
        joints[moving] -= step
        moving = moving[~(np.abs(step).max(axis=1) < STANDING)]
        if not len(moving):
            break
    return joints


def _equations(machine: Machine, joints: Array, position: Array, rotation: Array) -> Array:
    """The commanded part of the closure, at one pose or one of every row, lengths per reach."""
    positions = np.broadcast_to(position, (len(joints), 3))
    found = machine.closure.equations(joints, positions, np.broadcast_to(rotation, (len(joints), 3, 3)))
    entries = 0 if machine.mechanism.is_platform else 3 * len(machine.closure.columns)
    lengths = found.shape[1] - entries
    return np.hstack([found[:, :lengths] / machine.reach, found[:, lengths:]])


def _solved(machine: Machine, joints: Array, position: Array, rotation: Array) -> NDArray[np.bool_]:
    with np.errstate(invalid="ignore"):
        small = np.abs(_equations(machine, joints, position, rotation)).max(axis=1) < SOLVED
        return small & np.all(machine.closure.positive(joints) > 0, axis=1)
