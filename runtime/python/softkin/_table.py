"""Input of batches: the arguments of a caller become arrays of the right shape, or an error says what is wrong."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from softkin._input import matrix_of, refuse_strange
from softkin._types import ConfigurationLike, FrameLike, KinematicsError, Status

if TYPE_CHECKING:
    from softkin._core import Mechanism

_Number = TypeVar("_Number", np.float64, np.int64)


def numbers(values: ArrayLike, count: int | None, row: tuple[int, ...], what: str) -> NDArray[np.float64]:
    """A table with `count` rows of numbers; a single row stands for all. Without a count, any number of rows."""
    found = _array(values, what)
    if found.dtype.kind not in "fiub":
        raise _bad(f"{what} must be numbers, not {found.dtype}")
    return _shaped(found.astype(np.float64, copy=False), count, row, what)


def poses(positions: ArrayLike, rotations: ArrayLike | None) -> tuple[ArrayLike, ArrayLike | None]:
    """Positions and rotations: those that are given, or those of frames (N, 4, 4) in the place of the positions."""
    if rotations is not None:
        return positions, matrix_of(rotations)
    found = _array(positions, "positions")
    if found.ndim != 3 or found.shape[1:] != (4, 4) or found.dtype.kind not in "fiub":
        return positions, None
    return _halves(found.astype(np.float64))


def starts(start: FrameLike | tuple[ArrayLike, ArrayLike] | ArrayLike) -> tuple[ArrayLike, ArrayLike]:
    """Positions and rotations of frames to start from: a pair of both, or matrices (N, 4, 4), or one for all rows."""
    if isinstance(start, tuple) and len(start) == 2:
        places: Any = start[0]
        turns: Any = start[1]
        return places, turns
    found = _array(start, "start")
    if found.shape[-2:] != (4, 4) or found.ndim > 3 or found.dtype.kind not in "fiub":
        raise _bad("start must be a pair of positions and rotations, or matrices (N, 4, 4)")
    return _halves(found.astype(np.float64))


def _halves(matrices: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The positions and the rotations of matrices (…, 4, 4)."""
    if not (np.abs(matrices[..., 3, :] - (0.0, 0.0, 0.0, 1.0)) <= 1e-9).all():
        raise _bad("the last row of a frame's matrix must be 0 0 0 1")
    return matrices[..., :3, 3], matrices[..., :3, :3]


def whole_numbers(values: ArrayLike, count: int, size: int, what: str) -> NDArray[np.int64]:
    """A table with `count` rows of whole numbers; a single row stands for all."""
    found = _array(values, what)
    if found.dtype.kind not in "iub" and found.size > 0:
        raise _bad(f"{what} must be whole numbers, not {found.dtype}")
    return _shaped(found.astype(np.int64, copy=False), count, (size,), what)


def configuration_rows(robot: Mechanism, given: ArrayLike | ConfigurationLike | None, count: int) -> NDArray[np.int64]:
    """The bytes of `count` configurations; names, or a single row, stand for all, and None for the default."""
    rows: Any = robot.DEFAULT_CONFIGURATION if given is None else given
    if isinstance(given, str | Mapping):
        rows = robot._bytes(given)
    return whole_numbers(rows, count, len(robot.CONFIGURATION), "configurations")


def _array(values: object, what: str) -> NDArray[np.generic]:
    for one in (values, *values) if isinstance(values, list | tuple) else (values,):
        refuse_strange(one, f"{what} must be an array of numbers")
    try:
        return np.asarray(values)
    except (TypeError, ValueError) as error:  # rows of different lengths
        raise _bad(f"{what} must be an array of numbers") from error


def _shaped(found: NDArray[_Number], count: int | None, row: tuple[int, ...], what: str) -> NDArray[_Number]:
    if found.shape == (0,) and count in (None, 0):  # an empty list says nothing about the form of a row
        return found.reshape(0, *row)
    if count is not None and found.shape == row:
        return np.broadcast_to(found, (count, *row))
    if found.shape[1:] != row or found.ndim != len(row) + 1 or count not in (None, len(found)):
        expected = ("N" if count is None else str(count), *map(str, row))
        raise _bad(f"{what} must have shape ({', '.join(expected)}), not {found.shape}")
    return found


def _bad(message: str) -> KinematicsError:
    return KinematicsError(Status.BAD_INPUT, message)
