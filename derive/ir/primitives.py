"""The primitives: a closed set of total functions, which every language implements."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import sympy as sp
from numpy.typing import NDArray
from sympy.logic.boolalg import Boolean

from derive.ir.constants import EDGE, PIVOT, SOLVABLE
from derive.ir.symbols import is_decided

Array = NDArray[np.float64]
_SHIFT = 180.0 + float(EDGE)
_PIVOT, _SOLVABLE = float(PIVOT), float(SOLVABLE)


class Root(sp.Function):
    """root(x) = sqrt(max(0, x)): total."""

    nargs = 1
    is_nonnegative = True

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """The derivative; zero if the root is zero."""
        is_long = sp.Gt(self.args[0], 0)
        return Select(is_long, 1 / (2 * Select(is_long, self, sp.Integer(1))), sp.Integer(0))


class Atan2(sp.Function):
    """atan2(y, x) in radians, in (-pi, pi]; atan2(0, 0) = 0."""

    nargs = 2

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """The derivative; zero if both arguments are zero."""
        y, x = self.args
        square = y**2 + x**2
        return (x if argindex == 1 else -y) / Select(sp.Gt(square, 0), square, sp.Integer(1))


class Select(sp.Function):
    """select(condition, a, b): a where the condition holds, else b; both are evaluated."""

    nargs = 3
    is_real = True

    @classmethod
    def eval(cls, condition: Boolean, first: sp.Expr, second: sp.Expr) -> sp.Expr | None:
        """Simplify a choice between equal values, and one whose condition is decided."""
        if is_decided(condition):
            return first if condition == sp.true else second
        return first if first == second else None

    def _eval_derivative(self, s: sp.Symbol) -> sp.Expr:
        """The derivative of the chosen side; a condition has no derivative."""
        condition, first, second = self.args
        return Select(condition, first.diff(s), second.diff(s))


class ToReal(sp.Function):
    """to_real(n): an integer as a real number, where it multiplies."""

    nargs = 1
    is_real = True

    @classmethod
    def eval(cls, number: sp.Expr) -> sp.Expr | None:
        """Simplify a literal number, which serves both as an integer and as a real number."""
        return number if number.is_Integer else None


class Wrap(sp.Function):
    """wrap(angle): the value of an angle in (-pi, pi], a real number."""

    nargs = 1
    is_real = True

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """The derivative."""
        return _ONE


class NearestPeriod(sp.Function):
    """nearest_period(value, centre): value + 360 k in [centre - 180, centre + 180), in degrees.

    The interval is shifted down by 1e-9 degrees, so that a value on an edge stays on its side in
    spite of rounding: forward kinematics numbers the turns with the same shift.
    """

    nargs = 2


class NearestOnArc(sp.Function):
    """nearest_on_arc(angle, centre, half): the angle of the arc centre ± half nearest to angle (radians)."""

    nargs = 3


_ONE = sp.Integer(1)


def angle_of_cosine(adjacent: sp.Expr, hypotenuse: sp.Expr = _ONE) -> sp.Expr:
    """The angle in radians, 0 to pi, whose cosine is adjacent over hypotenuse, which is positive."""
    return Atan2(Root((hypotenuse - adjacent) * (hypotenuse + adjacent)), adjacent)


def angle_of_sine(sine: sp.Expr) -> sp.Expr:
    """The angle in radians, -pi/2 to pi/2, that has this sine."""
    return Atan2(sine, Root(1 - sine**2))


def larger(first: sp.Expr, second: sp.Expr) -> Select:
    """The larger of two numbers; the second where one of them is NaN."""
    return Select(sp.Gt(first, second), first, second)


def nearest_period(value: Array, centre: Array) -> Array:
    """value + 360 k in [centre - 180 - EDGE, centre + 180 - EDGE)."""
    return value - 360.0 * np.floor((value - centre + _SHIFT) / 360.0)


def wrap(angle: Array) -> Array:
    """The value of an angle in (-pi, pi]."""
    return np.asarray(angle - 2 * np.pi * np.ceil((angle - np.pi) / (2 * np.pi)))


def nearest_on_arc(angle: Array, centre: Array, half: Array) -> Array:
    """The angle of the arc centre ± half nearest to `angle`, counted from the centre."""
    delta = angle - centre - 2 * np.pi * np.floor((angle - centre + np.pi) / (2 * np.pi))
    return centre + np.clip(delta, -half, half)


_PRIMITIVES: dict[type[sp.Function], Callable[..., Array]] = {
    sp.sin: np.sin,
    sp.cos: np.cos,
    sp.Abs: np.abs,
    Root: lambda x: np.sqrt(np.maximum(x, 0.0)),
    Atan2: lambda y, x: np.arctan2(y + 0.0, x + 0.0),  # a zero has no sign
    Select: np.where,
    ToReal: lambda n: np.asarray(n, dtype=float),
    Wrap: wrap,
    NearestPeriod: nearest_period,
    NearestOnArc: nearest_on_arc,
}
PRIMITIVES = tuple(_PRIMITIVES)
FUNCTIONS = tuple(primitive for primitive in PRIMITIVES if primitive not in (ToReal, Wrap))
"""The primitives that a language calls: it writes the other two as arithmetic."""
KEYS = {one: re.sub(r"(?<=[a-z\d])(?=[A-Z])", "_", one.__name__).lower() for one in PRIMITIVES}
"""Their neutral names, from which a language makes its own: `nearest_on_arc`."""
VALUES: dict[type[sp.Basic], Callable[..., Array]] = {
    **_PRIMITIVES,
    sp.Le: np.less_equal,
    sp.Lt: np.less,
    sp.Ge: np.greater_equal,
    sp.Gt: np.greater,
    sp.Eq: np.equal,
    sp.Ne: np.not_equal,
    sp.And: np.logical_and,
    sp.Or: np.logical_or,
    sp.Not: np.logical_not,
    sp.Add: np.add,
    sp.Mul: np.multiply,
    sp.Pow: np.power,
}
"""The primitives and operations as functions of arrays: the reference for every language."""


def solve(matrix: Array, right: Array) -> tuple[Array, Array]:
    """Determinant and solution by LU decomposition with partial pivoting: rows, columns, then any shape. Unsolvable:
    zeros.
    """
    matrix, right, size = matrix.copy(), right.copy(), len(matrix)
    largest, most = np.max(np.abs(matrix), axis=(0, 1)), _SOLVABLE
    tiny = _PIVOT * largest
    regular = (largest >= 1.0 / most) & (largest <= most) & np.all(np.abs(right) <= most, axis=(0, 1))
    determinant = np.ones(matrix.shape[2:])
    for k in range(size):
        best = k + np.argmax(np.abs(matrix[k:, k]), axis=0)
        for table in (matrix, right) if np.any(best != k) else ():
            table[k], lifted = np.take_along_axis(table, best[None, None], axis=0)[0], table[k].copy()
            np.put_along_axis(table, np.broadcast_to(best[None, None], (1, *lifted.shape)), lifted[None], axis=0)
        determinant = np.where(best == k, determinant, -determinant) * matrix[k, k]
        regular &= np.abs(matrix[k, k]) > tiny
        matrix[k, k] = 1.0 / np.where(regular, matrix[k, k], 1.0)
        for i in range(k + 1, size):
            factor = matrix[i, k] * matrix[k, k]
            matrix[i, k + 1 :] -= factor * matrix[k, k + 1 :]
            right[i] -= factor * right[k]
    for k in reversed(range(size)):
        for i in range(k + 1, size):
            right[k] -= matrix[k, i] * right[i]
        right[k] *= matrix[k, k]
    return np.where(regular, determinant, 0.0), np.where(regular, right, 0.0)


def solved(rows: list[list[float]], size: int) -> tuple[float, list[list[float]]]:
    """`solve` of one system with Python's own numbers, which round like arrays; a row ends in its right-hand sides."""
    nothing, most = (0.0, [[0.0] * len(row[size:]) for row in rows]), _SOLVABLE
    largest, determinant = max(abs(v) for row in rows for v in row[:size]), 1.0
    if largest < 1.0 / most or not all(abs(v) <= most for row in rows for v in row):  # also false for NaN
        return nothing
    for k in range(size):
        best = max(range(k, size), key=lambda i: abs(rows[i][k]))
        if best != k:
            rows[k], rows[best], determinant = rows[best], rows[k], -determinant
        top, pivot = rows[k], rows[k][k]
        determinant *= pivot
        if not abs(pivot) > _PIVOT * largest:
            return nothing
        top[k] = 1.0 / pivot
        for row in rows[k + 1 :]:
            factor = row[k] * top[k]
            row[k + 1 :] = [v - factor * t for v, t in zip(row[k + 1 :], top[k + 1 :], strict=True)]
    for k in reversed(range(size)):
        for i in range(k + 1, size):
            rows[k][size:] = [v - rows[k][i] * t for v, t in zip(rows[k][size:], rows[i][size:], strict=True)]
        rows[k][size:] = [v * rows[k][k] for v in rows[k][size:]]
    return determinant, [row[size:] for row in rows]
