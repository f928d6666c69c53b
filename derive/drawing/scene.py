"""A drawing as data: bodies, joints, dimensions and frames, in the coordinates of the machine.

Labels are expressions in the names of parameters and axes, in interface units: a language spells them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

import numpy as np
import sympy as sp

from derive.ir.interpret import Array

Point = tuple[float, float, float]
_APART = 1e-6


class Body(Enum):
    """The kind of body to which a drawn segment belongs."""

    LINK = "link"
    ROD = "rod"
    PLATE = "plate"
    BASE = "base"


@dataclass(frozen=True)
class Segment:
    """A straight part of a body."""

    start: Point
    end: Point
    body: Body
    across: Point | None = None
    """For a rod that stands for a parallelogram, the vector from its middle line to one of the two parallel rods."""


@dataclass(frozen=True)
class Turn:
    """A rotary joint: its axis points where a positive turn is counter-clockwise seen against it."""

    label: sp.Expr
    """Zero if bars turn the joint back: nothing drives it, and it has no arrow."""
    at: Point
    axis: Point
    toward: Point | None = None
    """The direction of the body that turns; None if it lies along the axis."""
    zero: Point | None = None
    """The same direction at joint value zero, where the drawn pose is another."""


@dataclass(frozen=True)
class Slide:
    """A linear joint: its axis points to positive values."""

    label: sp.Expr
    at: Point
    axis: Point
    has_rail: bool = True
    has_arrow: bool = True
    """False for a rail that several drives move together: every drive has an arrow of its own."""


@dataclass(frozen=True)
class Dimension:
    """A length between two points; a negative length points against its positive direction."""

    label: sp.Expr
    start: Point
    end: Point
    is_negative: bool = False


@dataclass(frozen=True)
class Arc:
    """An angle of the machine: from one direction to another, at a point."""

    label: sp.Expr
    at: Point
    start: Point
    end: Point


@dataclass(frozen=True)
class Spot:
    """A point that parameters give by its coordinates."""

    labels: tuple[sp.Expr, ...]
    at: Point


@dataclass(frozen=True)
class Frame:
    """A frame: its origin, and its axes as the columns of its rotation."""

    position: Point
    rotation: tuple[Point, Point, Point]
    """By rows."""


ORIGIN = Frame((0.0, 0.0, 0.0), ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
"""The frame of the machine."""


@dataclass(frozen=True)
class Motor:
    """A fixed motor of a belt: its axis points where a positive drive turns it counter-clockwise seen against it."""

    label: sp.Expr
    at: Point
    axis: Point


@dataclass(frozen=True)
class Belt:
    """A belt that motors share: its line, the wheels it goes around, and the frame of the machine."""

    path: tuple[Point, ...]
    wheels: tuple[Point, ...]
    motors: tuple[Motor, ...]
    radius: float
    normal: Point
    frame: tuple[Segment, ...]
    tips: tuple[Point, Point]
    """The places for the names of the shared motions: at an end of the beam, and of the rail or the arm."""


@dataclass(frozen=True)
class Scene:
    """The drawing of a mechanism in one pose."""

    segments: tuple[Segment, ...]
    turns: tuple[Turn, ...]
    slides: tuple[Slide, ...]
    dimensions: tuple[Dimension, ...]
    spots: tuple[Spot, ...]
    grounds: tuple[Point, ...]
    """The points at which the machine is fixed."""
    tool: Frame
    hidden: tuple[sp.Expr, ...] = ()
    """Lengths and angles that are zero in this machine."""
    arcs: tuple[Arc, ...] = ()
    belt: Belt | None = None
    loops: tuple[tuple[sp.Expr, tuple[sp.Expr, ...]], ...] = ()
    """The joints of a chain that loops move, each with the lengths of its loop."""

    @property
    def meetings(self) -> tuple[tuple[Point, tuple[sp.Expr, ...]], ...]:
        """The points in which the axes of three rotary joints or more meet, one after the other, with their names."""
        return tuple(_meetings(self.turns))

    @property
    def size(self) -> float:
        """The largest extent of the drawing; 0 where everything is in one point."""
        points = np.array([(0.0, 0.0, 0.0), self.tool.position, *(p for s in self.segments for p in (s.start, s.end))])
        return float(np.max(np.ptp(points, axis=0)))


def _meetings(turns: tuple[Turn, ...]) -> Iterator[tuple[Point, tuple[sp.Expr, ...]]]:
    """Axes that meet: no two neighbours are parallel, and every axis goes through the point of the first two."""
    last: tuple[sp.Expr, ...] = ()
    for index in range(len(turns) - 2):
        place = _crossing(turns[index], turns[index + 1])
        if place is None or turns[index].label in last:
            continue
        count = 2
        while index + count < len(turns) and _is_on(turns[index + count], place):
            count += 1
        last = tuple(t.label for t in turns[index : index + count])
        if count > 2 and all(label != 0 for label in last):
            yield point(place), last


def _crossing(one: Turn, other: Turn) -> Array | None:
    """The point that two axes share; None if they are parallel or pass each other."""
    a, b, between = np.array(one.axis), np.array(other.axis), np.subtract(other.at, one.at)
    normal = np.cross(a, b)
    if np.linalg.norm(normal) < _APART or abs(between @ normal) > _APART * (1.0 + float(np.linalg.norm(between))):
        return None
    return np.asarray(np.array(one.at) + (np.cross(between, b) @ normal) / (normal @ normal) * a)


def _is_on(turn: Turn, place: Array) -> bool:
    between = place - np.array(turn.at)
    return bool(np.linalg.norm(np.cross(between, turn.axis)) <= _APART * (1.0 + float(np.linalg.norm(between))))


def point(values: Array) -> Point:
    """A vector as a point; a vector in the plane lies at z = 0."""
    x, y, *rest = (float(v) for v in values)
    return (x, y, rest[0] if rest else 0.0)


def frame_of(values: tuple[float, ...]) -> Frame:
    """A frame by its position and its rotation by rows."""
    rows = [point(np.array(values[3 + 3 * i : 6 + 3 * i])) for i in range(3)]
    return Frame(point(np.array(values[:3])), (rows[0], rows[1], rows[2]))
