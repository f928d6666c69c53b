"""A sum in a sum: taken apart where another sum has made the pair, and nowhere else."""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from derive.ir.program import Let, Require, Status
from derive.ir.reason import Why, about_machine
from derive.lowering.lower import lowered
from derive.report.cost import cost_of
from tests.unit.lowering.test_lower import A, B, F, G, H, X, Y, lets_of, program

FIRST, SECOND, THIRD = Let(F, X - A), Let(G, B * Y + A), Let(H, X - G)


def test_a_sum_is_opened_where_another_has_the_pair() -> None:
    """A sum is replaced by its terms where this gives a pair that another sum has."""
    (shorter,), _ = lowered([program(FIRST, SECOND, THIRD, outputs=(F, H))], ())
    assert lets_of(shorter) == {"f": X - A, "h": F - B * Y}


def test_a_constant_of_the_machine_is_a_term_like_others() -> None:
    """A pair may consist of a constant and another term."""
    (shorter,), _ = lowered([program(FIRST, SECOND, THIRD, outputs=(F, H))], ("a",))
    assert lets_of(shorter) == {"f": X - A, "h": F - B * Y}


def test_a_pair_with_other_signs_is_another_pair() -> None:
    """A pair with other relative signs is not shared."""
    (shorter,), _ = lowered([program(Let(F, X + A), SECOND, THIRD, outputs=(F, H))], ())
    assert lets_of(shorter) == {"f": A + X, "g": B * Y + A, "h": X - G}


def test_a_sum_that_is_read_twice_stays() -> None:
    """A sum that two values read is not replaced by its terms."""
    (shorter,), _ = lowered([program(FIRST, SECOND, THIRD, outputs=(F, G, H))], ())
    assert lets_of(shorter) == {"f": X - A, "g": B * Y + A, "h": X - G} and cost_of(shorter).additions == 3


def test_what_a_refusal_tells_is_a_reader() -> None:
    """A sum that the amount of a reason reads is not replaced by its terms."""
    reason = replace(about_machine(Why.OTHER_MIRROR), amount=G)
    refusal = Require(sp.Gt(H, 0), Status.UNREACHABLE, reason=reason)
    (shorter,), _ = lowered([program(FIRST, SECOND, THIRD, refusal, outputs=(F, H))], ())
    (kept,) = shorter.requires()
    assert lets_of(shorter)["h"] == X - G and kept.reason == reason
