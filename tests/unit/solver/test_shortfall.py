"""The missing amount where a two-root step has no root, against the triangle that does not close."""

import sympy as sp
from hypothesis import assume, given
from hypothesis import strategies as st

from derive.ir.constants import DEGREE
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Root, larger
from derive.ir.program import Let, Output
from derive.ir.reason import Reason, Unit, Why
from derive.ir.symbols import real
from derive.solver.subproblems.shortfall import cannot_reach, out_of_reach

LENGTH = st.floats(1.0, 500.0)
SIGNED = LENGTH | LENGTH.map(lambda v: -v)
FIRST, SECOND, ROD = (sp.Symbol(n, positive=True) for n in ("first", "second", "rod"))
LEFT, RIGHT, X, Y = (real(n) for n in ("left", "right", "x", "y"))
REACH = sp.Symbol("reach", positive=True)
Q = real("q")


def value(reason: Reason, **values: float) -> float:
    """The amount at numbers."""
    assert reason.amount is not None
    found, _ = run(normalise("amount", [], [Output("amount", reason.amount)]), values)
    return float(found["amount"])


def triangle(first: sp.Expr, second: sp.Expr, third: sp.Expr) -> sp.Expr:
    """Heron's product: negative where three lengths close no triangle."""
    return (first + second - third) * (first + second + third) * (first - second + third) * (second + third - first)


@given(LENGTH, LENGTH, LENGTH)
def test_the_third_side_is_so_much_too_long_or_too_short(first: float, second: float, reach: float) -> None:
    """The missing amount of a triangle that does not close is the length by which its third side is too long or too
    short.
    """
    missing = max(reach - first - second, abs(first - second) - reach)
    assume(missing > 1e-6)
    reason = out_of_reach(Q, triangle(FIRST, SECOND, REACH), [])
    assert (reason.why, reason.unit, reason.subject.name) == (Why.OUT_OF_REACH, Unit.LENGTH, "q")
    assert abs(value(reason, first=first, second=second, reach=reach) - missing) < 1e-9 * (first + second + reach)


@given(SIGNED, SIGNED, LENGTH)
def test_whatever_signs_the_lengths_have(left: float, right: float, reach: float) -> None:
    """The missing amount does not depend on the signs of the lengths."""
    missing = max(reach - abs(left) - abs(right), abs(abs(left) - abs(right)) - reach)
    assume(missing > 1e-6)
    reason = out_of_reach(Q, triangle(LEFT, RIGHT, REACH), [])
    assert abs(value(reason, left=left, right=right, reach=reach) - missing) < 1e-9 * (abs(left) + abs(right) + reach)


def test_the_amount_is_the_larger_of_two_differences() -> None:
    """The amount of a triangle is written as one would write it by hand, with the distance to reach alone."""
    first, second, reach = (real(n) for n in ("first", "second", "reach"))
    reason = out_of_reach(Q, triangle(FIRST, SECOND, reach), [Let(reach, Root(X**2 + Y**2))])
    assert reason.amount == larger(reach - first - second, sp.Abs(first - second) - reach)


@given(SIGNED, st.floats(0.0, 800.0))
def test_a_length_is_so_much_too_short_for_another(left: float, reach: float) -> None:
    """Where a length of either sign does not fit beside another, the difference of their sizes is missing."""
    assume(abs(left) > reach + 1e-6)
    reason = out_of_reach(Q, (REACH - LEFT) * (REACH + LEFT), [])
    assert abs(value(reason, left=left, reach=reach) - (abs(left) - reach)) < 1e-9 * abs(left)


def test_a_product_that_is_no_triangle_has_no_amount() -> None:
    """Four sums of lengths that are not Heron's have no amount, rather than a wrong one."""
    reason = out_of_reach(Q, (FIRST - SECOND) * (FIRST + SECOND) * (FIRST - REACH) * (FIRST + REACH), [])
    assert (reason.amount, reason.unit) == (None, Unit.NONE)


@given(LENGTH, st.floats(-800.0, 800.0), st.floats(-800.0, 800.0))
def test_a_rod_would_have_to_be_so_much_longer(rod: float, x: float, y: float) -> None:
    """The missing amount of a rod that does not reach is the length that it lacks."""
    assume(x * x + y * y > (rod + 1e-3) ** 2)
    reason = cannot_reach("rod 1", sp.factor(ROD**2 - X**2 - Y**2), [])
    assert reason.words == "rod 1 cannot reach"
    assert abs(value(reason, rod=rod, x=x, y=y) - ((x * x + y * y) ** 0.5 - rod)) < 1e-6


@given(LENGTH, st.floats(-800.0, 800.0), st.sampled_from([1, -1]), st.sampled_from([1, -1]))
def test_in_whatever_signs_the_factors_are_written(rod: float, x: float, first: int, second: int) -> None:
    """The missing amount does not depend on the signs of the factors of the radicand."""
    assume(abs(x) > rod + 1e-3)
    radicand = sp.Mul(first * second, first * (ROD - X), second * (ROD + X), evaluate=False)
    assert abs(value(cannot_reach("rod 1", radicand, []), rod=rod, x=x) - (abs(x) - rod)) < 1e-9 * abs(x)


@given(LENGTH, LENGTH.map(lambda v: v + 1.0), st.floats(-0.8, 0.8), st.floats(1.1e-3, 500.0), st.booleans())
def test_a_rod_in_a_product_that_has_a_name(arm: float, rod: float, share: float, gap: float, is_inside: bool) -> None:
    """The third side is the rod's projection on the plane of the arm, sqrt(rod^2 - aside^2), under a name. The rod
    lacks the gap between that and the difference of the other two sides, whichever of these is the longer one.
    """
    aside = rod * share
    square = rod * rod - aside * aside
    arm, distance = (arm + square**0.5 + gap, arm) if is_inside else (arm, arm + square**0.5 + gap)
    third = real("third_square")
    radicand = (third - (FIRST - SECOND) ** 2) * ((FIRST + SECOND) ** 2 - third)
    reason = out_of_reach(Q, radicand, [Let(third, (ROD - X) * (ROD + X))])
    needed = ((distance - arm) ** 2 + aside * aside) ** 0.5
    assert reason.amount is not None and third in reason.amount.free_symbols
    assert abs(value(reason, first=arm, second=distance, rod=rod, third_square=square) - abs(needed - rod)) < 1e-6


def test_what_is_no_length_has_no_amount() -> None:
    """A radicand without a length as factor gives a reason without an amount."""
    reason = out_of_reach(Q, 4 * DEGREE * X * Y, [])
    assert (reason.amount, reason.unit) == (None, Unit.NONE)
