"""Arms: what only one side of a choice needs is computed there only."""

from __future__ import annotations

import sympy as sp

from derive.ir.primitives import (
    Root,
    Select,
)
from derive.ir.program import (
    Let,
    Require,
    Status,
)
from derive.ir.symbols import (
    real,
)
from derive.optimize.control_flow import Arms, Item, in_arms, spared

A, B, C, D, E, F, R, X, Y = (real(n) for n in "abcdefrxy")
REGULAR, NEAR = sp.Gt(R, 1), sp.Lt(X, 2)


def shape(items: tuple[Item, ...]) -> list[object]:
    """Names in order; a choice as its condition and its two sides."""
    found: list[object] = []
    for item in items:
        if isinstance(item, Arms):
            found.append((item.condition, shape(item.holds), shape(item.fails)))
        else:
            found.append(item.name if isinstance(item, Let) else "require")
    return found


def test_choices_by_one_condition_are_gathered_with_what_they_alone_need() -> None:
    body = [
        Let(A, Root(X)),
        Let(B, sp.sin(X)),
        Let(C, Select(REGULAR, A / R, B)),
        Let(D, X + 1),
        Let(E, Select(REGULAR, D / R, B + 1)),
    ]
    assert shape(in_arms(body, [C, E])) == [(REGULAR, [A, C, D, E], [B, C, E])]


def test_what_is_read_elsewhere_stays_before() -> None:
    body = [Let(A, Root(X)), Let(C, Select(REGULAR, A, Y)), Let(E, Select(REGULAR, A + 1, Y + 1)), Let(F, A + C + E)]
    assert shape(in_arms(body, [F])) == [A, (REGULAR, [C, E], [C, E]), F]


def test_a_name_for_a_name_disappears_where_nobody_else_reads_it() -> None:
    body = [Let(A, Select(REGULAR, R, sp.Integer(1))), Let(B, Select(REGULAR, X / A, Y)), Let(C, Select(REGULAR, Y / A, X))]
    (arms,) = in_arms(body, [B, C])
    assert isinstance(arms, Arms)
    assert arms.holds == (Let(B, X / R), Let(C, Y / R))
    assert arms.fails == (Let(B, Y), Let(C, X))


def test_a_negative_is_taken_from_what_has_been_computed() -> None:
    body = [Let(B, Select(REGULAR, X / R, Y)), Let(C, Select(REGULAR, -X / R, Y))]
    (arms,) = in_arms(body, [B, C])
    assert isinstance(arms, Arms) and arms.holds == (Let(B, X / R), Let(C, -B))


def test_a_choice_that_a_number_decides_is_decided_with_it() -> None:
    """`stays` is 1 where X is near, and then nobody needs the long way round."""
    stays, long_way = real("stays"), real("long_way")
    body = [
        Let(long_way, sp.sin(Y)),
        Let(stays, Select(NEAR, sp.Integer(1), Select(sp.Gt(long_way, 0), sp.Integer(1), sp.Integer(0)))),
        Let(A, Select(sp.Gt(stays, 0), Y, long_way)),
        Let(B, Select(sp.Gt(stays, 0), R, long_way + 1)),
    ]
    (arms,) = in_arms(body, [A, B])
    assert isinstance(arms, Arms) and arms.condition == NEAR
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
    assert shape(in_arms(body, [D, E, F])) == [(REGULAR, [A, C], [A, C]), F, (REGULAR, [D, E], [D, E])]


def test_a_condition_is_not_crossed() -> None:
    refused = Require(NEAR, Status.UNREACHABLE)
    body = [Let(A, Select(REGULAR, X, Y)), refused, Let(B, Select(REGULAR, Y, X))]
    assert in_arms(body, [A, B]) == tuple(body)


def test_what_only_second_sides_read_is_bound_on_each_of_them() -> None:
    body = [
        Let(D, sp.sin(Y)),
        Let(A, Select(REGULAR, X, D)),
        Let(B, Select(REGULAR, X + 1, D + 1)),
        Let(C, Select(NEAR, Y, D + A)),
        Let(E, Select(NEAR, Y + 1, D + B)),
    ]
    assert shape(in_arms(body, [A, B, C, E])) == [(REGULAR, [A, B], [D, A, B]), (NEAR, [C, E], [D, C, E])]


def test_a_side_keeps_a_statement() -> None:
    """Nothing reads A where the condition holds: the side is bound all the same, because a side cannot be empty."""
    choice = Arms(REGULAR, (Let(A, X),), (Let(A, Y),), (A,))
    later = Arms(REGULAR, (Let(B, X),), (Let(B, A + 1),), (B,))
    assert spared([choice, later], [B]) == (choice, later)


def test_a_single_choice_stays_an_expression() -> None:
    body = [Let(A, Root(X)), Let(B, Select(REGULAR, A, Y))]
    assert in_arms(body, [B]) == tuple(body)
