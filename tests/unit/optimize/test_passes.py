"""Passes: each with the program before and after."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from derive.emit.python.printer import ScalarPrinter
from derive.ir.constants import DEGREE
from derive.ir.interpret import run
from derive.ir.passes import hoist, normalise
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Output, Program, Require, Status
from derive.ir.symbols import Sign, names_in, real, without_words
from derive.ir.tree import If, Item
from derive.ir.verify import BrokenProgram
from derive.lowering.scheduling import scheduled
from derive.optimize.inline import inlined
from derive.optimize.joining import joined
from tests.unit.answers import values

A, B, C, D, E, F, P, Q, R, X, Y, Z = (real(n) for n in "abcdefpqrxyz")
FAR = Require(sp.Gt(X, Y), Status.UNREACHABLE)


def body(program: Program) -> list[object]:
    """The names that are bound and the conditions, in order."""
    return [s.name if isinstance(s, Let) else s.condition for s in program.body]


def test_another_value_under_the_same_name_is_refused() -> None:
    with pytest.raises(BrokenProgram, match=r"a is bound twice, to x \+ 1 and to x \+ 2"):
        normalise("p", [Let(A, X + 1), Let(A, X + 2)], [Output("o", A)])


def test_a_circle_is_refused() -> None:
    with pytest.raises(BrokenProgram, match="is read before it is bound"):
        normalise("p", [Let(A, B + 1), Let(B, A + 1)], [Output("o", A)])


def test_a_name_is_a_name_whatever_is_known_of_its_sign() -> None:
    long = sp.Symbol("a", positive=True)
    program = normalise("p", [Let(B, long + 1), Require(sp.Gt(B, 0), Status.OK)], [Output("o", A + B)])
    assert program.inputs == (A,)
    assert program.lets()[0].value == A + 1


def test_a_positive_name_does_not_decide_a_condition() -> None:
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
    program = normalise("p", [Let(D, C + X)], [Output("o", D + A * DEGREE)])
    assert program.inputs == (A, C, X)


def test_hoisting_goes_through_lets_and_conditions() -> None:
    program = normalise("p", [Let(A, C * 2), Let(B, A + 1), Require(sp.Gt(B, 0), Status.OK)], [Output("o", B + X)])
    (lowered,), hoisted = hoist([program], ["c"])
    assert [let.name for let in hoisted] == [A, B]
    assert body(lowered) == [sp.Gt(B, 0)]


def test_hoisting_moves_what_depends_on_constants_alone() -> None:
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
    statements = [Let(A, Root(C) + D), Let(B, A * X), Require(sp.Gt(B, A), Status.UNREACHABLE), Let(Y, B / A + C)]
    program = normalise("p", statements, [Output("o", Y), Output("q", A)])
    (lowered,), hoisted = hoist([program], ["c", "d"])
    given = {"c": np.asarray(2.0), "d": np.asarray(0.5), "x": np.linspace(-2, 2, 9)}
    constants, _ = run(normalise("setup", hoisted, [Output(let.name.name, let.name) for let in hoisted]), given)
    before, after = run(program, given), run(lowered, {"x": given["x"], "c": given["c"], **constants})
    assert all(np.array_equal(before[0][k], after[0][k]) for k in before[0])
    assert np.array_equal(before[1], after[1])
    assert set(before[1]) == {Status.OK, Status.UNREACHABLE}


REGULAR, NEAR = sp.Gt(R, 2), sp.Gt(R, 1)
GIVEN = (X, Y, R)


def ran(items: Iterable[Item], values: Mapping[sp.Symbol, sp.Expr]) -> dict[sp.Symbol, sp.Expr]:
    """The values of all names after a tree has run; to read a name that is not bound is an error."""
    known = dict(values)

    def of(value: sp.Basic) -> sp.Basic:
        assert names_in(value) <= known.keys(), f"{value} reads what is not bound"
        return value.xreplace(known)

    for item in items:
        if isinstance(item, If):
            known = ran(item.holds if of(item.condition) == sp.true else item.fails, known)
        elif isinstance(item, Let):
            known[item.name] = of(item.value)
    return known


def bound_for_sure(items: Iterable[Item], known: frozenset[sp.Symbol]) -> frozenset[sp.Symbol]:
    """What is bound behind a tree on whatever way; to read what is not is an error."""
    for item in items:
        if isinstance(item, If):
            assert names_in(item.condition) <= known
            known = bound_for_sure(item.holds, known) & bound_for_sure(item.fails, known)
        elif isinstance(item, Let):
            assert names_in(item.value) <= known, f"{item.name} reads what one side of a choice alone binds"
            known |= {item.name}
    return known


def test_another_branch_has_values_of_its_own() -> None:
    """Where the names are bound once more, and the condition reads another value, it is another choice."""
    first = If(REGULAR, (Let(A, X), Let(B, -X)), (Let(A, Y), Let(B, Y)), (A, B))
    later = If(REGULAR, (Let(C, A),), (Let(C, B),), (C,))
    again = [Let(R, R - 2), first, If(REGULAR, (Let(Q, A),), (Let(Q, B),), (Q,))]
    found = joined([first, later, *again], [C, Q])
    assert [type(item) for item in found] == [If, Let, If]
    for r in (1, 3, 5):
        values = {X: sp.Integer(7), Y: sp.Integer(8), R: sp.Integer(r)}
        before, after = ran([first, later, *again], values), ran(found, values)
        assert {n: before[n] for n in (C, Q)} == {n: after[n] for n in (C, Q)}


@st.composite
def bodies(draw: st.DrawFn) -> list[Let]:
    """Statements, many of them choices by two conditions; each reads what stands before it."""
    body: list[Let] = []
    known: list[sp.Expr] = [X, Y]
    for place in range(draw(st.integers(2, 12))):
        one, two = draw(st.sampled_from(known)), draw(st.sampled_from(known))
        condition = draw(st.sampled_from([REGULAR, NEAR, None]))
        value = one + 2 * two if condition is None else Select(condition, one - 1, 3 * two + 1)
        body.append(Let(real(f"v{place}"), value))
        known.append(body[-1].name)
    return body


@pytest.mark.long
@given(bodies(), st.data())
def test_values_stay_the_same_and_are_bound_on_every_way(body: Sequence[Let], data: st.DataObject) -> None:
    """Joined or not, a tree has the same values on every side, and reads nothing that one side of a choice binds."""
    wanted = data.draw(st.lists(st.sampled_from([let.name for let in body]), min_size=1, unique=True))
    items = scheduled(body, wanted)
    found = joined(items, wanted)
    assert set(wanted) <= bound_for_sure(found, frozenset(GIVEN))
    for r in (sp.Rational(1, 2), sp.Rational(3, 2), sp.Integer(3)):
        values = {X: sp.Integer(7), Y: sp.Integer(-5), R: r}
        before, after = ran(items, values), ran(found, values)
        assert [before[n] for n in wanted] == [after[n] for n in wanted]


LARGE = sp.Gt(R, 1)


def test_the_order_of_operations_stays() -> None:
    """SymPy would make a cancelled sum and a product of three of these."""
    body = [Let(A, X - Y), Let(B, A + Y), Let(D, X * Y), Let(E, D * Z), Let(F, E + B)]
    items, _ = inlined(body, [F, F * B, B])
    text = {i.name.name: ScalarPrinter().print(i.value) for i in items if isinstance(i, Let)}
    assert text == {"b": "y + (x - y)", "f": "b + (x*y)*z"}


SIGNS = (Sign(real("sigma_arm"), ("front", "back")), Sign(real("sigma_elbow"), ("down", "up")))


def test_words_behind_a_name() -> None:
    assert without_words("axis_a1_front_up", SIGNS) == ("axis_a1", ("front", "up"))
    assert without_words("cos_q1_back", SIGNS) == ("cos_q1", ("back",))
    assert without_words("up", SIGNS) == ("up", ())
