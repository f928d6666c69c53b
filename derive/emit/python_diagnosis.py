"""The inverse and its limits as functions that say which quantity refused, why, and how much is missing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from derive.diagnosis import checks_of, plain
from derive.emit.python_layout import fold
from derive.emit.python_methods import branch, limits
from derive.emit.python_printer import ScalarPrinter
from derive.emit.python_program import Method, Refusals, functions, scalar_body
from derive.kinematics import Kinematics
from derive.program import Iterate, Require, Status

_PRINTER = ScalarPrinter()


def diagnosis(kin: Kinematics) -> dict[str, object]:
    """What the template reads: the primitives, and the functions with their heads and bodies."""
    methods = (branch(kin), limits(kin))
    used = functions(tuple(m.program for m in methods))
    return {
        "primitives": [f for f in used if f not in ("abs", "select")],
        "functions": [{"head": _head(m), "summary": m.summary, "body": _body(m)} for m in methods],
    }


def refused(status: Status, reason: str, missing: str = "0.0") -> str:
    """The answer of a function that refuses."""
    return f'return Diagnosis(Status.{status.name}, "{reason}", {missing})'


def _head(method: Method) -> list[str]:
    arguments = "".join(f", {a.name}: {a.kind}" for a in method.arguments)
    result = f"{method.kind} | Diagnosis" if method.kind else "Diagnosis"
    return fold(f"def {method.name}(constants: Constants{arguments}) -> {result}:", 0)


def _body(method: Method) -> list[str]:
    lines = scalar_body(method, "constants", _Reasons())
    return [*lines[:-1], refused(Status.OK, "")] if not method.kind else lines


class _Reasons(Refusals):
    """Refusals that say why."""

    def of_conditions(self, requires: Sequence[Require]) -> list[str]:
        """Every comparison refuses for itself."""
        return list(_checked(requires))

    def of_loop(self, loop: Iterate) -> str:
        """A loop that was never left has a reason and no amount."""
        return refused(loop.otherwise, plain(loop.note))


def _checked(requires: Sequence[Require]) -> Iterator[str]:
    for check in checks_of(requires):
        yield from fold(f"if not ({_PRINTER.print(check.condition)}):")
        yield from (f"    {line}" for line in fold(refused(check.status, check.reason, _PRINTER.print(check.missing))))

