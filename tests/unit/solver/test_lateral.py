"""Lateral: an arm, with or without a lateral offset, that must reach a commanded point."""

import numpy as np
import pytest
import sympy as sp

from derive.equations.problem import Equation, Problem
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.program import Output, Status
from derive.ir.symbols import cosine, real, sine
from derive.solver.subproblems.one_equation.trigonometric import trigonometric

Q, X, Y, BESIDE = real("q"), real("x"), real("y"), real("beside")
SCALE = sp.Symbol("reach", positive=True)


def solved(x: float, y: float, beside: float, side: float, free: float = 0.7) -> tuple[float, float, Status]:
    """Cosine and sine of the angle for -sin q x + cos q y = beside."""
    equation = Equation("sideways", cosine(Q) * Y - sine(Q) * X - (BESIDE if beside else 0))
    problem = Problem((Q,), (), (equation,), (Q,), {Q: real("free")}, SCALE)
    (binding,) = trigonometric(problem, (equation,))
    program = normalise("aim", binding.statements, [Output("c", cosine(Q)), Output("s", sine(Q))])
    given = {"x": x, "y": y, "beside": beside, "sigma_q": side, "free": free, "reach": 1000.0}
    outputs, status = run(program, {k: np.asarray(v) for k, v in given.items()})
    return float(outputs["c"]), float(outputs["s"]), Status(status.item())


@pytest.mark.parametrize("side", (1.0, -1.0))
@pytest.mark.parametrize("beside", (0.0, 40.0, -40.0))
def test_both_ways_meet_the_point(side: float, beside: float) -> None:
    """Both roots point the arm with its lateral offset at the point."""
    for angle in np.linspace(-3.0, 3.0, 13):
        x, y = 300.0 * np.cos(angle), 300.0 * np.sin(angle)
        c, s, status = solved(x, y, beside, side)
        assert status is Status.OK
        assert c * y - s * x == pytest.approx(beside, abs=1e-12 * 300)
        assert c * c + s * s == pytest.approx(1.0, abs=1e-15 * 8)


def test_the_two_ways_are_two() -> None:
    """The two signs give two different angles."""
    (c1, s1, _), (c2, s2, _) = (solved(120.0, 50.0, 40.0, side) for side in (1.0, -1.0))
    assert abs(c1 - c2) + abs(s1 - s2) > 0.1


@pytest.mark.parametrize("side", (1.0, -1.0))
def test_on_the_axis_the_angle_is_free(side: float) -> None:
    """A point on the axis, without a lateral offset, leaves the angle at the reference."""
    c, s, status = solved(0.0, 0.0, 0.0, side, free=0.7)
    assert (c, s, status) == (pytest.approx(np.cos(0.7)), pytest.approx(np.sin(0.7)), Status.OK)


def test_nearer_to_the_axis_than_the_arm_is_beside_it() -> None:
    """A point closer to the axis than the lateral offset is UNREACHABLE."""
    assert solved(30.0, 10.0, 40.0, 1.0)[2] is Status.UNREACHABLE
    assert solved(0.0, 0.0, 40.0, 1.0)[2] is Status.UNREACHABLE


@pytest.mark.parametrize("angle", np.linspace(-3.0, 3.0, 7))
def test_on_the_cylinder_both_ways_meet(angle: float) -> None:
    """At the distance of the lateral offset both roots coincide."""
    x, y = 40.0 * np.cos(angle), 40.0 * np.sin(angle)
    (c1, s1, first), (c2, s2, second) = (solved(x, y, 40.0, side) for side in (1.0, -1.0))
    assert first is second is Status.OK
    assert (c1, s1) == (pytest.approx(c2, abs=1e-7), pytest.approx(s2, abs=1e-7))
