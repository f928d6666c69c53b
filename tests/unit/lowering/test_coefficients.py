"""Constants that multiply one value of a sum are added; only where that saves an operation."""

from __future__ import annotations

from derive.ir.program import Let, Program
from derive.ir.symbols import real
from derive.lowering.lower import lowered
from tests.unit.lowering.test_lower import CONSTANTS, A, B, C, D, F, G, H, X, Y, lets_of, program


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
