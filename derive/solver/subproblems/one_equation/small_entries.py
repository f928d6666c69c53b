"""One less an entry of a rotation, without cancellation.

Near one the entry has lost the digits of the angle: 1 - cos u is u^2 / 2. The other two entries of its column are as
small as u and hold all digits. The squares of all three add up to one, so 1 - r = (p^2 + q^2) / (1 + r), and 1 + r is
the same near minus one.
"""

from __future__ import annotations

import sympy as sp

from derive.equations.problem import Column, Equation, Problem
from derive.ir.primitives import Select
from derive.ir.program import Let

_SAME = 1e-15
"""Two numbers that differ by less than this share are one number: products of sines and cosines of fixed angles."""
Factors = tuple[sp.Expr, sp.Expr]


def with_small_entries(problem: Problem, equation: Equation, factors: Factors) -> tuple[Factors, tuple[Let, ...]]:
    """The factors 1 - cosine and 1 + cosine, times a scale, and the statements that bind what they read. Those that are
    a multiple of one less an entry are written by the other entries.
    """
    if equation.column is None:
        return factors, ()
    less, more = (_by_others(problem, equation.column, f) for f in factors)
    return ((less, more), equation.column.lets) if (less, more) != factors else (factors, ())


def _by_others(problem: Problem, column: Column, value: sp.Expr) -> sp.Expr:
    if value.free_symbols - problem.numbers.keys() != {column.entry}:
        return value
    slope, size = sp.diff(value, column.entry), value.xreplace({column.entry: sp.Integer(0)})
    if column.entry in slope.free_symbols or size == 0:
        return value
    ratio = float((slope / size).xreplace(dict(problem.numbers)))
    if abs(abs(ratio) - 1.0) > _SAME:
        return value
    away = column.entry if ratio > 0.0 else -column.entry
    return size * Select(sp.Lt(away, 0), column.others / (1 + sp.Abs(column.entry)), 1 + away)
