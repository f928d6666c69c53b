"""Arms whose last axis stands beside the wrist centre, and independent truth about them: the chain multiplied out."""

from __future__ import annotations

import numpy as np
import softkin
from numpy.typing import NDArray

Array = NDArray[np.float64]
IRB_2400 = {"d1": 615.0, "a1": 100.0, "a2": 705.0, "a3": 135.0, "d4": 755.0, "d6": 85.0}
"""Dimensions of a known robot, which has a spherical wrist."""
LATERALS = (60.0, -35.0, 8.0)


def arm(lateral: float = 0.0) -> softkin.Ac6RZRYRYRXRYRZJ6Offset:
    """The known robot with its last axis beside the wrist centre."""
    return softkin.Ac6RZRYRYRXRYRZJ6Offset(**IRB_2400, j6_offset_x=lateral)


def frame(axes: Array, lateral: float) -> Array:
    """The homogeneous matrix at axis values in degrees, multiplied out."""
    q, k = np.radians(axes), IRB_2400
    steps = (
        turn(2, q[0]), shift(k["a1"], 0, k["d1"]), turn(1, q[1]), shift(0, 0, k["a2"]), turn(1, q[2]),
        shift(k["d4"], 0, k["a3"]), turn(0, q[3]), turn(1, q[4]), shift(lateral, 0, 0), turn(2, q[5]), shift(0, 0, k["d6"]),
    )
    return np.linalg.multi_dot(steps)


def turn(axis: int, angle: float) -> Array:
    """A turn about a coordinate axis."""
    matrix, (i, j) = np.eye(4), ((axis + 1) % 3, (axis + 2) % 3)
    matrix[i, i] = matrix[j, j] = np.cos(angle)
    matrix[j, i] = np.sin(angle)
    matrix[i, j] = -matrix[j, i]
    return matrix


def shift(x: float, y: float, z: float) -> Array:
    """A shift."""
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def posed(matrix: Array) -> tuple[Array, Array]:
    """Position and rotation."""
    return matrix[:3, 3], matrix[:3, :3]


def miss(axes: Array, lateral: float, wanted: Array) -> float:
    """The largest difference of the frame at these axes, lengths in metres."""
    difference = frame(axes, lateral) - wanted
    difference[:3, 3] /= 1000.0
    return float(np.abs(difference).max())


def all_roots(wanted: Array, lateral: float, rng: np.random.Generator) -> list[Array]:
    """Every solution that Newton's method finds from many starts, in degrees within one turn."""
    found: list[Array] = []
    for start in rng.uniform(-180, 180, (150, 6)):
        axes = _newton(start, lateral, wanted)
        if axes is None:
            continue
        if not any(np.abs(np.exp(1j * np.radians(axes)) - np.exp(1j * np.radians(o))).max() < 1e-6 for o in found):
            found.append(axes)
    return found


def _newton(axes: Array, lateral: float, wanted: Array) -> Array | None:
    for _ in range(40):
        here = frame(axes, lateral)
        twist = _apart(here, wanted)
        if np.abs(twist).max() < 1e-12:
            return axes
        columns = [_apart(here, frame(axes + step, lateral)) / 1e-6 for step in 1e-6 * np.eye(6)]
        matrix = np.stack(columns, axis=1)
        step = np.linalg.lstsq(matrix, twist, rcond=1e-9)[0]
        axes = axes + step * min(1.0, 30.0 / max(np.abs(step).max(), 1e-9))
    return None


def _apart(here: Array, there: Array) -> Array:
    """The small motion from one frame to the other: metres and radians."""
    turned = there[:3, :3] @ here[:3, :3].T
    spin = np.array([turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]]) / 2
    if np.trace(turned) < 1.0:
        spin = spin / max(np.linalg.norm(spin), 1e-9)  # beyond a right angle the sine falls again
    return np.concatenate([(there[:3, 3] - here[:3, 3]) / 1000.0, spin])
