"""Which axis may be inside limits on another of its turns, where these refuse it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import sympy as sp

from derive.description.mechanism import Joint, Limited, Mechanism
from derive.ir.symbols import (
    real,
)


@dataclass(frozen=True)
class OtherTurn:
    """An axis that is not between the largest of `lowest` and the smallest of `highest`, and may be on another turn."""

    name: str
    axis: sp.Symbol
    lowest: tuple[sp.Expr, ...]
    highest: tuple[sp.Expr, ...]

    def of(self, note: str) -> str:
        """Whose turn it is, where a condition with this note is not about the axis itself."""
        return "" if note.endswith(f" {self.name}") else f" of {self.name}"


def other_turns(mechanism: Mechanism) -> dict[str, tuple[OtherTurn, ...]]:
    """By the name of a limit (`lowest_a1`, `highest_a1`): the axes whose turn it may refuse, the last one first."""
    own = ((j.key, OtherTurn(j.name, j.axis, *_ends(j.key))) for j in mechanism.period_joints)
    found: dict[str, tuple[OtherTurn, ...]] = {key: (turn,) for key, turn in own}
    found |= {q.name: tuple(_of_quantity(q, mechanism)) for q in mechanism.limited if q.is_angle}
    return {f"{end}_{key}": turns for key, turns in found.items() for end in ("lowest", "highest")}


def _of_quantity(quantity: Limited, mechanism: Mechanism) -> Iterator[OtherTurn]:
    """Axes that turn a quantity once with each turn of their own: their limits, and how far it is from its own."""
    value = real(f"value_{quantity.name}")
    low, high = _ends(quantity.name)
    for joint in reversed(mechanism.joints):
        slope = sp.diff(quantity.value, joint.symbol)
        if not joint.multi_turn or slope not in (1, -1) or _moves_others(joint, quantity, mechanism):
            continue
        down, up = (low[0] - value, high[0] - value) if slope == 1 else (value - high[0], value - low[0])
        lowest, highest = _ends(joint.key)
        yield OtherTurn(joint.name, joint.axis, (*lowest, joint.axis + down), (*highest, joint.axis + up))


def _moves_others(joint: Joint, quantity: Limited, mechanism: Mechanism) -> bool:
    """Whether another joint of a quantity is geared to this axis."""
    return any(j.coupling.has(joint.motor) for j in mechanism.joints if j.symbol in quantity.value.free_symbols)


def _ends(key: str) -> tuple[tuple[sp.Expr], tuple[sp.Expr]]:
    return (real(f"lowest_{key}"),), (real(f"highest_{key}"),)
