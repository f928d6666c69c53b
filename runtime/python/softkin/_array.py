"""The primitives of every program on arrays, with an entry for each row. `_scalar` has them on plain numbers."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, ClassVar, Self, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from softkin._constants import EDGE, LARGEST, PIVOT, SOLVABLE
from softkin._scalar import DEGREE as DEGREE
from softkin._start import with_start
from softkin._types import Status

Array: TypeAlias = NDArray[np.float64]
Real: TypeAlias = Any
"""A number for every row, or one for all rows. (With the union of both, a type checker would take minutes.)"""
Reals: TypeAlias = tuple[Real, ...]
Whole: TypeAlias = Any
Values: TypeAlias = tuple[Any, ...]
"""Numbers and truth values together."""
Signs: TypeAlias = tuple[Whole, ...]
Turns: TypeAlias = tuple[Whole, ...]
Vector: TypeAlias = tuple[Real, Real, Real]
Rotation: TypeAlias = tuple[Vector, Vector, Vector]
Matrix: TypeAlias = tuple[Reals, ...]
"""By rows."""
Truth: TypeAlias = NDArray[np.bool_] | bool
Codes: TypeAlias = NDArray[np.uint8]
"""A `Status` for every row."""

FEW_SEARCHES = 512
"""So many calls on plain numbers of a program whose loops call programs take no longer than a call on arrays, which
goes on until the slowest row is done.
"""
_TURN = 2.0 * np.pi
_HALF_AND_EDGE = 180.0 + EDGE
_BOTH_SIGNS = np.array([1, -1])


class Programs(ABC):
    """The programs of a mechanism that run on arrays."""

    VALUES: int
    """The number of values that the inverse computes for one row, including inputs and results."""
    JACOBIAN_ROWS: ClassVar[tuple[int, ...]]
    """The rows of the twist that the Jacobian has, where it has no program of its own."""

    def __init__(self, constants: Any, machine: object = None) -> None:
        """constants: those of the machine for which the programs compute. machine: what has the programs on plain
        numbers for the same constants; None where rows have constants of their own.
        """
        self.constants, self.machine = constants, machine

    def at(self, rows: slice) -> Programs:
        """The programs of some rows."""
        return self

    @abstractmethod
    def forward(self, axes: Reals) -> tuple[tuple[Vector, Rotation, Reals], Codes]:
        """Position, rotation and the signed margin of every branch."""

    @abstractmethod
    def branch(
        self, position: Vector, rotation: Rotation, signs: Signs, turns: Turns, reference: Reals
    ) -> tuple[Reals, Codes]:
        """The axes of one branch, on their turns; limits are not tested."""

    def run_where(
        self,
        wanted: Truth,
        program: Callable[[Values, Codes], Values],
        given: Values,
        status: Codes,
        nothing: tuple[float, ...],
        few: int = 0,
    ) -> Values:
        """The results of a shared program in the rows where it is wanted; `nothing` in all other rows. Up to `few`
        rows are computed one after the other on plain numbers: the last digits may differ from those on arrays.
        """
        shape, found = status.shape, tuple(np.full(status.shape, value) for value in nothing)
        rows = np.flatnonzero(np.broadcast_to(wanted, shape) & (status == Status.OK))
        if (waits := _WAITS.get()) is not None and 0 < len(rows) * _SHARE < status.size:
            waits.append(rows % shape[-1])
        elif len(rows):
            own = tuple(np.broadcast_to(value, shape).ravel()[rows] for value in given)
            codes: Codes = np.zeros(len(rows), np.uint8)
            on_numbers = getattr(self.machine, f"_{program.__name__}", None) if len(rows) <= few else None
            with waiting(None):
                results = _one_by_one(on_numbers, own, codes, nothing) if on_numbers else program(own, codes)
            for column, values in zip(found, results, strict=True):
                column.reshape(-1)[rows] = values
            status.reshape(-1)[rows] = codes
        return found

    def every_branch(
        self, position: Vector, rotation: Rotation, branches: int, turns: Turns, reference: Reals
    ) -> tuple[Reals, Codes]:
        """The axes and statuses of every slot, in arrays (2, …, 2, rows): the last branch first, the first branch last.

        The signs of each branch are an array along a separate axis. So a value is computed only for the signs on which
        it depends: in an array (2, rows), if it depends on one branch.
        """
        return self.branch(position, rotation, both_signs(branches), turns, reference)

    @abstractmethod
    def limits(self, axes: Reals) -> Codes:
        """The statuses of the test of all limits."""

    def jacobian(self, axes: Reals) -> tuple[Matrix, Codes]:
        """The Jacobian by rows, per radian."""
        rows, status = self.twist(axes)
        return tuple(rows[row] for row in self.JACOBIAN_ROWS), status

    @abstractmethod
    def singularity(self, axes: Reals) -> tuple[Reals, Codes]:
        """The margins, each zero at its singularity."""

    def twist(self, axes: Reals) -> tuple[Matrix, Codes]:
        """The twist of the frame by rows, where the Jacobian lacks rows that are not zero."""
        raise NotImplementedError

    def bias(self, axes: Reals, speeds: Reals) -> tuple[Reals, Codes]:
        """The acceleration of the rows of the Jacobian at constant speeds of the axes."""
        rows, status = self.twist_bias(axes, speeds)
        return tuple(rows[row] for row in self.JACOBIAN_ROWS), status

    def twist_bias(self, axes: Reals, speeds: Reals) -> tuple[Reals, Codes]:
        """The acceleration of the twist at constant speeds of the axes, where `twist` is a program."""
        raise NotImplementedError

    def projection(self, rotation: Rotation) -> tuple[Rotation, Codes]:
        """The nearest rotation that the flange can have: the rotation itself, unless a program says otherwise."""
        return rotation, passed(*rotation)


class StartedPrograms(Programs):
    """The programs on arrays of a mechanism whose forward kinematics iterates."""

    def started(self, position: Vector, rotation: Rotation) -> Self:
        """These programs, whose forward kinematics starts at other frames."""
        return type(self)(with_start(self.constants, position, rotation))


class OrientationPrograms(Programs):
    """The programs on arrays of an orientation kinematics."""

    @abstractmethod
    def end_point_shift(self, rotation: Rotation, flange_axis: Vector, base_axis: Vector) -> tuple[Vector, Codes]:
        """The vector from a flange that turns to the end point."""


def both_signs(branches: int) -> Signs:
    """Both signs of every branch, each along a separate axis; that of the first branch is next to the rows."""
    return tuple([_BOTH_SIGNS.reshape(2, *(1,) * (k + 1)) for k in range(branches)])


def passed(*given: Values) -> Codes:
    """The statuses before any condition: all OK, in the common shape of the arguments."""
    return np.zeros(_common_shape(given), np.uint8)


def _common_shape(values: Values) -> tuple[int, ...]:
    """The common shape of values: a value may be the same for all rows, or for all signs of a branch."""
    shapes = _shapes(values)
    return shapes.pop() if len(shapes) == 1 else np.broadcast_shapes(*shapes)


def _shapes(values: Values) -> set[tuple[int, ...]]:
    """The shapes of values and of the entries of vectors; a plain number has none."""
    found = set()
    for value in values:
        if isinstance(value, np.ndarray):
            found.add(value.shape)
        elif isinstance(value, tuple):
            found |= _shapes(value)
    return found


def require(status: Codes, condition: Truth, otherwise: Status) -> None:
    """Write the status of the rows in which the condition does not hold, unless they have been refused before."""
    if not everywhere(condition):
        status += np.uint8(otherwise) * (np.logical_not(condition) & (status == Status.OK))


def reasonable(*values: Real) -> Truth:
    """The rows in which the size of all values is at most LARGEST."""
    found: Truth = True
    for value in values:
        # Nearly always all of them are; the least and the greatest value decide.
        if not isinstance(value, np.ndarray) or not (value.min() >= -LARGEST and value.max() <= LARGEST):
            found = found & (abs(value) <= LARGEST)
    return found


def everywhere(condition: Truth) -> bool:
    """Whether a condition holds in all rows."""
    return bool(condition.all()) if isinstance(condition, np.ndarray) else bool(condition)


def opposite(condition: Truth) -> Truth:
    """The rows in which a condition does not hold."""
    return ~condition if isinstance(condition, np.ndarray) else not condition


def elsewhere(condition: Truth, values: Values, other: Callable[..., Values], given: Values) -> Values:
    """The values where a condition holds; in the other rows, the values that `other` computes from their arguments.

    given: the arguments of `other`, which gets them as numbers or as arrays (rows,), whatever axes the values have.
    """
    if everywhere(condition):
        return values
    if not isinstance(condition, np.ndarray):
        return other(*given)
    shape = _common_shape((condition, values, given))
    rows = np.nonzero(np.broadcast_to(~condition, shape))
    found = other(*[np.broadcast_to(v, shape)[rows] if isinstance(v, np.ndarray) else v for v in given])
    return tuple([_replaced(value, rows, new, shape) for value, new in zip(values, found, strict=True)])


def _replaced(value: Real, rows: tuple[NDArray[np.intp], ...], new: Real, shape: tuple[int, ...]) -> Array:
    """The values with new ones in some rows."""
    whole = np.array(np.broadcast_to(value, shape))
    whole[rows] = new
    return whole


def initial(*values: Real) -> Values:
    """The state before the first pass."""
    return values


def settled(done: Truth, status: Codes) -> bool:
    """Whether no row has to go on: each is done, or has been refused."""
    return bool(np.all(done | (status != Status.OK)))


def advanced(done: Truth, state: Reals, following: Reals) -> Values:
    """The state for the next pass: rows that are done keep theirs."""
    return tuple(np.where(done, old, new) for old, new in zip(state, following, strict=True))


_WAITS: ContextVar[list[NDArray[np.intp]] | None] = ContextVar("waits", default=None)
_SHARE = 64
"""Rows wait where they are fewer than this share of all: a shared program takes as long for one row as for many."""


@contextmanager
def waiting(rows: list[NDArray[np.intp]] | None) -> Iterator[None]:
    """Few rows that want a shared program do not get it, but are noted (by their last index) to be computed together
    afterwards. None: every row gets it.
    """
    before = _WAITS.set(rows)
    try:
        yield
    finally:
        _WAITS.reset(before)


def _one_by_one(
    program: Callable[[Values], Values | Status], given: Values, status: Codes, nothing: tuple[float, ...]
) -> Values:
    """The results of a shared program that runs on plain numbers for one row after the other."""
    results = []
    for row, values in enumerate(zip(*[value.tolist() for value in given], strict=True)):
        found = program(values)
        if isinstance(found, Status):
            status[row], found = found, nothing
        results.append(found)
    return tuple(np.array(results).T)


def sin(x: Real) -> Real:
    """The sine."""
    sine: Array = np.sin(x)
    return sine


def cos(x: Real) -> Real:
    """The cosine."""
    cosine: Array = np.cos(x)
    return cosine


def absolute(x: Real) -> Real:
    """The absolute value."""
    size: Array = np.absolute(x)
    return size


def root(x: Real) -> Real:
    """The square root of x, and 0 for a negative x."""
    length: Array = np.sqrt(np.maximum(x, 0.0))
    return length


def sqrt(x: Real) -> Real:
    """The square root of a value that is not negative."""
    length: Array = np.sqrt(x)
    return length


def atan2(y: Real, x: Real) -> Real:
    """The angle of (x, y) in radians, in (-pi, pi]; 0 for (0, 0). Zeros have no sign."""
    angle: Array = np.arctan2(y + 0.0, x + 0.0)
    return angle


def degrees(y: Real, x: Real) -> Real:
    """The angle of (x, y) in degrees, modulo a turn: it may be -180 or 180. 0 for (0, 0)."""
    angle: Array = np.arctan2(y, x + 0.0)
    angle /= DEGREE
    return angle


_Number = TypeVar("_Number", Real, Whole)


def select(condition: Truth, first: _Number, second: _Number) -> _Number:
    """The first value where the condition holds, else the second; the first itself where it holds in all rows."""
    if everywhere(condition):
        return first
    return np.where(condition, first, second) if isinstance(condition, np.ndarray) else second


def nearest_period(value: Real, centre: Real) -> Real:
    """value + 360 k in [centre - 180, centre + 180), in degrees; the interval is shifted down by EDGE."""
    if isinstance(value, np.ndarray) and not isinstance(centre, np.ndarray):  # noqa: SIM102
        # Nearly always all values are inside already; the least and the greatest value decide.
        if value.min() - centre + _HALF_AND_EDGE >= 0.0 and value.max() - centre + _HALF_AND_EDGE < 360.0:
            return value
    turns: Array = np.floor((value - centre + _HALF_AND_EDGE) / 360.0)
    return value - 360.0 * turns


def nearest_on_arc(angle: Real, centre: Real, half: Real) -> Real:
    """The angle of the arc centre ± half that is nearest to angle, in radians."""
    delta = angle - centre
    turns: Array = np.floor((delta + np.pi) / _TURN)
    bounded: Array = np.minimum(np.maximum(delta - _TURN * turns, -half), half)
    return centre + bounded


def solve(matrix: Sequence[Reals], right: Sequence[Reals]) -> Reals:
    """The determinant, then the solution by rows: LU decomposition with partial pivoting.

    All of them are zero if the matrix is singular, or a number is NaN or beyond SOLVABLE in size.
    """
    size = len(matrix)
    rows = [[*row, *more] for row, more in zip(matrix, right or [()] * size, strict=True)]
    entries = np.broadcast_arrays(*(entry for row in rows for entry in row))
    table = np.array(entries).reshape(size, len(rows[0]), -1)
    largest = np.max(np.abs(table[:, :size]), axis=(0, 1))
    tiny, determinant = PIVOT * largest, np.ones_like(largest)
    regular = np.all(np.abs(table) <= SOLVABLE, axis=(0, 1)) & (largest >= 1.0 / SOLVABLE)
    every = np.arange(len(tiny))
    for k in range(size):
        best = k + np.argmax(np.abs(table[k:, k]), axis=0)
        chosen = table[best, :, every].T.copy()
        table[best, :, every] = table[k].T
        table[k] = chosen
        determinant = np.where(best == k, determinant, -determinant) * table[k, k]
        regular &= np.abs(table[k, k]) > tiny
        table[k, k] = 1.0 / np.where(regular, table[k, k], 1.0)
        factors = table[k + 1 :, k] * table[k, k]
        table[k + 1 :, k + 1 :] -= factors[:, None] * table[k, k + 1 :]
    for k in reversed(range(size)):
        for i in range(k + 1, size):
            table[k, size:] -= table[k, i] * table[i, size:]
        table[k, size:] *= table[k, k]
    solution = np.where(regular, table[:, size:], 0.0)
    found = np.where(regular, determinant, 0.0), *solution.reshape(-1, len(tiny))
    return tuple([value.reshape(entries[0].shape) for value in found])
