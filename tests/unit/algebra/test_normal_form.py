"""The normal form, and its ring: the same function, reduced as SymPy's own expansion is."""

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from derive.algebra.normal_form import (
    cosine,
    is_compound,
    linear_coefficients,
    polynomial,
    reduce_units,
    sine,
    split_known,
)
from derive.algebra.rings import is_rational, reduced_in_ring
from derive.ir.constants import DEGREE
from derive.ir.symbols import real
from tests.unit.solver.execution import ANGLES, NUMBERS, at, few

A1, A2, A3 = ANGLE_NAMES = tuple(real(f"a{k}") for k in (1, 2, 3))
S, T = (sp.Symbol(n, real=True, nonzero=True) for n in "st")
L = sp.Symbol("link", positive=True)
X = real("x")
A1, A2 = map(real, "a1 a2".split())

EXPRESSIONS = {
    "one angle": L * sp.cos(A1) - X,
    "a sum": sp.cos(A1 + A2) + L * sp.sin(A1 + A2 + A3),
    "a difference": sp.sin(A1 - A2) * sp.cos(A3 - A1),
    "powers": (sp.cos(A1) + L * sp.sin(A1)) ** 4 - sp.sin(A2) ** 3,
    "a double angle": sp.sin(2 * A1 + A2),
    "a plain angle": X - L * A1 / (2 * sp.pi) + sp.cos(A1),
    "a fixed turn": sp.cos(A1 + sp.pi / 6) + sp.sin(A2 - 5 * sp.pi / 7),
    "a direction": L * sp.cos(S * A1) + sp.sin(S * A1),
    "a direction in a sum": sp.cos(A1 + S * A2) + sp.sin(S * (A1 + A2) - A3),
    "two directions": sp.cos(S * A1 + T * A2) + S * T * sp.sin(S * T * A3) + S**3 * T**2,
}


@few
@pytest.mark.parametrize("name", EXPRESSIONS)
@given(
    turns=st.tuples(ANGLES, ANGLES, ANGLES),
    s=st.sampled_from([1, -1]),
    t=st.sampled_from([1, -1]),
    link=NUMBERS,
    x=NUMBERS,
)
def test_the_same_function(name: str, turns: tuple[float, ...], s: int, t: int, link: float, x: float) -> None:
    expression = EXPRESSIONS[name]
    form = polynomial(expression, ANGLE_NAMES, (S, T))
    values = {"s": s, "t": t, "link": link, "x": x, **{f"a{k}": v for k, v in enumerate(turns, 1)}}
    values |= {f(a).name: g(values[a.name]) for a in ANGLE_NAMES for f, g in ((cosine, np.cos), (sine, np.sin))}
    numbers = {k: np.asarray(v, dtype=float) for k, v in values.items()}
    assert abs(at(expression, numbers) - at(form, numbers)) <= 1e-13 * (1 + abs(x) + (1 + abs(link)) ** 4)


@pytest.mark.parametrize("name", EXPRESSIONS)
def test_normal(name: str) -> None:
    """Nothing is left to reduce, and no sine or cosine of an unknown is left unnamed."""
    form = polynomial(EXPRESSIONS[name], ANGLE_NAMES, (S, T))
    assert reduce_units(form, ANGLE_NAMES, (S, T)) == form
    assert all(
        sp.Poly(form, *[sine(a) for a in ANGLE_NAMES], S, T).degree(g) <= 1 for g in (*map(sine, ANGLE_NAMES), S, T)
    )
    assert not {s for f in form.atoms(sp.sin, sp.cos) for s in f.free_symbols} & {*ANGLE_NAMES, S, T}


def test_equal_functions_have_one_form() -> None:
    for first, second in [
        (sp.sin(A1) ** 2 + sp.cos(A1) ** 2, sp.Integer(1)),
        (sp.cos(A1 - A2) ** 2 - 1, -(sp.sin(A2 - A1) ** 2)),
        (sp.sin(A1 + A2) - sp.sin(A1) * sp.cos(A2), sp.cos(A1) * sp.sin(A2)),
        (S * sp.sin(S * A1), sp.sin(A1)),
        (sp.cos(S * (A1 - A2)), sp.cos(A2 - A1)),
        (sp.sin(A1 + sp.pi / 2), sp.cos(A1)),
        (sp.cos(A1 + sp.pi / 3) + sp.cos(A1 - sp.pi / 3), sp.cos(A1)),
    ]:
        assert polynomial(first - second, ANGLE_NAMES, (S,)) == 0


def test_signs_are_only_signs_where_they_are_named() -> None:
    assert reduce_units(S**2, ()) == S**2
    assert reduce_units(S**4 * X**2, (), (S,)) == X**2
    assert reduce_units(sine(A1) ** 2, (A2,)) == sine(A1) ** 2


def test_pi_is_half_a_turn_in_degrees() -> None:
    assert polynomial(X * A1 / (2 * sp.pi), (A1,), ()) == X * A1 / (360 * DEGREE)


def test_linear_coefficients() -> None:
    c, s = cosine(A1), sine(A1)
    assert linear_coefficients(L * c - X * s + 3, (c, s)) == ([L, -X], 3)
    assert linear_coefficients(X + 1, (c, s)) == ([0, 0], X + 1)
    for expression in (c * s, c**2 + s, L / c, sp.sin(c)):
        assert linear_coefficients(expression, (c, s)) is None


def test_split_known() -> None:
    c = cosine(A1)
    moving, known = split_known(L * (c + 1) - X + c * X, (c,))
    assert (moving, known) == (L * c + c * X, L - X)
    assert split_known(X, (c,)) == (0, X)


@pytest.mark.parametrize(
    "expression, compound",
    [(X, False), (-X, False), (sp.Integer(2), False), (2 * X, True), (X + 1, True), (X**2, True)],
)
def test_what_deserves_a_name(expression: sp.Expr, compound: bool) -> None:
    assert is_compound(expression) is compound


SIGN, FLAG = sp.Symbol("sign", real=True, nonzero=True), sp.Symbol("flag", real=True)
SYMBOLS = (sine(A1), cosine(A1), sine(A2), cosine(A2), real("link"), SIGN, FLAG)
SQUARES = {sine(a): 1 - cosine(a) ** 2 for a in (A1, A2)} | {SIGN: sp.Integer(1), FLAG: FLAG}
LEAVES = st.sampled_from(SYMBOLS) | st.fractions(-3, 3, max_denominator=4).map(
    lambda f: sp.Rational(f.numerator, f.denominator)
)
TREES = st.recursive(
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
@given(TREES)
def test_a_ring_expands_as_sympy_does(expression: sp.Expr) -> None:
    assert is_rational(expression)
    assert reduced_in_ring(expression, SQUARES) == slowly(expression)
    assert reduce_units(expression, (A1, A2), (SIGN, FLAG)) == slowly(expression)


def test_what_is_no_polynomial_is_left_to_sympy() -> None:
    x = real("x")
    for other in (sp.sqrt(2) * x, 1 / x, sp.sin(x), x**0.5, sp.Float(0.1) * x, sp.pi * x, x**x):
        assert not is_rational(other)
