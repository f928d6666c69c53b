"""Simple angles and rotations near those of a file, and the record of such changes.

No value is changed by more than the limit, a share of the machine's size (lengths) or of one radian (angles). The
changes are listed, and bound the difference of forward kinematics from the file's.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from derive.importing.robot import Array

SNAP = 1e-6
"""The default limit; angles that no structure needs are never changed by more, unless the file has rounded them."""
STEP = np.pi / 12
"""Angles become multiples of 15 degrees: right angles, and those of inclined wrists."""


@dataclass(frozen=True)
class Snapped:
    """A value that was changed, and the amount (radians or lengths)."""

    what: str
    amount: float
    is_angle: bool


def nearest_angle(angle: float) -> float:
    """The nearest multiple of 15 degrees."""
    return float(round(angle / STEP)) * STEP


def right_angled(rotation: Array) -> Array | None:
    """The rotation with entries 0 and ±1 that is nearest in its largest entries; None if there is none."""
    rounded = np.round(rotation)
    return rounded if np.allclose(rounded @ rounded.T, np.eye(3)) and np.linalg.det(rounded) > 0.0 else None


def angle_between(first: Array, second: Array) -> float:
    """The angle of the rotation between two."""
    return float(np.linalg.norm(first - second) / np.sqrt(2.0))
