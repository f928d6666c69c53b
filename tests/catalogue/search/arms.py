"""Arms whose last axis stands beside the wrist centre, and independent truth about them: the chain multiplied out."""

from functools import reduce

import numpy as np
import softkin
from numpy.typing import NDArray

from tests.orthonormal import turned

Array = NDArray[np.float64]
IRB_2400 = {"d1": 615.0, "a1": 100.0, "a2": 705.0, "a3": 135.0, "d4": 755.0, "d6": 85.0}
"""Dimensions of a known robot, which has a spherical wrist."""
LATERALS = (60.0, -35.0, 8.0)


def arm(lateral: float = 0.0) -> softkin.Ac6RZRYRYRXRYRZJ6Offset:
    """The known robot with its last axis beside the wrist centre."""
    return softkin.Ac6RZRYRYRXRYRZJ6Offset(**IRB_2400, j6_offset_x=lateral)


def frame(axes: Array, lateral: float) -> Array:
    """The homogeneous matrix (4, 4) at axis values (6) in degrees, multiplied out; of many rows at once."""
    q, k = np.moveaxis(np.radians(axes), -1, 0), IRB_2400
    steps = (
        turn(2, q[0]), shift(k["a1"], 0, k["d1"]), turn(1, q[1]), shift(0, 0, k["a2"]), turn(1, q[2]),
        shift(k["d4"], 0, k["a3"]), turn(0, q[3]), turn(1, q[4]), shift(lateral, 0, 0), turn(2, q[5]),
        shift(0, 0, k["d6"]),
    )  # fmt: skip
    return np.asarray(reduce(np.matmul, steps))


def turn(axis: int, angle: Array) -> Array:
    matrix = np.tile(np.eye(4), (*np.shape(angle), 1, 1))
    matrix[..., :3, :3] = turned(axis, angle)
    return matrix


def shift(x: float, y: float, z: float) -> Array:
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def posed(matrix: Array) -> tuple[Array, Array]:
    return matrix[:3, 3], matrix[:3, :3]


def miss(axes: Array, lateral: float, wanted: Array) -> float:
    """The largest difference of the frame at these axes, lengths in metres."""
    difference = frame(axes, lateral) - wanted
    difference[:3, 3] /= 1000.0
    return float(np.abs(difference).max())


def all_roots(wanted: Array, lateral: float, rng: np.random.Generator) -> list[Array]:
    """Every solution that Newton's method finds from many starts, in degrees."""
    axes = rng.uniform(-180, 180, (150, 6))
    for _ in range(40):
        here = frame(axes, lateral)
        columns = [_apart(here, frame(axes + step, lateral)) / 1e-6 for step in 1e-6 * np.eye(6)]
        step = (np.linalg.pinv(np.stack(columns, axis=-1), rcond=1e-9) @ _apart(here, wanted)[:, :, None])[:, :, 0]
        axes = axes + step * np.minimum(1.0, 30.0 / np.maximum(np.abs(step).max(axis=1, keepdims=True), 1e-9))
    reached = np.abs(_apart(frame(axes, lateral), wanted)).max(axis=1) < 1e-12
    found: list[Array] = []
    for root in axes[reached]:
        if not any(np.abs(np.exp(1j * np.radians(root)) - np.exp(1j * np.radians(o))).max() < 1e-6 for o in found):
            found.append(root)
    return found


def _apart(here: Array, there: Array) -> Array:
    """The small motions from one frame to the other: metres and radians."""
    turned = there[..., :3, :3] @ np.swapaxes(here[..., :3, :3], -1, -2)
    spin = np.stack([turned[..., i, j] - turned[..., j, i] for i, j in ((2, 1), (0, 2), (1, 0))], axis=-1) / 2
    length = np.maximum(np.linalg.norm(spin, axis=-1, keepdims=True), 1e-9)
    is_far = np.trace(turned, axis1=-2, axis2=-1)[..., None] < 1.0  # beyond a right angle the sine falls again
    moved = (there[..., :3, 3] - here[..., :3, 3]) / 1000.0
    return np.concatenate([moved, np.where(is_far, spin / length, spin)], axis=-1)
