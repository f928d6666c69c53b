"""The nearest solution inside the limits on arrays: `_nearest` has it on plain numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from softkin._array import Array, Codes, Reals
from softkin._batch import CHUNK, EVERY_SLOT
from softkin._columns import Poses, Table
from softkin._configuration import AUTOMATIC, slots
from softkin._constants import EDGE, LARGEST
from softkin._nearest import Metric, Turning, nearest, turning_of
from softkin._types import Diagnosis, Rotation, Status, Vector

if TYPE_CHECKING:
    from softkin._core import Mechanism


def nearest_batch(
    robot: Mechanism, positions: ArrayLike, rotations: ArrayLike | None, references: ArrayLike, metric: Metric
) -> tuple[Array, Codes]:
    """The nearest axes of every row, and statuses."""
    table = Table(robot, positions, rotations, references)
    axes, statuses = np.full((table.count, len(robot.AXES)), np.nan), np.zeros(table.count, np.uint8)
    size = min(CHUNK, EVERY_SLOT // 2**robot.BRANCHES)
    for start in range(0, table.count, size):
        rows = slice(start, start + size)
        poses = table.at(rows)
        with np.errstate(all="ignore"):
            found, status = _chunk(robot, poses, metric)
        axes[rows], statuses[rows] = found, status
    return axes, statuses


def _chunk(robot: Mechanism, poses: Poses, metric: Metric) -> tuple[Array, Codes]:
    """The rows of a chunk: all at once where every axis finds its turn by itself; the other rows one by one."""
    near = _table(poses.reference, (poses.count,))
    refused = np.broadcast_to(poses.refused, poses.count).copy()
    refused[(refused == Status.OK) & ~(np.abs(near) <= LARGEST).all(axis=1)] = Status.BAD_INPUT
    if robot._has_one_solution_a_branch():
        programs = robot._array_programs()
        turns = (0,) * len(robot.PERIOD_AXES)
        values, status = programs.every_branch(poses.position, poses.rotation, robot.BRANCHES, turns, poses.reference)
        status = status.reshape(-1, poses.count).astype(np.uint8)
        shape = (*(2,) * robot.BRANCHES, poses.count)
        every = _table(values, shape).reshape(*status.shape, len(values))
        turning = _turning(robot, poses, near, status, refused)
        if turning is None or not turning.coupled:
            return _all_at_once(robot, every, status, near, refused, metric, turning, poses)
    return _one_by_one(robot, poses, near, refused, metric, range(poses.count))


def _table(columns: Reals, shape: tuple[int, ...]) -> Array:
    """Columns as the last axis of one array."""
    table = np.empty((*shape, len(columns)))
    for i, column in enumerate(columns):
        table[..., i] = column
    return table


def _turning(robot: Mechanism, poses: Poses, near: Array, status: Codes, refused: Codes) -> Turning | None:
    """The effect of turns, measured at the first pose that is reached; None if no pose is reached."""
    solved = np.argwhere(((status == Status.OK) & (refused == Status.OK)).T)
    if not len(solved):
        return None
    row, slot = map(int, solved[0])
    position, rotation = _pose(poses, row)
    signs = slots((AUTOMATIC,) * robot.BRANCHES)[slot][1]
    return turning_of(robot, position, rotation, signs, tuple(near[row].tolist()))


def _all_at_once(
    robot: Mechanism,
    values: Array,
    status: Codes,
    near: Array,
    refused: Codes,
    metric: Metric,
    turning: Turning | None,
    poses: Poses,
) -> tuple[Array, Codes]:
    """Every slot on its nearest turns, then the nearest slot inside the limits."""
    if turning is None:
        return np.full(near.shape, np.nan), np.where(refused == Status.OK, status.min(axis=0), refused).astype(np.uint8)
    for axis, step in turning.alone:
        values[..., axis] = _nearest_values(values[..., axis], near[:, axis], step, turning.ranges[axis])
    outcome = status.copy()
    if robot.checks_limits:
        columns = tuple(np.moveaxis(values, -1, 0))
        limits = robot._array_programs().limits(columns)
        outcome = np.where(status == Status.OK, limits, status).astype(np.uint8)
    best, least = np.full(near.shape, np.nan), [np.full(len(near), np.inf) for _ in metric.ties]
    is_found = np.zeros(len(near), bool)
    for slot, own in enumerate(values):
        away = _distances(own, near, metric)
        takes = (outcome[slot] == Status.OK) & (refused == Status.OK)
        takes &= ~is_found | _are_less(away, least, metric)
        best[takes] = own[takes]
        least = [np.where(takes, new, old) for new, old in zip(away, least, strict=True)]
        is_found |= takes
    # a solution beyond the limits comes before a branch that is refused
    reason = np.where((status == Status.OK).any(axis=0), Status.UNREACHABLE, status.min(axis=0))
    final = np.where(is_found, Status.OK, np.where(refused == Status.OK, reason, refused)).astype(np.uint8)
    outside = (final == Status.UNREACHABLE) & ~_inside(robot, near)
    if outside.any():  # an axis that the pose leaves free may follow a reference inside the limits
        again, own = _one_by_one(robot, poses, near, refused, metric, np.flatnonzero(outside).tolist())
        best[outside], final[outside] = again[outside], own[outside]
    return best, final


def _inside(robot: Mechanism, near: Array) -> NDArray[np.bool_]:
    """The rows whose reference is inside the limits of its axes."""
    ranges = np.array(robot._ranges()[: near.shape[1]]).reshape(-1, 2)
    are_inside: NDArray[np.bool_] = np.all((near >= ranges[:, 0]) & (near <= ranges[:, 1]), axis=1)
    return are_inside


def _nearest_values(value: Array, centre: Array, step: float, ends: tuple[float, float]) -> Array:
    """`_nearest._nearest_value` on arrays."""
    lowest, highest = ends
    turned = value - step * np.floor((value - centre) / step + (0.5 + EDGE / 360.0))
    turned = turned - step * np.maximum(np.ceil((turned - highest) / step), 0.0)
    return turned + np.where(turned < lowest, step * np.ceil((lowest - turned) / step), 0.0)


def _distances(axes: Array, near: Array, metric: Metric) -> list[Array]:
    found = []
    for row in metric.weights:
        apart = np.array(row) * (axes - near)
        found.append(np.abs(apart).max(axis=1, initial=0.0) if metric.takes_largest else (apart * apart).sum(axis=1))
    return found


def _are_less(own: list[Array], least: list[Array], metric: Metric) -> NDArray[np.bool_]:
    less, undecided = np.zeros(len(own[0]), bool), np.ones(len(own[0]), bool)
    for mine, other, tie in zip(own, least, metric.ties, strict=True):
        is_less = mine < other - tie
        less |= undecided & is_less
        undecided &= ~is_less & ~(other < mine - tie)
    return less


def _one_by_one(
    robot: Mechanism, poses: Poses, near: Array, refused: Codes, metric: Metric, rows: range | list[int]
) -> tuple[Array, Codes]:
    """Rows by the scalar search: where turns move several axes, and where a branch may have several solutions."""
    axes, statuses = np.full(near.shape, np.nan), refused.copy()
    for row in rows:
        if refused[row] == Status.OK:
            found = nearest(robot, *_pose(poses, row), tuple(near[row].tolist()), metric)
            statuses[row] = found.status if isinstance(found, Diagnosis) else Status.OK
            if not isinstance(found, Diagnosis):
                axes[row] = found
    return axes, statuses


def _pose(poses: Poses, row: int) -> tuple[Vector, Rotation]:
    """Position and rotation of a row in plain numbers."""
    cells = (*poses.position, *(cell for line in poses.rotation for cell in line))
    x, y, z, a, b, c, d, e, f, g, h, i = (float(np.broadcast_to(cell, poses.count)[row]) for cell in cells)
    return (x, y, z), ((a, b, c), (d, e, f), (g, h, i))
