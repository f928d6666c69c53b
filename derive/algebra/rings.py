"""Expressions with rational numbers, expanded in a ring of polynomials: many times faster than term by term."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import sympy as sp
from sympy.polys.rings import PolyElement, PolyRing


def is_rational(expression: sp.Expr) -> bool:
    """Whether an expression is made of symbols and rational numbers by sums, products and whole positive powers."""
    for node in sp.preorder_traversal(expression):
        if isinstance(node, sp.Pow) and not (node.exp.is_Integer and node.exp.is_positive):
            return False
        if not isinstance(node, sp.Add | sp.Mul | sp.Pow | sp.Symbol | sp.Rational):
            return False
    return True


def reduced_in_ring(expression: sp.Expr, squares: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    """The expanded expression with the squares of some symbols replaced by their values, until no square is left."""
    present = expression.free_symbols
    used = {s: v for s, v in squares.items() if s in present}
    names = present.union(*(v.free_symbols for v in used.values()))
    ring = _ring(tuple(sorted(names, key=lambda s: s.sort_key())))
    value = ring.from_expr(expression)
    for symbol, square in used.items():
        value = _lowered(ring, value, ring.symbols.index(symbol), ring.from_expr(square))
    return value.as_expr()


@cache
def _ring(symbols: tuple[sp.Symbol, ...]) -> PolyRing:
    return PolyRing(symbols, sp.QQ)


def _lowered(ring: PolyRing, value: PolyElement, place: int, square: PolyElement) -> PolyElement:
    """The polynomial with the square of one symbol replaced; the square of a flag is the flag itself."""
    while any(monomial[place] > 1 for monomial in value):
        parts: dict[int, PolyElement] = {}
        for monomial, number in value.terms():
            half, odd = divmod(monomial[place], 2)
            rest = (*monomial[:place], odd, *monomial[place + 1 :])
            parts.setdefault(half, ring.zero)[rest] = number
        value = sum((part * square**half for half, part in parts.items()), start=ring.zero)
    return value
