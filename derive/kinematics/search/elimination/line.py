"""Fourteen values of a line with a point on it, which every motion of the frame changes linearly; and the number 1.

    1, p (a point), l (the direction of a line through it), p·p, p·l, p × l, (p·p) l - 2 (p·l) p

A turn rotates the four vectors. A shift by t adds what is linear in these values: 2 t·p + t·t to p·p, and so on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import sympy as sp

from derive.ir.symbols import real

SIZE = 15
_UNIT, _POINT, _DIRECTION, _SQUARE, _ALONG, _MOMENT, _LAST = 0, 1, 4, 7, 8, 9, 12
"""The places of the values."""
_VECTORS = (_POINT, _DIRECTION, _MOMENT, _LAST)
_C, _S, _T = real("cosine_of_turn"), real("sine_of_turn"), real("shift")


@dataclass(frozen=True)
class Move:
    """A motion of a frame. parts: matrices by which it changes the values, each times one of `factors`, by rows."""

    parts: tuple[sp.ImmutableSparseMatrix, ...]
    factors: tuple[sp.Expr, ...]

    @property
    def matrix(self) -> sp.Matrix:
        """The whole change."""
        return sum((p * f for p, f in zip(self.parts, self.factors, strict=True)), sp.zeros(SIZE, SIZE))


def direction_of(move: Move) -> sp.Matrix:
    """What a motion does to directions."""
    return move.matrix[_DIRECTION : _DIRECTION + 3, _DIRECTION : _DIRECTION + 3]


def axis_line(axis: int) -> sp.Matrix:
    """The values of an axis of a frame, with its origin as the point."""
    found = sp.zeros(SIZE, 1)
    found[_UNIT] = found[_DIRECTION + axis] = sp.Integer(1)
    return found


def turn(axis: int, cosine: sp.Expr, sine: sp.Expr) -> Move:
    """A turn about an axis."""
    return Move(_parts_of_turn(axis), (sp.Integer(1), cosine, sine))


def shift(axis: int, amount: sp.Expr) -> Move:
    """A shift along an axis."""
    return Move(_parts_of_shift(axis), (sp.Integer(1), amount, amount**2))


def rotation(entries: Sequence[sp.Expr]) -> Move:
    """A rotation, by the rows of its matrix."""
    matrix, inner = sp.eye(SIZE), sp.Matrix(3, 3, list(entries))
    for place in _VECTORS:
        matrix[place : place + 3, place : place + 3] = inner
    return Move((sp.ImmutableSparseMatrix(matrix),), (sp.Integer(1),))


@cache
def _parts_of_turn(axis: int) -> tuple[sp.ImmutableSparseMatrix, ...]:
    first, second = (axis + 1) % 3, (axis + 2) % 3
    inner = sp.eye(3)
    inner[first, first] = inner[second, second] = _C
    inner[first, second], inner[second, first] = -_S, _S
    return _split(rotation(list(inner)).matrix, (_C, _S))


@cache
def _parts_of_shift(axis: int) -> tuple[sp.ImmutableSparseMatrix, ...]:
    columns = [_shifted(sp.Matrix(SIZE, 1, lambda i, _, k=k: int(i == k)), axis) for k in range(SIZE)]
    return _split(sp.Matrix.hstack(*columns), (_T, _T**2))


def _shifted(values: sp.Matrix, axis: int) -> sp.Matrix:
    """Values behind a shift along an axis. All terms are linear in the values."""
    found = values.copy()
    point, line, moment = (values[k : k + 3, 0] for k in (_POINT, _DIRECTION, _MOMENT))
    along, unit = values[_ALONG], sp.zeros(3, 1)
    unit[axis] = _T
    found[_POINT + axis] += _T * values[_UNIT]
    found[_SQUARE] += 2 * _T * point[axis] + _T**2 * values[_UNIT]
    found[_ALONG] += _T * line[axis]
    found[_MOMENT : _MOMENT + 3, 0] = moment + unit.cross(line)
    last = values[_LAST : _LAST + 3, 0] - 2 * unit.cross(moment)
    last += _T**2 * line - 2 * along * unit - 2 * _T * line[axis] * unit
    found[_LAST : _LAST + 3, 0] = last
    return found


def _split(matrix: sp.Matrix, factors: tuple[sp.Expr, sp.Expr]) -> tuple[sp.ImmutableSparseMatrix, ...]:
    """The parts of a matrix: without the factors, and what is multiplied by each of them."""
    gone = {_C: 0, _S: 0, _T: 0}
    parts = [matrix.expand().applyfunc(lambda e, f=f: e.coeff(f) if f in (_C, _S) else _power(e, f)) for f in factors]
    return tuple(sp.ImmutableSparseMatrix(p) for p in (matrix.subs(gone), *parts))


def _power(value: sp.Expr, factor: sp.Expr) -> sp.Expr:
    return sp.expand(value).coeff(_T, 1 if factor == _T else 2)
