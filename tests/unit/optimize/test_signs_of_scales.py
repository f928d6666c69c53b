"""The angle of (k x, k y) is that of (x, y) where k is proven to be positive, and nowhere else."""

import numpy as np
import pytest
import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, NearestPeriod, Root, Select, ToReal
from derive.ir.program import Let, Output, Program
from derive.ir.symbols import Sign, count, real
from derive.lowering.passes import STRAIGHT_LINE, lowered
from derive.lowering.unrolling import unroll
from tests.unit.answers import plain_directions

X, Y, K, COS, SIN, LENGTH, DIVISOR, AXIS = map(real, ("x", "y", "k", "cos_q", "sin_q", "length", "divisor", "axis_q"))
RNG = np.random.default_rng(5)
SAMPLES = {name: RNG.uniform(-2.0, 2.0, 400) for name in ("x", "y", "k", "ref")}


def _scaled(length: sp.Expr, condition: sp.Basic) -> Program:
    axis = NearestPeriod(Atan2(SIN, COS) / DEGREE, real("ref"))
    divisor = Let(DIVISOR, Select(condition, LENGTH, 1))
    lets = [Let(LENGTH, length), divisor, Let(COS, X / DIVISOR), Let(SIN, Y / DIVISOR), Let(AXIS, axis)]
    return normalise("p", lets, [Output("axis_q", AXIS)])


def mirrored(program: Program) -> Program:
    """The program as a graph, of whose angles the turn is free."""
    (changed,), _ = lowered([program], (), STRAIGHT_LINE)
    return changed


def _agree(first: Program, second: Program) -> None:
    given = {
        name: values for name, values in SAMPLES.items() if name in {s.name for s in (*first.inputs, *second.inputs)}
    }
    np.testing.assert_allclose(run(second, given)[0]["axis_q"], run(first, given)[0]["axis_q"], atol=1e-9)


@pytest.mark.parametrize(
    "length, condition, is_proven",
    [
        (Root(X**2 + Y**2), sp.Float("1e-11") < LENGTH, True),
        (K, sp.Abs(LENGTH) > sp.Float("1e-11"), False),
        (X * K, sp.Abs(LENGTH) > sp.Float("1e-11"), False),
        (-Root(X**2 + K**2), -sp.Float("1e-11") > LENGTH, False),
        (Root(X**2 + K**2) - 1, sp.Abs(LENGTH) > sp.Float("1e-11"), False),
    ],
)
def test_a_divisor_leaves_a_direction_only_where_it_is_a_length(
    length: sp.Expr, condition: sp.Basic, is_proven: bool
) -> None:
    """A divisor is dropped from a direction only if it is proven to be positive."""
    program = _scaled(length, condition)
    found = plain_directions(program)
    _agree(program, found)
    is_divided = any(1 / DIVISOR in sp.Mul.make_args(let.value) for let in found.lets())
    assert is_divided != is_proven


@pytest.mark.parametrize("factor", [K, -K, X * K, -Root(K**2), sp.Integer(-1)])
def test_a_factor_of_any_sign_turns_a_direction(factor: sp.Expr) -> None:
    """A factor of unknown sign keeps its effect on the angle of a direction."""
    axis = NearestPeriod(Atan2(SIN, COS) / DEGREE, real("ref"))
    program = normalise("p", [Let(COS, factor * X), Let(SIN, factor * Y), Let(AXIS, axis)], [Output("axis_q", AXIS)])
    for change in (plain_directions, mirrored):
        _agree(program, change(program))


def test_a_branch_sign_turns_a_direction() -> None:
    """A branch sign in front of a direction turns the angle by half a turn on one branch."""
    sigma = Sign(count("sigma_elbow"), ("up", "down"))
    sign, axis = real("sign_elbow"), NearestPeriod(Atan2(SIN, COS) / DEGREE, real("ref"))
    lets = [Let(sign, ToReal(sigma.symbol)), Let(COS, sign * X), Let(SIN, sign * Y), Let(AXIS, axis)]
    program = normalise("p", lets, [Output("axis_q", AXIS)])
    given = {name: SAMPLES[name] for name in ("x", "y", "ref")}
    every, _ = run(unroll(mirrored(program), (sigma,)), given)
    for number, word in ((1, "up"), (-1, "down")):
        wanted, _ = run(program, {**given, "sigma_elbow": np.asarray(number)})
        np.testing.assert_allclose(every[f"axis_q_{word}"], wanted["axis_q"], atol=1e-9)
