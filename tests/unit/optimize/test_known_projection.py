"""Aimed: a point in a direction that was made of it."""

from __future__ import annotations

import sympy as sp

from derive.ir.passes import normalise
from derive.ir.primitives import (
    Root,
    Select,
)
from derive.ir.program import (
    Let,
    Output,
    Program,
)
from derive.ir.symbols import (
    real,
)
from derive.optimize.known_projection import with_known_projections
from tests.unit.optimize.test_symmetry import same, values

B, C, D, E, H, L, S, T, X, Y = (real(n) for n in ("b", "cos_q1", "d", "e", "h", "l", "sin_q1", "t", "x", "y"))
FAR = sp.Gt(D, T)
MADE = (
    Let(D, Root(X**2 + Y**2)),
    Let(H, Root((D - B) * (D + B))),
    Let(E, Select(FAR, D**2, sp.Integer(1))),
    Let(C, Select(FAR, (X * H - Y * B) / E, sp.cos(T))),
    Let(S, Select(FAR, (Y * H + X * B) / E, sp.sin(T))),
)
"""A direction in which (x, y) is `h` ahead and `b` beside."""


def of(*lets: Let) -> Program:
    return normalise("p", (*MADE, *lets), [Output(let.name.name, let.name) for let in lets])


def test_ahead_and_beside_are_known() -> None:
    """The coordinates of a point in the frame that an angle turns to it are the distance and zero."""
    program = of(Let(real("ahead"), X * C + Y * S - L), Let(real("beside"), X * S - Y * C + L))
    found = values(with_known_projections(program))
    first, second = real("point_from_q1"), real("point_from_q1_2")
    assert found["point_from_q1"] == Select(FAR, H, X * C + Y * S) and found["ahead"] == first - L
    assert found["point_from_q1_2"] == Select(FAR, B, X * S - Y * C) and found["beside"] == second + L
    same(program, with_known_projections(program))


def test_a_multiple_of_the_point_too_and_once() -> None:
    """A multiple of the point is recognised, and the value is written once."""
    program = of(
        Let(real("one"), 2 * X * C + 2 * Y * S + L), Let(real("two"), L - 2 * X * C - 2 * Y * S + 2 * X * C + 2 * Y * S)
    )
    assert values(with_known_projections(program))["point_from_q1"] == Select(FAR, 2 * H, 2 * X * C + 2 * Y * S)
    same(program, with_known_projections(program))
    twice = of(Let(real("one"), X * C + Y * S + L), Let(real("two"), X * C + Y * S - 3 * L))
    assert [name for name in values(with_known_projections(twice)) if name.startswith("point")] == ["point_from_q1"]
    same(twice, with_known_projections(twice))


def test_what_stands_beside_is_not_written_out() -> None:
    """A discriminant stays a product: expanded it loses half its digits."""
    product = (L - B) * (L + B)
    program = of(Let(real("one"), product + X * C + Y * S), Let(real("two"), Root(product) + X * C + Y * S))
    found, point = values(with_known_projections(program)), real("point_from_q1")
    assert found["one"] == product + point and found["two"] == Root(product) + point


def test_another_point_is_not_known() -> None:
    """An expression of another point stays as it is."""
    for value in (X * C + 2 * Y * S, X * C - Y * S, X * C + Y * S**2, X * C, L * C + B * S):
        program = of(Let(real("other"), value))
        assert with_known_projections(program) == program


def test_nor_is_a_direction_by_another_length() -> None:
    """The divisor has to be the square of the length of this very point."""
    for length in (Root(X**2 + 2 * Y**2), Root(X**2 + Y**2 + L**2), X + Y):
        lets = (Let(D, length), *MADE[1:], Let(real("ahead"), X * C + Y * S))
        program = normalise("p", lets, [Output("ahead", real("ahead"))])
        assert with_known_projections(program) == program
