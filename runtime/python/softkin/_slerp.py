"""Frames between two frames: the position on a straight line, the rotation about one axis at constant speed."""

from __future__ import annotations

from math import acos, hypot, sin

from softkin._frame import Frame
from softkin._types import Rotation

Quaternion = tuple[float, float, float, float]
_STRAIGHT = 1e-9
"""Quaternions that are nearer than this are joined by a straight line."""


def between(start: Frame, goal: Frame, share: float) -> Frame:
    """The frame at a share of the way, 0 to 1; at both ends exactly these frames."""
    if share <= 0.0 or share >= 1.0:
        return start if share <= 0.0 else goal
    x, y, z = (a + share * (b - a) for a, b in zip(start.position, goal.position, strict=True))
    if start.rotation == goal.rotation:
        return Frame((x, y, z), start.rotation)
    return Frame((x, y, z), rotation_of(_slerp(quaternion_of(start.rotation), quaternion_of(goal.rotation), share)))


def angle_between(start: Rotation, goal: Rotation) -> float:
    """The angle of the turn from one rotation to the other, in radians."""
    along = sum(a * b for a, b in zip(quaternion_of(start), quaternion_of(goal), strict=True))
    return 2.0 * acos(min(abs(along), 1.0))


def quaternion_of(rotation: Rotation) -> Quaternion:
    """The unit quaternion (w, x, y, z) of a rotation: the largest of its four numbers first, so that none is lost."""
    (a, b, c), (d, e, f), (g, h, i) = rotation
    squares = (1.0 + a + e + i, 1.0 + a - e - i, 1.0 - a + e - i, 1.0 - a - e + i)
    largest = max(range(4), key=squares.__getitem__)
    rows = (
        (squares[0], h - f, c - g, d - b),
        (h - f, squares[1], b + d, c + g),
        (c - g, b + d, squares[2], f + h),
        (d - b, c + g, f + h, squares[3]),
    )
    return _unit(*rows[largest])


def rotation_of(quaternion: Quaternion) -> Rotation:
    """The rotation of a unit quaternion."""
    w, x, y, z = quaternion
    return (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )


def _slerp(start: Quaternion, goal: Quaternion, share: float) -> Quaternion:
    along = sum(a * b for a, b in zip(start, goal, strict=True))
    sense = 1.0 if along >= 0.0 else -1.0
    angle = acos(min(abs(along), 1.0))
    first, second = (1.0 - share, share) if angle < _STRAIGHT else (sin((1.0 - share) * angle), sin(share * angle))
    w, x, y, z = (first * a + second * sense * b for a, b in zip(start, goal, strict=True))
    return _unit(w, x, y, z)


def _unit(w: float, x: float, y: float, z: float) -> Quaternion:
    length = hypot(w, x, y, z)
    return w / length, x / length, y / length, z / length
