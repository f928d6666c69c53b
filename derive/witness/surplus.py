"""Axis values of machines with surplus rods: their lengths are those that the closure has at the pose of the others."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from derive.ir.interpret import Array, run
from derive.kinematics.kinematics import Kinematics
from derive.witness.closure import POSE, Closure

_ITERATIONS, _STILL = 60, 1e-16


def at_axes(
    kin: Kinematics, closure: Closure, values: dict[str, Array], parameters: Array, axes: Array
) -> tuple[Array, dict[str, Array], NDArray[np.object_]]:
    """Axis values, the outputs of forward kinematics there, and its answers. values: the machines, with any largest
    miss; axes: those of surplus rods are replaced.
    """

    def forward() -> tuple[dict[str, Array], NDArray[np.object_]]:
        return run(kin.forward, values | {j.axis.name: axes[:, i] for i, j in enumerate(kin.mechanism.joints)})

    outputs, status = forward()
    surplus = [i for i, j in enumerate(kin.mechanism.joints) if j in kin.mechanism.surplus_joints]
    if surplus:
        pose = np.stack([np.broadcast_to(outputs[name], (len(axes),)) for name in POSE], axis=1)
        offsets = np.stack([values[j.offset.name] for j in kin.mechanism.joints], axis=1)
        axes = _fitted(closure, (axes, offsets), pose, parameters, surplus)
        outputs, status = forward()
    return axes, outputs, status


def _fitted(closure: Closure, both: tuple[Array, Array], pose: Array, parameters: Array, surplus: list[int]) -> Array:
    """The axes with the surplus ones solved for by Newton's method on their equations, from a length above each. both:
    axes and their offsets.
    """
    axes, offsets = both
    joints = closure.joints(axes, parameters)[:, :, 0].copy()
    sizes = np.abs(pose[:, :3]).sum(axis=1) + np.abs(parameters).sum(axis=1) + 1.0
    joints[:, surplus] = sizes[:, None]
    for _ in range(_ITERATIONS):
        slopes = closure.by_joints(joints, pose, parameters)[:, :, surplus]
        step = (np.linalg.pinv(slopes) @ closure.residual(joints, pose, parameters))[:, :, 0]
        joints[:, surplus] -= step
        if not np.any(np.abs(step) > _STILL * sizes[:, None]):
            break
    fitted = closure.axes_at(joints, offsets, parameters, np.array([j.in_degrees for j in closure.described.joints]))
    return np.where([i in surplus for i in range(axes.shape[1])], fitted, axes)
