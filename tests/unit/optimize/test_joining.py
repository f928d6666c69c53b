"""Choices that an earlier one decides: what is read behind a choice, both of its sides bind."""

from collections.abc import Iterable, Mapping, Sequence

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from derive.ir.primitives import Select
from derive.ir.program import Let
from derive.ir.symbols import names_in, real
from derive.ir.tree import If, Item
from derive.lowering.scheduling import scheduled
from derive.optimize.joining import joined

A, B, C, P, Q, R, X, Y = (real(n) for n in "abcpqrxy")
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
