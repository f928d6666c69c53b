"""A step towards a root that may be double: to the nearer root of the parabola with the same value, slope and bend.

Where the parabola has no root, the step leads to its vertex. So nearly double roots are found as fast as others. A step
is not taken if it does not lower the value, or if the value is rounding already: two nearly equal roots each stay on
their side.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from derive.ir.primitives import Root, Select
from derive.ir.program import Let
from derive.ir.symbols import real

ROUNDING = sp.Float("1e-15")
"""A sum smaller than this share of its terms is rounding."""
LONGEST = sp.Float("1e-2")
"""A longer step (radians) leads to another root than the one near the start."""
_ONE = sp.Integer(1)


def step_of(word: str) -> sp.Symbol:
    """The name of the step."""
    return real(f"step_{word}")


def parabola(
    start: sp.Symbol,
    name: sp.Symbol,
    word: str,
    derivatives: tuple[sp.Expr, sp.Expr, sp.Expr],
    there: sp.Expr,
    terms: sp.Expr,
) -> Iterator[Let]:
    """The statements that bind the name to the start plus one step.

    word: the end of the names of the statements. there: the value after the step. terms: the size of the terms of
    which the value is the sum.
    """
    value, slope, bend, square, radius, below, after = (
        real(f"{n}_{word}") for n in ("value", "slope", "bend", "square", "radius", "below", "after")
    )
    yield from (Let(n, v) for n, v in zip((value, slope, bend), derivatives, strict=True))
    to_root = -2 * value / Select(sp.Gt(sp.Abs(below), sp.Abs(value)), below, _ONE)
    to_vertex = -slope / Select(sp.Gt(sp.Abs(bend), sp.Abs(slope)), bend, _ONE)
    yield Let(square, slope**2 - 2 * value * bend)
    yield Let(radius, Root(square))
    yield Let(below, slope + Select(sp.Ge(slope, 0), radius, -radius))
    yield Let(step_of(word), Select(sp.Ge(square, 0), to_root, to_vertex))
    yield Let(after, sp.Abs(there))
    lowers = sp.And(sp.Lt(after, sp.Abs(value)), sp.Gt(sp.Abs(value), ROUNDING * terms))
    is_taken = sp.And(lowers, sp.Le(sp.Abs(step_of(word)), LONGEST))
    yield Let(name, Select(is_taken, start + step_of(word), start))
