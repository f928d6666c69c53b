"""Vectors of expressions, for the geometry of closed loops."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

Vector = tuple[sp.Expr, ...]


def vector(*entries: object) -> Vector:
    """A point or direction, in the plane or in space."""
    return tuple(sp.sympify(e) for e in entries)


def minus(end: Vector, start: Vector) -> Vector:
    """From start to end."""
    return tuple(e - s for e, s in zip(end, start, strict=True))


def dot(first: Vector, second: Vector) -> sp.Expr:
    """The scalar product; a direction in the plane ignores the z of a vector in space."""
    return sp.Add(*[a * b for a, b in zip(first, second, strict=False)])


def cross(first: Vector, second: Vector) -> sp.Expr:
    """The z of the vector product: positive where second lies to the left of first."""
    return first[0] * second[1] - first[1] * second[0]


def discs_meet(centres: Sequence[Vector], radii: Sequence[sp.Expr]) -> sp.Basic:
    """Whether three discs in the plane, their centres not on a line, have a point in common.

    Every two must meet. Then all three do, unless the point of equal powers lies between the centres and outside the discs.
    """
    a, b = minus(centres[1], centres[0]), minus(centres[2], centres[0])
    first, second, third = (r**2 for r in radii)
    along, across = dot(a, a) + first - second, dot(b, b) + first - third
    twice = cross(a, b)
    point = vector(along * b[1] - across * a[1], across * a[0] - along * b[0])  # times 2 * twice, seen from the first centre
    inside = (cross(point, b), cross(a, point))
    pairs = [
        sp.Le(dot(between, between), (radii[i] + radii[j]) ** 2)
        for i, j in ((0, 1), (0, 2), (1, 2))
        for between in [minus(centres[i], centres[j])]
    ]
    common = sp.Or(
        sp.Lt(inside[0], 0), sp.Lt(inside[1], 0), sp.Gt(inside[0] + inside[1], 2 * twice**2),
        sp.Le(dot(point, point), 4 * twice**2 * first),
    )
    return sp.And(*pairs, common)


def triple(rows: Sequence[Vector]) -> sp.Expr:
    """The determinant of three vectors in space, or of two in the plane."""
    return sp.Matrix([list(row) for row in rows]).det()
