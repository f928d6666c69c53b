"""The inverse and its limits as functions that say which axis or leg refused, why, and how much is missing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import sympy as sp

from derive.emit.python.calls import FOUND
from derive.emit.python.layout import fold
from derive.emit.python.methods import branch, limits
from derive.emit.python.printer import ScalarPrinter, primitives_in
from derive.emit.python.program import Method, Refusals, conjunction, scalar_body
from derive.ir.program import Call, Iterate, Require, Status
from derive.kinematics.kinematics import Kinematics
from derive.report.other_turns import OtherTurn
from derive.report.reasons import Reasons, reasons_of

_PRINTER = ScalarPrinter()


def diagnosis(kin: Kinematics) -> dict[str, object]:
    """What the template reads: the primitives, and the functions with their heads and bodies."""
    refusals = Explained(lambda status: f"Status.{status.name}", reasons_of(kin))
    methods = (branch(kin), limits(kin))
    bodies = [_body(m, refusals) for m in methods]
    return {
        "names_turns": any("turn_inside" in line for body in bodies for line in body),
        "primitives": primitives_in(line for body in bodies for line in body if '"' not in line),
        "calls": any(map(_calls, methods)),
        "functions": [{"head": _head(m), "summary": m.summary, "body": b} for m, b in zip(methods, bodies, strict=True)],
    }


def _head(method: Method) -> list[str]:
    arguments = "".join(f", {a.name}: {a.kind}" for a in method.arguments)
    result = f"{method.kind} | Diagnosis" if method.kind else "Diagnosis"
    return fold(f"def {method.name}({'self: Any, ' if _calls(method) else ''}constants: Constants{arguments}) -> {result}:", 0)


def _calls(method: Method) -> bool:
    """Whether a program calls others, which are methods of the mechanism."""
    return any(isinstance(s, Call) for s in method.program.body)


def _body(method: Method, refusals: Explained) -> list[str]:
    """Without the notes: they stand in the module of the mechanism."""
    body = scalar_body(method, "constants", refusals)
    lines = [line.partition("  # ")[0] for line in body if not line.lstrip().startswith("#")]
    return lines if method.kind else [*lines[:-1], 'return Diagnosis(Status.OK, "", 0.0)']


@dataclass(frozen=True)
class Explained(Refusals):
    """Refusals that say why."""

    reasons: Reasons

    def lines(self, requires: Sequence[Require]) -> list[str]:
        """Every reason for itself."""
        return list(self._lines(requires))

    def of_loop(self, loop: Iterate) -> str:
        """A loop that was never left has a reason and no amount."""
        return self._refused(loop.otherwise, self.reasons.loop(loop))

    def of_call(self) -> str:
        """A shared program has no reason of its own."""
        return f'return Diagnosis({FOUND}, "", 0.0)'

    def reads(self, require: Require) -> tuple[sp.Expr, ...]:
        """The amounts, and what other turns are compared with."""
        checks = self.reasons.checks([require])
        turns = [turn for check in checks for turn, _ in check.turns]
        return (*(c.missing for c in checks), *(e for t in turns for e in (t.axis, *t.lowest, *t.highest)))

    def _lines(self, requires: Sequence[Require]) -> Iterator[str]:
        for check in self.reasons.checks(requires):
            yield from fold(f"if not ({conjunction(check.conditions)}):")
            missing = fold(f"missing = {_PRINTER.print(check.missing)}") if check.missing != 0 else []
            amount = "missing" if missing else "0.0"
            inside = [line for turn, reason in check.turns for line in self._on_another(turn, check.status, reason, amount)]
            refused = fold(self._refused(check.status, check.reason, amount))
            yield from (f"    {line}" for line in (*missing, *inside, *refused))

    def _on_another(self, turn: OtherTurn, status: Status, reason: str, missing: str) -> list[str]:
        """Refuse because of the turn, where another one is inside."""
        low, high = (_one(word, ends) for word, ends in (("max", turn.lowest), ("min", turn.highest)))
        head = fold(f"if turn := turn_inside({_PRINTER.print(turn.axis)}, {low}, {high}):")
        return [*head, *(f"    {line}" for line in fold(self._refused(status, reason, f"{missing}, turn")))]

    def _refused(self, status: Status, reason: str, missing: str = "0.0") -> str:
        return f'return Diagnosis({self.answer(status)}, "{reason}", {missing})'


def _one(word: str, ends: Sequence[sp.Expr]) -> str:
    """The largest or the smallest of one or more ends."""
    texts = [_PRINTER.print(end) for end in ends]
    return f"{word}({', '.join(texts)})" if len(texts) > 1 else texts[0]
