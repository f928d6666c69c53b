"""Programs of which every axis may be in any turn: mirrored branches share their angles, and nothing is inverted."""

import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, NearestPeriod, Root, ToReal, Wrap
from derive.ir.program import Let, Output, Program
from derive.ir.symbols import Sign, count, real
from derive.lowering.passes import STRAIGHT_LINE, lowered
from derive.lowering.unrolling import unroll
from derive.report.cost import cost_of
from tests.unit.answers import same, values

A, B, C, L, N, P, Q, R, S, X, Y, ANGLE, AXIS = map(
    real, ("a", "b", "c", "l", "n", "p", "q", "r", "s", "x", "y", "angle", "axis")
)
ELBOW = Sign(count("sigma_elbow"), ("down", "up"))


def of(*lets: Let, outputs: tuple[sp.Symbol, ...]) -> Program:
    return normalise("p", lets, [Output(o.name, o) for o in outputs])


def shorter(program: Program, constants: str = "") -> Program:
    (found,), _ = lowered([program], tuple(constants), STRAIGHT_LINE)
    return found


def test_products_of_both_branches_are_computed_once() -> None:
    """Products that two branches share are computed once after unrolling."""
    swing = Let(R, ToReal(ELBOW.symbol) * Root(X))
    program = unroll(of(swing, Let(C, P * Y - Q * R), Let(S, Q * Y + P * R), outputs=(C, S)), (ELBOW,))
    found = shorter(program)
    assert cost_of(program).multiplications == cost_of(found).multiplications == 4
    same(program, found)


def test_the_angle_of_a_mirrored_direction_is_the_negative() -> None:
    """The angle of a mirrored direction is the negative of the angle, and costs no arc tangent."""
    swing = (
        Let(R, ToReal(ELBOW.symbol) * Root(X)),
        Let(ANGLE, Atan2(R, C)),
        Let(AXIS, NearestPeriod(A + ANGLE / DEGREE, N)),
    )
    program = unroll(of(*swing, outputs=(AXIS,)), (ELBOW,))
    found = shorter(program)
    assert cost_of(program).trigonometric == 2 and cost_of(found).trigonometric == 1
    same(program, found)


def test_an_angle_whose_turn_counts_stays() -> None:
    """The value of atan2(0, -1) is pi on both sides: its negative would be a turn less."""
    swing = (Let(R, ToReal(ELBOW.symbol) * Root(X)), Let(AXIS, A + Wrap(Atan2(R, C)) / DEGREE))
    program = unroll(of(*swing, outputs=(AXIS,)), (ELBOW,))
    assert cost_of(shorter(program)).trigonometric == 2
    same(program, shorter(program))


def test_minus_signs_that_meet_are_not_written() -> None:
    """S is read by its name, which is the negative of the product, and so is the angle."""
    program = of(Let(S, -X * Y), Let(ANGLE, Atan2(S, C)), Let(A, ANGLE + P), Let(B, S + 1), outputs=(A, B))
    assert values(shorter(program))["angle"] == Atan2(S, C)
