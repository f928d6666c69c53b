"""Vectors of expressions, for the geometry of closed loops."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

Vector = tuple[sp.Expr, ...]


def vector(*entries: object) -> Vector:
    """A point or direction, in the plane or in space."""
    return tuple(sp.sympify(e) for e in entries)


def minus(end: Vector, start: Vector) -> Vector:
    """The vector from start to end."""
    return tuple(e - s for e, s in zip(end, start, strict=True))


def dot(first: Vector, second: Vector) -> sp.Expr:
    """The scalar product; a direction in the plane ignores the z of a vector in space."""
    return sp.Add(*[a * b for a, b in zip(first, second, strict=False)])


def cross(first: Vector, second: Vector) -> sp.Expr:
    """The z of the vector product: positive where second lies to the left of first."""
    return first[0] * second[1] - first[1] * second[0]


def triple(rows: Sequence[Vector]) -> sp.Expr:
    """The determinant of three vectors in space, or of two in the plane; its products are not written out."""
    if len(rows) == 2:
        return cross(*rows)
    first, second, third = rows
    return sp.Add(*[first[i] * cross(_without(second, i), _without(third, i)) * (-1) ** i for i in range(3)])


def _without(entries: Vector, place: int) -> Vector:
    return (*entries[:place], *entries[place + 1 :])
