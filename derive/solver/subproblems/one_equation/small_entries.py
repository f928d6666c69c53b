"""One less an entry of a rotation, without cancellation.

Where an entry r = cos u is near one, it has lost the digits of u: 1 - cos u is u^2 / 2. The other two entries p and q
of its column are as small as u and hold all digits. Since p^2 + q^2 + r^2 = 1, 1 - r = (p^2 + q^2) / (1 + r); near
minus one, 1 + r = (p^2 + q^2) / (1 - r).

The entry may be compared with an arm h that earlier joints have folded, as cos u cos v is with cos v. Near h it is near
one, too, and h^2 - r^2 = p^2 + q^2 - (1 - h^2), where 1 - h^2 is the square of a sine, sin v. All of these are small.
"""

from __future__ import annotations

import sympy as sp

from derive.equations.problem import Column, Equation, Problem
from derive.ir.primitives import Select
from derive.ir.program import Let
from derive.ir.symbols import cosine, sine
from derive.solver.subproblems.one_equation.triangle import is_square, with_units

_SAME = 1e-15
"""Two numbers that differ by less than this share are equal: products of sines and cosines of fixed angles."""
_LARGE = sp.Rational(1, 2)
"""An entry larger than this is nearer to one than to zero."""
Factors = tuple[sp.Expr, sp.Expr]


def with_small_entries(
    problem: Problem, equation: Equation, factors: Factors, square: sp.Expr | None
) -> tuple[Factors, tuple[Let, ...]]:
    """The factors 1 - cosine and 1 + cosine, times a scale, and the statements that bind the names in them. A factor
    that is a multiple of one less an entry is computed from the other entries of its column.

    square: the square of the arm with which the entry is compared, by sines and cosines alone; None if it has none.
    """
    column = equation.column
    if column is None:
        return factors, ()
    less, more = (_by_others(problem, column, f) for f in factors)
    if (less, more) != factors:
        return (less, more), column.lets
    pair = _ends(column, factors)
    if pair is None:
        return factors, ()
    is_whole = pair[0][0] == column.size
    missing = sp.Integer(0) if is_whole else None if square is None else _less_than_one(problem, square)
    if missing is None or (column.size != 1 and not is_whole):
        return factors, ()
    less, more = (_with_arm(column, missing, *end) for end in pair)
    return (less, more), column.lets


def is_bounded(column: Column | None, factors: Factors) -> bool:
    """Whether the factors are the size of a column less its entry, and more: none is ever negative."""
    if column is None or not column.is_bounded:
        return False
    return {*factors} == {column.size - column.entry, column.size + column.entry}


def _ends(column: Column, factors: Factors) -> tuple[Factors, Factors] | None:
    """(h, entry) for h - entry and (h, -entry) for h + entry, or the reverse; None if the factors are others."""
    less, more = (sp.expand(f) for f in factors)
    arm, known_entry = (more + less) / 2, (more - less) / 2
    if known_entry not in (column.entry, -column.entry) or column.entry.free_symbols & arm.free_symbols:
        return None
    return (arm, known_entry), (arm, -known_entry)


def _with_arm(column: Column, missing: sp.Expr, arm: sp.Expr, known_entry: sp.Expr) -> sp.Expr:
    """h - entry, with h^2 = 1 - missing: near zero (the others - missing) / (h + entry)."""
    is_near = sp.Gt(known_entry, _LARGE * column.size)
    return Select(
        is_near, (column.others - missing) / (arm + Select(is_near, known_entry, sp.Integer(1))), arm - known_entry
    )


def _less_than_one(problem: Problem, square: sp.Expr) -> sp.Expr | None:
    """One less the square of an arm as a sum of squares, which keeps its digits near zero; None if it is none."""
    less = problem.reduce(1 - square)
    number, rest = sp.expand(less).as_coeff_Add()
    units = [cosine(a) ** 2 + sine(a) ** 2 for a in problem.units if less.free_symbols & {cosine(a), sine(a)}]
    for unit in (sp.Integer(1), *units):
        written = with_units(problem, sp.expand(number * unit + rest))
        terms = sp.Add.make_args(written)
        if written != 0 and all(is_square(t) and not t.is_number for t in terms):
            return written
    return None


def _by_others(problem: Problem, column: Column, value: sp.Expr) -> sp.Expr:
    if value.free_symbols - problem.numbers.keys() != {column.entry}:  # nor is it an entry, but a polar radius
        return value
    slope, size = sp.diff(value, column.entry), value.xreplace({column.entry: sp.Integer(0)})
    if column.entry in slope.free_symbols or size == 0:
        return value
    ratio = float((slope / size).xreplace(dict(problem.numbers)))
    if abs(abs(ratio) - 1.0) > _SAME:
        return value
    away = column.entry if ratio > 0.0 else -column.entry
    return size * Select(sp.Lt(away, 0), column.others / (1 + sp.Abs(column.entry)), 1 + away)
