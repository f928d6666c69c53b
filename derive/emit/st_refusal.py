"""How a method ends where a condition of its program does not hold."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from derive.diagnosis import checks_of, plain
from derive.emit.st_contract import Signature
from derive.emit.st_expression import StructuredText
from derive.emit.st_layout import conjunction, indented, wrapped
from derive.program import Require, Status

REASON, MISSING = "sReason", "dMissing"
"""The outputs of a method that explains its refusals."""


@dataclass(frozen=True)
class Refusal:
    """The statements up to and with RETURN, for a method of that signature."""

    signature: Signature
    errors: Mapping[str, str]
    """The spelling of every status, by its name."""
    type: str
    """The type of an error."""

    def of(self, status: Status, note: str = "") -> tuple[str, ...]:
        """Refuse with a status."""
        return self.answering(self.errors[status.name])

    def answering(self, error: str) -> tuple[str, ...]:
        """Refuse with an error that an expression gives. Where a method answers yes or no, refusing is yes."""
        if not self.signature.returns:
            return ("RETURN;",)
        value = "TRUE" if self.signature.returns == "BOOL" else error
        return (f"{self.signature.name} := {value};", "RETURN;")

    def lines(self, requires: Sequence[Require], printer: StructuredText) -> list[str]:
        """Refuse where conditions that refuse alike do not all hold."""
        parts = [printer.print(part) for r in requires for part in sp.ordered(sp.And.make_args(r.condition))]
        head = conjunction("IF NOT (", parts, ") THEN")
        return [*head, *indented(self.of(requires[0].otherwise)), "END_IF"]


@dataclass(frozen=True)
class Explained(Refusal):
    """The same for a method that says which quantity refused, why, and how much is missing."""

    def of(self, status: Status, note: str = "") -> tuple[str, ...]:
        """Refuse with a status and a reason."""
        return (f"{REASON} := '{plain(note)}';", *super().of(status))

    def lines(self, requires: Sequence[Require], printer: StructuredText) -> list[str]:
        """Every comparison refuses for itself."""
        return list(self._lines(requires, printer))

    def _lines(self, requires: Sequence[Require], printer: StructuredText) -> Iterator[str]:
        for check in checks_of(requires):
            yield from conjunction("IF NOT (", [printer.print(check.condition)], ") THEN")
            if check.missing != 0:
                yield from indented(wrapped(f"{MISSING} := {printer.print(check.missing)};"))
            yield from indented(self.of(check.status, check.reason))
            yield "END_IF"
