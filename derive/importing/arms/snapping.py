"""Simple angles and rotations near those of a file, and the record of what was moved there.

Nothing is moved by more than the limit, a share of the machine's size (lengths) or of one radian (angles); what was
moved is listed, and bounds how far forward kinematics can be from the file's.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from derive.importing.robot import Array

STEP = np.pi / 12
"""Angles are put back to multiples of 15 degrees: right angles, and those that inclined wrists have."""


@dataclass(frozen=True)
class Snapped:
    """Something that was moved, by how much (radians or lengths)."""

    what: str
    amount: float
    is_angle: bool


def nearest_angle(angle: float) -> float:
    """The nearest multiple of 15 degrees."""
    return float(round(angle / STEP)) * STEP


def right_angled(rotation: Array) -> Array | None:
    """The rotation with entries 0 and ±1 that is nearest in its largest entries; None where there is none."""
    rounded = np.round(rotation)
    return rounded if np.allclose(rounded @ rounded.T, np.eye(3)) and np.linalg.det(rounded) > 0.0 else None


def angle_between(first: Array, second: Array) -> float:
    """The angle of the rotation between two."""
    return float(np.linalg.norm(first - second) / np.sqrt(2.0))
