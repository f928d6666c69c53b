"""Affine systems: lengths in as many equations have one solution where the determinant never vanishes."""

from dataclasses import replace

import pytest
import sympy as sp
from hypothesis import given

from derive.ir.program import Status
from derive.ir.symbols import cosine, real, sine
from derive.solver.subproblems.affine_system import affine_pair, affine_triple
from tests.unit.solver.execution import (
    ANGLES,
    LENGTHS,
    NUMBERS,
    answer,
    answers,
    at,
    execute,
    few,
    problem,
    trigonometry,
)

V, W, S, U, TURN = (real(n) for n in ("v", "w", "s", "u", "turn"))
A, B, C = (real(n) for n in "abc")
K, L = (sp.Symbol(n, positive=True) for n in "kl")

TABLE = problem(
    V * sp.cos(TURN) - W * sp.sin(TURN) - A, V * sp.sin(TURN) + W * sp.cos(TURN) - B, lengths=(V, W), known=(TURN,)
)
BELTS = problem(K * V - L * W - A, L * V + K * W - B, lengths=(V, W))


@pytest.mark.long
@few
@given(turn=ANGLES, a=NUMBERS, b=NUMBERS, k=LENGTHS, link=LENGTHS)
def test_the_root(turn: float, a: float, b: float, k: float, link: float) -> None:
    for given_problem in (TABLE, BELTS):
        known = {A: a, B: b, K: k, L: link, **trigonometry(turn=turn)}
        values, status = execute(answer(affine_pair, given_problem).statements, known)
        assert status is Status.OK
        for equation in given_problem.equations:
            assert abs(at(equation.expression, values)) <= 1e-12 * (abs(a) + abs(b))


@pytest.mark.parametrize(
    "first, second",
    [
        (V + W - A, 2 * V + 2 * W - B),
        (A * V + W - 1, V + B * W - 1),
        (V + W * K - A, V - B),
        (V * W - A, V + W - B),
        (V + sp.cos(U) - A, V + W - B),
    ],
)
def test_not_taken(first: sp.Expr, second: sp.Expr) -> None:
    assert answers(affine_pair, problem(first, second, angles=(U,), lengths=(V, W))) == []


LEAN = real("lean")
SLIDES = problem(
    V * sp.cos(TURN) - W * sp.sin(TURN) * sp.cos(LEAN) + S * sp.sin(TURN) * sp.sin(LEAN) - A,
    V * sp.sin(TURN) + W * sp.cos(TURN) * sp.cos(LEAN) - S * sp.cos(TURN) * sp.sin(LEAN) - B,
    W * sp.sin(LEAN) + S * sp.cos(LEAN) - C,
    lengths=(V, W, S),
    known=(TURN, LEAN),
)
"""Three slides that two turns carry: a trunnion."""


@pytest.mark.long
@few
@given(turn=ANGLES, lean=ANGLES, a=NUMBERS, b=NUMBERS, c=NUMBERS)
def test_three_lengths_that_a_rotation_carries(turn: float, lean: float, a: float, b: float, c: float) -> None:
    known = {A: a, B: b, C: c, **trigonometry(turn=turn, lean=lean)}
    values, status = execute(answer(affine_triple, SLIDES).statements, known)
    assert status is Status.OK
    for equation in SLIDES.equations:
        assert abs(at(equation.expression, values)) <= 1e-12 * (abs(a) + abs(b) + abs(c))


def test_three_lengths_whose_determinant_may_vanish_are_not_taken() -> None:
    given_problem = problem(V + W - A, W + S * A - B, V + S - C, lengths=(V, W, S))
    assert answers(affine_triple, given_problem) == []


def test_parameters_alone_may_decide_as_a_condition_on_the_machine() -> None:
    """Two slides that a fixed angle parts: with the angle a parameter its cosine is a condition, else nothing is
    taken.
    """
    rails = problem(V + W * sp.sin(LEAN) - A, V + W * sp.cos(LEAN) - B, lengths=(V, W), known=(LEAN,))
    assert answers(affine_pair, rails) == []
    skewed = replace(rails, fixed=(sine(LEAN), cosine(LEAN)))
    assert answer(affine_pair, skewed).conditions == (cosine(LEAN) - sine(LEAN),)
