"""The places of labels: of several possible places, the one that covers least."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cache

import numpy as np

from derive.emit.picture.canvas import text_width
from derive.emit.picture.ink import Area, Line, Mark, Text, Vector, spot
from derive.emit.picture.view import Box

_STEP = 5.0
_OVER_TEXT, _OVER_INK, _OUTSIDE = 0.6, 3.0, 2000.0
"""The cost of a covered pixel of text, of a covered piece of a line, and of a place outside the page."""


@dataclass(frozen=True)
class Place:
    """A place for a label, its own cost, and the marks that are drawn with the label."""

    at: Vector
    cost: float
    marks: tuple[Mark, ...] = ()


@dataclass
class Sheet:
    """The marks on the page so far."""

    box: Box
    marks: list[Mark] = field(default_factory=list)
    _texts: list[tuple[float, float, float, float]] = field(default_factory=list)
    _ink: Vector = field(default_factory=lambda: np.zeros((0, 2)))

    def draw(self, marks: Iterable[Mark]) -> None:
        """Add marks, which later labels avoid."""
        ink = [self._ink]
        for mark in marks:
            self.marks.append(mark)
            if isinstance(mark, Text):
                self._texts.append(_extent(mark))
            else:
                ink.append(_sampled(mark))
        self._ink = np.vstack(ink)

    def label(self, text: str, size: float, colour: str, places: Sequence[Place], *, is_bold: bool = False) -> None:
        """Draw a label at the best of its places."""

        def at(place: Place) -> Text:
            return Text(text, spot(place.at), size, colour, is_bold=is_bold)

        best = min(
            places, key=lambda place: round(place.cost + self._cost(at(place), place.marks), 3)
        )  # among equals, the first
        self.draw((*best.marks, at(best)))

    def _cost(self, text: Text, marks: Sequence[Mark]) -> float:
        left, bottom, right, top = text_extent = _extent(text)
        box = self.box
        cost = _OUTSIDE * (left < box.left or right > box.right or bottom < box.bottom or top > box.top)
        for other in self._texts:
            wide = min(right, other[2]) - max(left, other[0])
            high = min(top, other[3]) - max(bottom, other[1])
            cost += _OVER_TEXT * wide * high if wide > 0 and high > 0 else 0.0
        cost += _OVER_INK * _inside(self._ink, text_extent)
        for ink in map(_sampled, marks):
            cost += 12.0 * sum(_inside(ink, other) for other in self._texts)
        return cost


def around(at: Vector, distances: Sequence[float], *, toward: Vector | None = None) -> list[Place]:
    """Places around a point, preferably in a direction."""
    found = []
    for distance in distances:
        for angle in np.arange(0.0, 2 * np.pi, np.pi / 8):
            direction = np.array([np.cos(angle), np.sin(angle)])
            away = 0.0 if toward is None else 12.0 * (1.0 - float(direction @ toward))
            found.append(Place(at + distance * direction * np.array([1.35, 1.0]), 0.25 * distance + away))
    return found


def _extent(text: Text) -> tuple[float, float, float, float]:
    wide, high = text_width(text.text, text.size, text.is_bold) + 5.0, 1.3 * text.size
    x, y = text.at
    left = x if text.is_left else x - wide / 2
    return left, y - high / 2, left + wide, y + high / 2


def _inside(points: Vector, extent: tuple[float, float, float, float]) -> int:
    """How many points are inside a rectangle."""
    left, bottom, right, top = extent
    x, y = points[:, 0], points[:, 1]
    return int(np.count_nonzero((x > left) & (x < right) & (y > bottom) & (y < top)))


@cache
def _sampled(mark: Mark) -> Vector:
    """Points along a line, or along the edge of an area."""
    if isinstance(mark, Text):
        return np.zeros((0, 2))
    points = [np.array(p) for p in mark.points]
    if isinstance(mark, Area):
        points.append(points[0])
    weight = 2 if isinstance(mark, Line) and mark.width > 4.0 else 1
    found = [points[0]]
    for a, b in zip(points, points[1:], strict=False):
        count = max(1, int(np.linalg.norm(b - a) / _STEP))
        found += [a + (b - a) * k / count for k in range(1, count + 1)]
    samples = np.array(found * weight)
    samples.setflags(write=False)
    return samples
