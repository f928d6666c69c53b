"""Batches: the programs of a mechanism over many rows, in chunks that fit in the processor's cache."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from softkin._array import (
    Array,
    Codes,
    Programs,
    Real,
    Reals,
    Rotation,
    StartedPrograms,
    Vector,
    both_signs,
    reasonable,
    waiting,
)
from softkin._array_rotation import made_rotations
from softkin._columns import Bytes, Configurations, Mask, Poses, Rows, Table, columns, configurations
from softkin._configuration import COINCIDE, FIRST, SECOND
from softkin._constants import COINCIDENT, EDGE
from softkin._table import configuration_rows, numbers, starts
from softkin._types import ConfigurationLike, FrameLike, Status

if TYPE_CHECKING:
    from softkin._core import Mechanism

CHUNK = 8192
"""The rows that are computed together: an array then has 64 KiB."""
EVERY_SLOT = 3 * CHUNK
"""The largest number of rows times slots computed together where all slots are computed, since slots share values."""
FEWEST = 512
"""The least number of rows computed together, unless there are fewer; the second of a root search with many trials."""
MANY = 100_000
"""From this size of a result on, intermediate values must take little memory, however few rows then go together."""
SHARE = 0.25
"""The share of the result's memory that intermediate values take."""
_UNTRIED = 255
"""The status of rows for which no slot was tried."""

_Forward: TypeAlias = tuple[tuple[Vector, Rotation, Reals], Codes]


def forward(robot: Mechanism, programs: Programs | Started, axes: ArrayLike) -> tuple[Array, Array, Bytes, Codes]:
    """Forward kinematics of every row."""
    values = numbers(axes, None, (len(robot.AXES),), "axes")
    return _poses(robot, values, lambda rows: programs.at(rows).forward(columns(values[rows])))


@dataclass(frozen=True)
class Started:
    """The programs of a mechanism whose forward kinematics starts at a frame of its own in every row."""

    programs: StartedPrograms
    positions: Array
    rotations: Array

    def at(self, rows: slice) -> Programs:
        """The programs of some rows. A start that is no rotation is no number, so that it is refused."""
        a, b, c, d, e, f, g, h, i = columns(self.rotations[rows].reshape(-1, 9))
        rotation, refused = made_rotations(((a, b, c), (d, e, f), (g, h, i)))
        x, y, z = columns(self.positions[rows])
        return self.programs.started((np.where(refused == Status.OK, x, np.nan), y, z), rotation)


def started(
    robot: Mechanism, programs: StartedPrograms, axes: ArrayLike, start: FrameLike | tuple[ArrayLike, ArrayLike]
) -> Started:
    """The programs from a start of its own for every row of axes, or from one start for all."""
    count = len(numbers(axes, None, (len(robot.AXES),), "axes"))
    places, turns = starts(start)
    positions = numbers(places, count, (3,), "start positions")
    return Started(programs, positions, numbers(turns, count, (3, 3), "start rotations"))


def _poses(robot: Mechanism, values: Array, program: Callable[[slice], _Forward]) -> tuple[Array, Array, Bytes, Codes]:
    count = len(values)
    positions, rotations = np.empty((count, 3)), np.empty((count, 3, 3))
    configurations = np.zeros((count, len(robot.CONFIGURATION)), np.int8)
    statuses = np.empty(count, np.uint8)
    for rows in _chunks(count):
        with np.errstate(all="ignore"):
            (position, rotation, margins), status = program(rows)
        failed = status != Status.OK
        _write(positions[rows], position, failed)
        for i in range(3):
            _write(rotations[rows, i], rotation[i], failed)
        written = configurations[rows]
        for i, margin in zip(robot._branch_bytes, margins, strict=True):
            written[:, i] = _branch_bytes(margin)
        for i, axis, turns in zip(robot._period_bytes, robot.PERIOD_AXES, robot._turn_sizes(), strict=True):
            written[:, i] = _periods(turns * values[rows, axis])
        written[failed] = 0
        statuses[rows] = status
    return positions, rotations, configurations, statuses


def inverse(
    robot: Mechanism,
    programs: Programs,
    positions: ArrayLike,
    rotations: ArrayLike | None,
    bytes_: ArrayLike | ConfigurationLike | None,
    references: ArrayLike | None,
) -> tuple[Array, Codes]:
    """Inverse kinematics of every row."""
    table = Table(robot, positions, rotations, references)
    codes = configuration_rows(robot, bytes_, table.count)
    axes, statuses = np.empty((table.count, len(robot.AXES))), np.empty(table.count, np.uint8)
    for rows in _chunks(table.count):
        with np.errstate(all="ignore"):
            poses, chosen = table.at(rows), configurations(robot, codes[rows])
            found, status = _chosen(robot, programs, poses, chosen)
            status = _limited(robot, programs, found, _later(poses.refused, status))
        _write(axes[rows], found, status != Status.OK)
        statuses[rows] = status
    return axes, statuses


def inverse_all(
    robot: Mechanism,
    programs: Programs,
    positions: ArrayLike,
    rotations: ArrayLike | None,
    references: ArrayLike | None,
) -> tuple[Array, Codes]:
    """Every slot of every row."""
    table = Table(robot, positions, rotations, references)
    turns, width, count = (0,) * len(robot.PERIOD_AXES), len(robot.AXES), 2**robot.BRANCHES
    axes, statuses = np.empty((table.count, count, width)), np.empty((table.count, count), np.uint8)
    size = _rows_together(programs.VALUES, table.count, count, width)
    # Columns whose distance is no power of two: such columns displace each other from the cache when they become rows.
    of_slots = np.empty((count, width, min(table.count, size) + 8))
    of_signs = of_slots.reshape(*(2,) * robot.BRANCHES, *of_slots.shape[1:])
    for rows, later in _then_those_that_wait(table.count, size):
        with np.errstate(all="ignore"), waiting(later):
            poses = table.at(rows)
            found, status = programs.every_branch(
                poses.position, poses.rotation, robot.BRANCHES, turns, poses.reference
            )
            status = _limited(robot, programs, found, _later(poses.refused, status))
        for i, value in enumerate(found):
            of_signs[..., i, : poses.count] = value
        refused = status.reshape(count, poses.count) != Status.OK
        of_slots.transpose(0, 2, 1)[:, : poses.count][refused] = np.nan
        axes[rows] = of_slots[:, :, : poses.count].transpose(2, 0, 1)
        statuses[rows] = status.reshape(count, poses.count).T
    return axes, statuses


def _then_those_that_wait(count: int, size: int) -> Iterator[tuple[Rows, list[NDArray[np.intp]] | None]]:
    """All rows in pieces, each with a list for those that wait; then these together, which wait no longer."""
    waits: list[NDArray[np.intp]] = []
    for rows in _chunks(count, size):
        later: list[NDArray[np.intp]] = []
        yield rows, later
        waits += [rows.start + some for some in later]
    if waits:
        chosen = np.unique(np.concatenate(waits))
        yield from ((chosen[piece], None) for piece in _chunks(len(chosen), size))


def _rows_together(values: int, rows: int, slots: int, width: int) -> int:
    """The number of rows computed together where all slots are computed: so few that intermediate values stay small.

    values: the number of values of one row, some of them separate for every slot.
    """
    on_the_way = 8.0 * (slots * width + 1.35 * values + 16.0)
    least = 1 if rows >= MANY else FEWEST
    wanted = int(SHARE * rows * slots * (8 * width + 1) / on_the_way)
    return max(1, min(CHUNK, EVERY_SLOT // slots, max(least, wanted)))


def _later(refused: Codes, status: Codes) -> Codes:
    """The statuses of a call, except where the rotation was refused before."""
    return np.where(refused == Status.OK, status, refused) if refused.any() else status


def _limited(robot: Mechanism, programs: Programs, axes: Reals, status: Codes) -> Codes:
    """The statuses together with those of the limits, where limits are tested."""
    if not robot.checks_limits:
        return status
    limits = programs.limits(axes)
    return np.where(status == Status.OK, limits, status) if limits.any() else status


def _chosen(robot: Mechanism, programs: Programs, poses: Poses, chosen: Configurations) -> tuple[Reals, Codes]:
    """The axes of every row on the slot that its bytes name, or on the nearest one of those that they leave open."""
    if chosen.are_named.all():
        return _named(robot, programs, poses, chosen)
    axes, status = np.full((len(robot.AXES), poses.count), np.nan), np.full(poses.count, Status.BAD_INPUT, np.uint8)
    for is_open, mask in chosen.by_open_branches():
        solve = partial(_nearest, is_open=is_open) if any(is_open) else _named
        size = min(CHUNK, EVERY_SLOT // 2 ** sum(is_open))
        for rows in _pieces(np.broadcast_to(mask, poses.count), size):
            found, outcome = solve(robot, programs, poses.at(rows, len(status[rows])), chosen.at(rows))
            status[rows] = outcome
            for i, value in enumerate(found):
                axes[i, rows] = value
    return tuple(axes), status


def _named(robot: Mechanism, programs: Programs, poses: Poses, chosen: Configurations) -> tuple[Reals, Codes]:
    """The axes of every row on the slot that its bytes name: the signs of the branches differ from row to row."""
    return programs.branch(poses.position, poses.rotation, chosen.signs, chosen.turns, poses.reference)


def _nearest(
    robot: Mechanism, programs: Programs, poses: Poses, chosen: Configurations, is_open: tuple[bool, ...]
) -> tuple[Reals, Codes]:
    """The axes of every row on the nearest of the slots that its bytes leave open. is_open: which branches are open."""
    both = both_signs(robot.BRANCHES)
    signs = tuple([own if is_so else name for is_so, own, name in zip(is_open, both, chosen.signs, strict=True)])
    axes, status = programs.branch(poses.position, poses.rotation, signs, chosen.turns, poses.reference)
    away = [np.broadcast_to(_distance(axes, poses.reference, c.axes), status.shape) for c in robot._criteria]
    best = _Best(robot, poses.count)
    for number, at in enumerate(np.ndindex(status.shape[:-1])):
        best.take(number, [own[at] for own in away], status[at])
    taken = *np.unravel_index(best.slot, status.shape[:-1]), np.arange(poses.count)
    return tuple([np.broadcast_to(value, status.shape)[taken] for value in axes]), best.status


def _distance(axes: Reals, reference: Reals, counted: tuple[int, ...]) -> Array:
    """The squared distance of every slot, as `squared_distance` computes it on plain numbers."""
    are_numbers = reasonable(*[reference[i] for i in counted])
    total = sum([(axes[i] - reference[i]) ** 2 for i in counted], np.zeros(()))
    return total if are_numbers is True else np.where(are_numbers, total, 0.0)


class _Best:
    """The number of the nearest solution so far of every row, and its status: that of the first slot where no slot has
    a solution.
    """

    def __init__(self, robot: Mechanism, rows: int) -> None:
        self.criteria = robot._criteria
        self.slot = np.zeros(rows, np.intp)
        self.status = np.full(rows, _UNTRIED, np.uint8)
        self.least = [np.full(rows, np.inf) for _ in self.criteria]

    def take(self, number: int, distances: list[Array], outcome: Codes) -> None:
        """Compare a slot with the nearest one so far."""
        is_better = (outcome == Status.OK) & ((self.status != Status.OK) | self._are_nearer(distances))
        self.status = np.where(is_better | (self.status == _UNTRIED), outcome, self.status)
        self.least = [np.where(is_better, own, least) for own, least in zip(distances, self.least, strict=True)]
        self.slot[is_better] = number

    def _are_nearer(self, distances: list[Array]) -> Mask:
        """The rows in which the distance by a criterion is less, and the distances by all criteria before it tie."""
        nearer, undecided = np.zeros(self.status.shape, bool), np.ones(self.status.shape, bool)
        for own, least, criterion in zip(distances, self.least, self.criteria, strict=True):
            is_less = own < least - criterion.tie
            nearer |= undecided & is_less
            undecided &= ~is_less & ~(least < own - criterion.tie)
        return nearer


def _branch_bytes(margin: Real) -> NDArray[np.int64]:
    return np.where(np.abs(margin) <= COINCIDENT, COINCIDE, np.where(np.greater(margin, 0.0), FIRST, SECOND))


def _periods(axis: Array) -> Array:
    turn = np.floor((axis + 180.0 + EDGE) / 360.0)
    number = np.where(turn >= 0, turn + 1.0, turn)
    return np.where(np.abs(number) <= 127.0, number, 0.0)


def _write(target: Array, values: tuple[Real, ...], failed: Mask) -> None:
    """Write the columns of a table, with NaN in rows that failed."""
    for i, value in enumerate(values):
        target[:, i] = value
    if failed.any():
        target[failed] = np.nan


def _chunks(count: int, size: int = CHUNK) -> Iterator[slice]:
    return (slice(start, start + size) for start in range(0, count, size))


def _pieces(mask: Mask, size: int) -> Iterator[Rows]:
    """The rows of a mask, in pieces of a given size."""
    if mask.all():
        return _chunks(len(mask), size)
    chosen = np.flatnonzero(mask)
    return (chosen[piece] for piece in _chunks(len(chosen), size))
