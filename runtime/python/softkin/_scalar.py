"""The primitives of every program on plain numbers. `_array` has the same ones on arrays."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2 as arctan2
from math import cos, floor, nan, pi, sin, sqrt

from softkin._constants import EDGE, LARGEST, PIVOT, SOLVABLE

__all__ = ["arctan2", "cos", "sin", "sqrt"]
"""What other modules import from here although it comes from elsewhere."""

DEGREE = pi / 180.0
"""One degree in radians."""
RADIAN = 180.0 / pi
"""One radian in degrees."""
_TURN = 2.0 * pi
_MOST_TURNS = 1e18
"""With more turns than this there is no nearest angle."""
_HALF_AND_EDGE = 180.0 + EDGE


def reasonable(*numbers: float) -> bool:
    """Whether all are numbers of reasonable size."""
    for number in numbers:  # noqa: SIM110 - faster than `all`
        if not -LARGEST <= number <= LARGEST:
            return False
    return True


def root(x: float) -> float:
    """The square root of x, and 0 for a negative x."""
    return sqrt(x) if x > 0.0 else 0.0


def atan2(y: float, x: float) -> float:
    """The angle of (x, y) in radians, in (-pi, pi]; 0 for (0, 0). Zeros have no sign."""
    return arctan2(y + 0.0, x + 0.0)


def nearest_period(value: float, centre: float) -> float:
    """value + 360 k in [centre - 180, centre + 180), in degrees; the interval is shifted down by EDGE.

    So a value on an edge stays on its side in spite of rounding.
    """
    turns = (value - centre + _HALF_AND_EDGE) / 360.0
    return value - 360.0 * floor(turns) if -_MOST_TURNS < turns < _MOST_TURNS else nan


def nearest_on_arc(angle: float, centre: float, half: float) -> float:
    """The angle of the arc centre ± half that is nearest to angle, in radians."""
    delta = angle - centre
    turns = (delta + pi) / _TURN
    if not -_MOST_TURNS < turns < _MOST_TURNS:
        return nan
    delta -= _TURN * floor(turns)
    return centre + min(max(delta, -half), half)


def solve(matrix: Sequence[Sequence[float]], right: Sequence[Sequence[float]]) -> tuple[float, ...]:
    """The determinant, then the solution by rows: LU decomposition with partial pivoting.

    Zeros if the matrix is singular, and where a number is NaN or beyond SOLVABLE in size.
    matrix, right: by rows; without right-hand sides the determinant alone.
    """
    rows = [[*row, *more] for row, more in zip(matrix, right or [()] * len(matrix), strict=True)]
    size, width = len(matrix), len(rows[0])
    nothing = (0.0,) * (1 + size * (width - size))
    largest = max(abs(entry) for row in matrix for entry in row)
    if not (largest >= 1.0 / SOLVABLE and all(abs(entry) <= SOLVABLE for row in rows for entry in row)):
        return nothing
    determinant = 1.0
    for k in range(size):
        best = max(range(k, size), key=lambda i: abs(rows[i][k]))
        if not abs(rows[best][k]) > PIVOT * largest:
            return nothing
        if best != k:
            rows[k], rows[best] = rows[best], rows[k]
            determinant = -determinant
        determinant *= rows[k][k]
        rows[k][k] = 1.0 / rows[k][k]
        for i in range(k + 1, size):
            factor = rows[i][k] * rows[k][k]
            for j in range(k + 1, width):
                rows[i][j] -= factor * rows[k][j]
    for k in reversed(range(size)):
        for j in range(size, width):
            for i in range(k + 1, size):
                rows[k][j] -= rows[k][i] * rows[i][j]
            rows[k][j] *= rows[k][k]
    return (determinant, *(entry for row in rows for entry in row[size:]))
