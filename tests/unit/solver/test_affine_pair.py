"""Affine pair: two lengths in two equations have one solution where the determinant never vanishes."""

from __future__ import annotations

import pytest
import sympy as sp
from hypothesis import given

from derive.ir.program import (
    Status,
)
from derive.ir.symbols import (
    real,
)
from derive.solver.subproblems.affine_pair import affine_pair
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

V, W, U, TURN = (real(n) for n in ("v", "w", "u", "turn"))
A, B = real("a"), real("b")
K, L = (sp.Symbol(n, positive=True) for n in "kl")

TABLE = problem(
    V * sp.cos(TURN) - W * sp.sin(TURN) - A, V * sp.sin(TURN) + W * sp.cos(TURN) - B, lengths=(V, W), known=(TURN,)
)
BELTS = problem(K * V - L * W - A, L * V + K * W - B, lengths=(V, W))


@few
@given(turn=ANGLES, a=NUMBERS, b=NUMBERS, k=LENGTHS, link=LENGTHS)
def test_the_root(turn: float, a: float, b: float, k: float, link: float) -> None:
    """The root solves both equations to rounding."""
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
    """The rule takes no pair of another form."""
    assert answers(affine_pair, problem(first, second, angles=(U,), lengths=(V, W))) == []
