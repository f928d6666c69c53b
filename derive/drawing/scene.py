"""A drawing as data: bodies, joints, dimensions and frames, in the coordinates of the machine.

Labels are expressions in the names of parameters and axes, in interface units: a language spells them.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
import sympy as sp

from derive.ir.interpret import Array

Point = tuple[float, float, float]


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


@dataclass(frozen=True)
class Turn:
    """A rotary joint: its axis points where a positive turn is counter-clockwise seen against it."""

    label: sp.Expr
    """Zero where bars turn the joint back: nothing drives it, and it has no arrow."""
    at: Point
    axis: Point
    toward: Point | None = None
    """The direction of the body that turns; None where it lies along the axis."""
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
    """None for a rail that several drives move together: every drive has an arrow of its own."""


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


@dataclass(frozen=True)
class Scene:
    """The drawing of a mechanism in one pose."""

    segments: tuple[Segment, ...]
    turns: tuple[Turn, ...]
    slides: tuple[Slide, ...]
    dimensions: tuple[Dimension, ...]
    spots: tuple[Spot, ...]
    grounds: tuple[Point, ...]
    """Where the machine is held."""
    tool: Frame
    hidden: tuple[sp.Expr, ...] = ()
    """Lengths and angles that are zero in this machine."""
    arcs: tuple[Arc, ...] = ()

    @property
    def size(self) -> float:
        """The largest extent of the drawing; 0 where everything is in one point."""
        points = np.array([(0.0, 0.0, 0.0), self.tool.position, *(p for s in self.segments for p in (s.start, s.end))])
        return float(np.max(np.ptp(points, axis=0)))


def point(values: Array) -> Point:
    """A vector as a point; a vector in the plane lies at z = 0."""
    x, y, *rest = (float(v) for v in values)
    return (x, y, rest[0] if rest else 0.0)


def frame_of(values: tuple[float, ...]) -> Frame:
    """A frame by its position and its rotation by rows."""
    rows = [point(np.array(values[3 + 3 * i : 6 + 3 * i])) for i in range(3)]
    return Frame(point(np.array(values[:3])), (rows[0], rows[1], rows[2]))
