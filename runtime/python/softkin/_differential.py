"""Jacobians and singularities of batches."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from softkin._array import Array, Codes, Programs
from softkin._batch import CHUNK, Started
from softkin._columns import columns
from softkin._table import numbers
from softkin._types import Status

if TYPE_CHECKING:
    from softkin._core import Mechanism


def jacobian(robot: Mechanism, programs: Programs | Started, axes: ArrayLike) -> tuple[Array, Codes]:
    """The Jacobian of every row, and its status."""
    values = numbers(axes, None, (len(robot.AXES),), "axes")
    count = len(values)
    matrices = np.empty((count, len(robot.JACOBIAN_ROWS), len(robot.AXES)))
    statuses = np.empty(count, np.uint8)
    for start in range(0, count, CHUNK):
        rows = slice(start, start + CHUNK)
        with np.errstate(all="ignore"):
            entries, status = programs.at(rows).jacobian(columns(values[rows]))
        for i, row in enumerate(entries):
            for k, entry in enumerate(row):
                matrices[rows, i, k] = entry
        statuses[rows] = status
    matrices[statuses != Status.OK] = np.nan
    return matrices, statuses


def singularity(robot: Mechanism, programs: Programs | Started, axes: ArrayLike) -> tuple[NDArray[np.bool_], Array]:
    """Whether every row is singular, and its margins."""
    values = numbers(axes, None, (len(robot.AXES),), "axes")
    margins = np.empty((len(values), len(robot.MARGINS)))
    failed = np.empty(len(values), bool)
    for start in range(0, len(values), CHUNK):
        rows = slice(start, start + CHUNK)
        with np.errstate(all="ignore"):
            found, status = programs.at(rows).singularity(columns(values[rows]))
        for k, margin in enumerate(found):
            margins[rows, k] = margin
        failed[rows] = status != Status.OK
    margins[failed] = np.nan
    return failed | (np.abs(margins) < robot._warning_distance()).any(axis=1), margins
