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
_OVER_TEXT, _ANY_TEXT, _OVER_INK, _THROUGH, _ON_LINE, _OUTSIDE = 3.0, 400.0, 3.0, 12.0, 5.0, 5000.0
"""The cost of a covered pixel of text, of any text that is covered, of a covered piece of a line, of a piece of a
label's line through another label and along or across another label's line, and of a place outside the page."""
_ROUNDS = 8
"""How often all labels are placed again."""

Extent = tuple[float, float, float, float]


@dataclass(frozen=True, eq=False)
class Place:
    """A place for a label, its own cost, and the marks that are drawn with the label."""

    at: Vector
    cost: float
    marks: tuple[Mark, ...] = ()


@dataclass(frozen=True)
class _Label:
    """A label and its possible places; what is drawn before all labels costs each of them a fixed amount."""

    text: str
    size: float
    colour: str
    places: tuple[Place, ...]
    is_bold: bool

    def at(self, place: Place) -> Text:
        return Text(self.text, spot(place.at), self.size, self.colour, is_bold=self.is_bold)


@dataclass
class Sheet:
    """The marks on the page so far, and the labels that still seek their places."""

    box: Box
    marks: list[Mark] = field(default_factory=list)
    _labels: list[_Label] = field(default_factory=list)
    _ink: Vector = field(default_factory=lambda: np.zeros((0, 2)))

    def draw(self, marks: Iterable[Mark]) -> None:
        """Add marks, which labels avoid."""
        ink = [self._ink]
        for mark in marks:
            self.marks.append(mark)
            ink.append(_sampled(mark))
        self._ink = np.vstack(ink)

    def label(self, text: str, size: float, colour: str, places: Sequence[Place], *, is_bold: bool = False) -> None:
        """Ask for a label at the best of its places."""
        self._labels.append(_Label(text, size, colour, tuple(places), is_bold))

    def settled(self) -> list[Mark]:
        """All marks. Each label in turn takes its best place beside the others, until all of them keep theirs."""
        fixed = [[self._own_cost(label, place) for place in label.places] for label in self._labels]
        chosen: list[Place] = []
        for k, label in enumerate(self._labels):
            chosen.append(self._best(label, fixed[k], list(zip(self._labels, chosen, strict=False))))
        for _ in range(_ROUNDS):
            before = list(chosen)
            for k, label in enumerate(self._labels):
                others = [pair for i, pair in enumerate(zip(self._labels, chosen, strict=True)) if i != k]
                chosen[k] = self._best(label, fixed[k], others)
            if all(a is b for a, b in zip(before, chosen, strict=True)):
                break
        lines = [mark for place in chosen for mark in place.marks]
        texts = [label.at(place) for label, place in zip(self._labels, chosen, strict=True)]
        return [*self.marks, *lines, *texts]

    def _best(self, label: _Label, fixed: Sequence[float], others: Sequence[tuple[_Label, Place]]) -> Place:
        """The place of the least cost; among equals, the first."""
        cells = frozenset().union(*(_cells_of(place) for _, place in others))
        extents = np.array([_extent(other.at(place)) for other, place in others]).reshape(-1, 4)
        ink = np.vstack([np.zeros((0, 2)), *(_ink_of(place) for _, place in others)])
        costs = [
            round(cost + _between(_extent(label.at(place)), place, extents, ink) + _ON_LINE * _met(place, cells), 3)
            for place, cost in zip(label.places, fixed, strict=True)
        ]
        return label.places[costs.index(min(costs))]

    def _own_cost(self, label: _Label, place: Place) -> float:
        """The cost of a place without other labels."""
        left, bottom, right, top = extent = _extent(label.at(place))
        box = self.box
        outside = left < box.left or right > box.right or bottom < box.bottom or top > box.top
        return place.cost + _OUTSIDE * outside + _OVER_INK * _inside(self._ink, extent)


def _between(extent: Extent, place: Place, extents: Vector, ink: Vector) -> float:
    """The cost of a label beside others: of texts on texts, and of lines of the one through the text of another."""
    wide = np.minimum(extent[2], extents[:, 2]) - np.maximum(extent[0], extents[:, 0])
    high = np.minimum(extent[3], extents[:, 3]) - np.maximum(extent[1], extents[:, 1])
    covered = np.where((wide > 0) & (high > 0), wide * high, 0.0)
    cost = float(np.sum(_OVER_TEXT * covered + _ANY_TEXT * (covered > 0)))
    own = _ink_of(place)
    through = sum(_inside(own, (e[0], e[1], e[2], e[3])) for e in extents)
    return cost + _THROUGH * (through + _inside(ink, extent))


def _met(place: Place, cells: frozenset[tuple[int, int]]) -> int:
    """How many small squares of the page the lines of a label share with those of others."""
    return len(_cells_of(place) & cells)


@cache
def _cells_of(place: Place) -> frozenset[tuple[int, int]]:
    return frozenset((int(x), int(y)) for x, y in _ink_of(place) // _STEP)


@cache
def _ink_of(place: Place) -> Vector:
    return np.vstack([np.zeros((0, 2)), *map(_sampled, place.marks)])


def around(at: Vector, distances: Sequence[float], *, toward: Vector | None = None) -> list[Place]:
    """Places around a point, preferably in a direction."""
    found = []
    for distance in distances:
        for angle in np.arange(0.0, 2 * np.pi, np.pi / 8):
            direction = np.array([np.cos(angle), np.sin(angle)])
            away = 0.0 if toward is None else 12.0 * (1.0 - float(direction @ toward))
            found.append(Place(at + distance * direction * np.array([1.35, 1.0]), 0.25 * distance + away))
    return found


def _extent(text: Text) -> Extent:
    wide, high = text_width(text.text, text.size, text.is_bold) + 5.0, 1.3 * text.size
    x, y = text.at
    left = x if text.is_left else x - wide / 2
    return left, y - high / 2, left + wide, y + high / 2


def _inside(points: Vector, extent: Extent) -> int:
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
