"""Axis values of a loop that turns its platform: the closure solved for the joints at poses around its home pose."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from derive.description.mechanism import Mechanism
from derive.ir.interpret import Array, evaluate
from derive.witness.closure import Closure

_SHIFT = 0.2
"""The largest distance of the platform from its home pose, in reaches."""
_TURN = np.radians(20.0)
_ITERATIONS = 60


def axes_near_home(
    mechanism: Mechanism, closure: Closure, values: dict[str, Array], parameters: Array, reach: Array, rng: Generator
) -> Array:
    """Axis values at random poses around home, by Newton's method on the closure itself."""
    home = poses_at_home(mechanism, values, reach)
    position = home[:, :3].copy()
    width = len(mechanism.task.position)
    position[:, :width] += _SHIFT * reach[:, None] * rng.uniform(-1.0, 1.0, (len(reach), width))
    rotation = home[:, 3:].reshape(-1, 3, 3)
    for row in closure.task[width:]:
        rotation = _turn("xyz".index(row[-1]), _TURN * rng.uniform(-1.0, 1.0, len(reach))) @ rotation
    pose = np.concatenate([position, rotation.reshape(-1, 9)], axis=1)
    units = closure.joint_scale(reach) / closure.axis_scale(reach)
    offsets = np.stack([values[j.offset.name] for j in mechanism.joints], axis=1)
    return np.asarray(joints_at(mechanism, closure, pose, parameters, reach, rng) / units + offsets)


def poses_at_home(mechanism: Mechanism, values: dict[str, Array], reach: Array) -> Array:
    """The home pose of every machine: position, then rotation by rows."""
    home = np.stack([np.broadcast_to(evaluate(v, values), reach.shape) for v in mechanism.home], axis=1)
    width = len(mechanism.task.position)
    position = np.zeros((len(reach), 3))
    position[:, :width] = home[:, :width]
    turns = dict(zip((2,) if home.shape[1] - width == 1 else (0, 1, 2), home[:, width:].T, strict=True))
    rotation = np.tile(np.eye(3), (len(reach), 1, 1))
    for axis, angle in turns.items():
        rotation = _turn(axis, angle) @ rotation
    return np.concatenate([position, rotation.reshape(-1, 9)], axis=1)


def joints_at(
    mechanism: Mechanism, closure: Closure, pose: Array, parameters: Array, reach: Array, rng: Generator
) -> Array:
    """Joint values at poses, by Newton's method; with branches from anywhere."""
    joints = closure.joint_scale(reach)
    if mechanism.branches:
        joints = joints * np.where(closure.angles, np.pi, 1.0) * rng.uniform(-1.0, 1.0, joints.shape)
    for _ in range(_ITERATIONS):
        residual, slopes = (f(joints, pose, parameters) for f in (closure.residual, closure.by_joints))
        step = (np.linalg.pinv(slopes) @ residual)[:, :, 0]
        joints = joints - (np.clip(step, -reach[:, None], reach[:, None]) if mechanism.branches else step)
    return np.asarray(joints)


def _turn(axis: int, angle: Array) -> Array:
    matrix = np.zeros((len(angle), 3, 3))
    matrix[:, axis, axis] = 1.0
    first, second = (axis + 1) % 3, (axis + 2) % 3
    matrix[:, first, first] = matrix[:, second, second] = np.cos(angle)
    matrix[:, second, first] = np.sin(angle)
    matrix[:, first, second] = -np.sin(angle)
    return matrix
