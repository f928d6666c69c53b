"""The refusals of a method: how it ends where a condition of its program does not hold."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import sympy as sp

from derive.emit.braced import indented
from derive.emit.expression import is_size_test
from derive.emit.st.contract import Signature
from derive.emit.st.expression import StructuredText
from derive.emit.st.layout import INSIDE, WIDTH, conjunction, wrapped
from derive.ir.program import Call, Iterate, Require, Status
from derive.ir.reason import OtherTurn
from derive.report.reasons import Check, Reasons

REASON, MISSING, TURN = "iReason", "dMissing", "iTurn"
"""The outputs of a method that explains its refusals: the number of a text of Diagnose, the missing amount, and the
number of a turn that is inside the limits."""


@dataclass(frozen=True)
class Refusal:
    """Writes the statements up to RETURN, for a method with a given signature."""

    signature: Signature
    errors: Mapping[str, str]
    """The spelling of every status, by the name of the status."""
    type: str
    """The type of an error."""

    def of(self, status: Status) -> tuple[str, ...]:
        """The lines that refuse with a status."""
        return self.answering(self.errors[status.name])

    def of_loop(self, status: Status, loop: Iterate) -> tuple[str, ...]:
        """The lines that refuse if a loop is never left."""
        return self.of(status)

    def of_call(self, call: Call, outcome: str) -> tuple[str, ...]:
        """The lines that refuse if a shared program does: they pass on its error, or have their own."""
        return self.answering(outcome) if call.refusal is None else self.of(call.refusal[0])

    def answering(self, error: str) -> tuple[str, ...]:
        """The lines that refuse with an error, given as an expression. A method that returns BOOL then answers
        FALSE.
        """
        if not self.signature.returns:
            return ("RETURN;",)
        value = "FALSE" if self.signature.returns == "BOOL" else error
        return (f"{self.signature.name} := {value};", "RETURN;")

    def key(self, require: Require) -> object:
        """The key by which successive conditions are refused together: the same refusal and the same subject.

        Tests of the size of inputs stay separate, because AND evaluates both sides, and what follows is defined only
        where these tests hold.
        """
        subject = None if require.reason is None else require.reason.subject
        return require.otherwise, subject, all(map(is_size_test, sp.And.make_args(require.condition)))

    def note(self, require: Require) -> str:
        """The comment above conditions that are refused together, of which this is the first."""
        return require.comment

    def lines(self, requires: Sequence[Require], printer: StructuredText) -> list[str]:
        """The lines that refuse if conditions with the same refusal do not all hold."""
        conditions = [part for r in requires for part in sp.ordered(sp.And.make_args(r.condition))]
        head = conjunction("IF NOT (", [text for part in conditions for text in printer.parts(part)], ") THEN")
        return [*head, *indented(self.of(requires[0].otherwise)), "END_IF"]


@dataclass(frozen=True)
class Tested:
    """An axis whose limits are tested."""

    structure: str
    """The structure that holds its range."""
    value: str
    lowest: str
    highest: str
    """The neutral names of the ends of its range."""
    has_turns: bool


@dataclass(frozen=True)
class Explained(Refusal):
    """Writes refusals for a method that also gives the reason and the missing amount."""

    reasons: Reasons
    texts: Sequence[str]
    """All reasons of the block; the number of a reason is its position, counted from 1."""
    axes: Mapping[str, Tested] = field(default_factory=dict)
    """The axes whose limits one function tests, by the names of their values."""

    def of_call(self, call: Call, outcome: str) -> tuple[str, ...]:
        """The lines that refuse if a shared program does."""
        own = self.reasons.call(call)
        return self.answering(outcome) if own is None else self._because(own[1], own[0])

    def of_loop(self, status: Status, loop: Iterate) -> tuple[str, ...]:
        """The lines that refuse if a loop is never left."""
        return self._because(self.reasons.loop(loop), status)

    def lines(self, requires: Sequence[Require], printer: StructuredText) -> list[str]:
        """The lines that refuse, for each reason separately."""
        return list(self._lines(requires, printer))

    def _lines(self, requires: Sequence[Require], printer: StructuredText) -> Iterator[str]:
        checks = self.reasons.checks(requires)
        if (axis := self._of_axis(checks)) is not None:
            yield from self._beyond(axis, self._number(checks[0].reason))
            return
        for check in checks:
            parts = [text for c in check.conditions for text in printer.parts(c)]
            yield from conjunction("IF NOT (", parts, ") THEN")
            if check.missing is not None:
                yield from indented(wrapped(f"{MISSING} := {printer.print(check.missing)};", WIDTH - 3 * INSIDE))
            yield from indented([*self._numbered(check.reason, check.turns, printer), *self.of(check.status)])
            yield "END_IF"

    def _of_axis(self, checks: Sequence[Check]) -> Tested | None:
        """The axis whose two limits these checks test, and nothing else; their reasons have numbers in a row."""
        if len(checks) != 2:
            return None
        names = [{s.name for s in check.conditions[0].free_symbols} for check in checks]
        tested = [self.axes[name] for name in sorted(names[0] & names[1]) if name in self.axes]
        if len(tested) != 1:
            return None
        axis = tested[0]
        if [own - (names[0] & names[1]) for own in names] != [{axis.lowest}, {axis.highest}]:
            return None
        of_turns = [reason for _, reason in checks[0].turns]
        if len(of_turns) != axis.has_turns or any(turn.axis.args for check in checks for turn, _ in check.turns):
            return None
        first, *following = (self._number(text) for text in (checks[0].reason, *of_turns, checks[1].reason))
        return axis if following == list(range(first + 1, first + 1 + len(following))) else None

    def _beyond(self, axis: Tested, first: int) -> Iterator[str]:
        given = f"axis := {axis.structure}, dValue := {axis.value}, iFirst := {first}"
        results = ", ".join(f"{name} => {name}" for name in (MISSING, TURN))
        yield f"IF NOT (({axis.value} >= {axis.structure}.lowest) AND ({axis.value} <= {axis.structure}.highest)) THEN"
        call = [f"{REASON} := Softkin_Beyond({given},", f"  {results});"]
        yield from indented([*call, *self.of(Status.UNREACHABLE)])
        yield "END_IF"

    def _numbered(self, plain: str, turns: Sequence[tuple[OtherTurn, str]], printer: StructuredText) -> Iterator[str]:
        """The lines that set the number of the reason: that of the first axis with another turn inside its limits, else
        the plain one.
        """
        if not turns:
            yield f"{REASON} := {self._number(plain)};"
            return
        (turn, reason), *others = turns
        low, high = (_one(word, ends, printer) for word, ends in (("MAX", turn.lowest), ("MIN", turn.highest)))
        yield from wrapped(f"{TURN} := Softkin_TurnInside({printer.print(turn.axis)}, {low}, {high});")
        yield f"IF {TURN} <> 0 THEN"
        yield from indented([f"{REASON} := {self._number(reason)};"])
        yield "ELSE"
        yield from indented(list(self._numbered(plain, others, printer)))
        yield "END_IF"

    def _number(self, reason: str) -> int:
        return self.texts.index(reason) + 1

    def _because(self, reason: str, status: Status) -> tuple[str, ...]:
        return (f"{REASON} := {self._number(reason)};", *self.of(status))


def _one(word: str, ends: Sequence[sp.Expr], printer: StructuredText) -> str:
    """The largest or the smallest of one or more limits."""
    texts = [printer.print(end) for end in ends]
    return f"{word}({', '.join(texts)})" if len(texts) > 1 else texts[0]
