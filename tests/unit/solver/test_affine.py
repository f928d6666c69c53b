"""Affine equations and systems: one root where the slope or the determinant never vanishes, else no rule."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from derive.ir.program import Let, Status
from derive.ir.symbols import cosine, real, sine
from derive.solver.subproblems.affine_system import (
    affine,
    affine_across,
    affine_along,
    affine_along_or_free,
    affine_pair,
    affine_triple,
)
from tests.unit.solver.execution import (
    ANGLES,
    ANYTHING,
    LENGTHS,
    NUMBERS,
    SCALE,
    all_finite,
    answer,
    answers,
    at,
    execute,
    few,
    problem,
    reference,
    trigonometry,
)

V, W, U, B, C, S, TURN, A, LEAN = map(real, ("v", "w", "u", "b", "c", "s", "turn", "a", "lean"))
K = sp.Symbol("k", positive=True)
S = sp.Symbol("s", real=True, nonzero=True)

MANY_TERMS = problem(K * V - B * C + C**2, lengths=(V,))
DIRECTED = problem(S * V + B, lengths=(V,), signs=(S,))


@given(k=LENGTHS, b=NUMBERS, c=NUMBERS)
def test_the_root(k: float, b: float, c: float) -> None:
    values, status = execute(answer(affine, MANY_TERMS).statements, {K: k, B: b, C: c})
    assert status is Status.OK
    residual = at(MANY_TERMS.equations[0].expression, values)
    assert abs(residual) <= 1e-14 * (abs(b * c) + c * c)
    assert abs(values["v"] - (b * c - c * c) / k) <= 1e-14 * (abs(b * c) + c * c) / k


@given(s=st.sampled_from([1.0, -1.0]), b=NUMBERS)
def test_a_direction_never_vanishes(s: float, b: float) -> None:
    """A coefficient that is a sign divides nothing: the root is exact."""
    values, _ = execute(answer(affine, DIRECTED).statements, {S: s, B: b})
    assert values["v"] == -b * s


def test_one_root_without_conditions() -> None:
    binding = answer(affine, MANY_TERMS)
    assert binding.unknowns == (V,)
    assert binding.determinant is binding.conditioning is None
    assert all(isinstance(s, Let) for s in binding.statements)


def test_every_equation_is_a_candidate() -> None:
    found = answers(affine, problem(2 * V - B, V * K - C, 3 * W + C, lengths=(V, W)))
    assert [b.unknowns for b in found] == [(V,), (V,), (W,)]


def test_a_name_stands_for_its_definition() -> None:
    name, long, short = real("name"), sp.Symbol("long", positive=True), sp.Symbol("short", positive=True)
    given_problem = problem(name * V - B, lengths=(V,))
    cannot = type(given_problem)(**{**vars(given_problem), "definitions": {name: long + short}})
    can = type(given_problem)(**{**vars(given_problem), "definitions": {name: long - short}})
    assert len(answers(affine, cannot)) == 1
    assert answers(affine, can) == []


@pytest.mark.parametrize(
    "expression",
    [B * V + C, (K - 1) * V + C, K * V + W, K * V**2 + C, K * V * W, V * sp.cos(U) + C, B + C, U - B, sp.cos(U) - C],
    ids=str,
)
def test_not_taken(expression: sp.Expr) -> None:
    assert answers(affine, problem(expression, angles=(U,), lengths=(V, W))) == []


@given(k=st.floats(1e-9, 1e9), b=ANYTHING, c=ANYTHING)
def test_total(k: float, b: float, c: float) -> None:
    values, _ = execute(answer(affine, MANY_TERMS).statements, {K: k, B: b, C: c})
    assert all_finite(values)


def test_along_a_direction() -> None:
    """A length along a known direction needs both equations: a direction along one axis is no exception."""
    turned = problem(sp.cos(U) * V - B, sp.sin(U) * V - C, lengths=(V,), known=(U,))
    binding = answer(affine_along, turned)
    assert binding.unknowns == (V,) and binding.determinant is None
    for angle in (0.0, 0.5, np.pi / 2, -2.0):
        named = {cosine(U): np.cos(angle), sine(U): np.sin(angle)}
        values, status = execute(binding.statements, {**named, B: 3 * np.cos(angle), C: 3 * np.sin(angle)})
        assert status is Status.OK
        assert abs(values["v"] - 3) <= 1e-15 * 4


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (2 * V - B, sp.sin(U) * V - C),
        (sp.cos(U) * V - B, B * V - C),
        (sp.cos(U) * V - W, sp.sin(U) * V - C),
        (sp.cos(U) * V**2 - B, sp.sin(U) * V - C),
        (sp.cos(U) * V - B, sp.Integer(3) * C),
    ],
    ids=("one alone", "no known size", "another unknown", "a square", "no unknown"),
)
def test_not_along_a_direction(first: sp.Expr, second: sp.Expr) -> None:
    """What one equation gives, or no combination of them, is left to other rules."""
    assert answers(affine_along, problem(first, second, lengths=(V, W), known=(U,))) == []


@pytest.mark.parametrize("angle", [0.3, -2.0, np.pi / 2], ids=str)
def test_across_a_direction(angle: float) -> None:
    """Slides whose directions may become parallel; where they are, the values nearest to the reference."""
    given_problem = problem(sp.cos(U) * V - B, sp.sin(U) * V + W - C, lengths=(V, W), known=(U,))
    binding = next(b for b in answers(affine_across, given_problem) if set(b.unknowns) == {V, W})
    assert binding.conditioning is not None and binding.conditioning.value == cosine(U)
    known = {cosine(U): np.cos(angle), sine(U): np.sin(angle), reference(V): 3.0, reference(W): 4.0, SCALE: 1.0}
    values, status = execute(binding.statements, {**known, B: 3 * np.cos(angle), C: 3 * np.sin(angle) + 5})
    assert status is Status.OK
    along, across = (values["v"], values["w"]) if angle != np.pi / 2 else (values["v"] - 0.5, values["w"] + 0.5)
    assert max(abs(along - 3), abs(across - 5)) <= 1e-14
    _, status = execute(binding.statements, {**known, B: 3 * np.cos(angle) + 0.1, C: 0.0})
    assert status is (Status.UNREACHABLE if angle == np.pi / 2 else Status.OK)


@pytest.mark.parametrize("angle", [0.3, -2.0, np.pi / 2], ids=str)
def test_along_a_direction_or_free(angle: float) -> None:
    """Where the direction vanishes the reference is kept, and the equations have to agree anywhere."""
    given_problem = problem(sp.cos(U) * V - B, 2 * sp.cos(U) * V - C, lengths=(V,), known=(U,))
    (binding,) = answers(affine_along_or_free, given_problem)
    known = {cosine(U): np.cos(angle), sine(U): np.sin(angle), reference(V): 7.0, SCALE: 1.0}
    values, status = execute(binding.statements, {**known, B: 3 * np.cos(angle), C: 6 * np.cos(angle)})
    assert status is Status.OK and abs(values["v"] - (7 if angle == np.pi / 2 else 3)) <= 1e-14
    for amounts in ({B: 3 * np.cos(angle) + 0.1, C: 6 * np.cos(angle)}, {B: 3 * np.cos(angle), C: 0.5}):
        assert execute(binding.statements, {**known, **amounts})[1] is Status.UNREACHABLE


def test_directions_alone_may_vanish() -> None:
    """A coefficient with a length in it is left to other rules: it has no scale to be compared with."""
    assert answers(affine_across, problem((B + 2) * V - C, lengths=(V,))) == []
    assert answers(affine_along_or_free, problem((B + 2) * V - C, B * V, lengths=(V,))) == []


FACTOR, L = (sp.Symbol(n, positive=True) for n in "kl")

TABLE = problem(
    V * sp.cos(TURN) - W * sp.sin(TURN) - A, V * sp.sin(TURN) + W * sp.cos(TURN) - B, lengths=(V, W), known=(TURN,)
)
BELTS = problem(FACTOR * V - L * W - A, L * V + FACTOR * W - B, lengths=(V, W))


@pytest.mark.long
@few
@given(turn=ANGLES, a=NUMBERS, b=NUMBERS, k=LENGTHS, link=LENGTHS)
def test_the_solution_of_a_system(turn: float, a: float, b: float, k: float, link: float) -> None:
    for given_problem in (TABLE, BELTS):
        known = {A: a, B: b, FACTOR: k, L: link, **trigonometry(turn=turn)}
        values, status = execute(answer(affine_pair, given_problem).statements, known)
        assert status is Status.OK
        for equation in given_problem.equations:
            assert abs(at(equation.expression, values)) <= 1e-12 * (abs(a) + abs(b))


@pytest.mark.parametrize(
    "first, second",
    [
        (V + W - A, 2 * V + 2 * W - B),
        (A * V + W - 1, V + B * W - 1),
        (V + W * FACTOR - A, V - B),
        (V * W - A, V + W - B),
        (V + sp.cos(U) - A, V + W - B),
    ],
)
def test_systems_that_are_not_taken(first: sp.Expr, second: sp.Expr) -> None:
    assert answers(affine_pair, problem(first, second, angles=(U,), lengths=(V, W))) == []


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
