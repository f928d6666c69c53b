"""Expressions with rational numbers, expanded in a ring of polynomials: many times faster than term by term."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from math import comb, isqrt
from random import Random

import sympy as sp
from sympy import igcd, ilcm
from sympy.polys.galoistools import gf_degree, gf_gcd, gf_strip
from sympy.polys.rings import PolyElement, PolyRing

from derive.ir.symbols import cosine, sine
from derive.work import spend


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
    spend(terms_of_products(expression))
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
        spend(sum(len(part) * len(square) ** half for half, part in parts.items()))
        value = sum((part * square**half for half, part in parts.items()), start=ring.zero)
    return value


_PRIME = 2**61 - 1
_SEED = 37
_SQUARE_TRIALS = 2
_LONGEST = 10**6
"""Coefficients that are more than such a multiple of what they share are those of long decimals, and share nothing."""


def common_factor(first: sp.Expr, second: sp.Expr) -> sp.Expr:
    """The greatest common divisor of two polynomials; of fractions, too, if it leaves short numbers: 21/50 and 7/20
    have 7/100, as 420 and 350 have 70, so that a machine has one form in every unit of length.

    To find it takes seconds where there are dozens of symbols, and nearly always it is a number. With numbers for all
    symbols but one this shows at once.
    """
    if not (is_rational(first) and is_rational(second)) or not first.free_symbols | second.free_symbols:
        return sp.gcd(first, second)
    symbols = sorted(first.free_symbols | second.free_symbols, key=lambda s: s.sort_key())
    one, other = (_ring(tuple(symbols)).from_expr(value) for value in (first, second))
    numbers = [number for polynomial in (one, other) for number in polynomial.values()]
    unit = ilcm(1, *[int(number.denominator) for number in numbers])
    whole = [int(number * unit) for number in numbers]
    content = igcd(0, *whole)
    if unit > 1 and max(map(abs, whole)) > _LONGEST * content:
        unit, content = 1, 1
    values = _drawn(len(symbols))
    if any(_may_share(one, other, values, place) for place in range(len(symbols))):
        spend(len(one) * len(other))
        return sp.gcd(sp.expand(unit * first), sp.expand(unit * second)) / unit
    return sp.Rational(content, unit)


def may_be_square(value: sp.Expr, angles: Sequence[sp.Symbol]) -> bool:
    """Whether a polynomial takes squares of rational numbers only, at rational points of the unit circle for sines and
    cosines of the angles, and whole numbers for the rest.
    """
    if not is_rational(value) or not value.free_symbols:
        return True
    ring = _ring(tuple(sorted(value.free_symbols, key=lambda s: s.sort_key())))
    polynomial, rng = ring.from_expr(value), Random(_SEED)
    spend(_SQUARE_TRIALS * len(polynomial))
    for _ in range(_SQUARE_TRIALS):
        values = {symbol: sp.QQ(rng.randrange(2, 100)) for symbol in ring.symbols}
        for angle in angles:
            half = sp.QQ(rng.randrange(2, 100))
            values |= {cosine(angle): (1 - half**2) / (1 + half**2), sine(angle): 2 * half / (1 + half**2)}
        found = polynomial.evaluate(
            [(generator, values[s]) for generator, s in zip(ring.gens, ring.symbols, strict=True)]
        )
        if any(part < 0 or isqrt(part) ** 2 != part for part in (int(found.numerator), int(found.denominator))):
            return False
    return True


def _drawn(count: int) -> list[int]:
    rng = Random(_SEED)
    return [rng.randrange(1, _PRIME) for _ in range(count)]


def _may_share(first: PolyElement, second: PolyElement, values: list[int], place: int) -> bool:
    """Whether two polynomials have a common factor that reads one symbol: with numbers for the others, in the field of
    a prime, that factor is left.
    """
    alone = [_in_one(polynomial, values, place) for polynomial in (first, second)]
    if any(gf_degree(coefficients) < 1 for coefficients in alone):
        return any(not coefficients for coefficients in alone)
    return bool(gf_degree(gf_gcd(*alone, _PRIME, sp.ZZ)) > 0)


def _in_one(polynomial: PolyElement, values: list[int], place: int) -> list[int]:
    """The coefficients of one symbol, the highest power first, with numbers for the others, modulo the prime."""
    highest = max((monomial[place] for monomial in polynomial), default=0)
    coefficients = [0] * (highest + 1)
    for monomial, number in polynomial.terms():
        term = int(number.numerator) * pow(int(number.denominator), -1, _PRIME)
        for k, power in enumerate(monomial):
            if power and k != place:
                term = term * pow(values[k], power, _PRIME) % _PRIME
        coefficients[highest - monomial[place]] += term
    found: list[int] = gf_strip([c % _PRIME for c in coefficients])
    return found


def terms_of_products(expression: sp.Expr) -> int:
    """The number of products of terms that are multiplied where an expression is expanded."""
    if isinstance(expression, sp.Add):
        return sum(map(terms_of_products, expression.args))
    if isinstance(expression, sp.Mul):
        product = 1
        for factor in expression.args:
            product *= terms_of_products(factor)
        return product
    if isinstance(expression, sp.Pow) and expression.exp.is_Integer and expression.exp > 1:
        return comb(terms_of_products(expression.base) + int(expression.exp) - 1, int(expression.exp))
    return 1
