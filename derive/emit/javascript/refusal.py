"""How a function refuses: it returns a `Refusal`."""

from __future__ import annotations

from collections.abc import Sequence

from derive.emit import refusals
from derive.emit.javascript.printer import PRINTER, status, text
from derive.ir.program import Status
from derive.report.reasons import Reasons


class Refusals(refusals.Refusals):
    """The refusals of one mechanism."""

    largest, smallest = "Math.max", "Math.min"

    def refused(self, outcome: Status, reason: str = "", missing: str = "", turn: str = "") -> str:
        given = [status(outcome), text(reason) if reason else "", missing or ("0" if turn else ""), turn]
        return f"refuse({', '.join(filter(None, given))})"

    def refused_parameters(self, sentence: str, names: Sequence[str]) -> str:
        return f"refuseParameters({text(sentence)}, {text(names)})"

    def reasonable(self, values: Sequence[str]) -> str:
        return f"isReasonable({', '.join(values)})"

    def inside(self, axis: str, lowest: str, highest: str) -> tuple[str, str]:
        return f"const turn = turnInside({axis}, {lowest}, {highest});", "turn"


def refusals_of(reasons: Reasons) -> Refusals:
    """The refusals of a mechanism with these reasons."""
    return Refusals(reasons, PRINTER)
