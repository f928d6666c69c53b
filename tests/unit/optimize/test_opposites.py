"""Opposites: fewer minus signs, and the same answers."""

from __future__ import annotations

import sympy as sp

from derive.ir.constants import (
    DEGREE,
)
from derive.ir.passes import assemble
from derive.ir.primitives import (
    Atan2,
    NearestPeriod,
    Root,
    Select,
    Wrap,
)
from derive.ir.program import (
    Let,
    Output,
    Program,
)
from derive.ir.symbols import (
    real,
)
from derive.optimize.negation import with_fewer_signs
from tests.unit.optimize.test_twins import same, values

A, B, C, L, N, R, S, U, V, X, Y = (real(n) for n in ("a", "b", "c", "l", "n", "r", "s", "u", "v", "x", "y"))
ANGLE, AXIS = real("angle"), real("axis")


def of(*lets: Let, outputs: tuple[sp.Symbol, ...]) -> Program:
    return assemble("p", lets, [Output(o.name, o) for o in outputs])


def test_a_negative_that_is_read_with_a_minus() -> None:
    program = of(Let(S, -Root(X) * R), Let(A, -L * S), Let(B, S**2 + Y), outputs=(A, B))
    found = values(with_fewer_signs(program))
    assert found == {"minus_s": Root(X) * R, "a": L * real("minus_s"), "b": real("minus_s") ** 2 + Y}
    same(program, with_fewer_signs(program))


def test_a_difference_that_two_read_with_a_minus() -> None:
    program = of(Let(S, X - Y), Let(A, Select(sp.Gt(R, 1), -S * U, V)), Let(B, -S * V), outputs=(A, B))
    found = values(with_fewer_signs(program))
    assert found["minus_s"] == Y - X and found["b"] == V * real("minus_s")
    same(program, with_fewer_signs(program))


def test_what_gains_nothing_stays() -> None:
    for lets in (
        (Let(S, X - Y), Let(A, U - S), Let(B, -S * V)),  # u + minus_s and minus_s*v would be fewer, but s is wanted
        (Let(S, X + Y), Let(A, U - S), Let(B, S * V)),
        (Let(S, Root(X)), Let(A, -S * V), Let(B, S + 1)),
    ):
        program = of(*lets, outputs=(A, B, S) if lets[0].value == X - Y else (A, B))
        assert len(values(with_fewer_signs(program))) == len(lets)
        same(program, with_fewer_signs(program))
    assert with_fewer_signs(of(Let(S, X + Y), Let(A, U - S), Let(B, S * V), outputs=(A, B))).bound() == (S, A, B)


def test_an_angle_whose_turn_nobody_counts() -> None:
    """atan2(-s, c) is -atan2(s, c) but for a turn, where the sine is zero."""
    lets = (Let(S, -Root(X) * R), Let(ANGLE, Atan2(S, C)), Let(AXIS, NearestPeriod(A + ANGLE / DEGREE, N)), Let(B, -L * S))
    program = of(*lets, outputs=(AXIS, B))
    found = values(with_fewer_signs(program))
    assert found["minus_angle"] == Atan2(real("minus_s"), C)
    assert found["axis"] == NearestPeriod(A - real("minus_angle") / DEGREE, N)
    same(program, with_fewer_signs(program))


def test_an_angle_whose_turn_counts_stays() -> None:
    lets = (Let(S, -Root(X) * R), Let(ANGLE, Atan2(S, C)), Let(AXIS, A + Wrap(ANGLE) / DEGREE), Let(B, -L * S))
    found = values(with_fewer_signs(of(*lets, outputs=(AXIS, B))))
    assert found["angle"] == Atan2(-real("minus_s"), C)


def test_it_ends_where_a_difference_of_angles_is_read_with_a_minus() -> None:
    """SymPy takes the sign out of sin(a - b) by the names, so that either angle seems to save signs, and again."""
    for first, second in (("angle_q2", "angle_q3"), ("angle_of_arm", "angle_of_wrist"), ("a1", "b1")):
        p, q = real(first), real(second)
        lets = (Let(p, Atan2(S, C)), Let(q, Atan2(X, Y)), Let(A, -L * sp.sin(p - q)), Let(B, -Y * sp.sin(p - q)))
        program = of(*lets, outputs=(A, B))
        same(program, with_fewer_signs(program))


def test_opposites_of_opposites_have_their_first_name() -> None:
    program = of(Let(real("minus_s"), -X * Y), Let(A, -L * real("minus_s")), outputs=(A,))
    assert values(with_fewer_signs(program)) == {"s": X * Y, "a": L * S}
