"""The marks on a page: lines, areas and texts, in pixels with y upward."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Spot = tuple[float, float]
Vector = NDArray[np.float64]
_DECIMALS = 1
"""Coordinates are rounded to this many decimals, so that the last bit of a number does not change a file."""
_HEAD, _HALF = 9.0, 3.4
"""The length of an arrow head, and half of its width."""


@dataclass(frozen=True)
class Line:
    """A stroke through points."""

    points: tuple[Spot, ...]
    colour: str
    width: float
    dashes: tuple[float, ...] = ()


@dataclass(frozen=True)
class Area:
    """A filled polygon."""

    points: tuple[Spot, ...]
    fill: str
    edge: str
    width: float = 1.0


@dataclass(frozen=True)
class Text:
    """A line of text with its centre, or its left end at half of its height, at a point."""

    text: str
    at: Spot
    size: float
    colour: str
    is_left: bool = False
    is_bold: bool = False
    has_ground: bool = True
    """Whether the text covers what is drawn below it."""


Mark = Line | Area | Text


def spot(point: Iterable[float]) -> Spot:
    """A point of the page."""
    x, y = point
    return round(float(x), _DECIMALS) + 0.0, round(float(y), _DECIMALS) + 0.0


def line(points: Iterable[Iterable[float]], colour: str, width: float, dashes: tuple[float, ...] = ()) -> Line:
    """A stroke through points."""
    return Line(tuple(spot(p) for p in points), colour, width, dashes)


def area(points: Iterable[Iterable[float]], fill: str, edge: str, width: float = 1.0) -> Area:
    """A filled polygon."""
    return Area(tuple(spot(p) for p in points), fill, edge, width)


def head(tip: Sequence[float] | Vector, direction: Vector, colour: str, size: float = 1.0) -> Area:
    """The head of an arrow; it has no size where the direction vanishes."""
    end, length = np.asarray(tip, dtype=float), float(np.linalg.norm(direction))
    along = direction / length if length > 1e-9 else np.zeros(2)
    across = np.array([-along[1], along[0]])
    back = end - _HEAD * size * along
    return area([end, back + _HALF * size * across, back - _HALF * size * across], colour, colour, 0.5)


def arrow(points: Sequence[Vector], colour: str, width: float, size: float = 1.0) -> list[Mark]:
    """A stroke with a head at its end."""
    last, before = points[-1], points[-2]
    along = last - before
    short = last - along / max(float(np.linalg.norm(along)), 1e-9) * 0.8 * _HEAD * size
    far = np.linalg.norm(along) > _HEAD * size
    return [line([*points[:-1], short if far else last], colour, width), head(last, along, colour, size)]


def moved(marks: Iterable[Mark], right: float, up: float) -> list[Mark]:
    """The marks elsewhere on the page."""

    def there(at: Spot) -> Spot:
        return spot((at[0] + right, at[1] + up))

    return [
        replace(mark, at=there(mark.at))
        if isinstance(mark, Text)
        else replace(mark, points=(*map(there, mark.points),))
        for mark in marks
    ]
