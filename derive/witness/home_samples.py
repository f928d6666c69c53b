"""Axis values of a platform that moves freely: the closure solved for the joints at poses around its home pose."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from derive.description.mechanism import Mechanism
from derive.ir.interpret import Array, evaluate
from derive.witness.closure import Closure

_SHIFT = 0.02
"""The largest distance of the platform from its home pose, in reaches: a reach is the sum of all coordinates."""
_TURN = np.radians(20.0)
_ITERATIONS = 60


def axes_near_home(
    mechanism: Mechanism, closure: Closure, values: dict[str, Array], parameters: Array, reach: Array, rng: Generator
) -> Array:
    """Axis values at random poses around home, by Newton's method on the closure itself."""
    home = np.stack([np.broadcast_to(evaluate(v, values), reach.shape) for v in mechanism.home], axis=1)
    position = home[:, :3] + _SHIFT * reach[:, None] * rng.uniform(-1.0, 1.0, (len(reach), 3))
    rotation = _turn(2, home[:, 5]) @ _turn(1, home[:, 4]) @ _turn(0, home[:, 3])
    for axis in range(3):
        rotation = _turn(axis, _TURN * rng.uniform(-1.0, 1.0, len(reach))) @ rotation
    pose = np.concatenate([position, rotation.reshape(-1, 9)], axis=1)
    joints = closure.joint_scale(reach)
    for _ in range(_ITERATIONS):
        residual, slopes = (f(joints, pose, parameters) for f in (closure.residual, closure.by_joints))
        joints = joints - (np.linalg.pinv(slopes) @ residual)[:, :, 0]
    units = closure.joint_scale(reach) / closure.axis_scale(reach)
    offsets = np.stack([values[j.offset.name] for j in mechanism.joints], axis=1)
    return np.asarray(joints / units + offsets)


def _turn(axis: int, angle: Array) -> Array:
    matrix = np.zeros((len(angle), 3, 3))
    matrix[:, axis, axis] = 1.0
    first, second = (axis + 1) % 3, (axis + 2) % 3
    matrix[:, first, first] = matrix[:, second, second] = np.cos(angle)
    matrix[:, second, first] = np.sin(angle)
    matrix[:, first, second] = -np.sin(angle)
    return matrix
