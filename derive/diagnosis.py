"""What to say where a condition of a program does not hold: the quantity that refused, why, and how much is missing."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import sympy as sp
from sympy.core.relational import GreaterThan, Relational, StrictGreaterThan

from derive.program import LARGEST, Require, Status

NOT_INITIALIZED = "not initialized"
NO_MEANING = "byte {byte} of the configuration means nothing"


@dataclass(frozen=True)
class Check:
    """A comparison of its own, with what it says where it fails."""

    condition: sp.Basic
    status: Status
    reason: str
    missing: sp.Expr
    """How much one side is short of the other, in the unit of the quantity; zero where that means nothing."""


def checks_of(requires: Iterable[Require]) -> Iterator[Check]:
    """Every comparison of conditions that must all hold, in a fixed order."""
    for require in requires:
        for part in sp.ordered(sp.And.make_args(require.condition)):
            yield Check(part, require.otherwise, _reason(require.note, part), _missing(part))


def plain(note: str) -> str:
    """A note as text that every controller can show."""
    return note.replace("²", "^2").replace("'", "")


def _reason(note: str, part: sp.Basic) -> str:
    quantity = _quantity(part)
    if quantity is None:
        return plain(note)
    if _is_size_test(part):
        return plain(f"{note}: {quantity} is none")
    return plain(f"{note}: {quantity} is too {'small' if _asks_for_more(part) else 'large'}")


def _quantity(part: sp.Basic) -> str | None:
    """The name on the left side of a comparison, if it is one."""
    if not isinstance(part, Relational):
        return None
    left = part.lhs.args[0] if isinstance(part.lhs, sp.Abs) else part.lhs
    return left.name if isinstance(left, sp.Symbol) else None


def _missing(part: sp.Basic) -> sp.Expr:
    if not isinstance(part, Relational) or _is_size_test(part):
        return sp.Integer(0)
    return part.rhs - part.lhs if _asks_for_more(part) else part.lhs - part.rhs


def _asks_for_more(part: sp.Basic) -> bool:
    return isinstance(part, GreaterThan | StrictGreaterThan)


def _is_size_test(part: sp.Basic) -> bool:
    """Whether it asks of an input that it is a number: then nothing may be computed from it."""
    return isinstance(part, Relational) and part.rhs == LARGEST
