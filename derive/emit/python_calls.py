"""Calls of programs that several programs share: values go in and come out as one tuple, in the order of the program."""

from __future__ import annotations

from derive.emit.python_layout import fold, taken_apart
from derive.emit.python_printer import ScalarPrinter, spelled
from derive.program import Call

GIVEN, FOUND = "given", "found"
"""The argument of a shared program, and what it answered: its values or, on plain numbers, the status of its refusal."""


def scalar_lines(call: Call, printer: ScalarPrinter) -> list[str]:
    """Call, hand a refusal on, and take the values apart."""
    head = fold(f"{FOUND} = self._{call.program.name}({_values(call, printer)})")
    return [*_note(call), *head, f"if isinstance({FOUND}, Status):", f"    return {FOUND}", *_taken(call, FOUND)]


def array_lines(call: Call, printer: ScalarPrinter) -> list[str]:
    """The same on arrays: the shared program writes the statuses of its refusals."""
    head = fold(f"{FOUND} = self.{call.program.name}({_values(call, printer)}, status)")
    return [*_note(call), *head, *_taken(call, FOUND)]


def _values(call: Call, printer: ScalarPrinter) -> str:
    return f"({''.join(f'{printer.print(value)}, ' for value in call.arguments).rstrip()})"


def _taken(call: Call, source: str) -> list[str]:
    """The values that are read, by their names; every other one is `_`."""
    targets = [spelled(o.name) if o.name in {name.name for name in call.names} else "_" for o in call.program.outputs]
    last = max((k for k, target in enumerate(targets) if target != "_"), default=-1)
    if last < 0:
        return []
    targets = [*targets[: last + 1], *(["*_"] if last + 1 < len(targets) else [])]
    return taken_apart(targets, source)


def _note(call: Call) -> list[str]:
    return [f"# {call.note}"] if call.note else []
