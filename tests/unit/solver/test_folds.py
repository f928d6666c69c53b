"""Folds and sweeps, on small derivations.

An angle v points an arm at a point, and a later step needs |e| <= size with e = p cos v + q sin v. Near the fold v
turns until e is within its size, if its own equation then holds to rounding. It stays where e is within its size, where
the turn would be more than rounding, and far from the fold.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import numpy as np
import sympy as sp
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from derive.equations.problem import Conditioning, Equation, Problem, StepDeterminant
from derive.ir.constants import FOLD, ROUNDING
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Root
from derive.ir.program import Let, Output, Program, Statement
from derive.ir.symbols import cosine, real, sine
from derive.solver.corners.folds import beyond_folds
from derive.solver.subproblems.direction import direction
from derive.solver.subproblems.one_equation.trigonometric import trigonometric

V, U, X, Y, BESIDE = (real(n) for n in ("v", "u", "x", "y", "beside"))
P, Q, SIZE, LEVEL = (real(n) for n in ("p", "q", "size", "level"))
X1, X2, Y1, Y2, NEEDED = (real(n) for n in ("x1", "x2", "y1", "y2", "needed"))
SCALE = sp.Symbol("scale", positive=True)
UNIT, ALLOWED = 1000.0, 1000.0 * float(ROUNDING)
"""The characteristic length, and the rounding error of a length."""
ROUNDED = 1e-15
"""The rounding error of v; of a u that v turns fast, a multiple of it."""
many = settings(max_examples=150)
ANGLES = st.floats(-3.1, 3.1)
SIDES = st.sampled_from((1.0, -1.0))


def decades(lowest: float, highest: float) -> st.SearchStrategy[float]:
    """Numbers from every decade with the same probability."""
    return st.floats(lowest, highest).map(lambda x: 10.0**x)


def problem(*angles: sp.Symbol) -> Problem:
    return Problem(angles, (), (), (V, U), {V: real("free_v"), U: real("free_u")}, SCALE)


def aimed() -> tuple[tuple[Statement, ...], StepDeterminant]:
    """The two-root step: -sin v x + cos v y = beside."""
    equation = Equation("sideways", cosine(V) * Y - sine(V) * X - BESIDE)
    (binding,) = trigonometric(problem(V), (equation,))
    assert binding.determinant is not None and binding.determinant.legs is not None
    return binding.statements, binding.determinant


def program(statements: tuple[Statement, ...], *names: sp.Symbol) -> Program:
    own = (cosine(V), sine(V), NEEDED, real("ahead_v"), *names)
    return normalise("fold", statements, [Output(n.name, n) for n in own])


@cache
def turning(*, is_ruled: bool) -> Program:
    """The later step needs e = p cos v + q sin v."""
    statements, determinant = aimed()
    statements = (*statements, Let(NEEDED, P * cosine(V) + Q * sine(V)))
    later = StepDeterminant(real("sigma_w"), real("unused"), SCALE, reach=(SIZE, NEEDED))
    return program(beyond_folds(statements, (determinant, later), (), SCALE) if is_ruled else statements)


@cache
def sweeping(*, is_ruled: bool) -> Program:
    """Between them u is the direction of (x1 cos v + x2 sin v, y1 cos v + y2 sin v); e = level + p cos u + q sin u."""
    statements, determinant = aimed()
    along, across, radius = real("part_x"), real("part_y"), real("radius_u")
    statements = (
        *statements,
        Let(along, X1 * cosine(V) + X2 * sine(V)),
        Let(across, Y1 * cosine(V) + Y2 * sine(V)),
        Let(radius, Root(along**2 + across**2)),
        *direction(
            problem(U), U, along=along, across=across, conditioning=radius, note="", is_length=True, scale=sp.Integer(1)
        ),
        Let(NEEDED, LEVEL + P * cosine(U) + Q * sine(U)),
    )
    later = StepDeterminant(real("sigma_w"), real("unused"), SCALE, reach=(SIZE, NEEDED))
    conditionings = (Conditioning(U, radius, sp.Integer(1)),)
    ruled = beyond_folds(statements, (determinant, later), conditionings, SCALE)
    return program(ruled if is_ruled else statements, cosine(U), sine(U), radius)


Values = Mapping[str, float]


def outputs(chosen: Program, values: Values) -> Values:
    found, _ = run(chosen, {k: np.asarray(v) for k, v in values.items()})
    return {k: float(v) for k, v in found.items()}


def point(angle: float, ahead: float, beside: float) -> dict[str, float]:
    """The point at a distance ahead of an angle, and beside it."""
    c, s = np.cos(angle), np.sin(angle)
    return {"x": ahead * c - beside * s, "y": ahead * s + beside * c, "beside": beside, "scale": UNIT}


def left(values: Values, found: Values) -> float:
    """The residual of the step's own equation."""
    return abs(values["y"] * found["cos_v"] - values["x"] * found["sin_v"] - values["beside"])


@many
@given(ANGLES, decades(-13.0, -1.0), st.floats(1.0, 900.0), SIDES, st.floats(-0.8, 0.8), decades(-12.0, -2.0), SIDES)
def test_it_turns_to_where_the_later_step_reaches_within_rounding_and_no_farther(
    angle: float, share: float, beside: float, side: float, phase: float, turn: float, way: float
) -> None:
    """Near a fold the angle turns to the nearest value at which the later step has a solution, within rounding."""
    values = point(angle, side * share * UNIT, beside) | {"sigma_v": side, "free_v": 0.0, "size": 0.0}
    slope_at = angle + phase  # e = sin(v - slope_at + ...) is steep there
    values |= {"p": -np.sin(slope_at), "q": np.cos(slope_at)}
    before = outputs(turning(is_ruled=False), values | {"sigma_v": side})
    assert left(values, before) < ALLOWED / 10.0
    own = np.arctan2(before["sin_v"], before["cos_v"])
    turn *= way
    values["size"] = abs(np.sin(own + turn - slope_at))
    assume(abs(before["needed"]) > values["size"] and before["needed"] * np.sin(own + turn - slope_at) > 0.0)
    found = outputs(turning(is_ruled=True), values)
    root = before["ahead_v"]
    cost = abs(beside * (1.0 - np.cos(turn)) + root * np.sin(turn))
    assert abs(np.hypot(found["cos_v"], found["sin_v"]) - 1.0) < 1e-14
    assert left(values, found) < 1.1 * ALLOWED
    if root**2 > 1.01 * float(FOLD) * UNIT**2 or cost > 2.0 * ALLOWED:
        assert found == before
    elif root**2 < 0.99 * float(FOLD) * UNIT**2 and cost < ALLOWED / 2.0:
        assert abs(found["needed"]) <= values["size"] + 2.0 * turn**2 + 1e-15
        assert abs(found["ahead_v"] - values["x"] * found["cos_v"] - values["y"] * found["sin_v"]) < ALLOWED / 10.0


@many
@given(ANGLES, decades(-13.0, -1.0), st.floats(1.0, 900.0), SIDES, ANGLES, decades(-12.0, 0.0))
def test_it_stays_where_the_later_step_reaches(
    angle: float, share: float, beside: float, side: float, slope_at: float, more: float
) -> None:
    """Where the later step has a solution the angle does not change."""
    values = point(angle, side * share * UNIT, beside) | {"sigma_v": side, "free_v": 0.0, "size": 0.0}
    values |= {"p": -np.sin(slope_at), "q": np.cos(slope_at)}
    before = outputs(turning(is_ruled=False), values)
    values["size"] = abs(before["needed"]) * (1.0 + more)
    assert outputs(turning(is_ruled=True), values) == before


def swinging(base: float, aside: float, turned: float) -> dict[str, float]:
    """The vector (x, y) with polar angle u: at v = base + d it is (sin d, aside cos d), rotated."""
    c, s = np.cos(turned), np.sin(turned)
    x, y = np.array([-np.sin(base), np.cos(base)]), aside * np.array([np.cos(base), np.sin(base)])
    first, second = c * x - s * y, s * x + c * y
    return {"x1": first[0], "x2": first[1], "y1": second[0], "y2": second[1]}


@many
@given(
    ANGLES, st.floats(10.0, 900.0), SIDES, decades(-10.0, -7.0), ANGLES, st.floats(0.3, 2.8),
    SIDES, st.floats(0.05, 0.9), st.floats(-0.95, 0.95), ANGLES,
)  # fmt: skip
def test_a_later_angle_that_sweeps_ends_where_its_step_reaches(
    base: float, beside: float, side: float, aside: float, turned: float, later: float,
    sign: float, size: float, share: float, free: float,
) -> None:  # fmt: skip
    """A valid pose: there u is `turned + later`, and rounding has changed both angles."""
    true = base + aside / np.tan(later)
    values = point(true, 0.0, beside) | swinging(base, aside, turned)
    values |= {"sigma_v": side, "free_v": 0.0, "free_u": free, "size": size}
    values |= {"p": -sign * np.sin(turned), "q": sign * np.cos(turned), "level": share * size - sign * np.sin(later)}
    before, found = (outputs(sweeping(is_ruled=ruled), values) for ruled in (False, True))
    assert abs(found["needed"]) <= size + ROUNDED / found["radius_u"]
    assert left(values, found) < 1.1 * ALLOWED
    if abs(before["needed"]) <= size:
        assert found == before


@many
@given(ANGLES, st.floats(10.0, 900.0), SIDES, decades(-12.0, -8.5), ANGLES, SIDES, decades(-5.0, 0.0))
def test_what_no_later_angle_reaches_stays_refused(
    base: float, beside: float, side: float, aside: float, turned: float, sign: float, beyond: float
) -> None:
    """|level| exceeds size and swing together."""
    values = point(base, 0.0, beside) | swinging(base, aside, turned) | {"sigma_v": side, "free_v": 0.0, "free_u": 0.0}
    values |= {"p": np.cos(base), "q": np.sin(base), "size": 0.5, "level": sign * (1.5 + beyond)}
    found = outputs(sweeping(is_ruled=True), values)
    assert abs(found["needed"]) > 0.5 * (1.0 + beyond)
    assert left(values, found) < 1.1 * ALLOWED


@settings(max_examples=300)
@given(
    ANGLES, st.floats(10.0, 900.0), SIDES, st.floats(-1e-5, 1e-5), ANGLES, st.floats(0.4, 1.0), st.floats(0.05, 0.3),
    ANGLES
)  # fmt: skip
def test_at_the_threshold_of_a_free_angle_it_points_to_what_the_next_step_takes(
    base: float, beside: float, side: float, above: float, turned: float, apart: float, lean: float, free: float
) -> None:
    """u may be `apart` on both sides of a centre; only one of them points ahead; on the other rounding decides if u is
    free.
    """
    aside, centre = 1e-11 * np.sin(apart + lean) * (1.0 + above), turned - lean
    values = point(base + aside / np.tan(apart - lean), 0.0, beside) | swinging(base, aside, turned)
    values |= {"sigma_v": side, "free_v": 0.0, "free_u": free}
    values |= {"size": 0.5, "level": 0.5 - np.cos(apart), "p": np.cos(centre), "q": np.sin(centre)}
    found = outputs(sweeping(is_ruled=True), values)
    assert left(values, found) < 1.1 * ALLOWED
    if found["radius_u"] > 1e-11:
        assert abs(found["needed"]) <= 0.5 + 2.0 * ROUNDED / found["radius_u"]
