"""How a body on plain numbers refuses: with a status, or with a diagnosis: which axis or leg, why, and how much is missing."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field

import sympy as sp
from sympy.core.relational import Relational

from derive.emit.python.calls import FOUND
from derive.emit.python.layout import fold
from derive.emit.python.printer import ScalarPrinter
from derive.ir.program import Iterate, Require, Status
from derive.ir.reason import OtherTurn
from derive.report.reasons import Check, Reasons

_SCALAR = ScalarPrinter()


@dataclass(frozen=True)
class Refusals:
    """How a body on plain numbers refuses: it returns what `answer` says for a status."""

    answer: Callable[[Status], str]
    success: str = field(default="Status.OK", kw_only=True)
    """What a body without results returns where nothing refuses."""

    def lines(self, requires: Sequence[Require]) -> list[str]:
        """Where conditions that refuse alike do not all hold."""
        head = fold(f"if not ({conjunction(r.condition for r in requires)}):")
        return [*head, f"    return {self.answer(requires[0].otherwise)}"]

    def of_loop(self, loop: Iterate) -> str:
        """Where a loop was never left."""
        return f"return {self.answer(loop.otherwise)}"

    def of_call(self) -> str:
        """Where a shared program has refused."""
        return f"return {FOUND}"


@dataclass(frozen=True)
class Explained(Refusals):
    """Refusals that say why. What is missing is computed there, and nowhere else."""

    reasons: Reasons

    def lines(self, requires: Sequence[Require]) -> list[str]:
        """Every reason for itself."""
        return [line for check in self.reasons.checks(requires) for line in self._lines(check)]

    def of_loop(self, loop: Iterate) -> str:
        """A loop that was never left has a reason and no amount."""
        return self._refused(loop.otherwise, self.reasons.loop(loop))

    def of_call(self) -> str:
        """A shared program has no reason of its own."""
        return f'return Diagnosis({FOUND}, "", 0.0)'

    def _lines(self, check: Check) -> Iterator[str]:
        yield from fold(f"if not ({conjunction(check.conditions)}):")
        missing = [] if check.missing is None else fold(f"missing = {_SCALAR.print(check.missing)}")
        amount = "missing" if missing else "0.0"
        inside = [line for turn, reason in check.turns for line in self._on_another(turn, check.status, reason, amount)]
        refused = fold(self._refused(check.status, check.reason, amount))
        yield from (f"    {line}" for line in (*missing, *inside, *refused))

    def _on_another(self, turn: OtherTurn, status: Status, reason: str, missing: str) -> list[str]:
        """Refuse because of the turn, where another one is inside."""
        low, high = (_one(word, ends) for word, ends in (("max", turn.lowest), ("min", turn.highest)))
        head = fold(f"if turn := turn_inside({_SCALAR.print(turn.axis)}, {low}, {high}):")
        return [*head, *(f"    {line}" for line in fold(self._refused(status, reason, f"{missing}, turn")))]

    def _refused(self, status: Status, reason: str, missing: str = "0.0") -> str:
        return f'return Diagnosis({self.answer(status)}, "{reason}", {missing})'


def status_of(status: Status) -> str:
    """A status as generated code names it."""
    return f"Status.{status.name}"


PLAIN = Refusals(status_of)
"""Refusals with a status alone."""


def explained(reasons: Reasons) -> Explained:
    """Refusals with a diagnosis; nothing where there is none."""
    return Explained(status_of, reasons, success="None")


def conjunction(conditions: Iterable[sp.Basic]) -> str:
    """Conditions that must all hold, as one."""
    parts = [p for c in conditions for p in (sp.ordered(c.args) if isinstance(c, sp.And) else [c])]
    if len(parts) == 1:
        return _SCALAR.print(parts[0])
    return " and ".join(_SCALAR.print(p) if isinstance(p, Relational) else f"({_SCALAR.print(p)})" for p in parts)


def _one(word: str, ends: Sequence[sp.Expr]) -> str:
    """The largest or the smallest of one or more ends."""
    texts = [_SCALAR.print(end) for end in ends]
    return f"{word}({', '.join(texts)})" if len(texts) > 1 else texts[0]
