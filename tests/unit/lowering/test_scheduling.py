"""Scheduling: what only one side of a choice needs is computed there only."""

import sympy as sp

from derive.ir.passes import normalise
from derive.ir.primitives import Select
from derive.ir.program import Let, Output, Program, Require, Solve, Statement, Status
from derive.ir.symbols import real
from derive.ir.tree import If, Item
from derive.lowering.passes import structured
from derive.lowering.scheduling import scheduled

A, B, C, D, E, F, R, X, Y = (real(n) for n in "abcdefrxy")
REGULAR, NEAR = sp.Gt(R, 1), sp.Lt(X, 2)


def shape(items: tuple[Item, ...]) -> list[object]:
    """Names in order; a choice as its condition and its two sides."""
    found: list[object] = []
    for item in items:
        if isinstance(item, If):
            found.append((item.condition, shape(item.holds), shape(item.fails)))
        else:
            found.append(item.name if isinstance(item, Let) else "require")
    return found


def test_a_choice_that_a_number_decides_is_decided_with_it() -> None:
    """`stays` is 1 where X is near, and then nobody needs the long way round."""
    stays, long_way = real("stays"), real("long_way")
    body = [
        Let(long_way, sp.sin(Y)),
        Let(stays, Select(NEAR, sp.Integer(1), Select(sp.Gt(long_way, 0), sp.Integer(1), sp.Integer(0)))),
        Let(A, Select(sp.Gt(stays, 0), Y, long_way)),
        Let(B, Select(sp.Gt(stays, 0), R, long_way + 1)),
    ]
    (arms,) = scheduled(body, [A, B])
    assert isinstance(arms, If) and arms.condition == NEAR
    assert arms.holds == (Let(A, Y), Let(B, R))
    assert shape(arms.fails)[0] == long_way


def test_what_needs_a_choice_before_it_is_not_gathered_with_that() -> None:
    """E needs F, which needs C and is needed outside: there are two choices."""
    body = [
        Let(A, Select(REGULAR, X, Y)),
        Let(C, Select(REGULAR, X + 1, Y + 1)),
        Let(F, A + C),
        Let(D, Select(REGULAR, F, Y)),
        Let(E, Select(REGULAR, F + 1, X)),
    ]
    assert shape(scheduled(body, [D, E, F])) == [(REGULAR, [A, C], [A, C]), F, (REGULAR, [D, E], [D, E])]


def test_a_condition_is_not_crossed() -> None:
    """Choices on both sides of a refusal stay on their sides."""
    refused = Require(NEAR, Status.UNREACHABLE)
    body = [Let(A, Select(REGULAR, X, Y)), refused, Let(B, Select(REGULAR, Y, X))]
    assert scheduled(body, [A, B]) == tuple(body)


def test_what_only_second_sides_read_is_bound_on_each_of_them() -> None:
    """A value that only the second sides of two choices read is bound on both of these sides."""
    body = [
        Let(D, sp.sin(Y)),
        Let(A, Select(REGULAR, X, D)),
        Let(B, Select(REGULAR, X + 1, D + 1)),
        Let(C, Select(NEAR, Y, D + A)),
        Let(E, Select(NEAR, Y + 1, D + B)),
    ]
    assert shape(scheduled(body, [A, B, C, E])) == [(REGULAR, [A, B], [D, A, B]), (NEAR, [C, E], [D, C, E])]


def refusing(*body: Statement) -> Program:
    return normalise("branch", body, [Output("a", A), Output("b", B)])


def test_a_choice_waits_for_what_it_needs() -> None:
    """B needs the solution of an equation, which stays behind the refusal."""
    first, refused, last = (
        Let(A, Select(REGULAR, X, Y)),
        Require(sp.Gt(A, 0), Status.UNREACHABLE),
        Let(B, Select(REGULAR, Y, D)),
    )
    program = refusing(first, refused, Solve((D,), (E,), (F,)), last)
    assert [type(item).__name__ for item in structured(program)] == ["Let", "Require", "Solve", "Let"]


def test_what_a_later_choice_needs_does_not_go_before_an_earlier_one() -> None:
    """C stands first, and only the second side of the second choice needs it."""
    body = [
        Let(C, sp.sin(Y)),
        Let(A, Select(NEAR, X, Y)),
        Let(D, Select(NEAR, X + 1, Y + 1)),
        Let(B, Select(REGULAR, A, C)),
        Let(E, Select(REGULAR, D, C + 1)),
    ]
    assert shape(scheduled(body, [A, B, D, E])) == [(NEAR, [A, D], [A, D]), (REGULAR, [B, E], [B, E])]
