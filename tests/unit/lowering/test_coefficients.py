"""Constants that multiply: collected in a sum, and taken into the terms of one; only where an operation is saved."""

from __future__ import annotations

import pytest
import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.primitives import Select
from derive.ir.program import Let, Program
from derive.ir.symbols import real
from derive.lowering.lower import lowered
from derive.report.cost import Cost, cost_of
from tests.unit.lowering.test_lower import CONSTANTS, A, B, C, D, F, G, H, X, Y, lets_of, program

P, Q = real("p"), real("q")


def shorter_of(one: Program) -> Program:
    (shorter,), _ = lowered([one], CONSTANTS)
    return shorter


def test_the_coefficients_of_a_value_are_added_although_one_product_has_a_name() -> None:
    """c x + d x becomes (c + d) x, also where c x has a name."""
    shorter = shorter_of(program(Let(F, C * X), Let(G, F + D * X - Y), outputs=(F, G)))
    assert lets_of(shorter) == {"f": C * X, "g": real("c_plus_d") * X - Y}


def test_a_value_beside_its_multiple_has_the_coefficient_one() -> None:
    """f - c f becomes (1 - c) f."""
    assert lets_of(shorter_of(program(Let(F, X - Y), Let(G, A * F), Let(H, F - C * F), outputs=(G, H)))) == {
        "f": X - Y, "h": real("one_minus_c") * F,
    } | {"g": A * F}  # fmt: skip


def test_products_that_are_read_elsewhere_are_added_as_they_are() -> None:
    """Products that are needed in any case are added, and not multiplied again."""
    one = program(Let(F, C * X), Let(G, D * X), Let(H, F + G), outputs=(F, G, H))
    assert lets_of(shorter_of(one)) == {"f": C * X, "g": D * X, "h": F + G}


def test_what_is_no_constant_is_not_collected() -> None:
    """Coefficients that depend on the pose are not added."""
    one = program(Let(F, A * X), Let(G, F + B * X), outputs=(F, G))
    assert lets_of(shorter_of(one)) == {"f": A * X, "g": F + B * X}


@pytest.mark.parametrize(
    ("value", "cost"),
    [
        (C * (D * X + C * Y), Cost(1, 2)),
        (C * (D * X - 3 * Y + D), Cost(2, 2)),
        ((C * X - D * Y) / C, Cost(1, 1)),
        (C * Select(X > 0, D * X, C * Y - D), Cost(1, 2)),
        (C * Select(X > 0, C, D), Cost()),
        (C * (X + D * Y), Cost(1, 2)),
        (C * Select(X > 0, X, D * Y), Cost(0, 2)),
        ((2 * X + 3 * Y) / DEGREE, Cost(1, 3)),
    ],
)
def test_a_constant_goes_into_the_terms_of_a_sum_where_each_has_one(value: sp.Expr, cost: Cost) -> None:
    """A constant in front of a sum is multiplied into its terms where every term has a constant coefficient."""
    assert cost_of(shorter_of(program(Let(F, value), outputs=(F,)))) == cost


def test_a_sum_that_is_read_elsewhere_stays() -> None:
    """A constant is not multiplied into a sum that another value reads."""
    one = program(Let(G, D * X + C * Y), Let(F, C * G), outputs=(F, G))
    assert lets_of(shorter_of(one)) == {"g": D * X + C * Y, "f": C * G}


def test_sums_that_two_choices_read_are_scaled_once_under_a_name_that_says_so() -> None:
    """Two choices between the same sums read sums that are scaled once."""
    swap = X > Y
    lets = (
        Let(P, C * X - D * Y),
        Let(Q, D * X + C * Y),
        Let(F, C * Select(swap, P, Q)),
        Let(G, C * Select(swap, Q, P)),
    )
    shorter = shorter_of(program(*lets, outputs=(F, G)))
    assert set(lets_of(shorter)) == {"scaled_p", "scaled_q", "f", "g"} and cost_of(shorter) == Cost(2, 4)


def test_nothing_is_scaled_where_one_of_two_choices_has_a_side_without_a_coefficient() -> None:
    """Choices are not scaled where one side has no constant coefficient."""
    swap = X > Y
    lets = (
        Let(P, C * X - D * Y),
        Let(Q, D * X + C * Y),
        Let(F, C * Select(swap, P, Q)),
        Let(G, C * Select(swap, X, P)),
    )
    shorter = shorter_of(program(*lets, outputs=(F, G)))
    assert set(lets_of(shorter)) == {"p", "q", "f", "g"}


def test_a_condition_is_not_scaled() -> None:
    """A sum that a condition reads is not scaled."""
    lets = (Let(P, C * X - D * Y), Let(F, C * Select(P > 0, P, D)))
    shorter = shorter_of(program(*lets, outputs=(F,)))
    assert lets_of(shorter)["p"] == C * X - D * Y
