"""How a function refuses: it fills a refusal, unless its caller wants none, and returns its status."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce

import sympy as sp

from derive.emit import refusals
from derive.emit.c.printer import list_of, status, text
from derive.ir.program import Status
from derive.ir.reason import Unit


class Refusals(refusals.Refusals):
    """The refusals of one function."""

    largest, smallest = "fmax", "fmin"

    def refused(self, outcome: Status, reason: str = "", missing: str = "", turn: str = "") -> str:
        """The call that fills a refusal; a reason ends in the unit of the missing amount."""
        unit = next((u.value for u in Unit if u.value and reason.endswith(f" [{u.value}]")), "")
        words = reason.removesuffix(f" [{unit}]") if unit else reason
        return f"softkin_refuse(why, {status(outcome)}, {text(words)}, {text(unit)}, {missing or '0.0'}, {turn or '0'})"

    def refused_parameters(self, sentence: str, names: Sequence[str]) -> str:
        return f"softkin_refuse_parameters(why, {text(sentence)}, {text(', '.join(names))})"

    def reasonable(self, values: Sequence[str]) -> str:
        return f"softkin_are_reasonable((const double[]){list_of(values)}, {len(values)})"

    def inside(self, axis: str, lowest: str, highest: str) -> tuple[str, str]:
        return f"const int turn = softkin_turn_inside({axis}, {lowest}, {highest});", "turn != 0"

    def extreme(self, word: str, ends: Sequence[sp.Expr]) -> str:
        """The largest or the smallest of one or more limits: a function of C takes two numbers."""
        return reduce(lambda found, other: f"{word}({found}, {other})", map(self.printer.print, ends))
