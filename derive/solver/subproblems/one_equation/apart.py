"""Apart:  two equations between which a length was eliminated, where that length drops out of both.

The difference of two equations says nothing if both coefficients of the eliminated length vanish: where one slide is
parallel to another. There the two equations are a pair for the angle u: a1 cos u + b1 sin u = e1,
a2 cos u + b2 sin u = e2. One root. Where their determinant vanishes, too, nothing determines u.
"""

from __future__ import annotations

import sympy as sp

from derive.algebra.normal_form import linear_coefficients
from derive.equations.problem import Equation, Problem
from derive.ir.constants import FREE_ANGLE
from derive.ir.primitives import Root, Select
from derive.ir.program import Let
from derive.ir.symbols import cosine, real, sine

Pair = tuple[sp.Expr, sp.Expr]


def determined_apart(
    problem: Problem, equation: Equation, angle: sp.Symbol, free: Pair
) -> tuple[tuple[Let, ...], Pair]:
    """Cosine and sine of the angle where the equation says nothing, and the statements that bind the names in them.
    Where the two equations do not determine the angle, these are `free`.
    """
    read = [linear_coefficients(e, (cosine(angle), sine(angle))) for e in equation.apart]
    rows = [row for row in read if row is not None]
    if len(rows) != 2:
        return (), free
    ((a1, b1), c1), ((a2, b2), c2) = rows
    if any(problem.unknowns_of(v) for v in (a1, b1, c1, a2, b2, c2)):
        return (), free
    size = problem.reduce(a1 * b2 - a2 * b1)
    if size == 0:
        return (), free
    determinant, along, across, length, divisor = (
        real(f"{word}_{angle.name}_apart") for word in ("determinant", "along", "across", "length", "divisor")
    )
    is_known = sp.And(sp.Gt(sp.Abs(determinant), FREE_ANGLE * problem.scale**2), sp.Gt(length, 0))
    lets = (
        Let(determinant, size, "where the slide drops out of both equations these are a pair"),
        Let(along, (b1 * c2 - b2 * c1) * determinant),
        Let(across, (a2 * c1 - a1 * c2) * determinant),
        Let(length, Root(along**2 + across**2)),
        Let(divisor, Select(is_known, length, sp.Integer(1))),
    )
    cos_free, sin_free = free
    return lets, (Select(is_known, along / divisor, cos_free), Select(is_known, across / divisor, sin_free))
