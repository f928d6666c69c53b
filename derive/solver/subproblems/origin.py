"""From the origin: what is known of an equation where the commanded position is zero, and what the position adds to it.

Of a machine that stands at its origin with given angles, lengths are roots: they cancel there, and what is left of e is a
multiple of the arm that turns. Where the arm is short the terms of e are larger than e by the ratio of rod and arm. So e is
taken as what is left at the origin, plus what the position adds: with v the known names that hold it, v0 their values at the
origin, and e of no more than the second degree in v, e = e(v0) + sum (v - v0) (e_v(v) + e_v(v0)) / 2, with no remainder.
"""

from __future__ import annotations

import sympy as sp

from derive.algebra.normal_form import reduce_units
from derive.equations.problem import Equation, Problem


def from_origin(problem: Problem, equation: Equation, value: sp.Expr, arm: sp.Expr) -> sp.Expr | None:
    """The value, where the roots of the machine leave a multiple of the arm at the origin; None where they do not."""
    zero = {c: sp.Integer(0) for c in problem.position}
    moving = {c: c for c in problem.position} | {
        let.name: let.value for let in equation.lets if let.value.free_symbols & zero.keys()
    }
    names = [n for n in moving if n in value.free_symbols]
    if not problem.squares or not names or sp.Poly(value, *names).total_degree() > 2:
        return None
    origin = {n: moving[n].xreplace(zero) for n in names}
    written = reduce_units(value.xreplace(origin), problem.units, problem.signs)
    left = _through_squares(problem, written)
    if left == written or any(sp.cancel(term / arm).as_numer_denom()[1].has(arm) for term in sp.Add.make_args(left)):
        return None
    added = [(moving[n] - origin[n]) * _mean_rate(value, n, origin) for n in names]
    return sp.Add(sp.factor(left), *added)


def _mean_rate(value: sp.Expr, name: sp.Symbol, origin: dict[sp.Symbol, sp.Expr]) -> sp.Expr:
    """Half of the rates at both ends."""
    rate = sp.diff(value, name)
    return sp.expand((rate + rate.xreplace(origin)) / 2)


def _through_squares(problem: Problem, value: sp.Expr) -> sp.Expr:
    """The normal form with the squares of roots written out."""
    while True:
        after = value.replace(
            lambda n: isinstance(n, sp.Pow) and n.base in problem.squares and n.exp.is_Integer and n.exp >= 2,
            lambda n: problem.squares[n.base] ** (n.exp // 2) * n.base ** (n.exp % 2),
        )
        if after == value:
            return value
        value = reduce_units(after, problem.units, problem.signs)
