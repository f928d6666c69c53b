"""All roots of a trial along one joint, on plain numbers, by the rules of `_cells` and `_roots`, which are for arrays.

The circle is cut into cells until each holds at most one root. A cell is a list of its map (joint = base + scale s, or
base + scale s² with the other side of the two roots at s < 0), its number of cuts, and both ends: s, and the trial
there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import acos, atan2, hypot, pi, sqrt
from typing import Any

# `_cells` and `_roots` explain the constants.
from softkin._constants import (
    AHEAD,
    ASIDE,
    BENT,
    CELLS,
    CLOSING,
    FINEST,
    FINISHED,
    FLAT,
    GAP,
    NARROW,
    NEAR_ZERO,
    NEXT,
    RESERVE,
    RIM,
    SEAM,
    SHIFTS,
    TOUCHED,
    TRIALS,
    TURNED,
    VANISHING,
)

_PLACE = ("tried", "side", "freed", "freed_angle")
_THIRD = 2.0 * pi / 3.0
Values = tuple[Any, ...]
Scan = Callable[[Values, Any], Values]
"""The function that evaluates the trial on arrays."""
Place = tuple[float, int, int, float]
"""The joint value, the side, the number of the direction that is free (-1: none), and its angle."""
Results = tuple[float, ...]
"""The results of a trial: value, slope, guard, slope of the guard, then cosine and sine of every direction."""
Cell = tuple[float, float, bool, int, float, Results, float, Results]


def nearest_root(
    trial: Callable[[Values], Any],
    finish: Callable[[Values], Any],
    start: float,
    wanted: bool,
    trial_given: Values,
    finish_given: Values,
    count: int,
    scan: Scan | None = None,
    sides: tuple[int, ...] = (),
) -> Values:
    """True and the results of `finish` at the root that fits and is nearest to the start; False and zeros where there
    is none, or none is wanted.

    trial_given, finish_given: the arguments, in which a name stands for a coordinate of the place. sides: of the
    candidates, where the trial lists them.
    """
    if wanted:
        for values in _finished(trial, finish, start, trial_given, finish_given, scan, sides, FINISHED):
            return values
    return (False, *(count - 1) * (0.0,))


def every_root(
    trial: Callable[[Values], Any],
    finish: Callable[[Values], Any],
    start: float,
    wanted: bool,
    trial_given: Values,
    finish_given: Values,
    count: int,
    scan: Scan | None = None,
    sides: tuple[int, ...] = (),
) -> list[Values]:
    """The results of `finish` at all roots that fit, the nearest to the start first."""
    every = _finished(trial, finish, start, trial_given, finish_given, scan, sides, TRIALS) if wanted else ()
    return [values[1:] for values in every]


def _finished(
    trial: Callable[[Values], Any],
    finish: Callable[[Values], Any],
    start: float,
    trial_given: Values,
    finish_given: Values,
    scan: Scan | None,
    sides: tuple[int, ...],
    most: int,
) -> Iterator[Values]:
    search, at, looked_at = _Search(_of(trial, trial_given)), _of(finish, finish_given), 0
    if scan is None:
        places = _listed(trial(trial_given), sides)
        places.sort(key=lambda place: _away(place, start))
        yield from (values for values in map(at, places) if values[0])
        return
    for shift in SHIFTS:
        if shift != SHIFTS[0] and search.trials + CELLS > TRIALS - RESERVE:
            return
        places = search.roots(start, shift, _scanned(scan, shift, trial_given))
        places.sort(key=lambda place: _away(place, start))
        is_there = False
        for place in places[: most - looked_at]:
            values = at(place)
            if values[0]:
                is_there = True
                yield values
        if is_there:
            return
        looked_at = min(most, looked_at + len(places))


def _away(place: Place, start: float) -> float:
    return abs((place[0] - start - AHEAD + pi) % (2.0 * pi) - pi)


def _listed(said: Sequence[Any], sides: tuple[int, ...]) -> list[Place]:
    """The candidates that are offered: of each a joint value, and whether it is one."""
    return [(said[2 * k], side, -1, 0.0) for k, side in enumerate(sides) if said[2 * k + 1]]


def _scanned(scan: Scan, shift: float, given: Values) -> list[Results]:
    """The results at the ends of the first cells, all in one batch."""
    import numpy as np

    joint = 2.0 * pi / CELLS * (np.arange(CELLS) + shift)
    place = {"tried": joint, "side": 1, "freed": -1, "freed_angle": 0.0}
    with np.errstate(all="ignore"):
        results = scan(tuple(place[v] if isinstance(v, str) else v for v in given), np.zeros(CELLS, np.uint8))
    columns: list[Results] = np.stack([np.broadcast_to(v, joint.shape) for v in results], axis=1).tolist()
    return columns


def _of(program: Callable[[Values], Any], given: Values) -> Callable[[Place], Results]:
    """A program as a function of the place."""
    values = list(given)
    slots = [(given.index(name), k) for k, name in enumerate(_PLACE) if name in given]

    def at(place: Place) -> Results:
        for slot, k in slots:
            values[slot] = place[k]
        results: Results = program(tuple(values))
        return results

    return at


class _Search:
    """A search: the trial, the roots found so far, and the number of trials."""

    def __init__(self, trial: Callable[[Place], Results]) -> None:
        self.trial = trial
        self.found: list[Place] = []
        self.trials = 0

    def roots(self, start: float, shift: float, ends: list[Results]) -> list[Place]:
        """Candidates for roots, in no order; only the complete closure decides whether a candidate is a root."""
        width = 2.0 * pi / CELLS
        self.found = []
        self.trials += CELLS
        results = [(value, slope * width, guard, rate * width, *rest) for value, slope, guard, rate, *rest in ends]
        self.offer(start, 0.0, False, 0.0, self.evaluate(start, 0.0, False, 0.0))
        for k in range(CELLS):
            cells: list[Cell] = [((k + shift) * width, width, False, 0, 0.0, results[k], 1.0, results[(k + 1) % CELLS])]
            while cells:
                cells += self.cut(cells.pop())
        return self.found

    def evaluate(self, base: float, scale: float, curved: bool, s: float) -> Results:
        """The results of the trial at s, with slopes by s."""
        self.trials += 1
        value, slope, guard, guard_slope, *directions = self.trial(self.place(base, scale, curved, s))
        rate = 2.0 * scale * s if curved else scale
        return (value, slope * rate, guard, guard_slope * rate, *directions)

    @staticmethod
    def place(base: float, scale: float, curved: bool, s: float) -> Place:
        """The place of a trial."""
        if curved:
            return (base + scale * s * s, -1 if s < 0.0 else 1, -1, 0.0)
        return (base + scale * s, 1, -1, 0.0)

    def cut(self, cell: Cell) -> list[Cell]:
        """The cells into which a cell must be cut; none where its root is found, or it has no root."""
        base, scale, curved, depth, low, first, high, last = cell
        if self.trials > TRIALS - RESERVE:
            return []
        width, extent = high - low, _extent(scale, curved, low, high)
        f, df, g, dg = first[:4]
        f1, df1, g1, dg1 = last[:4]
        seam = curved and low >= -2.0 * SEAM and high <= 2.0 * SEAM
        if _turned(first, last) < TURNED:
            if extent > NARROW and not seam:
                return self.halves(cell, low + ASIDE * width)
            if g >= -GAP or g1 >= -GAP:
                self.jump(cell)
                if seam:
                    self.touch(cell, seam)
            return []
        if not curved and extent > NARROW and _hides_roots(g, dg, g1, dg1, width):
            return self.halves(cell, low + self.where(depth, g, dg, g1, dg1, width))
        if not curved and (g < 0.0) != (g1 < 0.0):
            return self.over_the_end(cell)
        if not curved and g < 0.0:
            return []
        changes = f * f1 <= 0.0
        doubtful = _hides_roots(f, df, f1, df1, width)
        small = min(abs(f), abs(f1)) <= TOUCHED
        if doubtful and extent > FINEST and not small and not seam:
            s = low + self.where(depth, f, df, f1, df1, width)
            return self.halves(cell, (SEAM if high > 1.5 * SEAM else -SEAM) if curved and abs(s) < SEAM else s)
        if changes:
            self.close_in(cell)
        elif doubtful and (small or seam):
            self.touch(cell, seam)
        return []

    @staticmethod
    def where(depth: int, f: float, df: float, f1: float, df1: float, width: float) -> float:
        """The place of the cut: where tangents meet, and near the middle in every third step."""
        if depth % 3 == 2:
            return ASIDE * width
        return min(max(_between(f, df, f1, df1, width), 0.02 * width), 0.98 * width)

    def touch(self, cell: Cell, seam: bool) -> None:
        """Store the end that is nearer to zero. Where the two sides join, both roots of the parabola with the slopes
        of both ends, or its extremum where it has none.
        """
        base, scale, curved, _, low, first, high, last = cell
        width, f = high - low, first[0]
        a, b = first[1] * width, last[1] * width
        if not (seam and a * b < 0.0):
            self.found.append(self.place(base, scale, curved, low if abs(f) <= abs(last[0]) else high))
            return
        bend = b - a
        half = sqrt(max(a * a - 2.0 * bend * f, 0.0)) / abs(bend)
        for side in (-half, half) if half > 0.0 else (half,):
            self.found.append(self.place(base, scale, curved, low + width * min(max(side - a / bend, 0.0), 1.0)))

    def halves(self, cell: Cell, s: float) -> list[Cell]:
        """The two parts of a cell that is cut at s."""
        base, scale, curved, depth, low, first, high, last = cell
        middle = self.evaluate(base, scale, curved, s)
        self.offer(base, scale, curved, s, middle)
        return [
            (base, scale, curved, depth + 1, low, first, s, middle),
            (base, scale, curved, depth + 1, s, middle, high, last),
        ]

    def over_the_end(self, cell: Cell) -> list[Cell]:
        """The cells around a zero of the guard, from the end with solutions to the other side.

        The sides join where the guard is slightly above zero; on the strip from there to zero they are one curve.
        """
        base, scale, _, depth, low, first, high, last = cell
        meet = self.closing(cell, 2, TOUCHED if max(first[2], last[2]) > TOUCHED else 0.0)[2]
        rim = self.closing(cell, 2, 0.0)[2]
        end = base + scale * meet
        within = base + scale * (low if first[2] >= 0.0 else high)
        curve, strip = (end, within - end, True), (end, scale * (rim - meet), False)
        parts = ((curve, -0.5, 0.5), (curve, 0.5, 1.0), (strip, 0.0, RIM))
        cells: list[Cell] = [
            (*path, depth, a, self.evaluate(*path, a), b, self.evaluate(*path, b)) for path, a, b in parts
        ]
        for part in cells:
            self.offer(*part[:3], part[4], part[5])
        return cells

    def offer(self, base: float, scale: float, curved: bool, s: float, results: Results) -> None:
        """Store the place of a trial if it is a root. Where the guard vanishes, the value has half of its digits."""
        value, guard = abs(results[0]), results[2]
        if (value <= VANISHING and guard >= 0.0) or (value <= NEXT and abs(guard) <= VANISHING):
            place = self.place(base, scale, curved, s)
            if not any(place[1:] == other[1:] and abs(place[0] - other[0]) < FLAT for other in self.found):
                self.found.append(place)

    def closing(self, cell: Cell, column: int, level: float) -> tuple[float, float, float, Results]:
        """Find the place where a column equals a level. Returns both ends, the better one, and the trial there.

        Newton's method from the end nearer to zero; bisection outside the cell, and in every third step.
        """
        base, scale, curved, _, low, first, high, last = cell
        a, b = first[column] - level, last[column] - level
        for number in range(CLOSING):
            if a == 0.0 or b == 0.0:
                break
            better = abs(a) <= abs(b)
            value, slope = (a, first[column + 1]) if better else (b, last[column + 1])
            s = (low if better else high) - (value / slope if slope != 0.0 else 0.0)
            if not low < s < high or slope == 0.0 or number % 3 == 2:
                s = low + ASIDE * (high - low)
            new = self.evaluate(base, scale, curved, s)
            value = new[column] - level
            if (value < 0.0) == (a < 0.0):
                low, first, a = s, new, value
            else:
                high, last, b = s, new, value
            if abs(value) <= FINEST * abs(new[column + 1]) or _extent(scale, curved, low, high) <= FINEST:
                break
        is_low = abs(a) <= abs(b)
        return low, high, low if is_low else high, first if is_low else last

    def close_in(self, cell: Cell) -> None:
        """Store the root of a cell that holds one and, where the value jumps, the roots with a free angle."""
        base, scale, curved = cell[:3]
        low, high, best, results = self.closing(cell, 0, 0.0)
        self.found.append(self.place(base, scale, curved, best))
        if abs(results[0]) > TOUCHED:
            ends = self.evaluate(base, scale, curved, low), self.evaluate(base, scale, curved, high)
            self.jump((base, scale, curved, 0, low, ends[0], high, ends[1]))

    def jump(self, cell: Cell) -> None:
        """Store the roots at a constant joint, where the angle that turns most is free: the angles of value 0."""
        base, scale, curved, _, low, first, high, last = cell
        if len(first) == 4:
            return
        joint, side = self.place(base, scale, curved, 0.5 * (low + high))[:2]
        freed = min(range((len(first) - 4) // 2), key=lambda k: _turn(first, last, k))
        self.trials += 3
        a, b, c = (self.trial((joint, side, freed, k * _THIRD))[0] for k in (0, 1, 2))
        level = (a + b + c) / 3.0
        along, across = a - level, (b - c) / sqrt(3.0)
        swing = hypot(along, across)
        centre = atan2(across, along)
        half = acos(min(max(-level / swing, -1.0), 1.0)) if swing > 0.0 else 0.5 * pi
        angles = [centre - half, centre + half]
        if abs(level) + swing <= NEXT:  # every angle is a root
            angles += [centre - half + pi, centre + half + pi]
        self.found += [(joint, side, freed, angle) for angle in angles]


def _extent(scale: float, curved: bool, low: float, high: float) -> float:
    """The distance that the joint travels from one end of a cell to the other."""
    return abs(scale) * (high - low) * (abs(low) + abs(high) if curved else 1.0)


def _turn(first: Results, last: Results, k: int) -> float:
    """The cosine of the angle by which a direction turns."""
    return first[4 + 2 * k] * last[4 + 2 * k] + first[5 + 2 * k] * last[5 + 2 * k]


def _turned(first: Results, last: Results) -> float:
    """The cosine of the angle by which the direction turns that turns most."""
    return min((_turn(first, last, k) for k in range((len(first) - 4) // 2)), default=1.0)


def _between(f: float, df: float, f1: float, df1: float, width: float) -> float:
    """The distance from the first end at which the tangents of both ends meet; about half the cell if they do not."""
    if df == df1:
        return ASIDE * width
    met = (f1 - f - df1 * width) / (df - df1)
    return met if 0.0 < met < width else ASIDE * width


def _hides_roots(f: float, df: float, f1: float, df1: float, width: float) -> bool:
    """Whether there may be more roots within a cell than the signs at its ends show."""
    sign = -1.0 if f < 0.0 else 1.0
    crosses = sign * (f + df * width) < 0.0 or sign * (f1 - df1 * width) < 0.0
    if f * f1 > 0.0 and df * df1 > 0.0 and crosses:  # a tangent reaches zero, extrema on both sides
        return True
    return _comes_back(f, df, f1, df1, width) or _doubtful(f, df * width, f1, df1 * width)


def _comes_back(f: float, df: float, f1: float, df1: float, width: float) -> bool:
    """Whether a value with one sign at both ends falls towards zero from both, and its tangents nearly meet beyond it.

    Where they do not meet in between, the value has an inflection and may reach zero, too. Tangents are no bound on a
    value with kinks.
    """
    sign = -1.0 if f < 0.0 else 1.0
    if not (f * f1 > 0.0 and sign * df < 0.0 < sign * df1):
        return False
    rest = f1 - f - df1 * width
    if not (rest * (df - df1) > 0.0 and abs(rest) < abs(df - df1) * width):
        return True
    margin = TOUCHED + NEAR_ZERO * min(abs(f), abs(f1)) + BENT * abs(df1 - df) * width
    return sign * (f + df * _between(f, df, f1, df1, width)) <= margin


def _doubtful(f: float, a: float, f1: float, b: float) -> bool:
    """Whether the cubic with these values and slopes has an extremum in the cell that may hide two roots."""
    rise = f1 - f
    sign = -1.0 if (rise if f * f1 < 0.0 else f) < 0.0 else 1.0
    cube, square = a + b - 2.0 * rise, 3.0 * rise - 2.0 * a - b
    radicand = square * square - 3.0 * cube * a
    if radicand <= 0.0 or cube == 0.0:
        return False
    root = sqrt(radicand)
    inside = [u for u in ((-square - root) / (3.0 * cube), (-square + root) / (3.0 * cube)) if 0.0 < u < 1.0]
    if not inside:
        return False
    if f * f1 < 0.0:
        return sign * a >= 0.0 and sign * b >= 0.0
    lowest = min(sign * (f + u * (a + u * (square + u * cube))) for u in inside)
    return f * f1 > 0.0 and lowest <= NEAR_ZERO * min(abs(f), abs(f1))
