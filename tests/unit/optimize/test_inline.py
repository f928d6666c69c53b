"""Read once: what is read once, and is short, is written where it is read."""

from __future__ import annotations

import sympy as sp

from derive.emit.python.printer import ScalarPrinter
from derive.ir.primitives import Atan2, NearestPeriod, Root, Select
from derive.ir.program import Let, Require, Status
from derive.ir.symbols import real
from derive.ir.tree import If
from derive.optimize.inline import LONGEST, Grouped, inlined

A, B, C, D, E, F, R, X, Y, Z = (real(n) for n in "abcdefrxyz")
REGULAR = sp.Gt(R, 1)


def test_a_chain_becomes_one_expression() -> None:
    """Values that are read once become one expression."""
    items, values = inlined([Let(A, X * Y), Let(B, X + A), Let(C, Atan2(B, Z)), Let(D, C * R)], [D])
    assert items == ()
    assert ScalarPrinter().print(values[D]) == "arctan2(x + x*y + 0.0, z + 0.0)*r"


def test_the_order_of_operations_stays() -> None:
    """SymPy would make a cancelled sum and a product of three of these."""
    body = [Let(A, X - Y), Let(B, A + Y), Let(D, X * Y), Let(E, D * Z), Let(F, E + B)]
    items, _ = inlined(body, [F, F * B, B])
    text = {i.name.name: ScalarPrinter().print(i.value) for i in items if isinstance(i, Let)}
    assert text == {"b": "y + (x - y)", "f": "b + (x*y)*z"}


def test_what_is_read_twice_keeps_its_name() -> None:
    """A value that is read twice keeps its name."""
    for value in (A + A * X, A**2, Root(A), Select(sp.Gt(A, 0), X, Y), NearestPeriod(X, A)):
        body = (Let(A, X * Y), Let(B, value))
        assert inlined(body, [B, B])[0] == body


def test_a_long_value_and_one_with_a_note_keep_theirs() -> None:
    """A long value and a value with a note keep their names."""
    long = sp.Add(*[real(f"x{i}") for i in range(LONGEST + 1)])
    body = [Let(A, long), Let(B, X + Y, "what it is"), Let(C, A * B), Let(D, C + C * X)]
    items, _ = inlined(body, [D])
    assert [i.name for i in items if isinstance(i, Let)] == [A, B, C]


def test_a_choice_a_root_and_a_turn_keep_theirs() -> None:
    """A choice, a root and a nearest period keep their names."""
    for value in (Select(REGULAR, X, Y), Root(X), NearestPeriod(X, Y)):
        body = (Let(A, value), Let(B, A + 1))
        assert inlined(body, [B, B])[0] == body


def test_read_once_on_each_side_of_a_choice() -> None:
    """A value that each side of a choice reads once is written into both sides."""
    choice = If(REGULAR, (Let(C, A + 1),), (Let(B, A * 2), Let(C, B - 1)), (C,))
    items, _ = inlined([Let(A, X * Y), choice], [C])
    (arms,) = items
    assert isinstance(arms, If)
    assert arms.holds == (Let(C, Grouped(X * Y) + 1),)
    assert arms.fails == (Let(C, Grouped(Grouped(X * Y) * 2) - 1),)


def test_read_behind_a_choice_or_by_its_condition_too() -> None:
    """A value that a statement after the choice or its condition reads, too, keeps its name."""
    choice = If(sp.Gt(B, 1), (Let(C, A + 1),), (Let(C, A - 1),), (C,))
    body = (Let(A, X * Y), Let(B, X + Y), choice, Let(D, A + C))
    items, _ = inlined(body, [D])
    assert items == body[:3]


def test_what_a_choice_binds_keeps_its_name() -> None:
    """A value that a choice binds keeps its name."""
    choice = If(REGULAR, (Let(C, X),), (Let(C, Y + X),), (C,))
    assert inlined([choice, Let(D, C + 1)], [D])[0] == (choice,)


def test_a_condition_may_be_between() -> None:
    """A value may be written into an expression behind a condition."""
    refused = Require(sp.Gt(X, 0), Status.UNREACHABLE)
    items, values = inlined([Let(A, X * Y), refused], [A])
    assert items == (refused,) and values[A] == Grouped(X * Y)
