"""Neighbouring axes at nearly a multiple of 15 degrees, put at it: that is what a closed form may need.

The later axis is turned about the common normal, together with all that it carries. A turn about an axis itself is an
offset of its joint: no structure needs that, so it stays.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from derive.importing.arms.lines import ROUNDING, Arm, way_places
from derive.importing.arms.snapping import Snapped, nearest_angle
from derive.importing.robot import Array, about


def aligned(arm: Arm, names: Sequence[str], limit: float) -> tuple[Arm, tuple[Snapped, ...]]:
    """The arm with the exact angles, and the changes. limit: in radians."""
    moved: list[Snapped] = []
    for place in range(1, len(arm.lines) + 1):
        is_tip = place == len(arm.lines)
        before = arm.lines[place - 1].direction
        after = arm.tip[:3, _column(arm, before)] if is_tip else arm.lines[place].direction
        turn, amount, angle = _to_simple(before, after)
        if ROUNDING < amount <= limit:
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
