"""The commands of a batch by columns; a column with one value in all rows is a single number."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from softkin._array import Array, Codes, Reals, Rotation, Signs, Turns, Vector, Whole
from softkin._array_rotation import made_rotations
from softkin._configuration import AUTOMATIC, COINCIDE, FIRST, SECOND
from softkin._table import numbers, poses
from softkin._types import KinematicsError, Status

if TYPE_CHECKING:
    from softkin._core import Mechanism

Bytes: TypeAlias = NDArray[np.int8]
Integers: TypeAlias = NDArray[np.int64]
Mask: TypeAlias = NDArray[np.bool_]
Rows: TypeAlias = slice | NDArray[np.intp]
_IDENTITY: Rotation = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@dataclass(frozen=True)
class Poses:
    """Poses of a chunk, by columns, with their references."""

    count: int
    position: Vector
    rotation: Rotation
    reference: Reals
    refused: Codes
    """The statuses of the rotations; a single one where the mechanism reads none."""

    def at(self, rows: Rows, count: int) -> Poses:
        """The poses of some rows. count: the number of these rows."""
        (x, y, z), *cells = (tuple(_at(v, rows) for v in part) for part in (self.position, *self.rotation))
        (a, b, c), (d, e, f), (g, h, i) = cells
        reference = tuple(_at(v, rows) for v in self.reference)
        return Poses(count, (x, y, z), ((a, b, c), (d, e, f), (g, h, i)), reference, _codes_at(self.refused, rows))


class Table:
    """The poses of a batch, with the references."""

    def __init__(
        self, robot: Mechanism, positions: ArrayLike, rotations: ArrayLike | None, references: ArrayLike | None
    ) -> None:
        """Raises BAD_INPUT for input that does not have the form of a batch."""
        width = len(robot.AXES)
        positions, rotations = poses(positions, rotations)
        self.positions = numbers(positions, None, (3,), "positions")
        self.count = len(self.positions)
        near = np.array(robot._without_reference()) if references is None else references
        self.references = numbers(near, self.count, (width,), "references")
        self.rotations = None
        if robot.READS_ROTATION:
            if rotations is None:
                raise KinematicsError(
                    Status.BAD_INPUT, f"{robot.NAME}: rotations are needed: this mechanism reads them"
                )
            self.rotations = numbers(rotations, self.count, (3, 3), "rotations").reshape(self.count, 9)

    def at(self, rows: Rows) -> Poses:
        """The poses of some rows, with repaired rotations."""
        x, y, z = columns(self.positions[rows])
        rotation, refused = _IDENTITY, np.zeros((), np.uint8)
        if self.rotations is not None:
            a, b, c, d, e, f, g, h, i = columns(self.rotations[rows])
            rotation, refused = made_rotations(((a, b, c), (d, e, f), (g, h, i)))
        near = self.references
        reference = tuple(near[0]) if _is_one_row(near) else columns(near[rows])
        return Poses(len(x), (x, y, z), rotation, reference, refused)


@dataclass(frozen=True)
class Configurations:
    """Configurations; if one row stands for all, a column has one entry."""

    branches: tuple[Bytes, ...]
    turns: Turns
    are_bytes: Mask
    """The mask of rows that are a valid configuration."""

    @property
    def signs(self) -> Signs:
        """The signs of the branches that are named."""
        return tuple(_number(3 - 2 * branch) for branch in self.branches)  # FIRST is 1, SECOND is -1

    @property
    def are_named(self) -> Mask:
        """The mask of rows that name all their branches."""
        named = self.are_bytes
        for branch in self.branches:
            named = named & ((branch == FIRST) | (branch == SECOND))
        return named

    def by_open_branches(self) -> Iterator[tuple[tuple[bool, ...], Mask]]:
        """Every set of open branches that occurs, with the mask of the rows that leave exactly these branches open."""
        is_open = [(branch == AUTOMATIC) | (branch == COINCIDE) for branch in self.branches]
        number = sum([mask.astype(np.int64) << k for k, mask in enumerate(is_open)], np.zeros_like(self.are_bytes, int))
        for pattern in np.unique(number[self.are_bytes]).tolist():
            yield tuple(bool(pattern >> k & 1) for k in range(len(is_open))), self.are_bytes & (number == pattern)

    def at(self, rows: Rows) -> Configurations:
        """The configurations of some rows."""
        if len(self.are_bytes) == 1:
            return self
        branches = tuple(branch[rows] for branch in self.branches)
        return Configurations(branches, tuple(_at(v, rows) for v in self.turns), self.are_bytes[rows])


def configurations(robot: Mechanism, codes: Integers) -> Configurations:
    """The configurations in a table of numbers, where 128 to 255 stand for the negative bytes."""
    if _is_one_row(codes):
        codes = codes[:1]
    are_bytes = np.ones(len(codes), np.bool_)
    if codes.size and (codes.min() < -128 or codes.max() > 255):
        are_bytes = np.all((codes >= -128) & (codes <= 255), axis=1)
    signed = codes.T.astype(np.int8, order="C")
    branches = tuple(signed[i] for i in robot._branch_bytes)
    for branch in branches:
        are_bytes = are_bytes & (branch >= AUTOMATIC) & (branch <= COINCIDE)
    return Configurations(branches, tuple(_number(signed[i]) for i in robot._period_bytes), are_bytes)


def columns(values: Array) -> tuple[Array, ...]:
    """The columns of a table, each contiguous in memory."""
    return tuple(np.ascontiguousarray(values.T))


def _number(column: Bytes) -> Whole:
    """A column as an array of integers, or as one integer."""
    return int(column[0]) if (column == column[0]).all() else column.astype(np.int64)


def _at(value: Any, rows: Rows) -> Any:
    return value[rows] if isinstance(value, np.ndarray) else value


def _codes_at(codes: Codes, rows: Rows) -> Codes:
    return codes[rows] if codes.ndim else codes


def _is_one_row(values: NDArray[np.float64] | Integers) -> bool:
    """Whether one row stands for all: then all rows are at the same address."""
    return values.strides[0] == 0
