"""How a function refuses: with a status, the reason, the missing amount, and the turn that would be inside."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import sympy as sp

from derive.emit.braces import block, indented
from derive.emit.conditions import parts_of, sized
from derive.emit.javascript.layout import comment
from derive.emit.javascript.printer import PRINTER, status, text
from derive.ir.program import Call, Iterate, Require, Status
from derive.ir.reason import OtherTurn
from derive.report.reasons import Check, Reasons


@dataclass(frozen=True)
class Refusals:
    """The refusals of one mechanism. The missing amount is computed where the refusal is returned, and nowhere else."""

    reasons: Reasons

    def lines(self, requires: Sequence[Require]) -> list[str]:
        """The lines that refuse where conditions about one subject do not all hold."""
        notes = [] if sized(r.condition for r in requires) else comment(requires[0].comment)
        explained = [r for r in requires if r.reason is not None]
        if len(explained) < len(requires):  # callers get no reason
            head = f"if (!({condition_of([r.condition for r in requires])}))"
            return [*notes, *block(head, [f"return refuse({status(requires[0].otherwise)});"])]
        return [*notes, *(line for check in self.reasons.checks(requires) for line in self._check(check))]

    def of_loop(self, outcome: Status, loop: Iterate) -> str:
        """The line that refuses where a loop is never left: a reason without an amount."""
        reason = "" if loop.reason is None else f", {text(self.reasons.loop(loop))}"
        return f"return refuse({status(outcome)}{reason});"

    def of_call(self, call: Call, found: str) -> str:
        """The line that refuses where a shared program does."""
        own = self.reasons.call(call)
        return f"return {found};" if own is None else f"return refuse({status(own[0])}, {text(own[1])});"

    def _check(self, check: Check) -> list[str]:
        given = [status(check.status), text(check.reason)]
        given += [] if check.missing is None else [PRINTER.print(check.missing)]
        inner = [line for turn, reason in check.turns for line in _on_another(turn, reason, check)]
        values = ", ".join(map(PRINTER.print, sized(check.conditions)))
        head = f"isReasonable({values})" if values else f"({condition_of(check.conditions)})"
        return block(f"if (!{head})", [*inner, f"return refuse({', '.join(given)});"])


def _on_another(turn: OtherTurn, reason: str, check: Check) -> Iterator[str]:
    """The lines that refuse because of the turn where another turn is inside the limits."""
    low, high = (_one(word, ends) for word, ends in (("Math.max", turn.lowest), ("Math.min", turn.highest)))
    missing = "0" if check.missing is None else PRINTER.print(check.missing)
    inside = f"const turn = turnInside({PRINTER.print(turn.axis)}, {low}, {high});"
    refused = f"if (turn) return refuse({status(check.status)}, {text(reason)}, {missing}, turn);"
    yield from ["{", *indented([inside, refused]), "}"]


def _one(word: str, ends: Sequence[sp.Expr]) -> str:
    """The largest or the smallest of one or more limits."""
    texts = [PRINTER.print(end) for end in ends]
    return f"{word}({', '.join(texts)})" if len(texts) > 1 else texts[0]


def condition_of(conditions: Iterable[sp.Basic]) -> str:
    """Conditions that must all hold, as one."""
    parts = parts_of(conditions)
    if len(parts) == 1:
        return PRINTER.print(parts[0])
    return " && ".join(PRINTER.print(p) if _is_plain(p) else f"({PRINTER.print(p)})" for p in parts)


def _is_plain(condition: sp.Basic) -> bool:
    return not isinstance(condition, sp.Or)
