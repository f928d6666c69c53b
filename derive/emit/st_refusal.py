"""How a method ends where a condition of its program does not hold."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from derive.emit.st_contract import Signature
from derive.program import Status


@dataclass(frozen=True)
class Refusal:
    """The statements up to and with RETURN, for a method of that signature."""

    signature: Signature
    errors: Mapping[str, str]
    """The spelling of every status, by its name."""
    type: str
    """The type of an error."""

    def of(self, status: Status) -> tuple[str, ...]:
        """Refuse with a status."""
        return self.answering(self.errors[status.name])

    def answering(self, error: str) -> tuple[str, ...]:
        """Refuse with an error that an expression gives. What allows no pose is singular; any other question is answered no."""
        if not self.signature.returns:
            return ("RETURN;",)
        answer = "TRUE" if self.signature.name == "IsSingularity" else "FALSE"
        value = answer if self.signature.returns == "BOOL" else error
        return (f"{self.signature.name} := {value};", "RETURN;")
