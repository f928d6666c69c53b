"""How a body on plain numbers refuses: with a status, or with a diagnosis, which names the axis or the leg, the reason
and the missing amount."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace

import sympy as sp
from sympy.core.relational import Relational

from derive.emit.expression import magnitude_tests, parts_of
from derive.emit.python.calls import FOUND
from derive.emit.python.layout import note_lines, quoted
from derive.emit.python.printer import ScalarPrinter
from derive.ir.program import Call, Iterate, Require, Status
from derive.ir.reason import OtherTurn, Reason, Why
from derive.report.reasons import Check, Reasons

_SCALAR = ScalarPrinter()
_MANY = 3
"""At least this many values are tested for size by a call."""


@dataclass(frozen=True)
class Refusals:
    """Refusals that return what `answer` gives for a status."""

    answer: Callable[[Status], str]
    success: str = field(default="Status.OK", kw_only=True)
    """The return value of a body without results where no condition refuses."""

    def lines(self, requires: Sequence[Require]) -> list[str]:
        """The lines that refuse if conditions with the same refusal do not all hold."""
        head = _unless([r.condition for r in requires])
        return [*_notes(requires), head, f"    return {self.answer(requires[0].otherwise)}"]

    def of_loop(self, status: Status, loop: Iterate) -> str:
        """The line that refuses if a loop is never left."""
        return f"return {self.answer(status)}"

    def of_call(self, call: Call) -> str:
        """The line with which a caller refuses if a shared program does: by passing it on, or with its own."""
        return f"return {FOUND if call.refusal is None else self.answer(call.refusal[0])}"


@dataclass(frozen=True)
class Explained(Refusals):
    """Refusals with a reason. The missing amount is computed where the refusal is returned, and nowhere else."""

    reasons: Reasons

    def lines(self, requires: Sequence[Require]) -> list[str]:
        """The lines that refuse, for each reason separately; the two limits of one value are tested together."""
        if len(requires) == 2 and (limits := Limits.of(*requires)) is not None:
            return self._between(limits)
        return [*_notes(requires), *(line for check in self.reasons.checks(requires) for line in self._lines(check))]

    def of_loop(self, status: Status, loop: Iterate) -> str:
        """The line that refuses if a loop is never left: a reason without an amount."""
        return self._refused(status, self.reasons.loop(loop))

    def of_call(self, call: Call) -> str:
        """The line with which a caller refuses if a shared program does, which gives no reason itself."""
        own = self.reasons.call(call)
        return f'return Diagnosis({FOUND}, "", 0.0)' if own is None else self._refused(*own)

    def _lines(self, check: Check) -> Iterator[str]:
        yield _unless(check.conditions)
        missing = [] if check.missing is None else [f"missing = {_SCALAR.print(check.missing)}"]
        amount = "missing" if missing else "0.0"
        inside = [line for turn, reason in check.turns for line in self._on_another(turn, check.status, reason, amount)]
        refused = [self._refused(check.status, check.reason, amount)]
        yield from (f"    {line}" for line in (*missing, *inside, *refused))

    def _on_another(self, turn: OtherTurn, status: Status, reason: str, missing: str) -> list[str]:
        """The lines that refuse because of the turn where another turn is inside the limits."""
        return [f"if turn := {_turn_inside(turn)}:", f"    {self._refused(status, reason, f'{missing}, turn')}"]

    def _between(self, limits: Limits) -> list[str]:
        """The lines that refuse a value beyond one of its limits. Functions of the package compute the missing amount,
        and the number of a turn that is inside.
        """
        value, low, high = map(_SCALAR.print, (limits.value, limits.lowest, limits.highest))
        subject = self.reasons.name(limits.reason.subject)
        given = f"{quoted(subject)}, {value}, {low}, {high}"
        turns = limits.reason.turns
        if turns == (OtherTurn(subject, limits.value, (limits.lowest,), (limits.highest,)),):
            refused = f"beyond_turn({given})"
        else:
            others = ", ".join(f"{quoted(turn.name)}: {_turn_inside(turn)}" for turn in turns)
            refused = f'beyond({given}, "{limits.reason.unit.value}"{f", {{{others}}}" if others else ""})'
        return [f"if not {low} <= {value} <= {high}:", f"    return {refused}"]

    def _refused(self, status: Status, reason: str, missing: str = "0.0") -> str:
        return f"return Diagnosis({self.answer(status)}, {quoted(reason)}, {missing})"


@dataclass(frozen=True)
class Limits:
    """The two conditions that a value is between its limits, with the reason for each: below the lower limit, or above
    the upper one.
    """

    value: sp.Expr
    lowest: sp.Expr
    highest: sp.Expr
    reason: Reason

    @classmethod
    def of(cls, below: Require, above: Require) -> Limits | None:
        """The limits that two conditions test; None if they test something else."""
        low, high, reason, other = below.condition, above.condition, below.reason, above.reason
        if not (
            isinstance(low, sp.GreaterThan)
            and isinstance(high, sp.LessThan)
            and low.lhs == high.lhs
            and reason
            and other
        ):
            return None
        found = cls(low.lhs, low.rhs, high.rhs, reason)
        amounts = (Why.BELOW, low.rhs - low.lhs), (Why.ABOVE, high.lhs - high.rhs)
        is_alike = (reason, other) == tuple(replace(reason, why=why, amount=amount) for why, amount in amounts)
        return found if is_alike and below.otherwise is above.otherwise is Status.UNREACHABLE else None


def _unless(conditions: Sequence[sp.Basic]) -> str:
    """The `if` in front of the statements for the case that conditions do not all hold."""
    values = magnitude_tests(conditions, _MANY)
    if values:
        return f"if not reasonable({', '.join(map(_SCALAR.print, values))}):"
    return f"if not ({conjunction(conditions)}):"


def _notes(requires: Sequence[Require]) -> list[str]:
    """The subject of the conditions as a comment; none for inputs, where the name of the called function tells it."""
    note = requires[0].comment
    return [] if magnitude_tests([requires[0].condition], _MANY) else note_lines(note)


def status_of(status: Status) -> str:
    """A status as the generated code names it."""
    return f"Status.{status.name}"


PLAIN = Refusals(status_of)
"""Refusals with a status alone."""


def explained(reasons: Reasons) -> Explained:
    """Refusals with a diagnosis; a body without results returns None if no condition refuses."""
    return Explained(status_of, reasons, success="None")


def conjunction(conditions: Iterable[sp.Basic]) -> str:
    """Conditions that must all hold, as one."""
    parts = parts_of(conditions)
    if len(parts) == 1:
        return _SCALAR.print(parts[0])
    return " and ".join(_SCALAR.print(p) if isinstance(p, Relational) else f"({_SCALAR.print(p)})" for p in parts)


def _turn_inside(turn: OtherTurn) -> str:
    """The call that finds the number of a turn inside the limits."""
    low, high = (_one(word, ends) for word, ends in (("max", turn.lowest), ("min", turn.highest)))
    return f"turn_inside({_SCALAR.print(turn.axis)}, {low}, {high})"


def _one(word: str, ends: Sequence[sp.Expr]) -> str:
    """The largest or the smallest of one or more limits."""
    texts = [_SCALAR.print(end) for end in ends]
    return f"{word}({', '.join(texts)})" if len(texts) > 1 else texts[0]
