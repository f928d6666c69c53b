"""Sums of angles: their names, and the addition theorems read backwards."""

from itertools import combinations, product

import pytest
import sympy as sp

from derive.algebra.angle_sums import Terms, name_of, recognise, symbol_of_sum, terms_of
from derive.algebra.normal_form import polynomial
from derive.ir.symbols import real

A1, A2, A3, THETA = ANGLES = tuple(real(n) for n in ("a1", "a2", "a3", "theta"))
L = sp.Symbol("link", positive=True)


@pytest.mark.parametrize(
    "terms, name",
    [
        (((A1, 1),), "a1"),
        (((A1, 1), (A2, 1)), "a12"),
        (((A1, 1), (A2, 1), (A3, 1)), "a123"),
        (((A1, -1), (A2, 1)), "a2_from_a1"),
        (((A1, 1), (A2, -1), (A3, 1)), "a13_from_a2"),
        (((A1, 1), (THETA, 1)), "a1_theta"),
    ],
)
def test_names(terms: Terms, name: str) -> None:
    assert name_of(terms) == name
    assert symbol_of_sum(terms) == real(name)


@pytest.mark.parametrize(
    "argument, terms",
    [
        (A1, ((A1, 1),)),
        (A1 + A3, ((A1, 1), (A3, 1))),
        (A2 - A1, ((A1, -1), (A2, 1))),
        (2 * A1, None),
        (A1 + 1, None),
        (A1 + L, None),
        (sp.Integer(0), None),
        (A1 / 2 + A2, None),
    ],
)
def test_plain_sums_alone_have_terms(argument: sp.Expr, terms: Terms | None) -> None:
    assert terms_of(argument, ANGLES) == terms


SUMS = [
    tuple(zip(chosen, (1, *signs), strict=True))
    for size in (2, 3)
    for chosen in combinations((A1, A2, A3), size)
    for signs in product((1, -1), repeat=size - 1)
]


@pytest.mark.parametrize("terms", SUMS, ids=name_of)
@pytest.mark.parametrize("word, function", [("cos", sp.cos), ("sin", sp.sin)])
@pytest.mark.parametrize("sign", [1, -1])
def test_recognised(terms: Terms, word: str, function: type[sp.Function], sign: int) -> None:
    argument = sp.Add(*[a * s for a, s in terms])
    assert recognise(sign * polynomial(function(argument), ANGLES, ()), ANGLES) == (sign, word, terms)


@pytest.mark.parametrize(
    "expression",
    [sp.cos(A1), 2 * sp.cos(A1 + A2), sp.cos(A1) * sp.cos(A2), sp.cos(A1 + A2) + 1, L, sp.cos(A1 + 2 * A2)],
)
def test_not_recognised(expression: sp.Expr) -> None:
    assert recognise(polynomial(expression, ANGLES, ()), ANGLES) is None
