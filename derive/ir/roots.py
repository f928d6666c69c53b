"""All roots of a trial along one joint, by arrays: the circle is cut into cells until each holds one root at most.

A trial is a function of the searched joint: a value that must vanish, with its slope; a guard that is negative where the
trial has no solution, with its slope; and directions, the cosines and sines of angles that a partial step takes from a
vector, which turn fast where that vector is short. The two roots under the guard are one curve: where the guard vanishes
the curve goes over from one to the other. Such an end is looked at in s with joint = end + scale s², s > 0 on the wanted
side and s < 0 on the other: there value is smooth. A cell is cut

* where a direction turns by more than 45 degrees: so trials stand close where it turns;
* where value has one sign at both ends, and its slopes say that it may touch zero in between;
* where a cubic through values and slopes at both ends has more than one root, or nearly.

The last two hold of the guard as well.

What is left has one root where value changes its sign, else none. A cell too narrow to be cut, over which a direction turns,
is a jump: there the joint stands still, and the angle is free. A value that is an entry of a rotation is then
a + b cos + c sin of the angle, which three trials determine.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]
Rows = NDArray[np.int64]
Flags = NDArray[np.bool_]
T = TypeVar("T")

CELLS = 72
"""The circle is cut into so many cells at first."""
SHIFTS = (0.5, 0.25)
"""How far behind the start the first cell begins, in cells; where no root fits, the circle is cut otherwise, once more."""
ROUNDS = 50
"""Cells are cut again at most so often."""
CLOSING = 60
"""Trials that close in on one root at most."""
RESERVE = 2 * CLOSING + 6
"""What the last cell may take, where trials are counted."""
NEXT = 1e-6
"""A trial next to where the guard vanishes that leaves no more than this is offered, too."""
NARROW = 1e-10
"""A cell narrower than this, over which a direction turns, is a jump (radians)."""
FLAT = 1e-7
"""Where the guard is on the other side for a shorter part of a cell than this, it is not noticed."""
FINEST = 1e-15
"""No cell is cut that is shorter than this share of it."""
GAP = 1e-6
"""A jump is looked at where the guard is not farther beyond zero at both ends."""
NEAR_ZERO = 0.5
"""A cubic hides two roots where it turns back below this share of the values at the ends."""
BENT = 0.125
"""So much of how slopes differ over a cell their tangents may stay away from zero, and there may be a root: it has kinks."""
CROWDED = 4 * CELLS
"""A row that has more cells than this to be cut is cut no more: what is cut there is rounding."""
SEAM = 1e-3
"""No cell is cut nearer to where the two sides meet: there a slope has no digits."""
ASIDE = 0.47
"""Where a cell is halved: not quite in the middle, where the two sides may meet and a slope has no size."""
_THIRD = 2.0 * np.pi / 3.0
TURNED = 0.7
"""The cosine of how far a direction may turn over a cell."""
ROOT = 1e-15
"""A value of this size is zero."""
RIM = 0.999
"""How much of the strip on which the two sides are one is looked at."""
TOUCHED = 1e-12
"""A value of this size may be zero where it only touches zero."""
VANISHING = 1e-10
"""A trial that leaves no more than this is offered as a root, whatever there is around it: the reference itself, for one."""


class At(NamedTuple):
    """Where to try: the rows of the problem, the joint, the side (+1 is the wanted one), and what is free."""

    rows: Rows
    joint: Reals
    side: Rows
    freed: Rows
    """The number of the direction that is given by `angle` instead, or -1."""
    angle: Reals


Trial = Callable[[At], Reals]
Finish = Callable[[At], tuple[Flags, Reals]]
"""Whether a root fits, and what is said of it."""
"""The columns value, slope, guard, slope of the guard, then cosine and sine of every direction."""
VALUE, SLOPE, GUARD, GUARD_SLOPE, DIRECTIONS = range(5)


@dataclass(frozen=True)
class Cells:
    """Intervals low < high of s, and what the trial says at both ends; slopes by s."""

    rows: Rows
    base: Reals
    scale: Reals
    curved: NDArray[np.bool_]
    cuts: Rows
    """How often it was cut."""
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

    def side(self, s: Reals) -> Rows:
        """The side at s."""
        return np.where(self.curved & (s < 0.0), -1, 1)

    def at(self, trial: Trial, s: Reals) -> Reals:
        """What the trial says at s."""
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
    """All of them."""
    return Cells(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(Cells)))


def find_roots(trial: Trial, start: Reals, shift: float = SHIFTS[0]) -> At:
    """Every root of every row, and more that only a look at the whole closure tells from roots; in no order."""
    if not len(start):
        none = np.zeros(0, dtype=int)
        return At(none, start, none, none, start)
    cells = _around(trial, start, shift)
    found = [_start(trial, start)]
    ends, holding = [cells.take(np.zeros(0, dtype=int))], [cells.take(np.zeros(0, dtype=int))]
    for _ in range(2 * ROUNDS):  # what is closed in on waits until nothing is cut any more: it is one loop for all rows
        if not len(cells):
            cells, ends = _over_the_end(trial, joined(*ends)), ends[:1]
            found.append(_vanishing(cells))
        if not len(cells):
            break
        says = _look(cells)
        found += [_jumps(trial, cells.take(says.jumps)), _touched(cells.take(says.touches))]
        holding.append(cells.take(says.holds))
        ends.append(cells.take(says.ends))
        cut = cells.take(says.cut)
        cells = cut.halves(trial, _where(cut, says.by_guard[says.cut]))
        found.append(_vanishing(cells.take(np.arange(len(cut), len(cells)))))
        cells = cells.take(np.bincount(cells.rows, minlength=1)[cells.rows] <= CROWDED)
    return _all([*found, *_closed_in(trial, joined(*holding))])


def nearest(trial: Trial, finish: Finish, start: Reals) -> tuple[Flags, Reals]:
    """Whether a row has a root that fits, and what `finish` says at the nearest of them."""
    found, answer = _nearest(trial, finish, start, SHIFTS[0])
    for shift in SHIFTS[1:]:
        rows = np.flatnonzero(~found)
        if len(rows):
            again, values = _nearest(_of_rows(trial, rows), _of_rows(finish, rows), start[rows], shift)
            found[rows], answer[rows] = again, values
    return found, answer


def _of_rows(asked: Callable[[At], T], rows: Rows) -> Callable[[At], T]:
    """What is asked, of some rows alone."""
    return lambda place: asked(place._replace(rows=rows[place.rows]))


def _nearest(trial: Trial, finish: Finish, start: Reals, shift: float) -> tuple[Flags, Reals]:
    place = find_roots(trial, start, shift)
    is_wanted, values = finish(place)
    away = place.joint - start[place.rows]
    away = np.abs(away - 2.0 * np.pi * np.round(away / (2.0 * np.pi)))
    fits = np.flatnonzero(is_wanted)
    order = fits[np.lexsort((away[fits], place.rows[fits]))]
    rows, first = np.unique(place.rows[order], return_index=True)
    found, answer = np.zeros(len(start), dtype=bool), np.zeros((len(start), values.shape[1]))
    found[rows], answer[rows] = True, values[order[first]]
    return found, answer


def _vanishing(cells: Cells) -> At:
    """The beginnings of cells where the value is zero already."""
    is_root = _vanishes(cells.first)
    return _places(cells.take(is_root), cells.low[is_root])


def _vanishes(said: Reals) -> Flags:
    """Whether a trial is next to a root, whatever there is around it: where the guard vanishes, value has half its digits."""
    value, guard = np.abs(said[:, VALUE]), said[:, GUARD]
    return np.asarray((value <= VANISHING) & (guard >= 0.0) | (value <= NEXT) & (np.abs(guard) <= VANISHING))


def _start(trial: Trial, start: Reals) -> At:
    """The starts that are roots themselves: a path stands there."""
    rows = np.arange(len(start))
    place = At(rows, start, np.ones(len(rows), dtype=int), np.full(len(rows), -1), np.zeros(len(rows)))
    said = trial(place)
    is_root = _vanishes(said)
    return At(rows[is_root], start[is_root], place.side[is_root], place.freed[is_root], place.angle[is_root])


def _around(trial: Trial, start: Reals, shift: float) -> Cells:
    """The first cells: number 0 of every row, then number 1, and so on.

    None ends at the start, where value and guard may vanish.
    """
    count, width = len(start), 2.0 * np.pi / CELLS
    rows = np.tile(np.arange(count), CELLS)
    base = (start[None, :] + width * (np.arange(CELLS)[:, None] + shift)).ravel()
    zero, one = np.zeros(len(rows)), np.ones(len(rows))
    empty = np.empty((len(rows), 0))
    cells = Cells(rows, base, np.full(len(rows), width), zero > 0.0, 0 * rows, zero, one, empty, empty)
    first = cells.at(trial, zero)
    return replace(cells, first=first, last=np.roll(first, -count, axis=0))


class _Verdicts(NamedTuple):
    """What becomes of every cell: at most one of these; none where it has no root."""

    jumps: Flags
    ends: Flags
    """The guard vanishes in between."""
    holds: Flags
    """One root."""
    touches: Flags
    cut: Flags
    by_guard: Flags
    """Cut where the slopes of the guard say, not those of the value."""


def _look(cells: Cells) -> _Verdicts:
    width = cells.high - cells.low
    (f, df, g, dg), (f1, df1, g1, dg1) = (e[:, :DIRECTIONS].T for e in (cells.first, cells.last))
    turned = _turned(cells)
    fast = turned.min(axis=1, initial=1.0) < TURNED
    wide = np.abs(cells.joint(cells.high) - cells.joint(cells.low)) > NARROW
    jumps = fast & ~wide & ((g >= -GAP) | (g1 >= -GAP))
    slow = ~fast
    returns = slow & (width > FLAT) & ~cells.curved & _hides_roots(g, dg, g1, dg1, width)
    ends = slow & ((g < 0.0) != (g1 < 0.0)) & ~cells.curved & ~returns
    within = slow & ((g >= 0.0) & (g1 >= 0.0) | cells.curved)
    seen = within & ~returns
    changes = f * f1 <= 0.0
    doubtful = seen & _hides_roots(f, df, f1, df1, width)
    small = np.minimum(np.abs(f), np.abs(f1)) <= TOUCHED
    seam = cells.curved & (cells.low >= -2.0 * SEAM) & (cells.high <= 2.0 * SEAM)
    again = doubtful & ~small & (width > FINEST) & ~seam
    touches = doubtful & (small | seam) & ~changes
    holds = seen & changes & ~again
    return _Verdicts(jumps, ends, holds, touches, (fast & wide) | returns | again, returns)


def _turned(cells: Cells) -> Reals:
    """The cosine of how far every direction turns over a cell: (cells, directions)."""
    a, b = cells.first[:, DIRECTIONS:], cells.last[:, DIRECTIONS:]
    return np.asarray(a[:, ::2] * b[:, ::2] + a[:, 1::2] * b[:, 1::2])


def _hides_roots(f: Reals, df: Reals, f1: Reals, df1: Reals, width: Reals) -> Flags:
    """Whether there may be more roots within a cell than its ends tell."""
    sign = np.where(f < 0.0, -1.0, 1.0)
    crosses = (sign * (f + df * width) < 0.0) | (sign * (f1 - df1 * width) < 0.0)
    waves = (f * f1 > 0.0) & (df * df1 > 0.0) & crosses  # a tangent leads to zero, and the value turns before and after
    return waves | _comes_back(f, df, f1, df1, width) | _doubtful(f, df * width, f1, df1 * width)


def _comes_back(f: Reals, df: Reals, f1: Reals, df1: Reals, width: Reals) -> Flags:
    """Whether a value that has one sign at both ends heads for zero at both, and its tangents meet beyond, or nearly there.

    Where they do not meet in between it is bent both ways, and nobody knows. It has kinks, too: tangents are no bound.
    """
    margin = TOUCHED + NEAR_ZERO * np.minimum(np.abs(f), np.abs(f1)) + BENT * np.abs(df1 - df) * width
    sign = np.where(f < 0.0, -1.0, 1.0)
    rest = f1 - f - df1 * width  # between 0 and (df - df1) width where the tangents meet in between
    is_bent = ~((rest * (df - df1) > 0.0) & (np.abs(rest) < np.abs(df - df1) * width))
    lowest = sign * (f + df * _between(f, df, f1, df1, width))
    return np.asarray((f * f1 > 0.0) & (sign * df < 0.0) & (sign * df1 > 0.0) & (is_bent | (lowest <= margin)))


def _between(f: Reals, df: Reals, f1: Reals, df1: Reals, width: Reals) -> Reals:
    """How far behind the first end its tangent meets that of the last; half way where they do not."""
    apart = df - df1
    met = (f1 - f - df1 * width) / np.where(apart == 0.0, 1.0, apart)
    return np.where((apart != 0.0) & (met > 0.0) & (met < width), met, ASIDE * width)


def _doubtful(f: Reals, a: Reals, f1: Reals, b: Reals) -> Flags:
    """Whether the cubic through values and slopes turns within the cell where it may hide two roots."""
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


def _where(cells: Cells, by_guard: Flags) -> Reals:
    """Where to cut: where tangents meet, every third time in the middle, and always where a direction turns."""
    width = cells.high - cells.low
    column = np.where(by_guard, GUARD, VALUE)
    f, df, f1, df1 = (e[np.arange(len(cells)), column + k] for e in (cells.first, cells.last) for k in (0, 1))
    meets = np.clip(_between(f, df, f1, df1, width), 0.02 * width, 0.98 * width)
    middle = (cells.cuts % 3 == 2) | (_turned(cells).min(axis=1, initial=1.0) < TURNED)
    s = cells.low + np.where(middle, ASIDE * width, meets)
    beside = np.where(cells.high > 1.5 * SEAM, SEAM, -SEAM)
    return np.where(cells.curved & (np.abs(s) < SEAM), beside, s)


def _over_the_end(trial: Trial, cells: Cells) -> Cells:
    """The cells around the place where the guard vanishes: from the end that is within to the other side.

    The sides meet where the guard is a touch above zero; on the strip from there to zero they are one.
    """
    swap = cells.first[:, GUARD] < 0.0
    within, beyond = (cells.joint(np.where(swap == flag, cells.low, cells.high)) for flag in (False, True))
    low, high = np.zeros(len(cells)), np.ones(len(cells))  # of the way from within to beyond
    path = Cells(cells.rows, within, beyond - within, cells.curved, cells.cuts, low, high, *_ordered(cells, swap))
    level = np.where(path.first[:, GUARD] > TOUCHED, TOUCHED, 0.0)
    meet, rim = (_closing(trial, path, GUARD, at)[2] for at in (level, 0.0 * level))
    end = within + path.scale * meet
    curve = replace(path, base=end, scale=within - end, curved=np.ones(len(cells), dtype=bool))
    strip = replace(path, base=end, scale=path.scale * (rim - meet))
    return joined(_part(trial, curve, -0.5, 0.5), _part(trial, curve, 0.5, 1.0), _part(trial, strip, 0.0, RIM))


def _part(trial: Trial, cells: Cells, low: float, high: float) -> Cells:
    """The part of the same maps from low to high."""
    ends = (np.full(len(cells), low), np.full(len(cells), high))
    return replace(cells, low=ends[0], high=ends[1], first=cells.at(trial, ends[0]), last=cells.at(trial, ends[1]))


def _ordered(cells: Cells, swap: Flags) -> tuple[Reals, Reals]:
    """What is said at the end within and at the end beyond, slopes along the way from the one to the other."""
    first, last = (np.where(swap[:, None], a, b) for a, b in ((cells.last, cells.first), (cells.first, cells.last)))
    turn = np.where(swap, -1.0, 1.0) * (cells.high - cells.low)
    for columns in (first, last):
        columns[:, SLOPE] *= turn
        columns[:, GUARD_SLOPE] *= turn
    return first, last


def _closing(trial: Trial, cells: Cells, column: int, level: Reals) -> tuple[Reals, Reals, Reals]:
    """Close in on where a column passes a level: the end on the side of the first, the other end, and the better one.

    Newton's method from the end that is nearer to zero; halved where that leads out of the cell, and every third time.
    """
    low, high = cells.low.copy(), cells.high.copy()
    first, last = cells.first[:, column : column + 2].copy(), cells.last[:, column : column + 2].copy()
    first[:, 0] -= level
    last[:, 0] -= level
    going = np.flatnonzero((first[:, 0] != 0.0) & (last[:, 0] != 0.0))
    for number in range(CLOSING):
        if not len(going):
            break
        a, b = low[going], high[going]
        better = np.abs(first[going, 0]) <= np.abs(last[going, 0])
        value, slope = np.where(better[:, None], first[going], last[going]).T
        guess = np.where(better, a, b) - value / np.where(slope == 0.0, 1.0, slope)
        leads_out = ~((guess > a) & (guess < b)) | (slope == 0.0) | (number % 3 == 2)
        s = np.where(leads_out, a + ASIDE * (b - a), guess)
        new = cells.take(going).at(trial, s)[:, column : column + 2]
        new[:, 0] -= level[going]
        same = (new[:, 0] < 0.0) == (first[going, 0] < 0.0)
        low[going], high[going] = np.where(same, s, a), np.where(same, b, s)
        first[going], last[going] = np.where(same[:, None], new, first[going]), np.where(same[:, None], last[going], new)
        settled = np.abs(new[:, 0]) <= FINEST * np.abs(new[:, 1])  # the next step would be rounding
        done = settled | (new[:, 0] == 0.0) | (high[going] - low[going] <= FINEST)
        going = going[~done]
    return low, high, np.where(np.abs(first[:, 0]) <= np.abs(last[:, 0]), low, high)


def _closed_in(trial: Trial, cells: Cells) -> list[At]:
    """The roots of cells that hold one; where the value jumps there, what a free angle makes of it."""
    if not len(cells):
        return []
    low, high, best = _closing(trial, cells, VALUE, np.zeros(len(cells)))
    left = np.abs(cells.at(trial, best)[:, VALUE]) > TOUCHED
    narrow = replace(cells, low=low, high=high).take(left)
    narrow = replace(narrow, first=narrow.at(trial, narrow.low), last=narrow.at(trial, narrow.high))
    return [_places(cells, best), _jumps(trial, narrow)]


def _touched(cells: Cells) -> At:
    """The end that is nearer to zero."""
    nearer = np.abs(cells.first[:, VALUE]) <= np.abs(cells.last[:, VALUE])
    return _places(cells, np.where(nearer, cells.low, cells.high))


def _jumps(trial: Trial, cells: Cells) -> At:
    """Where the joint stands still and the angle that turns most is free: both angles that let the value vanish."""
    turned = _turned(cells)
    if not turned.size:  # no cells, or no directions
        return _places(cells.take(np.zeros(0, dtype=int)), np.zeros(0))
    s = 0.5 * (cells.low + cells.high)
    place = _places(cells, s)._replace(freed=np.argmin(turned, axis=1))
    says = [trial(place._replace(angle=np.full(len(cells), k * _THIRD)))[:, VALUE] for k in (0, 1, 2)]
    level = (says[0] + says[1] + says[2]) / 3.0
    along, across = says[0] - level, (says[1] - says[2]) / np.sqrt(3.0)
    swing = np.hypot(along, across)
    cosine = np.clip(-level / np.where(swing > 0.0, swing, 1.0), -1.0, 1.0)
    centre, half = np.arctan2(across, along), np.arccos(cosine)
    both = _all([place._replace(angle=centre - half), place._replace(angle=centre + half)])
    any_angle = np.tile(np.abs(level) + swing <= NEXT, 2)
    return _all([both, At(*(column[any_angle] for column in both._replace(angle=both.angle + np.pi)))])


def _places(cells: Cells, s: Reals) -> At:
    return At(cells.rows, cells.joint(s), cells.side(s), np.full(len(cells), -1), np.zeros(len(cells)))


def _all(places: Sequence[At]) -> At:
    return At(*map(np.concatenate, zip(*places, strict=True)))
