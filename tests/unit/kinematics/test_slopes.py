"""Slopes by automatic differentiation: those of every primitive are what a small step measures, on either side."""

import numpy as np
import pytest
import sympy as sp

from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Output
from derive.ir.symbols import real
from derive.kinematics.scan.slopes import slope_name, with_slopes

X, A, VALUE = real("x"), real("a"), real("value")
VALUES = {
    "size": sp.Abs(X**2 - 2) * X,
    "divided by a size": 3 * sp.sin(X) / sp.Abs(A * X - A),
    "root": Root(X**2 + A),
    "choice": Select(sp.Gt(X, 1), X**3, -X),
    "size of a choice": sp.Abs(Select(sp.Gt(X, 1), A * X, sp.cos(X))),
}


@pytest.mark.parametrize("name", VALUES)
def test_a_slope_is_what_a_small_step_measures(name: str) -> None:
    lets = with_slopes([Let(VALUE, VALUES[name])], X)
    program = normalise("slopes", lets, [Output("value", VALUE), Output("slope", slope_name(VALUE))])
    x, step, a = np.array([-2.3, -0.7, 0.2, 1.3, 2.9]), 1e-6, np.full(5, 1.7)
    found, _ = run(program, {"x": x, "a": a})
    ends = [run(program, {"x": x + side * step, "a": a})[0]["value"] for side in (1, -1)]
    assert np.allclose(found["slope"], (ends[0] - ends[1]) / (2 * step), rtol=1e-7, atol=1e-7)
