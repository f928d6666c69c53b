"""A robot as lines: the positions of its axes at joint values of zero, in the frame of the base.

Forward kinematics is the product of the motions about these lines, times the pose of the tip at zero.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from string import ascii_lowercase

import numpy as np

from derive.description.joints import Kind
from derive.importing.formats.documents import COARSE
from derive.importing.robot import Array, Moving, Robot, Shifted, about

ROUNDING = 2e-14
"""Below this share a difference is the rounding of our own calculation, and is not listed."""
_SMALLEST = 1e-9
"""A machine that is smaller (in the unit of the description) has no size."""


@dataclass(frozen=True)
class Line:
    """A movement about (or along) a directed line: by the sum of axis values times their multiples."""

    kind: Kind
    point: Array
    direction: Array
    drives: tuple[tuple[int, float], ...]
    """Numbers of axes, with multipliers."""


@dataclass(frozen=True)
class Arm:
    """The lines of a robot, and its tip at zero (4 x 4)."""

    lines: tuple[Line, ...]
    tip: Array
    size: float
    """The length of the way from the base's nearest point on the first axis, from axis to nearest point of the next, to
    the tip; if that is zero the distance of the tip from the base, or one unit. Lengths are compared with it. It is
    that of the machine, whatever frames the file chooses.
    """
    rounding: float
    """A length below which differences are the rounding of our own calculation."""
    aslant: tuple[float, ...]
    """The largest angles (radians) by which the file has rounded each line against the one before it (the first one
    against the base), then the tip against the last line.
    """

    def limit(self, place: int, stated: float) -> float:
        """The limit of what is snapped between two lines, where more was stated than 0: at least what is rounded."""
        return max(stated, self.aslant[place]) if stated > 0.0 else 0.0


def arm_of(robot: Robot) -> Arm:
    """The lines of a robot. Offsets of joints that follow others are part of its zero."""
    number = {axis.name: k for k, axis in enumerate(robot.axes)}
    frame, written = np.eye(4), 0.0
    lines: list[Line] = []
    aslant, rounded = list[float](), 0.0
    for step in robot.steps:
        for place in step.places:
            matrix = place.matrix()
            if not isinstance(place, Shifted) and place.rounding < COARSE:
                rounded += place.rounding
            frame = frame @ matrix
            written += float(np.linalg.norm(matrix[:3, 3]))
        if step.moving is not None:
            direction = frame[:3, :3] @ np.array(step.moving.direction)
            drives = tuple((number[name], multiplier) for name, multiplier in step.moving.drives)
            if drives:
                aslant.append(rounded + step.moving.aslant)
                rounded = step.moving.aslant
                lines.append(Line(step.moving.kind, frame[:3, 3].copy(), direction, drives))
            frame = frame @ motion(step.moving, step.moving.offset)
    lengths = (_way(lines, frame[:3, 3]), float(np.linalg.norm(frame[:3, 3])))
    size = next((length for length in lengths if length > _SMALLEST), 1.0)
    return Arm(tuple(lines), frame, size, ROUNDING * (size + written), (*aslant, rounded))


def _way(lines: Sequence[Line], tip: Array) -> float:
    """The length of the way along all axes that turn to the tip."""
    places = [place for line, place in zip(lines, way_places(lines, tip), strict=True) if line.kind is Kind.ROTARY]
    return float(sum(np.linalg.norm(b - a) for a, b in pairwise([*places, tip])))


def way_places(lines: Sequence[Line], tip: Array) -> list[Array]:
    """A place for every line, whatever point the file gives: from the base to the nearest point of the first line that
    turns, and on to that of the next. A slide stands nowhere, and has the place before it.
    """
    turning = any(line.kind is Kind.ROTARY for line in lines)
    here = np.zeros(3) if turning else tip
    found = []
    for line in lines:
        here = projected(line, here) if line.kind is Kind.ROTARY else here
        found.append(here)
    return found


def projected(line: Line, point: Array) -> Array:
    """The point of a line that is nearest to a point."""
    return np.asarray(line.point + line.direction * float((point - line.point) @ line.direction))


def motion(moving: Moving, value: float) -> Array:
    """The homogeneous matrix of a joint's movement, in its own frame."""
    matrix = np.eye(4)
    direction = np.array(moving.direction)
    if moving.kind is Kind.LINEAR:
        matrix[:3, 3] = direction * value
    elif value != 0.0:
        matrix[:3, :3] = about(direction, value)
    return matrix


def forward(arm: Arm, values: Sequence[float]) -> Array:
    """The pose of the tip (4 x 4) at axis values (radians and lengths)."""
    frame = np.eye(4)
    for line in arm.lines:
        frame = frame @ moved(line, sum(values[k] * multiplier for k, multiplier in line.drives))
    return frame @ arm.tip


def moved(line: Line, value: float) -> Array:
    """The motion of a line by a value, in the frame of the base (4 x 4)."""
    matrix = np.eye(4)
    if line.kind is Kind.LINEAR:
        matrix[:3, 3] = line.direction * value
    else:
        rotation = about(line.direction, value)
        matrix[:3, :3], matrix[:3, 3] = rotation, line.point - rotation @ line.point
    return matrix


def place_names(drives: Iterable[Sequence[tuple[int, float]]], axes: Sequence[str]) -> list[str]:
    """A name for every movement, by the axes that drive it: the first one; if that moves several, A2, A2b, A2c."""
    names: list[str] = []
    counted: Counter[str] = Counter()
    for one in drives:
        axis = axes[one[0][0]]
        others = counted[axis]
        counted[axis] += 1
        names.append(f"{axis}{ascii_lowercase[others % 26] * (others // 26 + 1)}" if others else axis)
    return names


@dataclass(frozen=True)
class Relation:
    """The relation of two lines: their distance, and their angle (radians, at most a right angle)."""

    distance: float
    angle: float


def relation(first: Line, second: Line) -> Relation:
    """The distance and the angle of two lines; a slide has only a direction, and its distance is zero."""
    cross = np.cross(first.direction, second.direction)
    sine = float(np.linalg.norm(cross))
    angle = float(np.arctan2(sine, abs(first.direction @ second.direction)))
    between = second.point - first.point
    if Kind.LINEAR in (first.kind, second.kind):
        return Relation(0.0, angle)
    if sine < 1e-12:
        return Relation(float(np.linalg.norm(np.cross(between, first.direction))), angle)
    return Relation(abs(float(between @ cross)) / sine, angle)


def feet(first: Line, second: Line) -> tuple[Array, Array] | None:
    """The points of two lines that are nearest to each other; None if the lines are (nearly) parallel."""
    cosine = float(first.direction @ second.direction)
    determinant = 1.0 - cosine**2
    if determinant < 1e-6:
        return None
    between = second.point - first.point
    along, other = float(between @ first.direction), float(between @ second.direction)
    return (
        first.point + first.direction * (along - other * cosine) / determinant,
        second.point + second.direction * (along * cosine - other) / determinant,
    )


def spread(lines: Sequence[Line]) -> float:
    """The amount by which three lines miss a common point: their distances, and the distance of their feet on the
    middle one.
    """
    first, middle, last = lines
    before, behind = feet(first, middle), feet(middle, last)
    if before is None or behind is None:
        return float("inf")
    gaps = (before[0] - before[1], behind[0] - behind[1], before[1] - behind[0])
    return float(max(np.linalg.norm(gap) for gap in gaps))
