"""Conditions on the dimensions of a machine: whether its arms can reach a common point."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from derive.description.dimensions import Constraint
from derive.geometry.vectors import Vector, cross, dot, minus, vector
from derive.ir.program import Let
from derive.ir.symbols import real

_PAIRS = ((1, 2), (1, 3), (2, 3))


def discs_meet(centres: Sequence[Vector], radii: Sequence[sp.Expr], message: str) -> tuple[Constraint, ...]:
    """The conditions that three discs in the plane, the ranges of three arms seen from above, have a point in common.

    centres: x and y; radii: not negative; message: the condition in words. Every two discs must intersect. Then all
    three do, unless the radical centre (the point with equal powers to the circles) lies in the triangle of the centres
    and outside the discs. If the centres lie on a line there is no radical centre, and the pairs decide.
    """
    corners = tuple(vector(*(real(f"reach_{c}_{i}") for c in "xy")) for i in (1, 2, 3))
    reaches = tuple(real(f"reach_{i}") for i in (1, 2, 3))
    steps: list[Let] = []
    for corner, centre, reach, radius in zip(corners, centres, reaches, radii, strict=True):
        steps += [*_named(corner, centre), Let(reach, sp.sympify(radius))]
    steps[0] = Let(steps[0].name, steps[0].value, "what every arm reaches, seen from above: a disc")
    sides = tuple(_vector(f"side_{i}{j}") for i, j in _PAIRS)
    for side, (i, j) in zip(sides, _PAIRS, strict=True):
        steps += _named(side, minus(corners[j - 1], corners[i - 1]))
    reached = ((reaches[i - 1] + reaches[j - 1]) ** 2 for i, j in _PAIRS)
    pairs = (sp.Le(dot(side, side), square) for side, square in zip(sides, reached, strict=True))
    return Constraint(sp.And(*pairs), message, tuple(steps)), _all_three(sides[0], sides[1], reaches, message)


def _all_three(second: Vector, third: Vector, reaches: Sequence[sp.Symbol], message: str) -> Constraint:
    """The condition on three discs that intersect in pairs, in coordinates from the first centre."""
    power_2, power_3, area = real("power_2"), real("power_3"), real("corner_area")
    centre = _vector("equal_power")  # times 2 * area, seen from the first corner
    weight_2, weight_3 = real("weight_2"), real("weight_3")  # barycentric, of the centre, times 2 * area²
    steps = (
        Let(area, cross(second, third)),
        Let(power_2, dot(second, second) + reaches[0] ** 2 - reaches[1] ** 2),
        Let(power_3, dot(third, third) + reaches[0] ** 2 - reaches[2] ** 2),
        *_named(centre, vector(power_2 * third[1] - power_3 * second[1], power_3 * second[0] - power_2 * third[0])),
        Let(weight_2, cross(centre, third)),
        Let(weight_3, cross(second, centre)),
    )
    is_outside = sp.Or(sp.Lt(weight_2, 0), sp.Lt(weight_3, 0), sp.Gt(weight_2 + weight_3, 2 * area**2))
    is_reached = sp.Le(dot(centre, centre), 4 * area**2 * reaches[0] ** 2)
    return Constraint(sp.Or(is_outside, is_reached), message, steps)


def _vector(name: str) -> Vector:
    return vector(*(real(f"{name}_{c}") for c in "xy"))


def _named(names: Vector, values: Vector) -> tuple[Let, ...]:
    return tuple(Let(real(str(name)), value) for name, value in zip(names, values, strict=True))
