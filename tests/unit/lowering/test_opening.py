"""A sum in a sum: taken apart where another sum has made the pair, and nowhere else."""

from __future__ import annotations

from derive.ir.program import Let
from derive.lowering.passes import lowered
from tests.unit.lowering.test_lower import A, B, F, G, H, X, Y, lets_of, program

FIRST, SECOND, THIRD = Let(F, X - A), Let(G, B * Y + A), Let(H, X - G)


def test_a_constant_of_the_machine_is_a_term_like_others() -> None:
    """A pair may consist of a constant and another term."""
    (shorter,), _ = lowered([program(FIRST, SECOND, THIRD, outputs=(F, H))], ("a",))
    assert lets_of(shorter) == {"f": X - A, "h": F - B * Y}
