"""Eliminations: every solution of the equations solves the new ones, too, which have fewer unknowns."""

from collections.abc import Callable, Mapping

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from derive.equations.problem import Equation, Problem
from derive.ir.symbols import real
from derive.solver.eliminations import differences, squares
from tests.unit.solver.execution import ANGLES, NUMBERS, at, execute, few, problem, trigonometry

A1, A2, W = ANGLE_NAMES = tuple(real(n) for n in ("a1", "a2", "w"))
P, Q = real("p"), real("q")
X, Y, Z = (real(n) for n in "xyz")
L1, L2, K = (sp.Symbol(n, positive=True) for n in ("link_1", "link_2", "k"))
Given = tuple[Problem, Mapping[str, sp.Expr]]


def closure(**sides: sp.Expr) -> Given:
    """Equations side - x = 0, by the names of their right sides."""
    expressions = [side - real(name) for name, side in sides.items()]
    return problem(*expressions, angles=(A1, A2), lengths=(P, Q), known=(W,)), sides


ARM = closure(x=L1 * sp.cos(A1) + L2 * sp.cos(A1 + A2), y=L1 * sp.sin(A1) + L2 * sp.sin(A1 + A2))
ABSOLUTE = closure(x=L1 * sp.cos(A1) - L2 * sp.sin(A2), y=L1 * sp.sin(A1) + L2 * sp.cos(A2))
TURNED_BASE = closure(
    x=L1 * sp.cos(A1 + W) + L2 * sp.cos(A1 + A2 + W), y=L1 * sp.sin(A1 + W) + L2 * sp.sin(A1 + A2 + W)
)
BELTS = closure(x=2 * P - 3 * Q, y=K * P + Q, z=P + L1 * sp.cos(A1))
TABLE = closure(x=P * sp.cos(W) - Q * sp.sin(W), y=P * sp.sin(W) + Q * sp.cos(W))
RAIL = closure(x=P + L1 * sp.cos(A1), y=2 * P + L1 * sp.sin(A1))


def residual(case: Given, equation: Equation, **numbers: float) -> float:
    """The equation at a configuration that solves the case: x, y and z are what they then are."""
    _, sides = case
    angles = {n: numbers[n] for n in ("a1", "a2", "w")}
    values = {n: np.asarray(v) for n, v in numbers.items()}
    right = {real(n): at(side, values) for n, side in sides.items()}
    given_values = {**trigonometry(**angles), **{real(n): v for n, v in numbers.items()}, **right}
    named, _ = execute(equation.lets, given_values)
    return at(equation.expression, named)


@few
@pytest.mark.parametrize(
    "case, elimination, count",
    [
        (ARM, squares, 1),
        (TURNED_BASE, squares, 1),
        (BELTS, differences, 4),
        (TABLE, differences, 2),
        (RAIL, differences, 1),
    ],
    ids=["arm", "turned base", "belts", "turntable", "rail"],
)
@given(
    a1=ANGLES,
    a2=ANGLES,
    w=ANGLES,
    p=NUMBERS,
    q=NUMBERS,
    link_1=st.floats(1, 9),
    link_2=st.floats(1, 9),
    k=st.floats(1, 9),
)
def test_solutions_are_kept(
    case: Given, elimination: Callable[[Problem], tuple[Equation, ...]], count: int, **numbers: float
) -> None:
    found = elimination(case[0])
    assert len(found) == count
    size = 1 + max(abs(v) for v in numbers.values())
    for equation in found:
        assert abs(residual(case, equation, **numbers)) <= 1e-12 * size**2


def unknowns(case: Given, elimination: Callable[[Problem], tuple[Equation, ...]]) -> list[tuple[sp.Symbol, ...]]:
    return [case[0].unknowns_of(e.expression) for e in elimination(case[0])]


def test_a_difference_loses_a_length() -> None:
    assert unknowns(BELTS, differences) == [(Q,), (P,), (Q, A1), (Q, A1)]
    assert unknowns(TABLE, differences) == [(Q,), (P,)]
    assert unknowns(RAIL, differences) == [(A1,)]


def test_squares_lose_an_angle() -> None:
    assert unknowns(ARM, squares) == unknowns(TURNED_BASE, squares) == [(A2,)]


def test_squares_that_lose_nothing_are_no_consequence() -> None:
    """The squares depend on both absolute angles: their difference must become the unknown first."""
    assert unknowns(ABSOLUTE, squares) == []


def test_nothing_follows_without_a_known_side() -> None:
    assert squares(problem(L1 * sp.cos(A1) + L2 * sp.cos(A2), L1 * sp.sin(A1) - Y, angles=(A1, A2))) == ()


def test_a_plain_unknown_is_not_squared() -> None:
    assert squares(problem(P + sp.cos(A1) - X, sp.sin(A1) - Y, angles=(A1,), lengths=(P,))) == ()


def test_no_difference_by_an_unknown_factor() -> None:
    assert differences(problem(P * sp.cos(A1) - X, P * sp.sin(A1) - Y, angles=(A1,), lengths=(P,))) == ()
