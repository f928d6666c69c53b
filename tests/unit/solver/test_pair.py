"""Pairs of equations in the cosine and sine of one angle have one root; what is missing where two roots have none."""

from math import cos, sin

import numpy as np
import pytest
import sympy as sp
from hypothesis import assume, given
from hypothesis import strategies as st

from derive.ir.constants import DEGREE
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Root, larger
from derive.ir.program import Let, Output, Status
from derive.ir.reason import Reason, Unit, Why
from derive.ir.symbols import real
from derive.solver.subproblems.pair import pair
from derive.solver.subproblems.shortfall import cannot_reach, out_of_reach
from tests.unit.solver.execution import (
    ANGLES,
    ANYTHING,
    LENGTHS,
    NUMBERS,
    SCALE,
    all_finite,
    angle_of,
    answer,
    answers,
    distance,
    execute,
    few,
    problem,
    reference,
    trigonometry,
)

U, W, V, A, B, E, F, LEFT, RIGHT, X, Y, Q = map(
    real, ("u", "w", "v", "a", "b", "e", "f", "left", "right", "x", "y", "q")
)
L1, L2 = (sp.Symbol(f"link_{k}", positive=True) for k in (1, 2))
S = sp.Symbol("s", real=True, nonzero=True)
FREE = reference(U)

TURNED = problem(A * sp.cos(U) - B * sp.sin(U) - E, B * sp.cos(U) + A * sp.sin(U) - F, angles=(U,))
AGAINST = problem(A * sp.cos(U) + B * sp.sin(U) - E, B * sp.cos(U) - A * sp.sin(U) - F, angles=(U,))
DIRECTED = problem(
    A * sp.cos(U) - S * B * sp.sin(U) - E, B * sp.cos(U) + S * A * sp.sin(U) - F, angles=(U,), signs=(S,)
)
KINDS = {
    "turned": (TURNED, 1.0),
    "against": (AGAINST, -1.0),
    "directed": (DIRECTED, 1.0),
    "directed back": (DIRECTED, -1.0),
}


@few
@pytest.mark.parametrize("kind", KINDS)
@given(a=NUMBERS, b=NUMBERS, u=ANGLES, free=ANGLES)
def test_the_root(kind: str, a: float, b: float, u: float, free: float) -> None:
    given_problem, sense = KINDS[kind]
    right = complex(a, b) * np.exp(1j * sense * u)
    binding = answer(pair, given_problem)
    values, status = execute(
        binding.statements, {A: a, B: b, E: right.real, F: right.imag, S: sense, SCALE: 1.0, FREE: free}
    )
    assert status is Status.OK
    assert abs(np.hypot(values["cos_u"], values["sin_u"]) - 1) <= 1e-15
    is_free = abs(right) <= 2e-12
    assert distance(angle_of(values, U), free if is_free else u) <= 1e-14 or 1e-12 <= abs(right) <= 1e-9
    assert binding.determinant is None


@pytest.mark.parametrize("size, is_free", [(0.0, True), (1.999e-9, True), (2.001e-9, False)])
@pytest.mark.parametrize("free", [-7.0, 0.3, 3.0])
def test_a_vanishing_arm_leaves_the_reference(size: float, is_free: bool, free: float) -> None:
    """The threshold is 2e-12 of the machine's scale."""
    right = size * np.exp(1j * 0.7)
    values, status = execute(
        answer(pair, TURNED).statements, {A: size, B: 0.0, E: right.real, F: right.imag, SCALE: 1e3, FREE: free}
    )
    assert status is Status.OK
    assert distance(angle_of(values, U), free if is_free else 0.7) <= 1e-12


def test_the_conditioning_is_what_turns() -> None:
    conditioning = answer(pair, TURNED).conditioning
    assert conditioning is not None
    assert (conditioning.angle, conditioning.scale) == (U, SCALE)


HALVES = {
    "upper": (sp.sin(U), [(-0.5, 0.0), (0.5, 0.5), (3.0, 3.0), (3.5, np.pi), (0.5 + 6 * np.pi, 0.5)]),
    "right": (sp.cos(U), [(-0.5, -0.5), (1.5, 1.5), (2.0, np.pi / 2), (-3.0, -np.pi / 2), (0.5 - 4 * np.pi, 0.5)]),
}


@pytest.mark.parametrize("half", HALVES)
def test_the_reference_stays_on_the_half_circle_of_the_machine(half: str) -> None:
    """A free angle takes the reference, moved onto the half circle of the machine."""
    positive, cases = HALVES[half]
    excluded = problem(*(e.expression for e in TURNED.equations), angles=(U,), positive=(positive,))
    for free, wanted in cases:
        values, _ = execute(answer(pair, excluded).statements, {A: 0.0, B: 0.0, E: 0.0, F: 0.0, SCALE: 1.0, FREE: free})
        assert distance(angle_of(values, U), wanted) <= 1e-14


@few
@given(w=ANGLES, u=ANGLES)
def test_an_arm_of_length_one_has_no_degenerate_case(w: float, u: float) -> None:
    known = problem(sp.cos(U + W) - E, sp.sin(U + W) - F, angles=(U,), known=(W,))
    binding = answer(pair, known)
    assert binding.conditioning is None
    values, status = execute(binding.statements, {**trigonometry(w=w), E: cos(u + w), F: sin(u + w)})
    assert status is Status.OK
    assert distance(angle_of(values, U), u) <= 1e-14


@few
@given(link_1=LENGTHS, link_2=LENGTHS, b=NUMBERS, u=ANGLES)
def test_cramer(link_1: float, link_2: float, b: float, u: float) -> None:
    """Rows that are no rotated vector, with a determinant that never vanishes: two lengths of the machine."""
    oblique = problem(L1 * sp.cos(U) - E, B * sp.cos(U) + L2 * sp.sin(U) - F, angles=(U,))
    binding = answer(pair, oblique)
    assert binding.conditioning is binding.determinant is None
    right = {E: link_1 * cos(u), F: b * cos(u) + link_2 * sin(u)}
    values, _ = execute(binding.statements, {L1: link_1, L2: link_2, B: b, **right})
    assert abs(values["cos_u"] - cos(u)) <= 1e-14
    assert abs(values["sin_u"] - sin(u)) <= 1e-14 * (1 + abs(b) / link_2)


@pytest.mark.parametrize(
    "first, second",
    [
        (A * sp.cos(U) - E, B * sp.sin(U) - F),
        (sp.cos(U) - E, A * sp.sin(U) - F),
        (A * sp.cos(U) - B * sp.sin(U) - E, A * sp.cos(U) + B * sp.sin(U) - F),
        (sp.cos(U) - E, 2 * sp.cos(U) - F),
        (sp.cos(U) - E, sp.sin(U) ** 2 - F),
        (sp.cos(U) - V, sp.sin(U) - F),
        (sp.cos(U) - E, sp.sin(W) - F),
        (sp.cos(U + W) - E, sp.sin(U + W) - F),
        (sp.cos(U) - E, sp.sin(U) + U - F),
    ],
    ids=lambda e: str(e),
)
def test_not_taken(first: sp.Expr, second: sp.Expr) -> None:
    assert answers(pair, problem(first, second, angles=(U, W), lengths=(V,))) == []


def test_three_equations_are_three_pairs() -> None:
    assert len(answers(pair, problem(sp.cos(U) - E, sp.sin(U) - F, sp.cos(U) - 2 * sp.sin(U) - A, angles=(U,)))) == 3


@pytest.mark.parametrize("kind", KINDS)
@given(a=ANYTHING, b=ANYTHING, e=ANYTHING, f=ANYTHING, free=ANYTHING, scale=st.floats(1e-9, 1e9))
def test_total(kind: str, a: float, b: float, e: float, f: float, free: float, scale: float) -> None:
    """Also where the right side is not as long as the arm: the status of another statement says so."""
    given_problem, sense = KINDS[kind]
    values, _ = execute(
        answer(pair, given_problem).statements, {A: a, B: b, E: e, F: f, S: sense, SCALE: scale, FREE: free}
    )
    assert all_finite(values)


LENGTH = st.floats(1.0, 500.0)
SIGNED = LENGTH | LENGTH.map(lambda v: -v)
FIRST, SECOND, ROD = (sp.Symbol(n, positive=True) for n in ("first", "second", "rod"))
REACH = sp.Symbol("reach", positive=True)


def value(reason: Reason, **values: float) -> float:
    assert reason.amount is not None
    found, _ = run(normalise("amount", [], [Output("amount", reason.amount)]), values)
    return float(found["amount"])


def triangle(first: sp.Expr, second: sp.Expr, third: sp.Expr) -> sp.Expr:
    """Heron's product: negative where three lengths close no triangle."""
    return (first + second - third) * (first + second + third) * (first - second + third) * (second + third - first)


@given(LENGTH, LENGTH, LENGTH)
def test_the_third_side_is_so_much_too_long_or_too_short(first: float, second: float, reach: float) -> None:
    missing = max(reach - first - second, abs(first - second) - reach)
    assume(missing > 1e-6)
    reason = out_of_reach(Q, triangle(FIRST, SECOND, REACH), [])
    assert (reason.why, reason.unit, reason.subject.name) == (Why.OUT_OF_REACH, Unit.LENGTH, "q")
    assert abs(value(reason, first=first, second=second, reach=reach) - missing) < 1e-9 * (first + second + reach)


@given(SIGNED, SIGNED, LENGTH)
def test_whatever_signs_the_lengths_have(left: float, right: float, reach: float) -> None:
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
    assume(abs(left) > reach + 1e-6)
    reason = out_of_reach(Q, (REACH - LEFT) * (REACH + LEFT), [])
    assert abs(value(reason, left=left, reach=reach) - (abs(left) - reach)) < 1e-9 * abs(left)


def test_a_product_that_is_no_triangle_has_no_amount() -> None:
    reason = out_of_reach(Q, (FIRST - SECOND) * (FIRST + SECOND) * (FIRST - REACH) * (FIRST + REACH), [])
    assert (reason.amount, reason.unit) == (None, Unit.NONE)


@given(LENGTH, st.floats(-800.0, 800.0), st.floats(-800.0, 800.0))
def test_a_rod_would_have_to_be_so_much_longer(rod: float, x: float, y: float) -> None:
    assume(x * x + y * y > (rod + 1e-3) ** 2)
    reason = cannot_reach("rod 1", sp.factor(ROD**2 - X**2 - Y**2), [])
    assert reason.words == "rod 1 cannot reach"
    assert abs(value(reason, rod=rod, x=x, y=y) - ((x * x + y * y) ** 0.5 - rod)) < 1e-6


@given(LENGTH, st.floats(-800.0, 800.0), st.sampled_from([1, -1]), st.sampled_from([1, -1]))
def test_in_whatever_signs_the_factors_are_written(rod: float, x: float, first: int, second: int) -> None:
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
    reason = out_of_reach(Q, 4 * DEGREE * X * Y, [])
    assert (reason.amount, reason.unit) == (None, Unit.NONE)
