"""Cells of a root scan along one joint, on arrays: how many roots a cell may hold, and where a cell is cut.

A trial is a function of the scanned joint. It has a value, which is zero at a root, with its slope; a guard, which is
negative where the trial has no solution, with its slope; and directions, the cosines and sines of angles that a step
takes from a vector, which turn fast where that vector is short. The trial has two sides, the two roots of its two-root
step. They join where the guard vanishes, and form one smooth curve in s, with joint = end + scale s², s > 0 on the
wanted side and s < 0 on the other. A cell is cut

* where a direction turns by more than 45 degrees, so that trials are dense where it turns fast;
* where the value has one sign at both ends, and its slopes allow it to touch zero in between;
* where the cubic with the values and slopes at both ends has more than one root, or nearly.

The last two apply to the guard as well.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]
Rows = NDArray[np.int64]
Flags = NDArray[np.bool_]
NARROW = 1e-10
"""A cell narrower than this (radians) is a jump if a direction turns over it; and a change of the guard's sign over a
shorter part is not noticed."""
FLAT = 1e-7
"""Candidates nearer to each other than this (radians) are one, if their value vanishes."""
FINEST = 1e-15
"""A cell narrower than this (radians) is not cut: the joint has no more digits."""
GAP = 1e-6
"""A jump may hold roots where the guard is above minus this at one end."""
NEAR_ZERO = 0.5
"""A cubic may hide two roots where its extremum is below this fraction of the values at the ends."""
BENT = 0.125
"""Tangents that miss zero by this fraction of the change of slope may still hide a root: the value has kinks."""
SEAM = 1e-3
"""A cell is not cut closer than this to the point where the two sides join: there a slope has no digits."""
ASIDE = 0.47
"""A cell is bisected here, not quite in the middle, where the two sides may join and a slope has no digits."""
TURNED = 0.7
"""The cosine of the largest angle by which a direction may turn over a cell."""
TOUCHED = 1e-12
"""A value up to this size counts as zero where it only touches zero."""


class At(NamedTuple):
    """The places of trials: rows of the problem, joint, side (+1 is the wanted one), and the free direction."""

    rows: Rows
    joint: Reals
    side: Rows
    freed: Rows
    """The number of the free direction, whose angle is `angle`; -1: none."""
    angle: Reals


Trial = Callable[[At], Reals]
"""A function that returns the columns value, slope, guard, slope of the guard, then cosine and sine of every
direction."""
VALUE, SLOPE, GUARD, GUARD_SLOPE, DIRECTIONS = range(5)


@dataclass(frozen=True)
class Cells:
    """Intervals low < high of s, with the trials at both ends; slopes are derivatives by s."""

    rows: Rows
    base: Reals
    scale: Reals
    curved: NDArray[np.bool_]
    cuts: Rows
    """The number of cuts that led to the cell."""
    low: Reals
    high: Reals
    first: Reals
    last: Reals

    def __len__(self) -> int:
        return len(self.rows)

    def take(self, chosen: NDArray[np.bool_] | Rows) -> Cells:
        """The chosen cells."""
        return Cells(*(getattr(self, f.name)[chosen] for f in fields(self)))

    def joint(self, s: Reals) -> Reals:
        """The joint at s."""
        return np.asarray(self.base + self.scale * np.where(self.curved, s * s, s))

    def extent(self) -> Reals:
        """The distance that the joint travels from one end to the other, also where it turns back in between."""
        way = np.where(self.curved, np.abs(self.low) + np.abs(self.high), 1.0)
        return np.asarray(np.abs(self.scale) * (self.high - self.low) * way)

    def side(self, s: Reals) -> Rows:
        """The side at s."""
        return np.where(self.curved & (s < 0.0), -1, 1)

    def at(self, trial: Trial, s: Reals) -> Reals:
        """The trial at s."""
        if not len(self):
            return self.first
        columns = trial(At(self.rows, self.joint(s), self.side(s), np.full(len(self), -1), np.zeros(len(self))))
        rate = self.scale * np.where(self.curved, 2.0 * s, 1.0)
        columns[:, SLOPE] *= rate
        columns[:, GUARD_SLOPE] *= rate
        return columns

    def halves(self, trial: Trial, s: Reals) -> Cells:
        """The cells cut at s."""
        middle = self.at(trial, s)
        left = replace(self, cuts=self.cuts + 1, high=s, last=middle)
        right = replace(self, cuts=self.cuts + 1, low=s, first=middle)
        return joined(left, right)


def joined(*parts: Cells) -> Cells:
    """All cells of several batches in one."""
    return Cells(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(Cells)))


class Verdicts(NamedTuple):
    """The kind of every cell: at most one of these flags is true, and none where the cell has no root. Where the two
    sides join, a jump counts as touched, too."""

    jumps: Flags
    ends: Flags
    """The guard vanishes in between."""
    holds: Flags
    """One root."""
    touches: Flags
    cut: Flags
    by_guard: Flags
    """Whether the cell is cut by the tangents of the guard, not by those of the value."""


def look(cells: Cells) -> Verdicts:
    width, extent = cells.high - cells.low, cells.extent()
    (f, df, g, dg), (f1, df1, g1, dg1) = (e[:, :DIRECTIONS].T for e in (cells.first, cells.last))
    turned = turned_over(cells)
    fast = turned.min(axis=1, initial=1.0) < TURNED
    seam = at_seam(cells)
    wide = (extent > NARROW) & ~seam
    jumps = fast & ~wide & ((g >= -GAP) | (g1 >= -GAP))
    slow = ~fast
    returns = slow & (extent > NARROW) & ~cells.curved & _hides_roots(g, dg, g1, dg1, width)
    ends = slow & ((g < 0.0) != (g1 < 0.0)) & ~cells.curved & ~returns
    within = slow & ((g >= 0.0) & (g1 >= 0.0) | cells.curved)
    seen = within & ~returns
    changes = f * f1 <= 0.0
    doubtful = seen & _hides_roots(f, df, f1, df1, width)
    small = np.minimum(np.abs(f), np.abs(f1)) <= TOUCHED
    again = doubtful & ~small & (extent > FINEST) & ~seam
    touches = doubtful & (small | seam) & ~changes | jumps & seam
    holds = seen & changes & ~again
    return Verdicts(jumps, ends, holds, touches, (fast & wide) | returns | again, returns)


def at_seam(cells: Cells) -> Flags:
    """Whether a cell lies where the two sides join, and is so short that it is cut no more."""
    return np.asarray(cells.curved & (cells.low >= -2.0 * SEAM) & (cells.high <= 2.0 * SEAM))


def turned_over(cells: Cells) -> Reals:
    """The cosine of the angle by which every direction turns over a cell: (cells, directions)."""
    a, b = cells.first[:, DIRECTIONS:], cells.last[:, DIRECTIONS:]
    return np.asarray(a[:, ::2] * b[:, ::2] + a[:, 1::2] * b[:, 1::2])


def _hides_roots(f: Reals, df: Reals, f1: Reals, df1: Reals, width: Reals) -> Flags:
    """Whether there may be more roots within a cell than the signs at its ends tell."""
    sign = np.where(f < 0.0, -1.0, 1.0)
    crosses = (sign * (f + df * width) < 0.0) | (sign * (f1 - df1 * width) < 0.0)
    waves = (f * f1 > 0.0) & (df * df1 > 0.0) & crosses  # a tangent reaches zero, extrema on both sides
    return waves | _comes_back(f, df, f1, df1, width) | _doubtful(f, df * width, f1, df1 * width)


def _comes_back(f: Reals, df: Reals, f1: Reals, df1: Reals, width: Reals) -> Flags:
    """Whether a value with one sign at both ends falls towards zero from both, and its tangents meet about beyond zero.

    Where they do not meet in between, the value has an inflection and may reach zero, too. With kinks they are no
    bound.
    """
    margin = TOUCHED + NEAR_ZERO * np.minimum(np.abs(f), np.abs(f1)) + BENT * np.abs(df1 - df) * width
    sign = np.where(f < 0.0, -1.0, 1.0)
    rest = f1 - f - df1 * width  # between 0 and (df - df1) width where the tangents meet in between
    is_bent = ~((rest * (df - df1) > 0.0) & (np.abs(rest) < np.abs(df - df1) * width))
    lowest = sign * (f + df * _between(f, df, f1, df1, width))
    return np.asarray((f * f1 > 0.0) & (sign * df < 0.0) & (sign * df1 > 0.0) & (is_bent | (lowest <= margin)))


def _between(f: Reals, df: Reals, f1: Reals, df1: Reals, width: Reals) -> Reals:
    """The distance from the first end at which the tangents of both ends meet; half of the cell where they do not."""
    apart = df - df1
    met = (f1 - f - df1 * width) / np.where(apart == 0.0, 1.0, apart)
    return np.where((apart != 0.0) & (met > 0.0) & (met < width), met, ASIDE * width)


def _doubtful(f: Reals, a: Reals, f1: Reals, b: Reals) -> Flags:
    """Whether the cubic with these values and slopes has an extremum in the cell that may hide two roots."""
    rise = f1 - f
    sign = np.where(np.where(f * f1 < 0.0, rise, f) < 0.0, -1.0, 1.0)
    cube, square = a + b - 2.0 * rise, 3.0 * rise - 2.0 * a - b
    radicand = square * square - 3.0 * cube * a
    root, divisor = np.sqrt(np.maximum(radicand, 0.0)), np.where(cube == 0.0, 1.0, 3.0 * cube)
    turns, lowest = np.zeros(len(f), dtype=bool), np.full(len(f), np.inf)
    for u in ((-square - root) / divisor, (-square + root) / divisor):
        inside = (radicand > 0.0) & (cube != 0.0) & (u > 0.0) & (u < 1.0)
        turns |= inside
        lowest = np.where(inside, np.minimum(lowest, sign * (f + u * (a + u * (square + u * cube)))), lowest)
    three = (f * f1 < 0.0) & (sign * a >= 0.0) & (sign * b >= 0.0)
    two = (f * f1 > 0.0) & (lowest <= NEAR_ZERO * np.minimum(np.abs(f), np.abs(f1)))
    return np.asarray(turns & (three | two))


def where_to_cut(cells: Cells, by_guard: Flags) -> Reals:
    """The place of the cut: where tangents meet; near the middle in every third step, and where a direction turns."""
    width = cells.high - cells.low
    column = np.where(by_guard, GUARD, VALUE)
    f, df, f1, df1 = (e[np.arange(len(cells)), column + k] for e in (cells.first, cells.last) for k in (0, 1))
    meets = np.clip(_between(f, df, f1, df1, width), 0.02 * width, 0.98 * width)
    middle = (cells.cuts % 3 == 2) | (turned_over(cells).min(axis=1, initial=1.0) < TURNED)
    s = cells.low + np.where(middle, ASIDE * width, meets)
    beside = np.where(cells.high > 1.5 * SEAM, SEAM, -SEAM)
    return np.where(cells.curved & (np.abs(s) < SEAM), beside, s)
