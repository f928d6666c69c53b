"""How a function refuses: with a status, the reason, the missing amount, and the turn that would be inside."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import sympy as sp

from derive.emit.braces import block, indented
from derive.emit.c.layout import comment
from derive.emit.c.printer import C, status, text
from derive.emit.conditions import parts_of, sized
from derive.ir.program import Call, Iterate, Require, Status
from derive.ir.reason import OtherTurn, Unit
from derive.report.reasons import Check, Reasons


@dataclass(frozen=True)
class Refusals:
    """The refusals of one function. The missing amount is computed where the refusal is returned, and nowhere else."""

    reasons: Reasons
    printer: C

    def lines(self, requires: Sequence[Require]) -> list[str]:
        """The lines that refuse where conditions about one subject do not all hold."""
        notes = [] if sized(r.condition for r in requires) else comment(requires[0].comment)
        explained = [r for r in requires if r.reason is not None]
        if len(explained) < len(requires):  # callers get no reason
            head = f"if (!({self.condition([r.condition for r in requires])}))"
            return [*notes, *block(head, [f"return {refused(requires[0].otherwise, '')};"])]
        return [*notes, *(line for check in self.reasons.checks(requires) for line in self._check(check))]

    def of_loop(self, outcome: Status, loop: Iterate) -> str:
        """The line that refuses where a loop is never left: a reason without an amount."""
        return f"return {refused(outcome, '' if loop.reason is None else self.reasons.loop(loop))};"

    def of_call(self, call: Call, outcome: str) -> str:
        """The line that refuses where a shared program does."""
        own = self.reasons.call(call)
        return f"return {outcome};" if own is None else f"return {refused(*own)};"

    def condition(self, conditions: Iterable[sp.Basic]) -> str:
        """Conditions that must all hold, as one."""
        parts = parts_of(conditions)
        if len(parts) == 1:
            return self.printer.print(parts[0])
        printed = ((part, self.printer.print(part)) for part in parts)
        return " && ".join(f"({one})" if isinstance(part, sp.Or) else one for part, one in printed)

    def _check(self, check: Check) -> list[str]:
        missing = "0.0" if check.missing is None else self.printer.print(check.missing)
        inner = [line for turn, reason in check.turns for line in self._on_another(turn, reason, check, missing)]
        values = [self.printer.print(value) for value in sized(check.conditions)]
        if values:
            head = f"softkin_are_reasonable((const double[]){{{', '.join(values)}}}, {len(values)})"
        else:
            head = f"({self.condition(check.conditions)})"
        return block(f"if (!{head})", [*inner, f"return {refused(check.status, check.reason, missing)};"])

    def _on_another(self, turn: OtherTurn, reason: str, check: Check, missing: str) -> Iterator[str]:
        """The lines that refuse because of the turn where another turn is inside the limits."""
        low, high = (self._one(word, ends) for word, ends in (("fmax", turn.lowest), ("fmin", turn.highest)))
        inside = f"const int turn = softkin_turn_inside({self.printer.print(turn.axis)}, {low}, {high});"
        yield from ["{", *indented([
            inside, *block("if (turn != 0)", [f"return {refused(check.status, reason, missing, 'turn')};"]),
        ]), "}"]  # fmt: skip

    def _one(self, word: str, ends: Sequence[sp.Expr]) -> str:
        """The largest or the smallest of one or more limits."""
        found, *others = [self.printer.print(end) for end in ends]
        for other in others:
            found = f"{word}({found}, {other})"
        return found


def refused(outcome: Status, reason: str, missing: str = "0.0", turn: str = "0") -> str:
    """The call that fills a refusal; a reason ends in the unit of the missing amount."""
    unit = next((u.value for u in Unit if u.value and reason.endswith(f" [{u.value}]")), "")
    words = reason.removesuffix(f" [{unit}]") if unit else reason
    return f"softkin_refuse(why, {status(outcome)}, {text(words)}, {text(unit)}, {missing}, {turn})"
