"""The orientations of the flange against the frames of forward kinematics: orientation image and projection."""

from __future__ import annotations

import numpy as np

from derive.ir.interpret import Array, run
from derive.ir.program import Status
from derive.kinematics.kinematics import Freedom, Kinematics
from derive.witness.checks import CLOSURE_TOLERANCE, run_regular, worst
from derive.witness.closure import POSE, Closure
from derive.witness.disagreement import Disagreement
from derive.witness.samples import SEED, Samples, describe, random_machines

_SWING = np.radians(150.0)
"""The largest tilt of a commanded tool direction that must still be projected."""


def check_orientation(kin: Kinematics, samples: Samples) -> float:
    """Every sampled rotation is in the image; a tilted one is projected back to the rotation it was tilted from."""
    rotation = samples.pose[:, 3:].reshape(-1, 3, 3)
    image = run_regular(kin, kin.image, samples)
    zero = np.stack([image[f"zero_{name}"] for name in POSE[3:]], axis=1).reshape(-1, 3, 3)
    if kin.freedom is Freedom.ZERO:
        apart = rotation - zero
    elif kin.freedom is Freedom.THREE:
        apart = zero @ np.swapaxes(zero, 1, 2) - np.eye(3)
    else:
        base, flange = (np.stack([image[f"{w}_{c}"] for c in "xyz"], axis=1)[:, :, None] for w in ("rot", "u"))
        apart = np.concatenate([rotation @ flange - base, zero @ flange - base], axis=2)
    errors = np.max(np.abs(apart), axis=(1, 2))
    return max(worst(kin, "orientation image", errors, samples, CLOSURE_TOLERANCE), _check_projection(kin, samples))


def _check_projection(kin: Kinematics, samples: Samples) -> float:
    if kin.projection is None:
        return 0.0
    rotation = samples.pose[:, 3:].reshape(-1, 3, 3)
    swings = np.eye(3) if kin.freedom is Freedom.THREE else _swings(len(samples))
    tilted = (swings @ rotation).reshape(-1, 9)
    outputs, status = run(kin.projection, samples.values | {name: tilted[:, i] for i, name in enumerate(POSE[3:])})
    if (status != Status.OK).any():
        raise Disagreement(
            f"the projection refuses a tilt: {describe(kin, samples, int(np.argmax(status != Status.OK)))}"
        )
    projected = np.stack([outputs[name] for name in POSE[3:]], axis=1)
    errors = np.max(np.abs(projected - samples.pose[:, 3:]), axis=1)
    return worst(kin, "projection of the orientation", errors, samples, CLOSURE_TOLERANCE)


def _swings(count: int) -> Array:
    """Rotations about horizontal axes: the smallest that tilt the machine's z, without a twist."""
    rng = np.random.default_rng(SEED + 4)
    azimuth, tilt = rng.uniform(-np.pi, np.pi, count), rng.uniform(-_SWING, _SWING, count)
    cross = np.zeros((count, 3, 3))
    cross[:, 0, 2], cross[:, 2, 0] = np.sin(azimuth), -np.sin(azimuth)
    cross[:, 2, 1], cross[:, 1, 2] = np.cos(azimuth), -np.cos(azimuth)
    sine, versine = np.sin(tilt)[:, None, None], 1.0 - np.cos(tilt)[:, None, None]
    return np.asarray(np.eye(3) + sine * cross + versine * cross @ cross)


def check_jointless(kin: Kinematics, closure: Closure) -> tuple[int, float]:
    """Check the frame of every random machine. Returns the number of machines and the largest error."""
    values = random_machines(kin, np.random.default_rng(SEED))
    parameters = np.stack([values[name] for name in closure.parameters], axis=1)
    outputs, status = run(kin.forward, values)
    count = len(parameters)
    pose = np.stack([np.broadcast_to(outputs[name], count) for name in POSE], axis=1)
    expected = closure.frame(np.zeros((count, 0)), parameters)[:, :, 0]
    reach = np.maximum(np.abs(expected[:, :3]).max(axis=1, keepdims=True), np.finfo(float).tiny)
    unit = np.where(np.arange(len(POSE)) < 3, reach, 1.0)
    error = float(np.max(np.abs(pose - expected) / unit))
    if error > CLOSURE_TOLERANCE or np.any(status != Status.OK):
        raise Disagreement(f"the frame of a mechanism without joints: error {error:.1e}")
    return count, error
