"""The places of labels: of several possible places, the one that covers least."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property

import numpy as np
from numpy.typing import NDArray

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
        return np.array([_extent(self.at(place)) for place in self.places])

    @cached_property
    def ink(self) -> tuple[Vector, NDArray[np.intp]]:
        """The points of its lines at all places, and of which place each of them is."""
        points = [_ink_of(place) for place in self.places]
        return np.vstack(points), np.repeat(np.arange(len(points)), [len(p) for p in points])


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
        fixed = [self._own_costs(label) for label in self._labels]
        chosen: list[Place] = []
        for k, label in enumerate(self._labels):
            chosen.append(self._best(label, fixed[k], list(zip(self._labels, chosen, strict=False))))
        kept = 0
        for k, label in [*enumerate(self._labels)] * _ROUNDS:
            others = [pair for i, pair in enumerate(zip(self._labels, chosen, strict=True)) if i != k]
            best = self._best(label, fixed[k], others)
            kept = kept + 1 if best is chosen[k] else 1
            chosen[k] = best
            if kept == len(chosen):  # each has its best place beside the others as they are
                break
        lines = [mark for place in chosen for mark in place.marks]
        texts = [label.at(place) for label, place in zip(self._labels, chosen, strict=True)]
        return [*self.marks, *lines, *texts]

    def _best(self, label: _Label, fixed: Vector, others: Sequence[tuple[_Label, Place]]) -> Place:
        """The place of the least cost; among equals, the first."""
        cells = frozenset().union(*(_cells_of(place) for _, place in others))
        met = np.array([len(_cells_of(place) & cells) for place in label.places])
        costs = fixed + sum(_beside(label, other, place) for other, place in others) + _ON_LINE * met
        return label.places[int(np.argmin(np.round(costs, 3)))]

    def _own_costs(self, label: _Label) -> Vector:
        """The cost of every place without other labels."""
        box, (left, bottom, right, top) = self.box, label.extents.T
        outside = (left < box.left) | (right > box.right) | (bottom < box.bottom) | (top > box.top)
        covered = np.count_nonzero(_inside(self._ink, label.extents), axis=1)
        return np.asarray([place.cost for place in label.places] + _OUTSIDE * outside + _OVER_INK * covered)


@cache
def _beside(label: _Label, other: _Label, place: Place) -> Vector:
    """The cost of every place of a label beside another label at a place: of text on text, and of lines of the one
    through the text of the other.
    """
    extent = np.array([_extent(other.at(place))])
    wide = np.minimum(label.extents[:, 2], extent[:, 2]) - np.maximum(label.extents[:, 0], extent[:, 0])
    high = np.minimum(label.extents[:, 3], extent[:, 3]) - np.maximum(label.extents[:, 1], extent[:, 1])
    covered = np.where((wide > 0) & (high > 0), wide * high, 0.0)
    points, owners = label.ink
    through = np.bincount(owners[_inside(points, extent)[0]], minlength=len(label.places))
    through += np.count_nonzero(_inside(_ink_of(place), label.extents), axis=1)
    return np.asarray(_OVER_TEXT * covered + _ANY_TEXT * (covered > 0) + _THROUGH * through)


@cache
def _cells_of(place: Place) -> frozenset[tuple[int, int]]:
    return frozenset((x, y) for x, y in (_ink_of(place) // _STEP).astype(int).tolist())


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


def _inside(points: Vector, extents: Vector) -> NDArray[np.bool_]:
    """Which points are inside which rectangles: an array of shape (rectangles, points)."""
    left, bottom, right, top = extents.T[:, :, None]
    x, y = points.T
    return np.asarray((x > left) & (x < right) & (y > bottom) & (y < top))


@cache
def _sampled(mark: Mark) -> Vector:
    """Points along a line, or along the edge of an area."""
    if isinstance(mark, Text):
        return np.zeros((0, 2))
    points = [np.array(p) for p in mark.points]
    if isinstance(mark, Area):
        points.append(points[0])
    weight = 2 if isinstance(mark, Line) and mark.width > 4.0 else 1
    found = [points[0][None]]
    for a, b in zip(points, points[1:], strict=False):
        count = max(1, int(np.linalg.norm(b - a) / _STEP))
        found.append(a + (b - a) * np.arange(1, count + 1)[:, None] / count)
    samples = np.vstack(found * weight)
    samples.setflags(write=False)
    return samples
