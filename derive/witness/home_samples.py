"""Axis values of a loop that turns its platform: the closure solved for the joints at poses around its home pose."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import sympy as sp
from numpy.random import Generator
from numpy.typing import NDArray

from derive.description.mechanism import Mechanism
from derive.ir.interpret import Array, evaluate
from derive.witness.closure import Closure
from derive.witness.frames import is_miss

_SHIFT = 0.2
"""The largest distance of the platform from its home pose, in reaches."""
_TURN = np.radians(20.0)
_ITERATIONS = 60
_ROUNDS = 12
_STILL = 1e-15


def axes_near_home(
    mechanism: Mechanism, closure: Closure, values: dict[str, Array], parameters: Array, reach: Array, rng: Generator
) -> Array:
    """Axis values at random poses around home, by Newton's method on the closure itself."""
    home = poses_at_home(closure, values, reach)
    position = home[:, :3].copy()
    width = len(mechanism.task.position)
    own = ["xyz".index(c) for c in mechanism.task.position]
    position[:, own] += _SHIFT * reach[:, None] * rng.uniform(-1.0, 1.0, (len(reach), width))
    rotation = home[:, 3:].reshape(-1, 3, 3)
    for row in (r for r in closure.task[width:] if not is_miss(r)):
        rotation = _turn("xyz".index(row[-1]), _TURN * rng.uniform(-1.0, 1.0, len(reach))) @ rotation
    pose = on_guides(closure, np.concatenate([position, rotation.reshape(-1, 9)], axis=1), parameters)
    offsets = np.stack([values[j.offset.name] for j in mechanism.joints], axis=1)
    in_degrees = np.array([j.in_degrees for j in mechanism.joints])
    joints = joints_at(mechanism, closure, pose, parameters, reach, rng)
    return closure.axes_at(joints, offsets, parameters, in_degrees)


def on_guides(closure: Closure, pose: Array, parameters: Array) -> Array:
    """The poses with passive coordinates at which the guides hold the platform, by Newton's method."""
    joints = {j.symbol for j in closure.described.joints}
    rows = [k for k, e in enumerate(closure.described.equations) if not sp.sympify(e).free_symbols & joints]
    passive, columns = closure.moved[len(closure.task) :], slice(len(closure.task), None)
    still = np.zeros((len(pose), len(joints)))  # no fixed guide reads them
    for _ in range(_ITERATIONS if passive else 0):
        slopes = closure.by_pose(still, pose, parameters)[:, rows, columns]
        step = -(np.linalg.pinv(slopes) @ closure.residual(still, pose, parameters)[:, rows])[:, :, 0]
        step = np.clip(step, -1.0, 1.0) if "tilt z" in passive and len(passive) == 1 else step
        rotation = pose[:, 3:].reshape(-1, 3, 3)
        position = pose[:, :3].copy()
        for k, row in enumerate(passive):
            if row == "tilt z":
                rotation = rotation @ _turn(2, step[:, k])
            else:
                position[:, "xyz".index(row)] += step[:, k]
        pose = np.concatenate([position, rotation.reshape(-1, 9)], axis=1)
        if np.abs(step).max() <= _STILL * (1.0 + np.abs(pose).max()):
            break
    return pose


def poses_at_home(closure: Closure, values: dict[str, Array], reach: Array) -> Array:
    """The home pose of every machine: position, then rotation by rows."""
    own, coordinates = closure.described_values(values), sorted(closure.coordinates)
    home = np.stack([np.broadcast_to(evaluate(v, own), reach.shape) for v in closure.described.home], axis=1)
    width = len(coordinates)
    position = np.zeros((len(reach), 3))
    position[:, ["xyz".index(c) for c in coordinates]] = home[:, :width]
    turns = dict(zip((2,) if home.shape[1] - width == 1 else (0, 1, 2), home[:, width:].T, strict=True))
    rotation = np.tile(np.eye(3), (len(reach), 1, 1))
    for axis, angle in turns.items():
        rotation = _turn(axis, angle) @ rotation
    return np.concatenate([position, rotation.reshape(-1, 9)], axis=1)


def joints_at(
    mechanism: Mechanism, closure: Closure, pose: Array, parameters: Array, reach: Array, rng: Generator
) -> Array:
    """Joint values at poses, by Newton's method; from anywhere where a leg has several.

    mechanism: its rods tell which legs have several. If a quantity that must be positive is not,
    the joints on which it depends start elsewhere once more.
    """
    joints = closure.joint_size(reach)
    is_one_of_many = len(measured_legs(mechanism)) < len(mechanism.rods)
    if is_one_of_many:
        joints = _anywhere(closure, reach, rng)
    joints = _solved(closure, joints, pose, parameters, reach if is_one_of_many else None)
    for _ in range(_ROUNDS if is_one_of_many and closure.described.positive else 0):
        negative = closure.positive(joints, pose, parameters)[:, :, 0] <= 0
        again = (negative @ touched(closure.positive, joints, pose, parameters)) > 0
        if not again.any():
            break
        joints = np.where(again, _anywhere(closure, reach, rng), joints)
        joints = _solved(closure, joints, pose, parameters, reach)
    return joints


def measured_legs(mechanism: Mechanism) -> list[str]:
    """The rods whose base ends no joint moves: their lengths are joints."""
    joints = {j.symbol for j in mechanism.joints}
    return [rod.name for rod in mechanism.rods if not any(v.free_symbols & joints for v in rod.base)]


def _anywhere(closure: Closure, reach: Array, rng: Generator) -> Array:
    size = closure.joint_size(reach) * np.where(closure.angles, np.pi, 2.0)
    return np.asarray(size * rng.uniform(-1.0, 1.0, size.shape))


def _solved(closure: Closure, joints: Array, pose: Array, parameters: Array, longest: Array | None) -> Array:
    """Newton's method; a step is at most `longest`."""
    joints = joints.copy()
    moving = np.arange(len(joints))
    for _ in range(_ITERATIONS):
        state = joints[moving], pose[moving], parameters[moving]
        step = (np.linalg.pinv(closure.by_joints(*state)) @ closure.residual(*state))[:, :, 0]
        if longest is not None:
            step = np.clip(step, -longest[moving, None], longest[moving, None])
        joints[moving] -= step
        moving = moving[np.abs(step).max(axis=1) > _STILL * (1.0 + np.abs(joints[moving]).max(axis=1))]
        if not len(moving):
            break
    return joints


def touched(of: Callable[..., Array], joints: Array, pose: Array, parameters: Array) -> NDArray[np.float64]:
    """Which joints (columns) each quantity (rows) of a function of joints, poses and parameters depends on."""
    one = [part[:1] for part in (joints, pose, parameters)]
    here = of(*one)[0, :, 0]
    columns = []
    for k in range(joints.shape[1]):
        moved = one[0].copy()
        moved[0, k] += 1.0
        columns.append(of(moved, *one[1:])[0, :, 0] != here)
    return np.stack(columns, axis=1).astype(float)


def _turn(axis: int, angle: Array) -> Array:
    matrix = np.zeros((len(angle), 3, 3))
    matrix[:, axis, axis] = 1.0
    first, second = (axis + 1) % 3, (axis + 2) % 3
    matrix[:, first, first] = matrix[:, second, second] = np.cos(angle)
    matrix[:, second, first] = np.sin(angle)
    matrix[:, first, second] = -np.sin(angle)
    return matrix
