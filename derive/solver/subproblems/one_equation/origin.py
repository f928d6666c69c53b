"""From the origin: the right side e of a law of cosines, without cancellation, as its value at the origin plus an
increment.

Some machines state their lengths by the angles at which they stand at the origin, so that lengths are roots. At the
origin these roots cancel, and e is a multiple of the arm that turns. If the arm is short, the single terms of e are
larger than e by the ratio of rod and arm, and their sum loses as many digits. So e is written as its value at the
origin plus what the commanded position adds. Let v be the known names that depend on the position, and v0 their values
at the origin. For e of at most the second degree in v the trapezoidal rule is exact: e = e(v0) + sum (v - v0) (e_v(v) +
e_v(v0)) / 2.
"""

from __future__ import annotations

import sympy as sp

from derive.algebra.normal_form import reduce_units
from derive.equations.problem import Equation, Problem


def from_origin(problem: Problem, equation: Equation, value: sp.Expr, arm: sp.Expr) -> sp.Expr | None:
    """The value in this form, where its roots cancel to a multiple of the arm at the origin; None if they do not."""
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
    """The mean of the derivatives at the origin and at the commanded position."""
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
