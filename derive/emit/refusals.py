"""How a function of C or JavaScript refuses: with a status, the reason, the missing amount, and the turn that would be
inside.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import sympy as sp

from derive.emit.braced import Braced, block, indented
from derive.emit.expression import magnitude_tests
from derive.emit.inputs import Inputs
from derive.emit.setup import refused_inputs
from derive.ir.program import Call, Iterate, Require, Status
from derive.ir.reason import OtherTurn
from derive.report.reasons import Check, Reasons


@dataclass(frozen=True)
class Refusals(ABC):
    """The refusals of one function. The missing amount is computed where the refusal is returned, and nowhere else."""

    reasons: Reasons
    printer: Braced
    largest: ClassVar[str]
    smallest: ClassVar[str]

    @abstractmethod
    def refused(self, status: Status, reason: str = "", missing: str = "", turn: str = "") -> str:
        """The call that makes a refusal; callers get no reason if there is none."""

    @abstractmethod
    def refused_parameters(self, sentence: str, names: Sequence[str]) -> str:
        """The call that refuses the values of these parameters."""

    @abstractmethod
    def reasonable(self, values: Sequence[str]) -> str:
        """The test that all values are numbers of reasonable size."""

    @abstractmethod
    def inside(self, axis: str, lowest: str, highest: str) -> tuple[str, str]:
        """The statement that finds the turn of an axis that is inside limits, and the condition that there is one."""

    def lines(self, requires: Sequence[Require]) -> list[str]:
        """The lines that refuse if conditions about one subject do not all hold."""
        conditions = [r.condition for r in requires]
        notes = [] if magnitude_tests(conditions) else self.printer.comment(requires[0].comment)
        if any(r.reason is None for r in requires):  # callers get no reason
            return [*notes, *self._unless(conditions, self.refused(requires[0].otherwise))]
        return [*notes, *(line for check in self.reasons.checks(requires) for line in self._check(check))]

    def of_loop(self, status: Status, loop: Iterate) -> str:
        """The line that refuses if a loop is never left: a reason without an amount."""
        return f"return {self.refused(status, '' if loop.reason is None else self.reasons.loop(loop))};"

    def of_call(self, call: Call, outcome: str) -> str:
        """The line that refuses if a shared program does: it passes on the outcome, or has its own reason."""
        own = self.reasons.call(call)
        return f"return {outcome if own is None else self.refused(*own)};"

    def of_parameters(self, require: Require, inputs: Inputs) -> list[str]:
        """The lines that refuse parameters if a condition on them does not hold."""
        refused = self.refused_parameters(*refused_inputs(require, inputs))
        return [*self.printer.comment(require.note), *self._unless([require.condition], refused)]

    def _unless(self, conditions: Sequence[sp.Basic], refused: str) -> list[str]:
        return block(f"if (!({self.printer.conjunction(conditions)}))", [f"return {refused};"])

    def _check(self, check: Check) -> list[str]:
        missing = "" if check.missing is None else self.printer.print(check.missing)
        turns = [line for turn, reason in check.turns for line in self._on_another(turn, check.status, reason, missing)]
        values = [self.printer.print(value) for value in magnitude_tests(check.conditions)]
        head = self.reasonable(values) if values else f"({self.printer.conjunction(check.conditions)})"
        return block(f"if (!{head})", [*turns, f"return {self.refused(check.status, check.reason, missing)};"])

    def _on_another(self, turn: OtherTurn, status: Status, reason: str, missing: str) -> list[str]:
        """The lines that refuse because of the turn if another turn is inside the limits."""
        low, high = self.extreme(self.largest, turn.lowest), self.extreme(self.smallest, turn.highest)
        statement, found = self.inside(self.printer.print(turn.axis), low, high)
        refused = f"return {self.refused(status, reason, missing, 'turn')};"
        return ["{", *indented([statement, *self.printer.when(found, refused)]), "}"]

    def extreme(self, word: str, ends: Sequence[sp.Expr]) -> str:
        """The largest or the smallest of one or more limits."""
        texts = [self.printer.print(end) for end in ends]
        return f"{word}({', '.join(texts)})" if len(texts) > 1 else texts[0]
