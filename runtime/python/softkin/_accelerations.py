"""Accelerations of the frame and of the axes, and the speed that the limits of axes allow.

The frame has the velocity J v and the acceleration J a + bias(v): the bias is its acceleration at constant velocities v
of the axes. At a speed s along a path whose twist at speed 1 is t, and whose rate of the twist is r, the axes have the
velocities s v' and, where s is constant, the accelerations s² a', with J v' = t and J a' = r - bias(v').
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from softkin._array import Codes, Programs
from softkin._batch import CHUNK, Started
from softkin._columns import columns
from softkin._differential import jacobian, singularity
from softkin._table import numbers
from softkin._types import KinematicsError, Numbers, Reals, Status
from softkin._velocities import MISSED, axis_velocities, checked, solved_for_axes, twist

if TYPE_CHECKING:
    from softkin._core import Mechanism

_Array = NDArray[np.float64]


def twist_rate(robot: Mechanism, axes: Numbers, velocities: Numbers, accelerations: Numbers) -> Reals:
    """The acceleration of the frame."""
    found = np.array(twist(robot, axes, checked(robot, "twist_rate", accelerations, len(robot.AXES), "accelerations")))
    return tuple((found + _bias(robot, "twist_rate", axes, velocities)).tolist())


def axis_accelerations(
    robot: Mechanism,
    axes: Numbers,
    velocities: Numbers,
    rate: Numbers,
    held: Numbers | None,
    damping: float,
    length: float | None,
) -> Reals:
    """The accelerations of the axes."""
    call = "axis_accelerations"
    given = checked(robot, call, rate, len(robot.JACOBIAN_ROWS), "twist_rate")
    right = given - _bias(robot, call, axes, velocities)
    return solved_for_axes(robot, call, axes, right, held, damping, length)


def largest_feed(
    robot: Mechanism,
    axes: Numbers,
    along: Numbers,
    rate: Numbers | None,
    limits: tuple[Numbers | None, Numbers | None],
) -> float:
    """The largest speed at a pose."""
    call, zeros = "largest_feed", (0.0,) * len(robot.JACOBIAN_ROWS)
    first, second = (limits_of(robot, call, one, what) for one, what in zip(limits, _LIMITS, strict=True))
    velocities = axis_velocities(robot, axes, along, None, 0.0, None)
    turning = (0.0,) * len(robot.AXES)
    if np.isfinite(second).any():
        turning = axis_accelerations(robot, axes, velocities, zeros if rate is None else rate, None, 0.0, None)
    return float(feeds_of(np.array([velocities]), np.array([turning]), first, second)[0])


def axis_velocities_batch(
    robot: Mechanism, programs: Programs | Started, axes: ArrayLike, twists: ArrayLike
) -> tuple[_Array, Codes]:
    """The velocities of the axes in every row."""
    values = numbers(axes, None, (len(robot.AXES),), "axes")
    right = numbers(twists, len(values), (len(robot.JACOBIAN_ROWS),), "twists")
    return _solved(robot, programs, values, right)


def axis_accelerations_batch(
    robot: Mechanism, programs: Programs | Started, axes: ArrayLike, velocities: ArrayLike, rates: ArrayLike
) -> tuple[_Array, Codes]:
    """The accelerations of the axes in every row."""
    values = numbers(axes, None, (len(robot.AXES),), "axes")
    speeds = numbers(velocities, len(values), (len(robot.AXES),), "velocities")
    right = numbers(rates, len(values), (len(robot.JACOBIAN_ROWS),), "twist_rates")
    return _solved(robot, programs, values, right - _bias_rows(robot, programs, values, speeds))


def largest_feed_batch(
    robot: Mechanism,
    programs: Programs | Started,
    axes: ArrayLike,
    twists: ArrayLike,
    rates: ArrayLike | None,
    limits: tuple[Numbers | None, Numbers | None],
) -> tuple[_Array, Codes]:
    """The largest speed in every row."""
    call = "largest_feed_batch"
    first, second = (limits_of(robot, call, one, what) for one, what in zip(limits, _LIMITS, strict=True))
    velocities, statuses = axis_velocities_batch(robot, programs, axes, twists)
    turning, found = np.zeros_like(velocities), np.zeros_like(statuses)
    if np.isfinite(second).any():
        bends = np.zeros(len(robot.JACOBIAN_ROWS)) if rates is None else rates
        turning, found = axis_accelerations_batch(robot, programs, axes, velocities, bends)
    return feeds_of(velocities, turning, first, second), np.where(statuses == Status.OK, found, statuses)


_LIMITS = ("velocities", "accelerations")


def limits_of(robot: Mechanism, call: str, given: Numbers | None, what: str) -> _Array:
    """The limits of the axes; infinite where there is none."""
    values = [float("inf")] * len(robot.AXES) if given is None else [float(value) for value in given]
    if len(values) != len(robot.AXES) or not all(value > 0.0 for value in values):
        why = f"{what} must be {len(robot.AXES)} positive numbers, not {given!r}"
        raise KinematicsError(Status.BAD_INPUT, f"{robot.NAME}.{call}: {why}")
    return np.array(values)


def feeds_of(velocities: _Array, accelerations: _Array, first: _Array, second: _Array) -> _Array:
    """The largest speed of every row; NaN where the axes cannot move so."""
    with np.errstate(divide="ignore", invalid="ignore"):
        by_velocity = np.where(velocities == 0.0, np.inf, first / np.abs(velocities))
        by_acceleration = np.where(accelerations == 0.0, np.inf, np.sqrt(second / np.abs(accelerations)))
    return np.asarray(np.concatenate([by_velocity, by_acceleration], axis=1).min(axis=1, initial=np.inf))


def _bias(robot: Mechanism, call: str, axes: Numbers, velocities: Numbers) -> _Array:
    """The acceleration of the frame at constant velocities of the axes."""
    robot.jacobian(axes)  # refuses axes that allow no pose
    speeds = checked(robot, call, velocities, len(robot.AXES), "velocities")
    found = robot._bias(tuple(map(float, axes)), tuple(speeds.tolist()))
    if isinstance(found, Status):
        robot._fail(call, found, axes=tuple(axes), velocities=tuple(speeds.tolist()))
    return np.array(found)


def _bias_rows(robot: Mechanism, programs: Programs | Started, values: _Array, speeds: _Array) -> _Array:
    """The same of every row; NaN where a row is refused."""
    found = np.empty((len(values), len(robot.JACOBIAN_ROWS)))
    for start in range(0, len(values), CHUNK):
        rows = slice(start, start + CHUNK)
        with np.errstate(all="ignore"):
            entries, status = programs.at(rows).bias(columns(values[rows]), columns(speeds[rows]))
        for k, entry in enumerate(entries):
            found[rows, k] = entry
        found[rows][status != Status.OK] = np.nan
    return found


def _solved(robot: Mechanism, programs: Programs | Started, values: _Array, right: _Array) -> tuple[_Array, Codes]:
    """J⁻¹ right of every row. Axes of `HELD` stay where they are."""
    matrices, statuses = jacobian(robot, programs, values)
    is_singular, _ = singularity(robot, programs, values)
    statuses = np.where((statuses == Status.OK) & is_singular, np.uint8(Status.IMPOSSIBLE), statuses)
    free = [i for i in range(len(robot.AXES)) if i not in robot.HELD]
    found = np.zeros(values.shape)
    rows = np.flatnonzero((statuses == Status.OK) & np.isfinite(right).all(axis=1))
    statuses[(statuses == Status.OK) & ~np.isfinite(right).all(axis=1)] = np.uint8(Status.BAD_INPUT)
    own = matrices[rows][:, :, free]
    if len(robot.JACOBIAN_ROWS) == len(free):
        part = np.linalg.solve(own, right[rows][:, :, None])[:, :, 0] if len(free) else np.zeros((len(rows), 0))
    else:
        part = (np.linalg.pinv(own) @ right[rows][:, :, None])[:, :, 0]
        missing = np.abs(right[rows] - (own @ part[:, :, None])[:, :, 0]).max(axis=1, initial=0.0)
        statuses[rows[missing > MISSED * np.abs(right[rows]).max(axis=1, initial=0.0)]] = np.uint8(Status.UNREACHABLE)
    found[rows[:, None], free] = part
    found[statuses != Status.OK] = np.nan
    return found, statuses
