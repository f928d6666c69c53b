"""Polar and lateral: two roots, or one where a factor is positive; arms that must reach a commanded point."""

from math import cos, hypot, sin

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from derive.equations.problem import Equation, Problem
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.program import Output, Status
from derive.ir.symbols import cosine, real, sine
from derive.solver.subproblems.one_equation.trigonometric import trigonometric
from derive.solver.subproblems.polar import polar
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
    at,
    distance,
    execute,
    few,
    problem,
    reference,
)

V, W, F, G, A, B, C, SIGMA, Q, X, Y, BESIDE = map(
    real, ("v", "w", "f", "g", "a", "b", "c", "sigma_v", "q", "x", "y", "beside")
)
K = sp.Symbol("k", positive=True)
FREE = reference(V)
AT_CENTRE = 4.001e-12
"""Within 2e-12 of the centre every direction is right: the error of the point is at most twice that."""

PLAIN = problem(F * sp.cos(V) - A, F * sp.sin(V) - B, angles=(V,), lengths=(F,))
RADIUS = problem(F * sp.cos(V) - A, F * sp.sin(V) - B, angles=(V,), lengths=(F,), positive=(F,))
COMPASS = problem(B - F * sp.cos(V), A - F * sp.sin(V) + C, angles=(V,), lengths=(F,))
ELLIPSE = problem(K * F * sp.cos(V) - A, -2 * F * sp.sin(V) - B, angles=(V,), lengths=(F,))


@few
@pytest.mark.parametrize("sigma", [1.0, -1.0])
@given(a=NUMBERS, b=NUMBERS, free=ANGLES)
def test_both_roots(sigma: float, a: float, b: float, free: float) -> None:
    binding = answer(polar, PLAIN)
    values, status = execute(binding.statements, {A: a, B: b, SIGMA: sigma, SCALE: 1.0, FREE: free})
    assert status is Status.OK
    f, c, s = (float(values[n]) for n in ("f", "cos_v", "sin_v"))
    assert abs(f - sigma * hypot(a, b)) <= 1e-15 * hypot(a, b)
    assert max(abs(f * c - a), abs(f * s - b)) <= max(1e-13 * hypot(a, b), AT_CENTRE)
    assert abs(hypot(c, s) - 1) <= 1e-13
    if hypot(a, b) > 1e-10:
        assert distance(angle_of(values, V), np.arctan2(sigma * b, sigma * a)) <= 1e-13
    assert binding.determinant is not None
    assert binding.determinant.sigma == SIGMA
    assert sigma * at(binding.determinant.value, values) >= 0


@few
@given(a=NUMBERS, b=NUMBERS)
def test_a_positive_radius_has_one_root(a: float, b: float) -> None:
    binding = answer(polar, RADIUS)
    assert binding.determinant is None
    values, _ = execute(binding.statements, {A: a, B: b, SCALE: 1.0, FREE: 0.0})
    assert values["f"] >= 0
    assert abs(values["f"] - hypot(a, b)) <= 1e-13 * hypot(a, b)


@few
@given(a=NUMBERS, b=NUMBERS, c=NUMBERS, sigma=st.sampled_from([1.0, -1.0]))
def test_the_equations_may_stand_the_other_way_round(a: float, b: float, c: float, sigma: float) -> None:
    values, _ = execute(answer(polar, COMPASS).statements, {A: a, B: b, C: c, SIGMA: sigma, SCALE: 1.0, FREE: 0.0})
    size = hypot(b, a + c)
    assert abs(values["f"] * values["cos_v"] - b) <= max(1e-13 * size, AT_CENTRE)
    assert abs(values["f"] * values["sin_v"] - (a + c)) <= max(1e-13 * size, AT_CENTRE)


@pytest.mark.long
@few
@given(f=NUMBERS, v=ANGLES, k=LENGTHS)
def test_factors_of_the_radius(f: float, v: float, k: float) -> None:
    right = {A: k * f * cos(v), B: -2 * f * sin(v), K: k}
    for sigma in (1.0, -1.0):
        values, _ = execute(answer(polar, ELLIPSE).statements, {**right, SIGMA: sigma, SCALE: 1.0, FREE: 0.0})
        assert abs(values["f"] - sigma * abs(f)) <= 1e-13 * abs(f)
        if abs(f) > 1e-3:
            assert distance(angle_of(values, V), v + (0 if sigma * f > 0 else np.pi)) <= 1e-12


@pytest.mark.parametrize("given_problem", [PLAIN, RADIUS], ids=["two roots", "one root"])
@pytest.mark.parametrize("size, is_free", [(0.0, True), (1.999e-9, True), (2.001e-9, False)])
def test_the_centre_leaves_the_reference(given_problem: object, size: float, is_free: bool) -> None:
    binding = answer(polar, given_problem)  # type: ignore[arg-type]
    angles = set()
    for sigma in (1.0, -1.0):
        right = {A: size * cos(2.0), B: size * sin(2.0), SIGMA: sigma, SCALE: 1e3, FREE: 0.4}
        values, status = execute(binding.statements, right)
        assert status is Status.OK
        angles.add(round(angle_of(values, V), 9))
    assert angles == ({0.4} if is_free else {2.0} if binding.determinant is None else {2.0, round(2.0 - np.pi, 9)})


@few
@given(f=LENGTHS, w=ANGLES, v=ANGLES, sigma=st.sampled_from([1.0, -1.0]))
def test_a_product_becomes_known(f: float, w: float, v: float, sigma: float) -> None:
    """f sin w is found as one number, in a new equation for the driver."""
    sphere = problem(F * sp.sin(W) * sp.cos(V) - A, F * sp.sin(W) * sp.sin(V) - B, angles=(V, W), lengths=(F,))
    binding = answer(polar, sphere)
    assert binding.unknowns == (V,)
    (product,) = binding.new_equations
    right = {A: f * sin(w) * cos(v), B: f * sin(w) * sin(v), SIGMA: sigma, SCALE: 1.0, FREE: 0.0}
    values, _ = execute(binding.statements, right)
    expected = {"f": np.asarray(sigma * abs(f)), "sin_w": np.asarray(abs(sin(w)))}
    assert abs(at(product.expression, {**values, **expected})) <= 1e-12 * f


@few
@given(f=NUMBERS, k=LENGTHS, v=ANGLES)
def test_a_sum_becomes_known(f: float, k: float, v: float) -> None:
    """A radius that is longer than the axis by a fixed part."""
    telescope = problem(A - (F + K) * sp.cos(V), B - (F + K) * sp.sin(V), angles=(V,), lengths=(F,), positive=(F + K,))
    binding = answer(polar, telescope)
    assert binding.determinant is None
    radius = abs(f + k)
    values, _ = execute(binding.statements, {A: radius * cos(v), B: radius * sin(v), K: k, SCALE: 1.0, FREE: v})
    assert distance(angle_of(values, V), v) <= 1e-12
    (total,) = binding.new_equations
    assert abs(at(total.expression, {**values, "f": np.asarray(radius - k)})) <= 1e-12 * (radius + k)


@pytest.mark.parametrize(
    "first, second",
    [
        (F * sp.cos(V) - A, G * sp.sin(V) - B),
        (F * sp.cos(V) - A, F * sp.cos(V) - B),
        (F * sp.cos(V) - G, F * sp.sin(V) - B),
        (F * sp.cos(V) - A, F * sp.sin(W) - B),
        (A * sp.cos(V) - B, A * sp.sin(V) - C),
        (C * F * sp.cos(V) - A, F * sp.sin(V) - B),
        (F * sp.cos(V) ** 2 - A, F * sp.cos(V) * sp.sin(V) - B),
        (F * sp.cos(V) - G * sp.sin(V) - A, F * sp.sin(V) + G * sp.cos(V) - B),
    ],
    ids=lambda e: str(e),
)
def test_not_taken(first: sp.Expr, second: sp.Expr) -> None:
    assert answers(polar, problem(first, second, angles=(V, W), lengths=(F, G))) == []


@few
@pytest.mark.parametrize(
    "given_problem", [PLAIN, RADIUS, COMPASS, ELLIPSE], ids=["plain", "radius", "compass", "ellipse"]
)
@given(a=ANYTHING, b=ANYTHING, c=ANYTHING, free=ANYTHING, k=st.floats(1e-9, 1e9), sigma=st.sampled_from([1.0, -1.0]))
def test_total(given_problem: object, a: float, b: float, c: float, free: float, k: float, sigma: float) -> None:
    binding = answer(polar, given_problem)  # type: ignore[arg-type]
    values, _ = execute(binding.statements, {A: a, B: b, C: c, K: k, SIGMA: sigma, SCALE: k, FREE: free})
    assert all_finite(values)


REACHES = sp.Symbol("reach", positive=True)


def solved(x: float, y: float, beside: float, side: float, free: float = 0.7) -> tuple[float, float, Status]:
    """Cosine and sine of the angle for -sin q x + cos q y = beside."""
    equation = Equation("sideways", cosine(Q) * Y - sine(Q) * X - (BESIDE if beside else 0))
    problem = Problem((Q,), (), (equation,), (Q,), {Q: real("free")}, REACHES)
    (binding,) = trigonometric(problem, (equation,))
    program = normalise("aim", binding.statements, [Output("c", cosine(Q)), Output("s", sine(Q))])
    given = {"x": x, "y": y, "beside": beside, "sigma_q": side, "free": free, "reach": 1000.0}
    outputs, status = run(program, {k: np.asarray(v) for k, v in given.items()})
    return float(outputs["c"]), float(outputs["s"]), Status(status.item())


@pytest.mark.parametrize("side", (1.0, -1.0))
@pytest.mark.parametrize("beside", (0.0, 40.0, -40.0))
def test_both_ways_meet_the_point(side: float, beside: float) -> None:
    for angle in np.linspace(-3.0, 3.0, 13):
        x, y = 300.0 * np.cos(angle), 300.0 * np.sin(angle)
        c, s, status = solved(x, y, beside, side)
        assert status is Status.OK
        assert c * y - s * x == pytest.approx(beside, abs=1e-12 * 300)
        assert c * c + s * s == pytest.approx(1.0, abs=1e-15 * 8)


@pytest.mark.parametrize("side", (1.0, -1.0))
def test_on_the_axis_the_angle_is_free(side: float) -> None:
    c, s, status = solved(0.0, 0.0, 0.0, side, free=0.7)
    assert (c, s, status) == (pytest.approx(np.cos(0.7)), pytest.approx(np.sin(0.7)), Status.OK)
