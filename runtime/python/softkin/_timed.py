"""Time laws: a path, or a move from point to point, as fast as the limits of the axes allow.

Along a path toppra finds the speed (time-optimal path parameterization by reachability analysis: it takes any path, and
keeps the axes on it); from point to point ruckig does, which also limits the jerk. Both are imported here alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import ceil, inf
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from softkin._input import reals
from softkin._types import KinematicsError, Numbers, Reals, Status

if TYPE_CHECKING:
    from softkin._core import Mechanism
    from softkin._path import Path

_SAMPLES = 100
"""The least number of samples of a line: between them the axes follow a polynomial."""
_FINER = 4
"""The intervals between two samples in which the limits are held."""
_NEEDED = "{} needs {}: pip install 'softkin[time]'"


_MOST_TIMES = 1e7


class Part(NamedTuple):
    """A motion that follows others."""

    duration: float
    at: Callable[[float, int], Any]
    """Its values at a time since its beginning; 0, or the order of a derivative."""


@dataclass(frozen=True, eq=False, repr=False)
class Timed:
    """A motion in time, at equal steps and at its end."""

    robot: Mechanism
    times: NDArray[np.float64]
    """Seconds (N,)."""
    axes: NDArray[np.float64]
    """The axis values at these times (N, n)."""
    velocities: NDArray[np.float64]
    """Their speeds, per second (N, n)."""
    accelerations: NDArray[np.float64]
    """Their accelerations, per second squared (N, n)."""

    @property
    def duration(self) -> float:
        """The seconds that the motion takes."""
        return float(self.times[-1])

    def __repr__(self) -> str:
        """The machine, the duration, and the number of times."""
        return f"<Timed motion of {self.robot.NAME}: {self.duration:.6g} s, {len(self.times)} times>"

    def plot(self, ax: Any = None) -> Any:
        """Draw the speeds over time with matplotlib, and return its axes. ax: the axes to draw in; None makes a figure.

        Raises ImportError without matplotlib.
        """
        from softkin import _plot

        return _plot.curves(self.robot, self.times, self.velocities, ax, "time [s]", "speed", "/s")


def along(path: Path, limits: Mapping[str, Sequence[float]], step: float) -> Timed:
    """See `Path.timed`."""
    robot = path.robot
    if path.stop is not None or len(path.corners) < 2:
        end = f"the path stops at {path.stop.place:.6g}" if path.stop else "the path has no line"
        raise KinematicsError(Status.UNREACHABLE, f"{robot.NAME}.timed: {end}: there is nothing to time to its end")
    speeds, accelerations, _ = _limits(robot, limits)
    try:
        from toppra import algorithm, constraint
    except ImportError as problem:
        raise ImportError(_NEEDED.format("timed", "toppra and SciPy")) from problem
    kept = [np.column_stack([-np.array(most), most]) for most in (speeds, accelerations)]
    if len(path.places) <= _SAMPLES * (len(path.corners) - 1):
        path = robot.path(path.corners, path.configuration, path.axes[0], samples=_SAMPLES)
    bounds = [constraint.JointVelocityConstraint(kept[0]), constraint.JointAccelerationConstraint(kept[1])]
    parts = []
    for line in range(len(path.corners) - 1):
        curve = _Curve(path, line)
        if curve.is_still:
            continue
        solved = algorithm.TOPPRA(bounds, curve, curve.grid, parametrizer="ParametrizeConstAccel")
        found = solved.compute_trajectory(0.0, 0.0)
        if found is None:
            words = (
                f"no speed along line {line} keeps the limits: an axis turns without end there, or a limit is too low"
            )
            raise KinematicsError(Status.IMPOSSIBLE, f"{robot.NAME}.timed: {words}")
        parts.append(Part(float(found.duration), found))
    return _sampled(robot, parts, step) if parts else _at_rest(robot, path.axes[0])


def move(robot: Mechanism, start: Numbers, goal: Numbers, limits: Mapping[str, Sequence[float]], step: float) -> Timed:
    """See `Mechanism.move`."""
    count = len(robot.AXES)
    ends = [reals(values, count, what) for values, what in ((start, "start"), (goal, "goal"))]
    for axes in ends:
        refused = robot._beyond_limits(axes)
        if refused is not None:
            raise KinematicsError(refused.status, f"{robot.NAME}.move: {refused.in_words}", refused)
    speeds, accelerations, jerks = _limits(robot, limits)
    try:
        import ruckig
    except ImportError as problem:
        raise ImportError(_NEEDED.format("move", "ruckig")) from problem
    given, trajectory = ruckig.InputParameter(count), ruckig.Trajectory(count)
    given.current_position, given.target_position = map(list, ends)
    given.max_velocity, given.max_acceleration, given.max_jerk = speeds, accelerations, jerks
    given.synchronization = ruckig.Synchronization.Phase
    if ruckig.Ruckig(count).calculate(given, trajectory) not in (ruckig.Result.Working, ruckig.Result.Finished):
        raise KinematicsError(Status.BAD_INPUT, f"{robot.NAME}.move: no motion keeps these limits: {dict(limits)}")
    if not trajectory.duration > 0.0:
        return _at_rest(robot, ends[0])
    return _sampled(robot, [Part(trajectory.duration, lambda t, order: trajectory.at_time(t)[order])], step)


class _Curve:
    """The axes along one line, as toppra asks for them: at the samples they are exact, and so are their derivatives."""

    def __init__(self, path: Path, line: int) -> None:
        from scipy.interpolate import BPoly, CubicSpline

        chosen = [k for k, place in enumerate(path.places) if line <= place <= line + 1]
        places, axes = np.array(path.places)[chosen], np.array(path.axes)[chosen]
        rates = np.array([path._velocity(k, line) for k in chosen])
        if not np.isfinite(rates).all():
            words = f"an axis has no speed at a pose of line {line}, which is singular"
            raise KinematicsError(Status.IMPOSSIBLE, f"{path.robot.NAME}.timed: {words}")
        self.is_still = not rates.any()
        bends = CubicSpline(places, rates).derivative()(places)
        self._curve = BPoly.from_derivatives(places, np.stack([axes, rates, bends], axis=1))
        samples = np.arange(_FINER * (len(places) - 1) + 1) / _FINER
        self.grid = np.interp(samples, np.arange(len(places)), places)
        self.dof, self.path_interval, self.waypoints = axes.shape[1], places[[0, -1]], None

    def __call__(self, places: Any, order: int = 0) -> Any:
        return self._curve(places, nu=order)


def _limits(robot: Mechanism, limits: Mapping[str, Sequence[float]]) -> tuple[list[float], list[float], list[float]]:
    """Speed, acceleration and jerk of every axis."""
    names = [axis.name for axis in robot.AXES]
    words = f"{robot.NAME}: limits must be (speed, acceleration), or these and the jerk, for {', '.join(names)}"
    if set(limits) != set(names):
        raise KinematicsError(Status.BAD_INPUT, f"{words}, and not for {', '.join(limits) or 'none'}")
    rows = [[*map(float, limits[name]), inf][:3] for name in names]
    for name, row in zip(names, rows, strict=True):
        if len(row) < 3 or not all(value > 0.0 for value in row) or inf in row[:2]:
            raise KinematicsError(Status.BAD_INPUT, f"{words}, each above 0, not {limits[name]!r} for {name}")
    return [row[0] for row in rows], [row[1] for row in rows], [row[2] for row in rows]


def _sampled(robot: Mechanism, parts: Sequence[Part], step: float) -> Timed:
    """The values at every step, and at the end."""
    ends = np.cumsum([part.duration for part in parts])
    if not 0.0 < step < inf or ends[-1] / step > _MOST_TIMES:
        raise KinematicsError(Status.BAD_INPUT, f"{robot.NAME}: step must be seconds above 0, not {step!r}")
    times = np.append(np.arange(ceil(ends[-1] / step - 1e-9)) * step, ends[-1])
    rows: list[list[Any]] = [[], [], []]
    for time in times:
        k = min(int(np.searchsorted(ends, time)), len(parts) - 1)
        since = min(max(time - ends[k] + parts[k].duration, 0.0), parts[k].duration)
        for order, row in enumerate(rows):
            row.append(parts[k].at(since, order))
    return Timed(robot, times, *map(np.array, rows))


def _at_rest(robot: Mechanism, axes: Reals) -> Timed:
    """A motion that takes no time."""
    row = np.array([axes])
    return Timed(robot, np.zeros(1), row, 0.0 * row, 0.0 * row)
