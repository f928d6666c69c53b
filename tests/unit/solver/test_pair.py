"""Pair: two equations, linear in the cosine and sine of one angle, have one root."""

from math import cos, sin

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from derive.ir.program import Status
from derive.ir.symbols import real
from derive.solver.subproblems.pair import pair
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

U, W, V = real("u"), real("w"), real("v")
A, B, E, F = (real(n) for n in "abef")
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
    """The root solves both equations, for each kind of pair."""
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
    """The conditioning of a rotation is the length of the vector that it rotates."""
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
    """A vector of length one always determines its angle, and nothing is divided."""
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
    """The rule takes no pair of another form."""
    assert answers(pair, problem(first, second, angles=(U, W), lengths=(V,))) == []


def test_three_equations_are_three_pairs() -> None:
    """The rule offers every pair of equations that it can solve."""
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
