"""Paths: the axes along straight lines from frame to frame, on one branch."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import floor
from typing import TYPE_CHECKING, Any, NamedTuple

from softkin._configuration import slots
from softkin._frame import Frame
from softkin._slerp import between
from softkin._types import (
    Configuration,
    ConfigurationLike,
    Diagnosis,
    FrameLike,
    KinematicsError,
    Numbers,
    Reals,
    Signs,
    Status,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from softkin._core import Mechanism
    from softkin._timed import Timed

_SMOOTH = 1.0 / 36.0
"""A share of a full turn: where an axis turns further in one step, the step is halved."""
_SHORTEST = 1e-9
"""A step of this share of a line is not halved: an axis that still turns too far in it jumps."""
_APART = 1e-5
"""The share of a line over which the speed of the axes is measured."""


class Stop(NamedTuple):
    """Where and why a path ends before its last frame."""

    place: float
    """The number of the line, from 0, plus the share of it that is passed."""
    frame: Frame
    """The last frame that is reached."""
    refusal: Diagnosis
    """Why the path cannot go on: the reason that `diagnose` gives, or the axis that jumps."""


class Stretch(NamedTuple):
    """A part of a path on which a singularity is near."""

    start: float
    end: float
    """From place to place: the samples between which the margin is small, or changes its sign."""
    margin: str
    """The name of the margin: see `Mechanism.MARGINS`."""
    least: float
    """Its least size at the samples."""


@dataclass(frozen=True, repr=False)
class Path:
    """The axes along a path, up to its end or to where it stops."""

    robot: Mechanism
    corners: tuple[Frame, ...]
    """The frames that were given."""
    signs: Signs
    """The branch on which it stays."""
    places: Reals
    """For every sample, the number of its line, from 0, plus the share of this line that is passed."""
    frames: tuple[Frame, ...]
    """The frame of every sample."""
    axes: tuple[Reals, ...]
    """The axis values of every sample."""
    stop: Stop | None
    """None for a path that reaches its last frame."""
    singular: tuple[Stretch, ...]
    """The stretches near a singularity, by place."""

    def __bool__(self) -> bool:
        """Whether it reaches its last frame."""
        return self.stop is None

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        """The axis values of every sample (N, n)."""
        import numpy as np

        if copy is False:
            raise ValueError("a path is no array: its axis values are a copy")
        return np.array(self.axes, dtype or np.float64)

    def __repr__(self) -> str:
        """The machine, the number of samples, and where the path stops."""
        end = f"stops at {self.stop.place:.6g}: {self.stop.refusal.in_words}" if self.stop else "reaches its last frame"
        return f"<Path of {self.robot.NAME}: {len(self.axes)} samples, {end}>"

    @property
    def configuration(self) -> Configuration:
        """The configuration at the first sample: named branches, and turns."""
        branches = tuple(1 if sign > 0 else 2 for sign in self.signs)
        return self.robot._joined(branches, self.robot._periods(self.axes[0])) if self.axes else ()

    def velocities(self, duration: float = 1.0) -> tuple[Reals, ...]:
        """The speeds of the axes at every sample: per second, in the unit of each axis.

        duration: the seconds that each line takes, at constant speed. At a corner the speed on the line that ends
        there. Central differences over 1e-5 of a line, where the way before and behind is free.
        """
        lines = (min(max(line_of(place), 0), max(len(self.corners) - 2, 0)) for place in self.places)
        return tuple(self._velocity(k, line, duration) for k, line in enumerate(lines))

    def _velocity(self, sample: int, line: int, duration: float = 1.0) -> Reals:
        """The speeds at a sample that belongs to a line."""
        place, axes = self.places[sample], self.axes[sample]
        first, second = max(place - _APART, float(line)), min(place + _APART, line + 1.0, self.places[-1])
        if not second > first:
            return (0.0,) * len(axes)
        before, behind = (solved(self, at, axes) for at in (first, second))
        if isinstance(before, Diagnosis) or isinstance(behind, Diagnosis):
            return (float("nan"),) * len(axes)
        time = (second - first) * duration
        return tuple([(b - a) / time for a, b in zip(before, behind, strict=True)])

    def plot(self, ax: Any = None) -> Any:
        """Draw the axis values along the path with matplotlib, with stretches near a singularity, and where it stops.

        ax: the axes of matplotlib to draw in; None makes a figure. Returns these axes. Raises ImportError without
        matplotlib.
        """
        from softkin import _plot

        return _plot.path(self, ax)

    def timed(self, limits: Mapping[str, Sequence[float]], step: float = 0.01) -> Timed:
        """The path in time, as fast as the limits of the axes allow: at rest at every corner.

        limits: for every axis by name its highest speed, per second, and acceleration, per second squared, in the unit
        of the axis; a third number, the jerk, is not read. step: the seconds from one time of the result to the next.
        The limits are held at four places between two samples. Raises UNREACHABLE for a path that stops, IMPOSSIBLE
        where an axis has no speed, BAD_INPUT for other limits, ImportError without toppra and SciPy.
        """
        from softkin import _timed

        return _timed.along(self, limits, step)

    def feeds(self, velocities: Numbers | None = None, accelerations: Numbers | None = None) -> Reals:
        """The largest constant speed of the tool that the limits of the axes allow at every sample.

        velocities, accelerations: the largest size that each may have, one positive number for each axis, per second in
        the unit of the axis; None for no limit. The speed is in lengths a second, of a line that only turns in degrees
        a second; the smallest one is what the whole path may be driven with. Infinite where no axis moves or no limit
        is given, NaN where the way before and behind is not free. At a corner the speed on the line that ends there.
        Raises BAD_INPUT for limits that are not positive.
        """
        from softkin import _feeds

        return _feeds.along(self, velocities, accelerations)

    def fastest(self, duration: float = 1.0) -> Reals:
        """The highest speed of each axis at the samples, as a positive number: see `velocities`."""
        columns = zip(*self.velocities(duration), strict=True)
        return tuple([max(map(abs, column)) for column in columns])


def line_of(place: float) -> int:
    """The number of the line at a place; a corner belongs to the line that ends there."""
    whole = floor(place)
    return whole - 1 if whole == place and whole > 0 else whole


def _frame(corners: Sequence[Frame], place: float) -> Frame:
    line = min(floor(place), len(corners) - 2)
    return corners[0] if line < 0 else between(corners[line], corners[line + 1], place - line)


def solved(path: Path, place: float, near: Reals) -> Reals | Diagnosis:
    return _Follower(path.robot, path.corners, path.signs).solve(place, near)


def path(
    robot: Mechanism,
    frames: Iterable[FrameLike],
    configuration: ConfigurationLike | None,
    reference: Numbers | None,
    samples: int,
    singular: float,
) -> Path:
    """See `Mechanism.path`."""
    if type(samples) is not int or not 1 <= samples <= 10**6:
        raise KinematicsError(
            Status.BAD_INPUT, f"{robot.NAME}.path: samples must be a number from 1 to 10**6, not {samples!r}"
        )
    corners = tuple(_corner(robot, frame) for frame in frames)
    if not corners:
        raise KinematicsError(Status.BAD_INPUT, f"{robot.NAME}.path: a path needs a frame")
    near = robot._near(reference)
    branches, turns = robot._read(configuration)
    signs, axes = _first(robot, corners[0], branches, turns, near)
    refused = axes if isinstance(axes, Diagnosis) else robot._beyond_limits(axes)
    if refused is not None:
        if refused.status is Status.BAD_INPUT:
            robot._fail("path", refused, position=corners[0].position, reference=near)
        return Path(robot, corners, signs, (), (), (), Stop(0.0, corners[0], refused), ())
    assert not isinstance(axes, Diagnosis)
    follower = _Follower(robot, corners, signs)
    places, values = follower.run(axes, samples)
    reached = tuple(_frame(corners, place) for place in places)
    stretches = tuple(_stretches(robot, places, reached, values, singular))
    return Path(robot, corners, signs, places, reached, values, follower.stop, stretches)


def _corner(robot: Mechanism, frame: FrameLike) -> Frame:
    """A frame in tuples, with a rotation that is exact."""
    position, rows = robot._pose(frame)
    return Frame(position, robot._used("path", rows))


def _first(
    robot: Mechanism, frame: Frame, branches: Configuration, turns: tuple[int, ...], near: Reals
) -> tuple[Signs, Reals | Diagnosis]:
    """The first axes, and the signs of their branch, chosen as `inverse` does."""
    found = [(signs, robot._branch(*frame, signs, turns, near)) for _, signs in slots(branches)]
    best: tuple[Signs, Reals] | None = None
    for signs, axes in found:
        if not isinstance(axes, Diagnosis) and (best is None or robot._is_nearer(axes, best[1], near)):
            best = signs, axes
    return found[0] if best is None else best


class _Follower:
    """Follows the lines on one branch, with halved steps where the axes turn far, until it cannot go on."""

    def __init__(self, robot: Mechanism, corners: tuple[Frame, ...], signs: Signs) -> None:
        self.robot, self.corners, self.signs = robot, corners, signs
        self.turns = (0,) * len(robot.PERIOD_AXES)
        self.rotary = [i for i, axis in enumerate(robot.AXES) if axis.unit != "u"]
        self.smooth = _SMOOTH * robot._full_turn()
        self.stop: Stop | None = None

    def run(self, axes: Reals, samples: int) -> tuple[Reals, tuple[Reals, ...]]:
        """The places and the axes of the samples, and of the place where the path stops."""
        places, values = [0.0], [axes]
        for line in range(len(self.corners) - 1):
            for step in range(1, samples + 1):
                place = line + step / samples
                reached, axes, refused = self._walk(places[-1], values[-1], place)
                if reached > places[-1]:
                    places.append(reached)
                    values.append(axes)
                if refused is not None:
                    self.stop = Stop(reached, _frame(self.corners, reached), refused)
                    return tuple(places), tuple(values)
        return tuple(places), tuple(values)

    def solve(self, place: float, near: Reals) -> Reals | Diagnosis:
        """The axes at a place, on the turns that follow from axes nearby."""
        axes = self.robot._branch(*_frame(self.corners, place), self.signs, self.turns, near)
        return axes if isinstance(axes, Diagnosis) else self.robot._beyond_limits(axes) or axes

    def _walk(self, start: float, axes: Reals, goal: float) -> tuple[float, Reals, Diagnosis | None]:
        """The last place that the path from place to place reaches, the axes there, and the reason why it stops."""
        found = self.solve(goal, axes)
        refused = found if isinstance(found, Diagnosis) else self._jump(axes, found)
        if refused is None and not isinstance(found, Diagnosis):
            return goal, found, None
        middle = 0.5 * (start + goal)
        if goal - start <= _SHORTEST or not start < middle < goal:
            return start, axes, refused
        reached, axes, refused = self._walk(start, axes, middle)
        return (reached, axes, refused) if refused is not None else self._walk(middle, axes, goal)

    def _jump(self, axes: Reals, other: Reals) -> Diagnosis | None:
        """The axis that turns too far for a short step."""
        for i in self.rotary:
            apart = abs(other[i] - axes[i])
            if apart > self.smooth:
                axis = self.robot.AXES[i]
                words = f"{axis.name}: would have to jump by {float(f'{apart:.4g}')!r} {axis.unit}"
                return Diagnosis(Status.UNREACHABLE, words, 0.0)
        return None


def _stretches(
    robot: Mechanism, places: Reals, frames: Sequence[Frame], values: Sequence[Reals], singular: float
) -> Iterator[Stretch]:
    """The stretches on which a margin is small, or between whose ends it changes its sign."""
    every = [robot._started(*frame)._singularity(axes) for frame, axes in zip(frames, values, strict=True)]
    found: list[Stretch] = []
    for number, name in enumerate(robot.MARGINS):
        margins = [float("nan") if isinstance(m, Status) else m[number] for m in every]
        near = [not abs(m) >= singular for m in margins]
        changes = {i for i in range(1, len(margins)) if margins[i] * margins[i - 1] < 0.0}
        start = 0
        while start < len(margins):
            end = start
            while end + 1 < len(margins) and ((near[end] and near[end + 1]) or end + 1 in changes):
                end += 1
            if near[start] or end > start:
                sizes = [abs(m) for m in margins[start : end + 1]]
                found.append(Stretch(places[start], places[end], name, min(sizes)))
            start = end + 1
    yield from sorted(found)
