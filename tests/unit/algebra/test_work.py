"""The work of a derivation: counted before it is done, and the same whether or not results are kept."""

import pytest
import sympy as sp

from derive.algebra import rings
from derive.algebra.normal_form import factored, factors_of, reduce_units
from derive.algebra.rings import common_factor, may_be_square, terms_of_products
from derive.ir.symbols import cosine, real, sine
from derive.work import TooMuchWork, at_most, counted, spend

A, B, C = (real(name) for name in ("work_a", "work_b", "work_c"))
Q = real("work_q")


@pytest.mark.parametrize(
    ("expression", "products"),
    [(A, 1), (A + B, 2), ((A + B) * (B + C + 1), 6), ((A + B + C) ** 2, 6), (A * B**2, 1), ((A + B) ** 3 + C, 5)],
)
def test_products_of_an_expansion(expression: sp.Expr, products: int) -> None:
    assert terms_of_products(expression) == products


def test_a_result_that_is_kept_counts_as_the_first_time() -> None:
    value = (A * sine(Q) + B) ** 4 - (B * sine(Q) + C) ** 3
    counts = []
    for _ in range(2):
        with at_most(1e9) as work:
            reduce_units(value, (Q,), ())
        counts.append(work.done)
    assert counts[0] == counts[1] > 10


@pytest.mark.parametrize("is_kept", [False, True])
def test_the_bound_holds_whether_or_not_the_result_is_kept(is_kept: bool) -> None:
    value = (A + B * sine(Q) + 3 * is_kept) ** 5
    if is_kept:
        reduce_units(value, (Q,), ())
    with pytest.raises(TooMuchWork), at_most(5):
        reduce_units(value, (Q,), ())


def test_what_is_given_up_counts_outside_too() -> None:
    with at_most(100) as outer:
        with pytest.raises(TooMuchWork), at_most(10):
            spend(8)
            spend(8)
        assert outer.done == 8
        with pytest.raises(TooMuchWork), at_most(1e9):
            spend(93)


def test_a_kept_function_within_another_counts_once() -> None:
    @counted
    def inner(number: int) -> int:
        spend(number)
        return number

    @counted
    def outer(number: int) -> int:
        spend(1)
        return inner(number)

    for _ in range(2):
        with at_most(1e9) as work:
            assert outer(7) == 7
        assert work.done == 8


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (6 * A * B + 4 * A * C, 10 * A * B**2 - 2 * A),
        (6 * A + 4 * B, 10 * A - 2 * C),
        (A**2 - B**2, A * C + B * C),
        (sp.Integer(0), 3 * A),
        (A * sp.sqrt(2) + B * sp.sqrt(2), A**2 - B**2),
        (sp.Integer(4), sp.Integer(6)),
    ],
)
def test_the_common_factor_is_the_greatest_divisor(first: sp.Expr, second: sp.Expr) -> None:
    assert sp.expand(common_factor(first, second) - sp.gcd(first, second)) == 0


def test_fractions_have_the_common_factor_of_the_numbers_in_another_unit() -> None:
    """21/50 and 7/20 have 7/100, as 420 and 350 have 70; nothing is taken of long decimals."""
    milli = sp.Rational(1, 1000)
    assert common_factor(420 * milli * A, 350 * milli * B) == common_factor(420 * A, 350 * B) * milli == 70 * milli
    assert common_factor(420 * milli * A, 350 * milli * A * B) == 70 * milli * A
    assert common_factor(A / 3, sp.Rational(1234567, 10**6) * B) == 1


def test_a_fraction_stands_where_there_are_fewer_products() -> None:
    """In millimetres 180 a - b + 20800, in metres 9/50 a - b + 13/625; half of a sum stays."""
    in_metres = sp.Rational(9, 50) * A - B + sp.Rational(13, 625)
    assert factored(in_metres) == in_metres
    assert factored((A + B) / 2).as_coeff_Mul() == (sp.Rational(1, 2), A + B)


def test_no_factors_are_sought_of_dozens_of_symbols(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two sums of sixty symbols: to factor their product takes minutes."""
    many = [real(f"work_{k}") for k in range(60)]
    product = sp.expand(sp.Add(*many) * sp.Add(*many[::2]) * 6)
    monkeypatch.setattr("derive.algebra.normal_form.sp.factor", None)
    assert factors_of(product) == (6, sp.expand(product / 6))
    assert factored(product) == product


def test_polynomials_without_a_common_factor_are_told_apart_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two sums of thirty products of thirty symbols: their divisor takes minutes where it is searched for."""
    many = [real(f"work_{k}") for k in range(30)]
    first = sp.Add(*[many[k] * many[(k + 7) % 30] ** 2 for k in range(30)])
    second = sp.Add(*[many[k] ** 2 * many[(3 * k + 5) % 30] for k in range(30)])
    monkeypatch.setattr(rings.sp, "gcd", None)
    assert common_factor(2 * first, 4 * second) == 2


@pytest.mark.parametrize(
    ("value", "may_be"),
    [
        ((A + B) ** 2, True),
        (A**2 + B**2, False),
        (A**2 * (1 - cosine(Q) ** 2), True),
        (-((A + B) ** 2), False),
        (4 * A**2 / 9, True),
        (2 * A**2, False),
    ],
)
def test_squares_are_seen_in_numbers(value: sp.Expr, may_be: bool) -> None:
    assert may_be_square(sp.expand(value), (Q,)) is may_be


def test_factors_are_kept_with_their_work() -> None:
    assert factored(A**2 - B**2) == (A - B) * (A + B)
