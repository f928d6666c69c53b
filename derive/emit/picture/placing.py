"""The places of labels: of several possible places, the one that covers least."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property

import numpy as np
from numpy.typing import NDArray

from derive.emit.picture.canvas import text_width
from derive.emit.picture.ink import Area, Line, Mark, Spot, Text, Vector, spot
from derive.emit.picture.view import Box

_STEP = 5.0
_OVER_TEXT, _ANY_TEXT, _OVER_INK, _THROUGH, _ON_LINE, _OUTSIDE = 3.0, 400.0, 3.0, 12.0, 5.0, 5000.0
"""The cost of a covered pixel of text, of any text that is covered, of a covered piece of a line, of a piece of a
label's line through another label and along or across another label's line, and of a place outside the page."""
_ROUNDS = 8
"""The number of times that all labels are placed again."""
_ROWS = 1 << 12
"""More than the page has rows or columns of cells."""
_NOWHERE = np.zeros((0, 2))
_AROUND = np.array([(np.cos(angle), np.sin(angle)) for angle in np.arange(0.0, 2 * np.pi, np.pi / 8)])
_WIDER = np.array([1.35, 1.0])
"""Texts are wider than high, and so is the ring of places around a point."""


@dataclass(frozen=True, eq=False)
class Place:
    """A place for a label, its own cost, and the marks that are drawn with the label."""

    at: Vector
    cost: float
    marks: tuple[Mark, ...] = ()


@dataclass(frozen=True, eq=False)
class _Label:
    """A label and its possible places; what is drawn before all labels costs each of them a fixed amount."""

    text: str
    size: float
    colour: str
    places: tuple[Place, ...]
    is_bold: bool

    def at(self, place: Place) -> Text:
        return Text(self.text, spot(place.at), self.size, self.colour, is_bold=self.is_bold)

    @cached_property
    def extents(self) -> Vector:
        """The extent of its text at every place: an array of shape (places, 4)."""
        wide, high = text_width(self.text, self.size, self.is_bold) + 5.0, 1.3 * self.size
        centres = np.array([spot(place.at) for place in self.places])
        corner = centres - np.array([wide, high]) / 2
        return np.hstack([corner, corner + np.array([wide, high])])

    @cached_property
    def lines(self) -> tuple[Vector, ...]:
        """The points of its lines at each place."""
        return tuple(_points(place.marks) for place in self.places)

    @cached_property
    def ink(self) -> tuple[Vector, NDArray[np.intp]]:
        """The points of its lines at all places, and of which place each of them is."""
        return np.vstack(self.lines), np.repeat(np.arange(len(self.lines)), [len(points) for points in self.lines])

    @cached_property
    def cells(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """The numbers of the cells of the page that its lines go through, and at which place each of them does."""
        points, owners = self.ink
        columns, rows = (points // _STEP).astype(np.int64).T
        places, cells = np.divmod(np.unique((owners * _ROWS + rows) * _ROWS + columns), _ROWS**2)
        return cells, places


@dataclass
class Sheet:
    """The marks on the page so far, and the labels that still seek their places."""

    box: Box
    marks: list[Mark] = field(default_factory=list)
    _labels: list[_Label] = field(default_factory=list)
    _ink: Vector = field(default_factory=lambda: np.zeros((0, 2)))

    def draw(self, marks: Iterable[Mark]) -> None:
        """Add marks, which labels avoid."""
        drawn = list(marks)
        self.marks += drawn
        self._ink = np.vstack([self._ink, _points(drawn)])

    def label(self, text: str, size: float, colour: str, places: Sequence[Place], *, is_bold: bool = False) -> None:
        """Ask for a label at the best of its places."""
        self._labels.append(_Label(text, size, colour, tuple(places), is_bold))

    def settled(self) -> list[Mark]:
        """All marks. Each label in turn takes its best place beside the others, until all of them keep theirs."""
        fixed = [self._own_costs(label) for label in self._labels]
        chosen: list[int] = []
        for k, label in enumerate(self._labels):
            chosen.append(self._best(label, fixed[k], list(zip(self._labels, chosen, strict=False))))
        kept = 0
        for k, label in [*enumerate(self._labels)] * _ROUNDS:
            others = [pair for i, pair in enumerate(zip(self._labels, chosen, strict=True)) if i != k]
            best = self._best(label, fixed[k], others)
            kept = kept + 1 if best == chosen[k] else 1
            chosen[k] = best
            if kept == len(chosen):  # each has its best place beside the others as they are
                break
        places = [label.places[place] for label, place in zip(self._labels, chosen, strict=True)]
        texts = [label.at(place) for label, place in zip(self._labels, places, strict=True)]
        return [*self.marks, *(mark for place in places for mark in place.marks), *texts]

    def _best(self, label: _Label, fixed: Vector, others: Sequence[tuple[_Label, int]]) -> int:
        """The number of the place of the least cost; among equals, the first."""
        costs = fixed + _beside(label, others) if others else fixed
        cells, places = label.cells
        if len(cells):
            taken = [other.cells[0][other.cells[1] == place] for other, place in others if len(other.cells[0])]
            met = np.isin(cells, np.concatenate([np.zeros(0, dtype=np.int64), *taken]))
            costs = costs + _ON_LINE * np.bincount(places[met], minlength=len(label.places))
        return int(np.argmin(np.round(costs, 3)))

    def _own_costs(self, label: _Label) -> Vector:
        """The cost of every place without other labels."""
        box, (left, bottom, right, top) = self.box, label.extents.T
        outside = (left < box.left) | (right > box.right) | (bottom < box.bottom) | (top > box.top)
        covered = np.count_nonzero(_inside(self._ink, label.extents), axis=1)
        return np.asarray([place.cost for place in label.places] + _OUTSIDE * outside + _OVER_INK * covered)


def _beside(label: _Label, others: Sequence[tuple[_Label, int]]) -> Vector:
    """The cost of every place of a label beside other labels at their places: text covers text, or a line of one label
    goes through the text of another.
    """
    own, extents = label.extents[:, None], np.array([other.extents[place] for other, place in others])
    wide = np.minimum(own[:, :, 2], extents[:, 2]) - np.maximum(own[:, :, 0], extents[:, 0])
    high = np.minimum(own[:, :, 3], extents[:, 3]) - np.maximum(own[:, :, 1], extents[:, 1])
    covered = np.where((wide > 0) & (high > 0), wide * high, 0.0)
    lines = np.vstack([other.lines[place] for other, place in others])
    through = np.count_nonzero(_inside(lines, label.extents), axis=1)
    points, owners = label.ink
    _, hit = np.nonzero(_inside(points, extents))
    through += np.bincount(owners[hit], minlength=len(through))
    return np.asarray(np.sum(_OVER_TEXT * covered + _ANY_TEXT * (covered > 0), axis=1) + _THROUGH * through)


def around(at: Vector, distances: Sequence[float], *, toward: Vector | None = None) -> list[Place]:
    """Places around a point, preferably in a direction."""
    away = np.zeros(len(_AROUND)) if toward is None else 12.0 * (1.0 - _AROUND @ toward)
    return [
        Place(at + distance * direction * _WIDER, 0.25 * distance + float(further))
        for distance in distances
        for direction, further in zip(_AROUND, away, strict=True)
    ]


def _inside(points: Vector, extents: Vector) -> NDArray[np.bool_]:
    """Which points are inside which rectangles: an array of shape (rectangles, points)."""
    left, bottom, right, top = extents.T[:, :, None]
    x, y = points.T
    return np.asarray((x > left) & (x < right) & (y > bottom) & (y < top))


def _points(marks: Iterable[Mark]) -> Vector:
    """Points along lines, and along the edges of areas."""
    found = [point for mark in marks for point in _sampled(mark)]
    return np.array(found) if found else _NOWHERE


@cache
def _sampled(mark: Mark) -> tuple[Spot, ...]:
    """Points along a line, or along the edge of an area."""
    if isinstance(mark, Text):
        return ()
    ends = (*mark.points, mark.points[0]) if isinstance(mark, Area) else mark.points
    found = [ends[0]]
    for (x, y), (u, v) in zip(ends, ends[1:], strict=False):
        count = max(1, int(math.hypot(u - x, v - y) / _STEP))
        found += [(x + (u - x) * k / count, y + (v - y) * k / count) for k in range(1, count + 1)]
    return tuple(found) * (2 if isinstance(mark, Line) and mark.width > 4.0 else 1)


def extent(marks: Iterable[Mark]) -> Box:
    """The rectangle that marks cover."""
    found = np.array([corner for mark in marks for corner in _corners(mark)])
    (left, bottom), (right, top) = found.min(axis=0), found.max(axis=0)
    return Box(float(left), float(bottom), float(right), float(top))


def _corners(mark: Mark) -> Sequence[Spot]:
    if not isinstance(mark, Text):
        half = mark.width / 2
        return [(x + side * half, y + side * half) for x, y in mark.points for side in (-1.0, 1.0)]
    (x, y), wide, high = mark.at, text_width(mark.text, mark.size, mark.is_bold), 0.65 * mark.size
    left = x if mark.is_left else x - wide / 2
    return [(left, y - high), (left + wide, y + high)]
