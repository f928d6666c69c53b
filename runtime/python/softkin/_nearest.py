"""The solution nearest to a reference inside the limits, over all branches and turns.

A whole turn of a joint does not change the pose, but moves its axis; with a gear coupling or a pitch it moves other
axes and quantities, too. So the solutions of a branch are one solution plus all sums of such steps. An axis that no
other step moves finds its nearest value by itself. The steps of all other axes are searched in the order in which they
move each other: limits bound the search, and no sum farther than the best one is tried.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import ceil, floor, sqrt
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

from softkin._constants import EDGE, LARGEST
from softkin._input import reals
from softkin._scalar import reasonable
from softkin._types import Diagnosis, KinematicsError, Numbers, Reals, Rotation, Status, Vector

if TYPE_CHECKING:
    from softkin._core import Mechanism

MOST_TURNS = 254
"""The turns that are tried in each sense from the reference: as many as a period byte can name."""
_SAME = 1e-12
"""The share of an axis value that is rounding."""
Measure: TypeAlias = Literal["squares", "largest"]
"""How the differences of the axes make a distance: the sum of their squares, or the largest of them."""
_Cost: TypeAlias = tuple[float, float]
"""The distance so far, and the sum of squares, which decides between equal largest differences."""
Range: TypeAlias = tuple[float, float]


class Metric(NamedTuple):
    """A distance between axis values."""

    weights: tuple[Reals, ...]
    """Factors of the differences, one for each axis; each row decides where all rows before it tie."""
    ties: Reals
    """For each row, the distances that differ by at most this count as equal."""
    takes_largest: bool

    def distances(self, axes: Reals, reference: Reals) -> Reals:
        """The distance by every row."""
        apart = [a - b for a, b in zip(axes, reference, strict=True)]
        return tuple([self._of([w * d for w, d in zip(row, apart, strict=True)]) for row in self.weights])

    def _of(self, weighted: Sequence[float]) -> float:
        if self.takes_largest:
            return max(map(abs, weighted), default=0.0)
        return sum([d * d for d in weighted])

    def is_less(self, own: Reals, other: Reals) -> bool:
        """Whether distances are less than others; the lower slot stays where they tie."""
        for mine, least, tie in zip(own, other, self.ties, strict=True):
            if mine < least - tie:
                return True
            if least < mine - tie:
                return False
        return False


def metric_of(robot: Mechanism, weights: Numbers | None, measure: Measure) -> Metric:
    """The metric of an automatic choice, or that of given weights. Raises BAD_INPUT for weights that cannot be."""
    if measure not in ("squares", "largest"):
        raise KinematicsError(Status.BAD_INPUT, f'the measure must be "squares" or "largest", not {measure!r}')
    is_largest, count = measure == "largest", len(robot.AXES)
    if weights is None:
        rows = tuple(tuple(1.0 if i in c.axes else 0.0 for i in range(count)) for c in robot._criteria)
        ties = tuple(c.tie for c in robot._criteria)
    else:
        given = reals(weights, count, "weights")
        if not all(0.0 <= w <= LARGEST for w in given):
            raise KinematicsError(Status.BAD_INPUT, f"weights must be numbers from 0 to 1e9, not {given}")
        first = robot._criteria[0]
        rows, ties = (given,), (first.tie * max((given[i] ** 2 for i in first.axes), default=0.0),)
    return Metric(rows, tuple(map(sqrt, ties)) if is_largest else ties, is_largest)


class Turning(NamedTuple):
    """The effect of whole turns of the joints, and the ranges in which axes and quantities must stay."""

    steps: tuple[Reals, ...]
    """For each axis with a period byte: the amount that its turn adds to each axis, then to each further quantity with
    limits."""
    ranges: tuple[Range, ...]
    """The ranges of the axes, then of these quantities."""
    alone: tuple[tuple[int, float], ...]
    """The axes that move by themselves, each with its step."""
    coupled: tuple[tuple[int, Reals, tuple[int, ...]], ...]
    """The other axes in the order of their search: each with its step, and the values that no later step moves."""


def turning_of(robot: Mechanism, position: Vector, rotation: Rotation, signs: tuple[int, ...], near: Reals) -> Turning:
    """The turning of a machine, measured at a pose that it reaches; it is the same at any other."""
    return robot._once("turning", lambda: _measured(robot, position, rotation, signs, near))


def _measured(robot: Mechanism, position: Vector, rotation: Rotation, signs: tuple[int, ...], near: Reals) -> Turning:
    first = (1,) * len(robot.PERIOD_AXES)
    base = _with_turns(robot, position, rotation, signs, first, near)
    steps: list[Reals] = []
    for number, (axis, size) in enumerate(zip(robot.PERIOD_AXES, robot._turn_sizes(), strict=True)):
        turns = tuple(2 if i == number else 1 for i in range(len(first)))
        other = _with_turns(robot, position, rotation, signs, turns, near)
        step = (
            [_rounded(b, a) for a, b in zip(base, other, strict=True)]
            if base and other
            else [0.0] * len(robot._ranges())
        )
        step[axis] = 360.0 / size
        steps.append(tuple(step))
    alone = [n for n in range(len(steps)) if _is_alone(n, robot.PERIOD_AXES[n], steps)]
    own = tuple((robot.PERIOD_AXES[n], steps[n][robot.PERIOD_AXES[n]]) for n in alone)
    rest = [n for n in range(len(steps)) if n not in alone]
    return Turning(tuple(steps), robot._ranges(), own, _in_order(rest, robot.PERIOD_AXES, steps))


def _with_turns(
    robot: Mechanism, position: Vector, rotation: Rotation, signs: tuple[int, ...], turns: tuple[int, ...], near: Reals
) -> Reals:
    """The axes on named turns, followed by the quantities that have limits."""
    axes = robot._branch(position, rotation, signs, turns, near)
    return () if isinstance(axes, Diagnosis) else axes + robot._limited_values(axes)


def _rounded(after: float, before: float) -> float:
    """The difference, or zero if it is only rounding."""
    step = after - before
    return 0.0 if abs(step) <= _SAME * (abs(after) + abs(before)) else step


def _is_alone(number: int, axis: int, steps: Sequence[Reals]) -> bool:
    """Whether a turn moves its own axis alone, and no other turn moves it."""
    moved = [i for i, part in enumerate(steps[number]) if part]
    return moved == [axis] and not any(step[axis] for n, step in enumerate(steps) if n != number)


def _in_order(
    rest: list[int], axes: Sequence[int], steps: Sequence[Reals]
) -> tuple[tuple[int, Reals, tuple[int, ...]], ...]:
    """Steps in the order in which they move each other's axes, each with the values that it is the last to move."""
    order: list[int] = []
    while rest:
        free = [n for n in rest if not any(steps[m][axes[n]] for m in rest if m != n)]
        order.append((free or rest)[0])
        rest = [n for n in rest if n != order[-1]]
    last: dict[int, int] = {}
    for n in order:
        last |= {i: n for i, part in enumerate(steps[n]) if part}
    return tuple((axes[n], steps[n], tuple(i for i, final in last.items() if final == n)) for n in order)


def nearest(robot: Mechanism, position: Vector, rotation: Rotation, near: Reals, metric: Metric) -> Reals | Diagnosis:
    """The nearest axes inside the limits, or the reason of the nearest miss."""
    if not reasonable(*near):
        return Diagnosis(Status.BAD_INPUT, "not given: a reference of numbers of reasonable size", 0.0)
    found = _best(robot, position, rotation, near, near, metric)
    if isinstance(found, Diagnosis) and found.status is Status.UNREACHABLE:
        inside = _clamped(robot, near)
        if inside != near:  # a free axis follows the reference, so solve again with a reference inside the limits
            other = _best(robot, position, rotation, inside, near, metric)
            return found if isinstance(other, Diagnosis) else other
    return found


def _best(
    robot: Mechanism, position: Vector, rotation: Rotation, start: Reals, near: Reals, metric: Metric
) -> Reals | Diagnosis:
    best: Reals | None = None
    least: Reals = ()
    misses: list[tuple[tuple[float, ...], Diagnosis]] = []
    for signs, axes in robot._every_solution(position, rotation, start):
        if isinstance(axes, Diagnosis):
            misses.append(((1.0, float(axes.status), float(axes.missing <= 0.0), axes.missing), axes))
            continue
        turning = turning_of(robot, position, rotation, signs, start)
        turned = on_nearest_turns(robot, axes, near, metric, turning)
        refused = robot._beyond_limits(turned)
        if refused is not None:
            misses.append(((0.0, _excess(robot, turned, turning)), refused))
            continue
        own = metric.distances(turned, near)
        if best is None or metric.is_less(own, least):
            best, least = turned, own
    return best if best is not None else min(misses, key=lambda miss: miss[0])[1]


def on_nearest_turns(robot: Mechanism, axes: Reals, near: Reals, metric: Metric, turning: Turning) -> Reals:
    """The axes of one branch on the turns nearest to the reference inside the limits, or on turns that miss these
    little.
    """
    values = list(axes)
    for axis, step in turning.alone:
        values[axis] = _nearest_value(values[axis], near[axis], step, turning.ranges[axis])
    if not turning.coupled:
        return tuple(values)
    start = tuple(values) + robot._limited_values(tuple(values))
    return _Search(robot, near, metric, turning).run(start) or tuple(values)


def _nearest_value(value: float, centre: float, step: float, ends: Range) -> float:
    """value + k step nearest to a centre inside a range; nearest to the range where none is inside."""
    lowest, highest = ends
    turned = value - step * turns_to(value, centre, step)
    if turned > highest:
        turned -= step * ceil((turned - highest) / step)
        above = turned + step
        return above if turned < lowest and above - highest < lowest - turned else turned
    if turned < lowest:
        turned += step * ceil((lowest - turned) / step)
        below = turned - step
        return below if turned > highest and lowest - below < turned - highest else turned
    return turned


def turns_to(value: float, centre: float, step: float) -> int:
    """The number of steps from a value to the value nearest to a centre; on an edge as in `nearest_period`."""
    return floor((value - centre) / step + (0.5 + EDGE / 360.0))


class _Search:
    """The search for the best sum of steps that move several axes."""

    def __init__(self, robot: Mechanism, near: Reals, metric: Metric, turning: Turning) -> None:
        self.robot, self.near, self.metric, self.turning = robot, near, metric, turning
        self.best: Reals | None = None
        self.least: _Cost = (0.0, 0.0)

    def run(self, start: Reals) -> Reals | None:
        """The axes inside all limits that are nearest to the reference; None if no sum of steps is inside."""
        moved = {i for *_, final in self.turning.coupled for i in final}
        ranges = enumerate(zip(start, self.turning.ranges, strict=True))
        if all(i in moved or low <= value <= high for i, (value, (low, high)) in ranges):
            self._level(0, start, (0.0, 0.0))
        return self.best

    def _level(self, level: int, values: Reals, cost: _Cost) -> None:
        if level == len(self.turning.coupled):
            axes = values[: len(self.near)]
            if (self.best is None or cost < self.least) and self.robot._beyond_limits(axes) is None:
                self.best, self.least = axes, cost
            return
        axis, step, final = self.turning.coupled[level]
        low, high = self._bounds(values, step, final)
        centre = -turns_to(values[axis], self.near[axis], step[axis])
        low, high = max(low, centre - MOST_TURNS), min(high, centre + MOST_TURNS)
        if low > high:
            return

        def cost_of(turns: int) -> _Cost:
            return self._cost(values, step, final, turns, cost)

        at = _descended(min(max(centre, low), high), low, high, cost_of)
        for turns in self._outward(at, low, high, cost_of):
            moved = tuple([v + turns * s for v, s in zip(values, step, strict=True)]) if turns else values
            self._level(level + 1, moved, cost_of(turns))

    def _outward(self, at: int, low: int, high: int, cost_of: Callable[[int], _Cost]) -> Iterator[int]:
        """The numbers of steps between bounds, the nearest first, as long as they can be better than the best."""
        up, down = at, at - 1
        while up <= high or down >= low:
            is_up = down < low or (up <= high and cost_of(up) <= cost_of(down))
            turns = up if is_up else down
            if self.best is not None and cost_of(turns) >= self.least:
                return
            yield turns
            up, down = (up + 1, down) if is_up else (up, down - 1)

    def _bounds(self, values: Reals, step: Reals, final: Sequence[int]) -> tuple[int, int]:
        """The least and the largest number of steps with which every value that no later step moves is in its range."""
        low, high = -(10**9), 10**9
        for i in final:
            lowest, highest = self.turning.ranges[i]
            ends = sorted(((lowest - values[i]) / step[i], (highest - values[i]) / step[i]))
            low, high = max(low, ceil(max(ends[0], -1e9))), min(high, floor(min(ends[1], 1e9)))
        return low, high

    def _cost(self, values: Reals, step: Reals, final: Sequence[int], turns: int, cost: _Cost) -> _Cost:
        largest, squares = cost
        weights, count = self.metric.weights[0], len(self.near)
        for i in final:
            if i < count:
                apart = weights[i] * (values[i] + turns * step[i] - self.near[i])
                squares += apart * apart
                largest = max(largest, abs(apart))
        return (largest, squares) if self.metric.takes_largest else (squares, squares)


def _descended(at: int, low: int, high: int, cost_of: Callable[[int], _Cost]) -> int:
    """The number of the least cost, which grows from there on both sides."""
    for sense in (1, -1):
        while low <= at + sense <= high and cost_of(at + sense) < cost_of(at):
            at += sense
    return at


def _clamped(robot: Mechanism, near: Reals) -> Reals:
    """The reference inside the limits of its axes; held axes stay where they are."""
    ranges = robot._ranges()
    inside = (min(max(value, low), high) for value, (low, high) in zip(near, ranges, strict=False))
    return tuple([value if i in robot.HELD else own for i, (value, own) in enumerate(zip(near, inside, strict=True))])


def _excess(robot: Mechanism, axes: Reals, turning: Turning) -> float:
    """The squared distances of axes from their ranges, as shares of these ranges."""
    total, whole = 0.0, robot._full_turn()
    for i, (value, (low, high)) in enumerate(zip(axes + robot._limited_values(axes), turning.ranges, strict=True)):
        beyond = max(low - value, value - high, 0.0)
        if beyond > 0.0:
            is_bounded = low > -LARGEST and high < LARGEST
            in_turns = i >= len(robot.AXES) or robot.AXES[i].unit != "u"
            size = high - low if is_bounded else whole if in_turns else abs(low if high >= LARGEST else high)
            total += (beyond / size) ** 2 if size > 0.0 else beyond
    return total
