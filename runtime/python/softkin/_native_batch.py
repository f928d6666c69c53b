"""Batches of the native core: rows are shared among threads, which run while Python's lock is free."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from softkin._array import Array, Codes
from softkin._columns import Bytes, Table
from softkin._table import configuration_rows, numbers
from softkin._types import ConfigurationLike

if TYPE_CHECKING:
    from softkin._core import Mechanism

THREADS = "SOFTKIN_THREADS"
"""The variable of the environment that limits the threads of a call; without it there are as many as processors."""
FEWEST = 1024
"""The least number of rows in a piece: to start a thread takes as long as some hundred rows."""
_PIECES = 4
"""The number of pieces for each thread: a slow thread leaves its next piece to another."""


def forward(robot: Mechanism, axes: ArrayLike) -> tuple[Array, Array, Bytes, Codes]:
    """Forward kinematics of every row."""
    values = numbers(axes, None, (len(robot.AXES),), "axes")
    count = len(values)
    found = (
        np.empty((count, 3)),
        np.empty((count, 3, 3)),
        np.zeros((count, len(robot.CONFIGURATION)), np.int8),
        np.empty(count, np.uint8),
    )
    _in_pieces(count, lambda start, stop: robot._machine.forward_rows(values, *found, start, stop))
    return found


def inverse(
    robot: Mechanism,
    positions: ArrayLike,
    rotations: ArrayLike | None,
    bytes_: ArrayLike | ConfigurationLike | None,
    references: ArrayLike | None,
) -> tuple[Array, Codes]:
    """Inverse kinematics of every row."""
    table = Table(robot, positions, rotations, references)
    codes = configuration_rows(robot, bytes_, table.count)
    asked = (table.positions, table.rotations, codes, table.references)
    found = np.empty((table.count, len(robot.AXES))), np.empty(table.count, np.uint8)
    _in_pieces(table.count, lambda start, stop: robot._machine.inverse_rows(*asked, *found, start, stop))
    return found


def inverse_all(
    robot: Mechanism, positions: ArrayLike, rotations: ArrayLike | None, references: ArrayLike | None
) -> tuple[Array, Codes]:
    """Every slot of every row."""
    table = Table(robot, positions, rotations, references)
    asked, slots = (table.positions, table.rotations, table.references), 2**robot.BRANCHES
    found = np.empty((table.count, slots, len(robot.AXES))), np.empty((table.count, slots), np.uint8)
    _in_pieces(table.count, lambda start, stop: robot._machine.inverse_all_rows(*asked, *found, start, stop))
    return found


def jacobian(robot: Mechanism, axes: ArrayLike) -> tuple[Array, Codes]:
    """The Jacobian of every row, and its status."""
    values = numbers(axes, None, (len(robot.AXES),), "axes")
    count = len(values)
    found = np.empty((count, len(robot.JACOBIAN_ROWS), len(robot.AXES))), np.empty(count, np.uint8)
    _in_pieces(count, lambda start, stop: robot._machine.jacobian_rows(values, *found, start, stop))
    return found


def threads() -> int:
    """The largest number of threads of a call. Raises ValueError for a limit that is no positive whole number."""
    limit = os.environ.get(THREADS, "")
    if limit and not (limit.isdecimal() and int(limit) > 0):
        raise ValueError(f"{THREADS} must be a whole number of at least 1, not {limit!r}")
    return int(limit) if limit else _processors()


def _processors() -> int:
    own: Callable[[int], set[int]] | None = getattr(os, "sched_getaffinity", None)
    return len(own(0)) if own is not None else os.cpu_count() or 1


def _in_pieces(count: int, solve: Callable[[int, int], None]) -> None:
    """Solve all rows: by this thread where there are few, else by several."""
    most = min(threads(), count // FEWEST)
    if most < 2:
        solve(0, count)
        return
    from concurrent.futures import ThreadPoolExecutor

    size = max(FEWEST, -(-count // (most * _PIECES)))
    starts = range(0, count, size)
    with ThreadPoolExecutor(most) as pool:
        for _ in pool.map(solve, starts, (min(start + size, count) for start in starts)):
            pass
