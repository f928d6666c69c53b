"""Slopes, by automatic differentiation: every value of a straight-line program also differentiated by one of its
inputs.

    Let(a, t*x)              →  Let(slope_a, x)
    Let(b, Root(a))          →  Let(slope_b, Select(b > 0, slope_a/(2*b), 0))
    Let(d, a/b)              →  Let(slope_d, (slope_a - d*slope_b)/b)
    Let(c, Select(p, a, b))  →  Let(slope_c, Select(p, slope_a, slope_b))
    Let(e, Abs(a))           →  Let(slope_e, Select(a > 0, slope_a, -slope_a))

Total like the statements themselves: where a root vanishes its slope is given as zero. A `Require` has no slope, and a
condition is not differentiated.
"""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Statement
from derive.ir.symbols import is_condition, real

_ZERO = sp.Integer(0)


def slope_name(name: sp.Symbol) -> sp.Symbol:
    """The name of the slope of a value."""
    return real(f"slope_{name.name}")


def with_slopes(statements: Sequence[Statement], variable: sp.Symbol) -> tuple[Statement, ...]:
    """The statements, each followed by its slope where that is not zero; slopes that are bound already stay."""
    bound = {s.name for s in statements if isinstance(s, Let)}
    known = {name: slope_name(name) for name in bound if slope_name(name) in bound}
    given = {*known.values()}
    slopes: dict[sp.Symbol, sp.Expr] = {variable: sp.Integer(1), **known}
    found: list[Statement] = []
    for s in statements:
        if not isinstance(s, Let) or is_condition(s.value) or s.name in known or s.name in given:
            found.append(s)
            continue
        changed = _slope(s.value, slopes, s.name)
        found.append(s)
        if changed != 0:
            slopes[s.name] = slope_name(s.name)
            found.append(Let(slope_name(s.name), changed))
    return tuple(found)


def _slope(value: sp.Basic, slopes: dict[sp.Symbol, sp.Expr], whole: sp.Expr | None = None) -> sp.Expr:
    """The slope of an expression, from the slopes of its names. whole: the name of the expression itself, if any."""
    if not value.free_symbols & slopes.keys():
        return _ZERO
    if isinstance(value, Select):
        first, second = (_slope(side, slopes, whole) for side in value.args[1:])
        return Select(value.args[0], first, second)
    if isinstance(value, Root):
        root = value if whole is None else whole
        inner = _slope(value.args[0], slopes)
        return Select(sp.Gt(root, 0), inner / (2 * Select(sp.Gt(root, 0), root, sp.Integer(1))), _ZERO)
    if isinstance(value, sp.Abs):
        (signed,) = value.args
        inner = _slope(signed, slopes)
        return Select(sp.Gt(signed, 0), inner, -inner)
    if isinstance(value, sp.Symbol):
        return slopes[value]
    if isinstance(value, sp.Add):
        return sp.Add(*[_slope(term, slopes) for term in value.args])
    if isinstance(value, sp.sin | sp.cos):
        return value.diff(value.args[0]) * _slope(value.args[0], slopes)
    if isinstance(value, sp.Pow):
        return value.exp * value.base ** (value.exp - 1) * _slope(value.base, slopes)
    if isinstance(value, sp.Mul):
        return _of_product(value, slopes, whole)
    raise TypeError(f"no slope of {value}")


def _of_product(value: sp.Mul, slopes: dict[sp.Symbol, sp.Expr], whole: sp.Expr | None) -> sp.Expr:
    above, below = sp.fraction(value)
    if whole is not None and below.free_symbols & slopes.keys():
        return (_slope(above, slopes) - whole * _slope(below, slopes)) / below
    rest = [sp.Mul(*[g for k, g in enumerate(value.args) if k != i]) for i in range(len(value.args))]
    return sp.Add(*[_slope(f, slopes) * r for f, r in zip(value.args, rest, strict=True)])
