"""Velocities of the frame and of the axes, and what the Jacobian says about both."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from softkin._input import reals
from softkin._types import KinematicsError, Numbers, Reals, Status

if TYPE_CHECKING:
    from softkin._core import Mechanism

_Array = NDArray[np.float64]
_SINGULAR = 4.0 * float(np.finfo(np.float64).eps)
"""A singular value smaller than this share of the largest one is zero to all digits."""
MISSED = 1e-9
"""A twist is reached where what is missing of it is at most this share of its size."""
_LINEAR = ("x", "y", "z", "miss")
"""The first words of rows that are lengths."""


def twist(robot: Mechanism, axes: Numbers, velocities: Numbers) -> Reals:
    """The velocity of the frame."""
    moved = checked(robot, "twist", velocities, len(robot.AXES), "velocities")
    return tuple((_jacobian(robot, axes) @ moved).tolist())


def axis_velocities(
    robot: Mechanism, axes: Numbers, wanted: Numbers, held: Numbers | None, damping: float, length: float | None
) -> Reals:
    """The velocities of the axes."""
    given = checked(robot, "axis_velocities", wanted, len(robot.JACOBIAN_ROWS), "twist")
    return solved_for_axes(robot, "axis_velocities", axes, given, held, damping, length)


def solved_for_axes(
    robot: Mechanism,
    call: str,
    axes: Numbers,
    given: _Array,
    held: Numbers | None,
    damping: float,
    length: float | None,
) -> Reals:
    """The values of the axes whose product with the Jacobian is given: exact, or by damped least squares."""
    carried = checked(robot, call, [0.0] * len(robot.HELD) if held is None else held, len(robot.HELD), "held")
    (damped,) = checked(robot, call, (damping,), 1, "damping")
    if damped < 0.0:
        raise _bad(robot, call, f"damping must be 0 or positive, not {damping!r}")
    rows, columns = _sizes(robot, call, length, is_needed=damped > 0.0)
    matrix = _jacobian(robot, axes)
    if damped == 0.0 and robot.singularity(axes).is_singular:
        near = ", ".join(f"{n} {m:.3g}" for n, m in robot.singularity(axes).margins.items())
        message = (
            f"{robot.NAME}.{call}: the pose is singular (margins: {near}): there is no exact answer without damping"
        )
        raise KinematicsError(Status.IMPOSSIBLE, message)
    found = np.zeros(len(robot.AXES))
    found[list(robot.HELD)] = carried
    free = _free(robot)
    right = (given - matrix @ found) / rows
    scaled = matrix[:, free] / rows[:, None] * columns[free]
    solved = _damped(scaled, right, damped) if damped > 0.0 else _exact(robot, call, scaled, right)
    found[free] = solved * columns[free]
    return tuple(found.tolist())


def condition(robot: Mechanism, axes: Numbers, length: float | None) -> float:
    """The ratio of the largest to the least singular value."""
    found = _singular_values(robot, axes, length, "condition")
    if not found.size:
        return 1.0
    largest, least = float(found[0]), float(found[-1])
    return largest / least if least > _SINGULAR * largest else float("inf")


def manipulability(robot: Mechanism, axes: Numbers, length: float | None) -> float:
    """The product of the singular values."""
    return float(np.prod(_singular_values(robot, axes, length, "manipulability")))


def _singular_values(robot: Mechanism, axes: Numbers, length: float | None, call: str) -> _Array:
    """The singular values of the dimensionless Jacobian, the largest first."""
    rows, columns = _sizes(robot, call, length, is_needed=True)
    matrix = (_jacobian(robot, axes) / rows[:, None] * columns)[:, _free(robot)]
    return np.asarray(np.linalg.svd(matrix, compute_uv=False) if matrix.size else (), np.float64)


def _exact(robot: Mechanism, call: str, matrix: _Array, right: _Array) -> _Array:
    """The exact solution. With more rows than axes it may be that there is none."""
    count, width = matrix.shape
    if count == width:
        return np.asarray(np.linalg.solve(matrix, right), np.float64)
    solved = np.asarray(np.linalg.lstsq(matrix, right, rcond=None)[0], np.float64)
    missing = right - matrix @ solved
    if np.abs(missing).max(initial=0.0) > MISSED * np.abs(right).max(initial=0.0):
        worst = robot.JACOBIAN_ROWS[int(np.argmax(np.abs(missing)))]
        message = f"{robot.NAME}.{call}: the axes cannot move the frame so: {worst} is missed"
        raise KinematicsError(Status.UNREACHABLE, message)
    return solved


def _damped(matrix: _Array, right: _Array, damping: float) -> _Array:
    """The damped least squares, as those of a matrix with more rows: nothing is squared, so no digits are lost."""
    width = matrix.shape[1]
    whole = np.vstack([matrix, damping * np.eye(width)])
    return np.asarray(np.linalg.lstsq(whole, np.append(right, np.zeros(width)), rcond=None)[0], np.float64)


def _jacobian(robot: Mechanism, axes: Numbers) -> _Array:
    return np.array(robot.jacobian(axes), float).reshape(len(robot.JACOBIAN_ROWS), len(robot.AXES))


def _free(robot: Mechanism) -> list[int]:
    """The axes that are not held."""
    return [i for i in range(len(robot.AXES)) if i not in robot.HELD]


def _sizes(robot: Mechanism, call: str, length: float | None, *, is_needed: bool) -> tuple[_Array, _Array]:
    """What the rows are divided by and the columns multiplied with, so that the Jacobian has no unit."""
    if length is None:
        if is_needed and _is_mixed(robot):
            raise _bad(robot, call, "its rows or its axes differ in their unit: a characteristic length is needed")
        length = 1.0
    (size,) = checked(robot, call, (length,), 1, "length")
    if not size > 0.0:
        raise _bad(robot, call, f"length must be positive, not {length!r}")
    rows = np.array([size if row.split()[0] in _LINEAR else 1.0 for row in robot.JACOBIAN_ROWS])
    columns = np.array([size if axis.unit == "u" else 1.0 for axis in robot.AXES])
    return rows, columns


def _is_mixed(robot: Mechanism) -> bool:
    """Whether rows, or axes that are not held, differ in their unit."""
    kinds = {robot.AXES[i].unit for i in _free(robot)}
    return len(kinds) > 1 or len({row.split()[0] in _LINEAR for row in robot.JACOBIAN_ROWS}) > 1


def checked(robot: Mechanism, call: str, values: Numbers, count: int, what: str) -> _Array:
    """So many finite numbers. Raises BAD_INPUT."""
    found = np.array(reals(values, count, what))
    if not np.isfinite(found).all():
        raise _bad(robot, call, f"{what} must be finite, not {found.tolist()}")
    return found


def _bad(robot: Mechanism, call: str, why: str) -> KinematicsError:
    return KinematicsError(Status.BAD_INPUT, f"{robot.NAME}.{call}: {why}")
