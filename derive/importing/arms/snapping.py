"""Simple angles and rotations near those of a file, and the record of such changes.

No value is changed by more than the limit, a share of the machine's size (lengths) or of one radian (angles). The
changes are listed, and bound the difference of forward kinematics from the file's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from derive.importing.arms.lines import ROUNDING, Arm, way_places
from derive.importing.robot import Array, about

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


def aligned(arm: Arm, names: Sequence[str], limit: float) -> tuple[Arm, tuple[Snapped, ...]]:
    """The arm with neighbouring axes at exact multiples of 15 degrees, and the changes. limit: in radians, unless the
    file has rounded more.

    The later axis is turned about the common normal, together with all that it carries. A turn about an axis itself is
    an offset of its joint: no structure needs that, so it stays.
    """
    moved: list[Snapped] = []
    for place in range(1, len(arm.lines) + 1):
        is_tip = place == len(arm.lines)
        before = arm.lines[place - 1].direction
        after = arm.tip[:3, _column(arm, before)] if is_tip else arm.lines[place].direction
        turn, amount, angle = _to_simple(before, after)
        if ROUNDING < amount <= arm.limit(place, limit):
            there = arm.tip[:3, 3] if is_tip else way_places(arm.lines, arm.tip[:3, 3])[place]
            arm = _turned(arm, place, turn, there)
            pair = f"{names[place - 1]}-{'tip' if is_tip else names[place]}"
            moved.append(Snapped(f"{pair}: their angle read as {np.degrees(angle):g}°, off", amount, True))
    return arm, tuple(moved)


def _column(arm: Arm, direction: Array) -> int:
    """The axis of the tip that is nearest to a direction."""
    return int(np.argmax(np.abs(arm.tip[:3, :3].T @ direction)))


def _to_simple(before: Array, after: Array) -> tuple[Array, float, float]:
    """The rotation that puts a direction at a multiple of 15 degrees to the one before, its size, and that multiple."""
    normal = np.cross(before, after)
    sine, cosine = float(np.linalg.norm(normal)), float(before @ after)
    angle = float(np.arctan2(sine, cosine))
    nearest = nearest_angle(angle)
    if sine < ROUNDING:
        return np.eye(3), 0.0, nearest
    return about(normal / sine, nearest - angle), abs(nearest - angle), nearest


def _turned(arm: Arm, place: int, turn: Array, there: Array) -> Arm:
    """The arm with the lines from a place on, and the tip, turned about a point."""
    lines = tuple(
        line if k < place else replace(line, direction=turn @ line.direction, point=there + turn @ (line.point - there))
        for k, line in enumerate(arm.lines)
    )
    tip = arm.tip.copy()
    tip[:3, :3], tip[:3, 3] = turn @ tip[:3, :3], there + turn @ (tip[:3, 3] - there)
    return replace(arm, lines=lines, tip=tip)
