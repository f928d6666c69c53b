"""The ring gives the very expression that SymPy's own expansion gives, squares reduced."""

import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from derive.algebra.normal_form import reduce_units
from derive.algebra.rings import is_rational, reduced_in_ring
from derive.ir.symbols import cosine, real, sine

A1, A2 = real("a1"), real("a2")
SIGN, FLAG = sp.Symbol("sign", real=True, nonzero=True), sp.Symbol("flag", real=True)
SYMBOLS = (sine(A1), cosine(A1), sine(A2), cosine(A2), real("link"), SIGN, FLAG)
SQUARES = {sine(a): 1 - cosine(a) ** 2 for a in (A1, A2)} | {SIGN: sp.Integer(1), FLAG: FLAG}
LEAVES = st.sampled_from(SYMBOLS) | st.fractions(-3, 3, max_denominator=4).map(
    lambda f: sp.Rational(f.numerator, f.denominator)
)
EXPRESSIONS = st.recursive(
    LEAVES,
    lambda inner: (
        st.tuples(inner, inner).map(lambda p: p[0] + p[1])
        | st.tuples(inner, inner).map(lambda p: p[0] * p[1])
        | st.tuples(inner, st.integers(1, 3)).map(lambda p: p[0] ** p[1])
    ),
    max_leaves=10,
)


def slowly(expression: sp.Expr) -> sp.Expr:
    """Expanded term by term, each square of a symbol replaced by what it is."""
    while True:
        powers = {
            p: SQUARES[p.base] ** (p.exp // 2) * p.base ** (p.exp % 2)
            for p in sp.expand(expression).atoms(sp.Pow)
            if p.base in SQUARES
        }
        expression, before = sp.expand(sp.expand(expression).xreplace(powers)), expression
        if expression == before:
            return expression


@settings(deadline=None)
@given(EXPRESSIONS)
def test_a_ring_expands_as_sympy_does(expression: sp.Expr) -> None:
    assert is_rational(expression)
    assert reduced_in_ring(expression, SQUARES) == slowly(expression)
    assert reduce_units(expression, (A1, A2), (SIGN, FLAG)) == slowly(expression)


def test_what_is_no_polynomial_is_left_to_sympy() -> None:
    x = real("x")
    for other in (sp.sqrt(2) * x, 1 / x, sp.sin(x), x**0.5, sp.Float(0.1) * x, sp.pi * x, x**x):
        assert not is_rational(other)
