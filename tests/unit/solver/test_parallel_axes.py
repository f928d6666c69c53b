"""Parallel axes: a sum of angles takes the place of one of them, which follows at the end."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from derive.algebra.angle_sums import symbol_of_sum
from derive.algebra.normal_form import polynomial
from derive.equations.known_turns import Side, joints_of
from derive.equations.problem import Problem
from derive.geometry.frames import Factor, Motion
from derive.ir.symbols import cosine, real
from derive.solver.parallel_axes import Sum, candidate_sums, resolve, substitute
from tests.unit.solver.execution import ANGLES, angle_of, at, distance, execute, few, problem, reference, trigonometry

A1, A2, A3 = ANGLE_NAMES = tuple(real(n) for n in ("a1", "a2", "a3"))
X, Y = real("x"), real("y")
L = sp.Symbol("link", positive=True)

CLOSURE = problem(
    L * sp.cos(A1) + sp.cos(A1 + A2) - X, sp.sin(A1 + A2 + A3) - Y, L * sp.sin(A3 - A1) + A2 - X, angles=ANGLE_NAMES
)
SUMS = {
    "a1 + a2": (((A1, 1), (A2, 1)), A2),
    "a1 + a2 + a3": (((A1, 1), (A2, 1), (A3, 1)), A3),
    "a2 - a1": (((A1, -1), (A2, 1)), A2),
    "a1 - a2 - a3": (((A1, 1), (A2, -1), (A3, -1)), A3),
    "-a1 - a2": (((A1, -1), (A2, -1)), A1),
}


def the_sum(name: str) -> Sum:
    terms, replaced = SUMS[name]
    return Sum(real("total"), terms, replaced)


def total_of(name: str, turns: tuple[float, ...]) -> float:
    angles = dict(zip(ANGLE_NAMES, turns, strict=True))
    return sum(angles[a] * sign for a, sign in SUMS[name][0])


@few
@pytest.mark.parametrize("name", SUMS)
@given(turns=st.tuples(ANGLES, ANGLES, ANGLES), x=ANGLES, y=ANGLES, link=ANGLES)
def test_the_same_equations(name: str, turns: tuple[float, ...], x: float, y: float, link: float) -> None:
    total = the_sum(name)
    changed = substitute(CLOSURE, total)
    values = {"a1": turns[0], "a2": turns[1], "a3": turns[2], "x": x, "y": y, "link": link}
    named = trigonometry(total=total_of(name, turns), a1=turns[0], a2=turns[1], a3=turns[2])
    numbers = {k: np.asarray(v) for k, v in [*values.items(), *((s.name, v) for s, v in named.items())]}
    for before, after in zip(CLOSURE.equations, changed.equations, strict=True):
        assert abs(at(before.expression, numbers) - at(after.expression, numbers)) <= 1e-12


@pytest.mark.parametrize("name", SUMS)
def test_the_replaced_angle_leaves_all_but_plain_equations(name: str) -> None:
    total = the_sum(name)
    changed = substitute(CLOSURE, total)
    assert total.replaced not in changed.angles
    assert total.replaced in changed.pending
    assert total.symbol in changed.angles
    holding = [e for e in changed.equations if total.replaced in changed.unknowns_of(e.expression)]
    assert holding == [e for e in CLOSURE.equations if total.replaced in e.expression.free_symbols]


def test_what_holds_the_sum_alone_becomes_one_unknown() -> None:
    changed = substitute(CLOSURE, the_sum("a1 + a2 + a3"))
    assert changed.unknowns_of(changed.equations[1].expression) == (real("total"),)


@few
@pytest.mark.parametrize("name", SUMS)
@given(turns=st.tuples(ANGLES, ANGLES, ANGLES))
def test_the_replaced_angle_follows(name: str, turns: tuple[float, ...]) -> None:
    total = the_sum(name)
    solved = _with_unknowns(substitute(CLOSURE, total), ())
    binding = resolve(solved, total)
    assert binding is not None
    assert binding.unknowns == (total.replaced,)
    known = trigonometry(total=total_of(name, turns), a1=turns[0], a2=turns[1], a3=turns[2])
    others = {s: v for s, v in known.items() if not s.name.endswith(total.replaced.name)}
    values, _ = execute(binding.statements, others)
    assert distance(angle_of(values, total.replaced), turns[ANGLE_NAMES.index(total.replaced)]) <= 1e-13


@pytest.mark.parametrize("missing", [real("total"), A1, A2])
def test_it_waits_for_all_others(missing: sp.Symbol) -> None:
    total = the_sum("a1 + a2 + a3")
    assert resolve(_with_unknowns(substitute(CLOSURE, total), (missing,)), total) is None


def _with_unknowns(given_problem: Problem, angles: tuple[sp.Symbol, ...]) -> Problem:
    return Problem(**{**vars(given_problem), "angles": angles})


def test_the_reference_of_a_sum_is_the_sum_of_the_references() -> None:
    free = substitute(CLOSURE, the_sum("a1 - a2 - a3")).references[real("total")]
    assert sp.expand(free - (reference(A1) - reference(A2) - reference(A3))) == 0


def test_candidates() -> None:
    """Arguments with several unknown angles first, then differences; a fixed rotation of the base does not matter."""
    arguments = [A1, A1 + A2, A1 + A2 + A3 + sp.pi / 6]
    found = candidate_sums(CLOSURE, arguments)
    assert [t.symbol.name for t in found] == ["a12", "a123", "a23"]
    assert [t.replaced for t in found] == [A2, A3, A3]
    assert found[0].symbol == symbol_of_sum(((A1, 1), (A2, 1)))


def test_known_angles_make_no_sum() -> None:
    known = _with_unknowns(CLOSURE, (A2,))
    assert candidate_sums(known, [A1 + A2, A2, 2 * A2]) == ()


def test_a_sum_that_is_solved_names_itself() -> None:
    """The sine and the cosine of the sum are unknowns with names of their own."""
    changed = substitute(CLOSURE, the_sum("a1 + a2"))
    assert cosine(real("total")) in changed.atoms()
    assert polynomial(sp.cos(real("total")), changed.units, ()) == cosine(real("total"))


def names_of_sums(*arguments: sp.Expr, angles: tuple[sp.Symbol, ...] = ANGLE_NAMES) -> list[str]:
    given_problem = problem(sp.sin(A1) - Y, angles=angles)
    return [total.symbol.name for total in candidate_sums(given_problem, arguments)]


def test_a_known_angle_is_no_term_of_a_sum() -> None:
    """A joint that is held, or a fixed rotation of the base."""
    assert names_of_sums(A1 + A2 + A3, angles=(A1, A3)) == ["a13"]
    assert names_of_sums(A1 + A2 + sp.pi / 6) == ["a12"]


def test_a_sum_of_which_every_term_is_subtracted_is_the_negative_of_one_with_the_name() -> None:
    (total,) = candidate_sums(problem(sp.sin(A1) - Y, angles=ANGLE_NAMES), [-A2 - A3])
    assert (total.symbol.name, total.terms) == ("a23", ((A2, 1), (A3, 1)))


@few
@given(turns=st.tuples(ANGLES, ANGLES, ANGLES))
def test_the_rest_of_a_sum_is_subtracted_as_a_whole(turns: tuple[float, float, float]) -> None:
    """a3 - a1 - a2 is known: the rest is -(a1 + a2), and cos_a12 means a1 + a2."""
    total = Sum(real("total"), ((A1, -1), (A2, -1), (A3, 1)), A3)
    binding = resolve(problem(X - Y, known=(A1, A2, real("total"))), total)
    assert binding is not None
    named = trigonometry(a1=turns[0], a2=turns[1], total=turns[2] - turns[0] - turns[1])
    values, _ = execute(binding.statements, named)
    assert distance(angle_of(values, A3), turns[2]) <= 1e-12
    assert distance(angle_of(values, real("a12")), turns[0] + turns[1]) <= 1e-12


def test_a_frame_behind_a_turn_that_a_sum_stands_in_is_named_by_its_joints() -> None:
    """Behind `a23 - a2`, and behind `a123 - a23` with a sum of sums, there are the joints A3 and A1."""
    turned = tuple(Factor(Motion.TURN, 1, angle) for angle in (A2, A3, A1))
    first = substitute(replace(CLOSURE, turns=turned), Sum(real("a23"), ((A2, 1), (A3, 1)), A3))
    second = substitute(first, Sum(real("a123"), ((real("a23"), 1), (A1, 1)), A1))
    assert [t.amount for t in second.turns] == [A2, real("a23") - A2, real("a123") - real("a23")]
    side, names = Side("from", "base"), []
    for turn in second.turns:
        side = side.behind(joints_of(second, turn), turn)
        names.append(side.suffix)
    assert names == ["_from_a2", "_from_a23", "_from_a231"]
