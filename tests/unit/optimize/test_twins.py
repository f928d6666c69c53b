"""Twins and constant parts: the program before and after, and the same answers."""

from __future__ import annotations

import numpy as np
import sympy as sp

from derive.ir.constants import (
    DEGREE,
    FREE_ANGLE,
)
from derive.ir.interpret import run
from derive.ir.passes import assemble
from derive.ir.primitives import (
    Atan2,
    NearestPeriod,
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
from derive.optimize.constant_parts import constant_parts
from derive.optimize.symmetry import with_twins

A, B, C, D, N, R, T, X, Y = (real(n) for n in "abcdnrtxy")
C_DOWN, C_UP, S_DOWN, S_UP, M_DOWN, M_UP = (real(n) for n in ("c_down", "c_up", "s_down", "s_up", "m_down", "m_up"))
AXIS_DOWN, AXIS_UP = real("axis_down"), real("axis_up")
REGULAR = sp.Gt(R, 1)


def wrist() -> Program:
    """A wrist and the same turned over: where it is not regular, both are at the same angle."""
    lets = [
        Let(C_DOWN, Select(REGULAR, X / 2, sp.cos(T))),
        Let(S_DOWN, Select(REGULAR, Y / 2, sp.sin(T))),
        Let(C_UP, Select(REGULAR, -X / 2, sp.cos(T))),
        Let(S_UP, Select(REGULAR, -Y / 2, sp.sin(T))),
        Let(M_DOWN, A * C_DOWN + B * S_DOWN),
        Let(M_UP, A * C_UP + B * S_UP),
        Let(AXIS_DOWN, NearestPeriod(D + Atan2(M_DOWN, C_DOWN) / DEGREE, N)),
        Let(AXIS_UP, NearestPeriod(D + Atan2(M_UP, C_UP) / DEGREE, N)),
    ]
    return assemble("wrist", lets, [Output("down", AXIS_DOWN), Output("up", AXIS_UP)])


def values(program: Program) -> dict[str, sp.Expr]:
    return {let.name.name: let.value for let in program.lets()}


def same(first: Program, second: Program) -> None:
    random = np.random.default_rng(3)
    given = {s.name: random.uniform(-3, 3, 200) for s in {*first.inputs, *second.inputs}}
    (wanted, _), (found, _) = (run(p, {s.name: given[s.name] for s in p.inputs}) for p in (first, second))
    for name, value in wanted.items():
        np.testing.assert_allclose(found[name], value, rtol=1e-12, atol=1e-11)


def test_a_value_is_the_negative_of_its_twin_where_that_is_so() -> None:
    found = values(with_twins(wrist()))
    assert found["m_up"] == Select(REGULAR, -M_DOWN, A * C_UP + B * S_UP)


def test_an_angle_is_half_a_turn_from_its_twin() -> None:
    found = values(with_twins(wrist()))
    direction, other = real("direction_of_axis_up"), D + Atan2(M_UP, C_UP) / DEGREE
    assert found[direction.name] == Select(REGULAR, AXIS_DOWN + 180, other)
    assert found["axis_up"] == NearestPeriod(direction, N)
    same(wrist(), with_twins(wrist()))


def test_an_angle_mirrored_at_its_shift_needs_no_condition() -> None:
    lets = [
        Let(AXIS_DOWN, NearestPeriod(D + Atan2(X, Y) / DEGREE, N)),
        Let(AXIS_UP, NearestPeriod(D + Atan2(-X, Y) / DEGREE, N)),
    ]
    program = assemble("mirrored", lets, [Output("down", AXIS_DOWN), Output("up", AXIS_UP)])
    assert values(with_twins(program))["axis_up"] == NearestPeriod(2 * D - AXIS_DOWN, N)
    same(program, with_twins(program))


def test_another_value_on_the_other_side_is_no_twin() -> None:
    """The second sides of C differ: then nothing is known of it, and the sum stays as it is."""
    lets = [
        Let(C_DOWN, Select(REGULAR, X / 2, sp.cos(T))),
        Let(C_UP, Select(REGULAR, -X / 2, sp.sin(T))),
        Let(M_DOWN, A * C_DOWN),
        Let(M_UP, A * C_UP),
    ]
    program = assemble("other", lets, [Output("down", M_DOWN + 1), Output("up", M_UP + 1)])
    assert with_twins(program) == program


def test_an_angle_that_is_no_turn_is_left_alone() -> None:
    """Its value counts, not its direction: half a turn more would be another value."""
    lets = [Let(AXIS_DOWN, Atan2(X, Y) / DEGREE), Let(AXIS_UP, Atan2(-X, -Y) / DEGREE)]
    program = assemble("single", lets, [Output("down", AXIS_DOWN + 1), Output("up", AXIS_UP + 1)])
    assert with_twins(program) == program


def test_what_depends_on_constants_alone_is_computed_once() -> None:
    value = (A + B - X) * Y / (C * C) + A * X / B + Select(sp.Gt(X, FREE_ANGLE * C), Root(X), A**2)
    program = assemble("p", [Let(R, value)], [Output("o", R + A * B)])
    (found,), parts = constant_parts([program], ["a", "b", "c"])
    names = {let.name.name: let.value for let in parts}
    assert {k: v for k, v in names.items() if "squared" not in k} == {
        "a_plus_b": A + B,
        "a_by_b": A / B,
        "c_times_free_angle": C * FREE_ANGLE,
        "a_times_b": A * B,
    }
    assert names["a_squared"] == A**2 and names["c_squared"] == C**2
    same(program, assemble("p", [*parts, *found.body], found.outputs))


def test_what_cannot_be_said_in_a_name_is_a_constant_part() -> None:
    first, second = real("length_of_the_first_of_all_arms"), real("length_of_the_second_of_all_arms")
    program = assemble("p", [Let(R, X + first * second)], [Output("o", R)])
    (found,), (part,) = constant_parts([program], [first.name, second.name])
    assert part == Let(real("constant_part"), first * second)
    assert values(found) == {"r": X + real("constant_part")} or found.outputs[0].value == X + real("constant_part")


def test_names_of_parts_are_free() -> None:
    taken = Let(real("a_plus_b"), X * 3)
    program = assemble("p", [taken, Let(R, (A + B) * Y + taken.name)], [Output("o", R)])
    (found,), (part,) = constant_parts([program], ["a", "b"])
    assert part.name == real("a_plus_b_2")
    same(program, assemble("p", [part, *found.body], found.outputs))
