"""All roots of a trial along one joint, on arrays: the circle is cut into cells until each holds at most one root.

`cells` tells whether a cell must be cut. A cell that need not be cut has one root where the value changes its sign,
else none. A cell that is too narrow to be cut, and over which a direction turns, is a jump: there the joint is
constant, and the angle is free. The value is an entry of a rotation, so it is a + b cos + c sin of this angle, which
three trials determine. Where no root fits, the circle is searched once more with other cells.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np

from derive.ir.cells import (
    ASIDE,
    FINEST,
    GUARD,
    GUARD_SLOPE,
    SLOPE,
    TOUCHED,
    VALUE,
    At,
    Cells,
    Flags,
    Reals,
    Rows,
    Trial,
    at_seam,
    joined,
    look,
    turned_over,
    where_to_cut,
)

T = TypeVar("T")
CELLS = 72
"""The number of cells into which the circle is cut at first."""
SHIFTS = (0.414, 0.192)
"""The beginning of the first cell, in cells: at first, and where no root fits, for the second search. The cells do not
depend on the start, so a pose is searched in the same way from every reference; and none ends at a round angle, where
value and guard may vanish."""
ROUNDS = 50
"""The largest number of rounds in which cells are cut."""
CLOSING = 60
"""Trials that close in on one root at most."""
RESERVE = 2 * CLOSING + 6
"""The number of trials that the last cell may need beyond the limit."""
NEXT = 1e-6
"""Close to where the guard vanishes a trial with a value up to this is a candidate for a root, too."""
CROWDED = 4 * CELLS
"""Where a row has more cells to be cut than this, no cell of it is cut any more: only rounding is being cut."""
_THIRD = 2.0 * np.pi / 3.0
RIM = 0.999
"""The part of the strip, on which the two sides are one curve, that is searched."""
AHEAD = 1e-7
"""The nearest root is the one nearest to a joint that is ahead of the start by this (radians). Where a machine is
symmetric about its start, roots are as far to both sides, and rounding would choose, in every language another one."""
VANISHING = 1e-10
"""A trial with a value up to this is a candidate for a root, whatever its neighbours are: for example the reference."""
Finish = Callable[[At], tuple[Flags, Reals]]
"""The finishing program: whether a root fits, and its results."""


def find_roots(trial: Trial, start: Reals, shift: float = SHIFTS[0]) -> At:
    """Candidates for the roots of all rows, in no order; only the whole closure tells whether a candidate is a root."""
    if not len(start):
        none = np.zeros(0, dtype=int)
        return At(none, start, none, none, start)
    cells = _around(trial, len(start), shift)
    found = [_start(trial, start)]
    ends, holding = [cells.take(np.zeros(0, dtype=int))], [cells.take(np.zeros(0, dtype=int))]
    for _ in range(2 * ROUNDS):  # roots are refined when no cell is cut any more: in one loop for all rows
        if not len(cells):
            cells, ends = _over_the_end(trial, joined(*ends)), ends[:1]
            found.append(_vanishing(cells))
        if not len(cells):
            break
        says = look(cells)
        found += [_jumps(trial, cells.take(says.jumps)), _touched(cells.take(says.touches))]
        holding.append(cells.take(says.holds))
        ends.append(cells.take(says.ends))
        cut = cells.take(says.cut)
        cells = cut.halves(trial, where_to_cut(cut, says.by_guard[says.cut]))
        found.append(_vanishing(cells.take(np.arange(len(cut), len(cells)))))
        cells = cells.take(np.bincount(cells.rows, minlength=1)[cells.rows] <= CROWDED)
    return _all([*found, *_closed_in(trial, joined(*holding))])


def nearest(trial: Trial, finish: Finish, start: Reals) -> tuple[Flags, Reals]:
    """Whether a row has a root that fits, and the results of `finish` at the nearest one."""
    found, answer = _nearest(trial, finish, start, SHIFTS[0])
    for shift in SHIFTS[1:]:
        rows = np.flatnonzero(~found)
        if len(rows):
            again, values = _nearest(_of_rows(trial, rows), _of_rows(finish, rows), start[rows], shift)
            found[rows], answer[rows] = again, values
    return found, answer


def nearest_listed(places: Sequence[tuple[Reals, Flags, int]], finish: Finish, start: Reals) -> tuple[Flags, Reals]:
    """`nearest` for listed candidates: values of the joint, whether each is a candidate, and its side."""
    every = []
    for joint, is_offered, side in places:
        rows = np.flatnonzero(is_offered)
        every.append(At(rows, joint[rows], np.full(len(rows), side), np.full(len(rows), -1), np.zeros(len(rows))))
    return _nearest_of(_all(every), finish, start)


def _of_rows(asked: Callable[[At], T], rows: Rows) -> Callable[[At], T]:
    """The function for some of the rows."""
    return lambda place: asked(place._replace(rows=rows[place.rows]))


def _nearest(trial: Trial, finish: Finish, start: Reals, shift: float) -> tuple[Flags, Reals]:
    return _nearest_of(find_roots(trial, start, shift), finish, start)


def _nearest_of(place: At, finish: Finish, start: Reals) -> tuple[Flags, Reals]:
    """The candidate that fits and is nearest to the start."""
    is_wanted, values = finish(place)
    away = place.joint - start[place.rows] - AHEAD
    away = np.abs(away - 2.0 * np.pi * np.round(away / (2.0 * np.pi)))
    fits = np.flatnonzero(is_wanted)
    order = fits[np.lexsort((away[fits], place.rows[fits]))]
    rows, first = np.unique(place.rows[order], return_index=True)
    found, answer = np.zeros(len(start), dtype=bool), np.zeros((len(start), values.shape[1]))
    found[rows], answer[rows] = True, values[order[first]]
    return found, answer


def _vanishing(cells: Cells) -> At:
    """The beginnings of cells at which the value is zero."""
    is_root = _vanishes(cells.first)
    return _places(cells.take(is_root), cells.low[is_root])


def _vanishes(results: Reals) -> Flags:
    """Whether a trial is at a root by its value alone. Where the guard vanishes, the value has half of its digits."""
    value, guard = np.abs(results[:, VALUE]), results[:, GUARD]
    return np.asarray((value <= VANISHING) & (guard >= 0.0) | (value <= NEXT) & (np.abs(guard) <= VANISHING))


def _start(trial: Trial, start: Reals) -> At:
    """The starts that are roots themselves, for example where a path stands still."""
    rows = np.arange(len(start))
    place = At(rows, start, np.ones(len(rows), dtype=int), np.full(len(rows), -1), np.zeros(len(rows)))
    results = trial(place)
    is_root = _vanishes(results)
    return At(rows[is_root], start[is_root], place.side[is_root], place.freed[is_root], place.angle[is_root])


def _around(trial: Trial, count: int, shift: float) -> Cells:
    """The first cells of some rows: number 0 of every row, then number 1, and so on."""
    width = 2.0 * np.pi / CELLS
    rows = np.tile(np.arange(count), CELLS)
    base = np.asarray(width * (np.repeat(np.arange(CELLS), count) + shift), dtype=float)
    zero, one = np.zeros(len(rows)), np.ones(len(rows))
    empty = np.empty((len(rows), 0))
    cells = Cells(rows, base, np.full(len(rows), width), zero > 0.0, 0 * rows, zero, one, empty, empty)
    first = cells.at(trial, zero)
    return replace(cells, first=first, last=np.roll(first, -count, axis=0))


def _over_the_end(trial: Trial, cells: Cells) -> Cells:
    """The cells around a zero of the guard: from the end with solutions to the other side.

    The sides join where the guard is slightly above zero; on the strip from there to zero they are one curve.
    """
    swap = cells.first[:, GUARD] < 0.0
    within, beyond = (cells.joint(np.where(swap == flag, cells.low, cells.high)) for flag in (False, True))
    low, high = np.zeros(len(cells)), np.ones(len(cells))  # fractions of the way from the inner end
    path = Cells(cells.rows, within, beyond - within, cells.curved, cells.cuts, low, high, *_ordered(cells, swap))
    level = np.where(path.first[:, GUARD] > TOUCHED, TOUCHED, 0.0)
    meet, rim = (_closing(trial, path, GUARD, at)[2] for at in (level, 0.0 * level))
    end = within + path.scale * meet
    curve = replace(path, base=end, scale=within - end, curved=np.ones(len(cells), dtype=bool))
    strip = replace(path, base=end, scale=path.scale * (rim - meet))
    return joined(_part(trial, curve, -0.5, 0.5), _part(trial, curve, 0.5, 1.0), _part(trial, strip, 0.0, RIM))


def _part(trial: Trial, cells: Cells, low: float, high: float) -> Cells:
    """The parts of the cells from low to high, with the same relation between s and the joint."""
    ends = (np.full(len(cells), low), np.full(len(cells), high))
    return replace(cells, low=ends[0], high=ends[1], first=cells.at(trial, ends[0]), last=cells.at(trial, ends[1]))


def _ordered(cells: Cells, swap: Flags) -> tuple[Reals, Reals]:
    """The trials at the end with solutions and at the other end, with slopes along the way between them."""
    first, last = (np.where(swap[:, None], a, b) for a, b in ((cells.last, cells.first), (cells.first, cells.last)))
    turn = np.where(swap, -1.0, 1.0) * (cells.high - cells.low)
    for columns in (first, last):
        columns[:, SLOPE] *= turn
        columns[:, GUARD_SLOPE] *= turn
    return first, last


def _closing(trial: Trial, cells: Cells, column: int, level: Reals) -> tuple[Reals, Reals, Reals]:
    """Find the place where a column equals a level. Returns the bracketing end on the side of the cell's first end, the
    other bracketing end, and the nearer of the two.

    Newton's method from the end that is nearer to zero; bisection outside the cell, and in every third step.
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
        first[going], last[going] = (
            np.where(same[:, None], new, first[going]),
            np.where(same[:, None], last[going], new),
        )
        settled = np.abs(new[:, 0]) <= FINEST * np.abs(new[:, 1])  # the next step would be rounding
        left = replace(cells.take(going), low=low[going], high=high[going]).extent()
        done = settled | (new[:, 0] == 0.0) | (left <= FINEST)
        going = going[~done]
    return low, high, np.where(np.abs(first[:, 0]) <= np.abs(last[:, 0]), low, high)


def _closed_in(trial: Trial, cells: Cells) -> list[At]:
    """The roots of cells that hold one; where the value jumps, those with a free angle."""
    if not len(cells):
        return []
    low, high, best = _closing(trial, cells, VALUE, np.zeros(len(cells)))
    left = np.abs(cells.at(trial, best)[:, VALUE]) > TOUCHED
    narrow = replace(cells, low=low, high=high).take(left)
    narrow = replace(narrow, first=narrow.at(trial, narrow.low), last=narrow.at(trial, narrow.high))
    return [_places(cells, best), _jumps(trial, narrow)]


def _touched(cells: Cells) -> At:
    """The end that is nearer to zero. Where the two sides join, both roots of the parabola with the slopes of both
    ends, or its extremum where it has none.
    """
    width, f = cells.high - cells.low, cells.first[:, VALUE]
    a, b = cells.first[:, SLOPE] * width, cells.last[:, SLOPE] * width
    nearer = np.where(np.abs(f) <= np.abs(cells.last[:, VALUE]), 0.0, 1.0)
    turns = at_seam(cells) & (a * b < 0.0)
    bend = np.where(turns, b - a, 1.0)
    half = np.sqrt(np.maximum(a * a - 2.0 * bend * f, 0.0)) / np.abs(bend)
    below, above = (np.clip(side * half - a / bend, 0.0, 1.0) for side in (-1.0, 1.0))
    one, other = cells.low + width * np.where(turns, below, nearer), cells.low + width * above
    two = turns & (half > 0.0)
    return _all([_places(cells, one), _places(cells.take(two), other[two])])


def _jumps(trial: Trial, cells: Cells) -> At:
    """The roots in a jump, where the joint is constant and the angle that turns most is free: both angles at which the
    value vanishes.
    """
    turned = turned_over(cells)
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
