"""Numbers that a file has rounded, put back: 1.570796325 is meant to be a right angle.

Nothing is moved by more than the limit, a share of the machine's size (lengths) or of one radian (angles); what was
moved is listed, and bounds how far forward kinematics can be from the file's.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from derive.importing.arms.lines import ROUNDING
from derive.importing.robot import Array, Oriented, Place, Robot, Shifted, Step, Turned

STEP = np.pi / 12
"""Angles are put back to multiples of 15 degrees: right angles, and those that inclined wrists have."""
_NEARLY = 2e-3
"""What is farther from a multiple of 15 degrees is an angle of the machine's own: 3.142 is 4e-4 off."""


@dataclass(frozen=True)
class Snapped:
    """Something that was moved, by how much (radians or lengths)."""

    what: str
    amount: float
    is_angle: bool


def nearest_angle(angle: float) -> float:
    """The nearest multiple of 15 degrees."""
    return float(round(angle / STEP)) * STEP


def snapped_robot(robot: Robot, limit: float) -> tuple[Robot, tuple[Snapped, ...]]:
    """The robot with the angles of its file put back, and what was moved."""
    moved: list[Snapped] = []
    steps = tuple(replace(s, places=tuple(_place(s, p, limit, moved) for p in s.places)) for s in robot.steps)
    return replace(robot, steps=steps), tuple(moved)


def nearly(robot: Robot, limit: float) -> list[float]:
    """By how much angles of the file miss a multiple of 15 degrees, where that is above the limit, and little."""
    angles = [p.angle for s in robot.steps for p in s.places if isinstance(p, Turned)]
    return [m for a in angles if max(limit, ROUNDING) < (m := abs(a - nearest_angle(a))) < _NEARLY]


def _place(step: Step, place: Place, limit: float, moved: list[Snapped]) -> Place:
    if isinstance(place, Shifted):
        return place
    if isinstance(place, Turned):
        angle = nearest_angle(place.angle)
        amount = abs(angle - place.angle)
        if amount > max(limit, ROUNDING):
            return place
        if amount > ROUNDING:
            moved.append(Snapped(f"{step.name}: {place.angle:.10g} read as {np.degrees(angle):g}°", amount, True))
        return Turned(place.axis, angle)
    right = right_angled(np.array(place.rows))
    amount = angle_between(right, np.array(place.rows))
    if amount > max(limit, ROUNDING):
        return place
    if amount > ROUNDING:
        moved.append(Snapped(f"{step.name}: its orientation read as one of right angles", amount, True))
    rows = tuple(tuple(map(float, row)) for row in right)
    return Oriented(rows)  # type: ignore[arg-type]


def right_angled(rotation: Array) -> Array:
    """The rotation with entries 0 and ±1 that is nearest in its largest entries; itself where there is none."""
    rounded = np.round(rotation)
    return rounded if np.allclose(rounded @ rounded.T, np.eye(3)) and np.linalg.det(rounded) > 0.0 else rotation


def angle_between(first: Array, second: Array) -> float:
    """The angle of the rotation between two."""
    return float(np.linalg.norm(first - second) / np.sqrt(2.0))
