"""Trigonometric: a cos u + b sin u = e has two roots, told apart by the sign of the determinant."""

from dataclasses import dataclass

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from derive.equations.problem import Binding, Problem
from derive.ir.program import Status
from derive.ir.symbols import real
from derive.solver.subproblems.one_equation.trigonometric import trigonometric
from tests.unit.solver.execution import (
    ANGLES,
    ANYTHING,
    LENGTHS,
    NUMBERS,
    all_finite,
    angle_of,
    answer,
    answers,
    at,
    distance,
    execute,
    few,
    problem,
)

U, W, V = real("u"), real("w"), real("v")
SIGMA = real("sigma_u")
E = real("e")
L1, L2 = (sp.Symbol(f"link_{k}", positive=True) for k in (1, 2))
P, Q, REACH = real("p"), real("q"), real("reach")
SIGNS = st.sampled_from([1.0, -1.0])
MOST = (1 - 1e-6, 1 + 1e-6)


@dataclass(frozen=True)
class Kind:
    """A problem with its a, b and e, and the binding that solves it."""

    problem: Problem
    a: sp.Expr
    b: sp.Expr
    e: sp.Expr
    binding: Binding


def kind(a: sp.Expr, b: sp.Expr, e: sp.Expr) -> Kind:
    given_problem = problem(a * sp.cos(U) + b * sp.sin(U) - e, angles=(U,))
    return Kind(given_problem, a, b, e, answer(trigonometric, given_problem))


KINDS = {
    "cosine alone": kind(2 * L1 * L2, sp.Integer(0), E),
    "sine alone": kind(sp.Integer(0), L1, E),
    "negative sine": kind(sp.Integer(0), -L1, E),
    "negative cosine": kind(-L1 * L2, sp.Integer(0), E),
    "a fixed direction": kind(L1 * sp.cos(sp.pi / 6), -L1 * sp.sin(sp.pi / 6), E),
    "any direction": kind(P, Q, E),
    "an arm and an offset": kind(2 * L1 * P, 2 * L1 * Q, E),
    "a factor of any sign": kind(L1 * P, L1 * P * Q, E),
    "any factor": kind(P, sp.Integer(0), E),
    "law of cosines": kind(2 * L1 * P, 2 * L1 * Q, REACH**2 - L1**2 - P**2 - Q**2),
    "sums": kind(L1 + L2, L1 - L2, E),
}


def solved(case: Kind, values: dict[sp.Symbol, float], sigma: float) -> tuple[dict[str, np.ndarray], Status]:
    return execute(case.binding.statements, {**values, SIGMA: sigma})


def amplitude(case: Kind, values: dict[sp.Symbol, float]) -> float:
    return float(np.hypot(*(at(v, {s.name: np.asarray(x) for s, x in values.items()}) for v in (case.a, case.b))))


def machine(link_1: float, link_2: float, p: float, q: float) -> dict[sp.Symbol, float]:
    return {L1: link_1, L2: link_2, P: p, Q: q, sp.Symbol("scale"): link_1 + link_2}


@pytest.mark.long
@few
@pytest.mark.parametrize("name", [n for n in KINDS if n != "law of cosines"])
@given(link_1=LENGTHS, link_2=LENGTHS, p=NUMBERS, q=NUMBERS, u=ANGLES)
def test_both_roots(name: str, link_1: float, link_2: float, p: float, q: float, u: float) -> None:
    case = KINDS[name]
    values = machine(link_1, link_2, p, q)
    named = {s.name: np.asarray(v) for s, v in values.items()}
    a, b = at(case.a, named), at(case.b, named)
    h = np.hypot(a, b)
    values[E] = a * np.cos(u) + b * np.sin(u)
    middle, half = np.arctan2(b, a), np.arccos(np.clip(values[E] / h if h else 1.0, -1, 1))
    roots = {}
    for sigma in (1.0, -1.0):
        found, status = solved(case, values, sigma)
        if h < 1e-8 * link_1 * max(1.0, link_1):  # refused as too short, or nearly
            assert all_finite(found)
            return
        assert status is Status.OK
        cos_u, sin_u = found["cos_u"], found["sin_u"]
        assert abs(cos_u**2 + sin_u**2 - 1) <= 1e-11
        assert abs(a * cos_u + b * sin_u - values[E]) <= 1e-13 * h
        assert case.binding.determinant is not None
        determinant = at(case.binding.determinant.value, found)
        assert sigma * determinant >= -1e-12 * h
        assert abs(abs(determinant) - h * np.sin(half)) <= 1e-6 * h
        roots[sigma] = angle_of(found, U)
    expected = [middle + half, middle - half]
    for root in expected:  # no true root is missing, and the two slots do not hold the same one
        assert min(distance(root, r) for r in roots.values()) <= 1e-6
    assert abs(distance(*roots.values()) - distance(*expected)) <= 1e-6


@given(link_1=LENGTHS, p=NUMBERS, q=NUMBERS, w=ANGLES, sigma=SIGNS)
def test_law_of_cosines(link_1: float, p: float, q: float, w: float, sigma: float) -> None:
    """The radicand stays a product of lengths: the squares of the offset are expressed by its length."""
    case = KINDS["law of cosines"]
    tip = link_1 + np.exp(1j * w) * complex(p, -q)
    found, status = solved(case, {**machine(link_1, 1.0, p, q), REACH: abs(tip)}, sigma)
    if np.hypot(p, q) < 1e-8 * link_1:
        assert all_finite(found)
        return
    assert status is Status.OK
    again = link_1 + np.exp(1j * angle_of(found, U)) * complex(p, -q)
    assert abs(abs(again) - abs(tip)) <= 1e-14 * (link_1 + np.hypot(p, q))


@pytest.mark.parametrize("name", ["cosine alone", "sine alone", "a fixed direction", "any direction", "sums"])
@pytest.mark.parametrize("side", [1, -1])
def test_the_boundary_belongs_to_the_workspace(name: str, side: int) -> None:
    """A right side that exceeds the amplitude by rounding is solved, and one that exceeds it by more is refused."""
    case = KINDS[name]
    values = machine(325.0, 225.0, -40.0, 30.0)
    h = amplitude(case, values)
    for excess, wanted in (
        (0.0, Status.OK),
        (4e-13, Status.OK),
        (1e-11, Status.UNREACHABLE),
        (5.0, Status.UNREACHABLE),
    ):
        both = [solved(case, {**values, E: side * h * (1 + excess)}, sigma) for sigma in (1.0, -1.0)]
        assert [status for _, status in both] == [wanted, wanted]
        assert distance(*(angle_of(found, U) for found, _ in both)) <= (1e-7 if excess == 0.0 else 1e-15)
        assert all(all_finite(found) for found, _ in both)
    inside = [angle_of(solved(case, {**values, E: side * h * (1 - 1e-9)}, sigma)[0], U) for sigma in (1.0, -1.0)]
    assert distance(*inside) == pytest.approx(2 * np.sqrt(2e-9), rel=1e-3)


@few
@pytest.mark.parametrize("factor", MOST)
@given(turn=ANGLES)
def test_what_is_too_short_cannot_be_aimed(factor: float, turn: float) -> None:
    case = KINDS["an arm and an offset"]
    short = 1e-9 * 300.0 * factor
    values = {**machine(300.0, 200.0, short * np.cos(turn), short * np.sin(turn)), E: 0.0}
    for sigma in (1.0, -1.0):
        found, status = solved(case, values, sigma)
        assert status is (Status.OK if factor > 1 else Status.UNREACHABLE)
        assert all_finite(found)


@few
@pytest.mark.parametrize("name", KINDS)
@given(link_1=st.floats(1e-3, 1e9), link_2=st.floats(1e-3, 1e9), p=ANYTHING, q=ANYTHING, e=ANYTHING, sigma=SIGNS)
def test_total(name: str, link_1: float, link_2: float, p: float, q: float, e: float, sigma: float) -> None:
    found, _ = solved(KINDS[name], {**machine(link_1, link_2, p, q), E: e, REACH: e}, sigma)
    assert all_finite(found)


def test_the_margin_needs_no_unit() -> None:
    """Where the amplitude is one of the machine's lengths, the determinant over its scale is a plain sine."""
    for name in ("cosine alone", "sine alone", "negative sine", "a fixed direction"):
        case = KINDS[name]
        assert case.binding.determinant is not None
        small, large = ({**machine(k * 3.0, k * 2.0, 0.0, 0.0), E: 0.0} for k in (1.0, 1000.0))
        margins = [
            at(case.binding.determinant.value / case.binding.determinant.scale, solved(case, v, 1.0)[0])
            for v in (small, large)
        ]
        assert margins == pytest.approx([1.0, 1.0])


@pytest.mark.parametrize(
    "expression",
    [
        sp.cos(U) * sp.sin(U) - E,
        sp.cos(U) ** 2 - E,
        sp.cos(U) - sp.cos(W),
        L1 * sp.cos(U) + U - E,
        L1 * sp.cos(U) + V,
        V * sp.cos(U) - E,
        V - E,
        L1 - E,
    ],
    ids=str,
)
def test_not_taken(expression: sp.Expr) -> None:
    assert answers(trigonometric, problem(expression, angles=(U, W), lengths=(V,))) == []
