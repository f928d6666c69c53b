"""Passes: each with the program before and after."""

import numpy as np
import pytest
import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.interpret import run
from derive.ir.passes import hoist, normalise
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Output, Program, Require, Status
from derive.ir.symbols import real
from derive.ir.verify import BrokenProgram

A, B, C, D, X, Y = (real(n) for n in "abcdxy")
FAR = Require(sp.Gt(X, Y), Status.UNREACHABLE)


def body(program: Program) -> list[object]:
    """The names that are bound and the conditions, in order."""
    return [s.name if isinstance(s, Let) else s.condition for s in program.body]


def values(program: Program) -> dict[str, sp.Expr]:
    return {let.name.name: let.value for let in program.lets()}


def test_another_value_under_the_same_name_is_refused() -> None:
    """Two values under one name raise `BrokenProgram`."""
    with pytest.raises(BrokenProgram, match=r"a is bound twice, to x \+ 1 and to x \+ 2"):
        normalise("p", [Let(A, X + 1), Let(A, X + 2)], [Output("o", A)])


def test_a_circle_is_refused() -> None:
    """Values that need each other raise `BrokenProgram`."""
    with pytest.raises(BrokenProgram, match="is read before it is bound"):
        normalise("p", [Let(A, B + 1), Let(B, A + 1)], [Output("o", A)])


def test_a_name_is_a_name_whatever_is_known_of_its_sign() -> None:
    """Symbols with the same name are one name, whatever their assumptions."""
    long = sp.Symbol("a", positive=True)
    program = normalise("p", [Let(B, long + 1), Require(sp.Gt(B, 0), Status.OK)], [Output("o", A + B)])
    assert program.inputs == (A,)
    assert program.lets()[0].value == A + 1


def test_a_positive_name_does_not_decide_a_condition() -> None:
    """The assumptions of a symbol decide no condition."""
    long = sp.Symbol("a", positive=True)
    program = normalise("p", [Let(B, Select(sp.Gt(long - X, 0), X, Y))], [Output("o", B)])
    assert program.inputs == (A, X, Y)


def test_pi_is_half_a_turn_and_a_surd_a_root() -> None:
    """Pi becomes 180 degrees, and an irrational square root becomes `Root`."""
    program = normalise(
        "p", [Let(A, X * sp.pi / 4), Let(B, X * sp.cos(sp.pi / 12) + sp.sin(sp.pi / 5))], [Output("o", A + B)]
    )
    assert values(program)["a"] == 45 * DEGREE * X
    assert values(program)["b"].has(Root)
    outputs, _ = run(program, {"x": np.asarray(2.0)})
    assert outputs["o"] == pytest.approx(2 * np.pi / 4 + 2 * np.cos(np.pi / 12) + np.sin(np.pi / 5), abs=1e-15)


def test_inputs_are_what_is_free_in_the_order_of_their_names() -> None:
    """The inputs are the names that no statement binds, in alphabetical order."""
    program = normalise("p", [Let(D, C + X)], [Output("o", D + A * DEGREE)])
    assert program.inputs == (A, C, X)


def test_hoisting_goes_through_lets_and_conditions() -> None:
    """Hoisting follows chains of values, and leaves conditions where they are."""
    program = normalise("p", [Let(A, C * 2), Let(B, A + 1), Require(sp.Gt(B, 0), Status.OK)], [Output("o", B + X)])
    (lowered,), hoisted = hoist([program], ["c"])
    assert [let.name for let in hoisted] == [A, B]
    assert body(lowered) == [sp.Gt(B, 0)]


def test_hoisting_moves_what_depends_on_constants_alone() -> None:
    """Values of constants alone are moved out of programs, and computed once."""
    first = normalise("first", [Let(A, C * 2), Let(B, A + X)], [Output("o", B * A)])
    second = normalise("second", [Let(D, C * 2), FAR], [Output("o", D)])
    (lowered_first, lowered_second), hoisted = hoist([first, second], ["c"])
    assert hoisted == (Let(A, C * 2),)
    assert body(lowered_first) == [B]
    assert body(lowered_second) == [FAR.condition]
    assert lowered_second.outputs == (Output("o", A),)
    assert lowered_first.inputs == (A, X)
    assert lowered_second.inputs == (A, X, Y)


def test_a_hoisted_name_makes_way_for_others() -> None:
    """One name is a constant of the first program and a temporary of the second: both survive."""
    first = normalise("first", [Let(A, C * 2)], [Output("o", A)])
    second = normalise("second", [Let(A, X * 2)], [Output("o", A)])
    third = normalise("third", [Let(A, C * 3)], [Output("o", A)])
    lowered, hoisted = hoist([first, second, third], ["c"])
    assert [str(let.name) for let in hoisted] == ["a_2", "a_3"]
    assert [p.outputs[0].value for p in lowered] == [real("a_2"), A, real("a_3")]
    assert values(lowered[1]) == {"a": X * 2}


def test_hoisting_changes_no_value() -> None:
    """A program gives the same results after hoisting."""
    statements = [Let(A, Root(C) + D), Let(B, A * X), Require(sp.Gt(B, A), Status.UNREACHABLE), Let(Y, B / A + C)]
    program = normalise("p", statements, [Output("o", Y), Output("q", A)])
    (lowered,), hoisted = hoist([program], ["c", "d"])
    given = {"c": np.asarray(2.0), "d": np.asarray(0.5), "x": np.linspace(-2, 2, 9)}
    constants, _ = run(normalise("setup", hoisted, [Output(let.name.name, let.name) for let in hoisted]), given)
    before, after = run(program, given), run(lowered, {"x": given["x"], "c": given["c"], **constants})
    assert all(np.array_equal(before[0][k], after[0][k]) for k in before[0])
    assert np.array_equal(before[1], after[1])
    assert set(before[1]) == {Status.OK, Status.UNREACHABLE}
