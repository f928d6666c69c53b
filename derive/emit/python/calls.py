"""Calls of programs that several programs share: the arguments and the results are one tuple each, in the order of
the program."""

from __future__ import annotations

from collections.abc import Sequence

from derive.emit.python.layout import note_lines, taken_apart, tuple_of
from derive.emit.python.printer import ScalarPrinter, spelled
from derive.ir.program import Call, Program
from derive.ir.symbols import is_condition
from derive.kinematics.search.loop.find import ONWARD
from derive.kinematics.search.programs import START

FOUND = "found"
"""The result of a shared program: its values or, on plain numbers, the status of its refusal."""


def scalar_lines(call: Call, printer: ScalarPrinter, refused: str = f"return {FOUND}") -> list[str]:
    """The lines that call the program, pass on its refusal, and unpack its values."""
    head = [f"{FOUND} = self._{call.program.name}({_values(call, printer)})"]
    lines = [*head, f"if isinstance({FOUND}, Status):", f"    {refused}", *_taken(call, FOUND)]
    if call.is_conditional:
        inside, nothing = ([f"    {line}" for line in part] for part in (lines, _taken(call, _nothing(call))))
        lines = [f"if {printer.print(call.wanted)}:", *inside, "else:", *nothing]
    return [*_note(call), *lines]


def array_lines(call: Call, printer: ScalarPrinter) -> list[str]:
    """The lines that call the program on arrays, where it writes the statuses of its refusals itself."""
    inner = "status" if call.refusal is None else "refused"
    head = f"{FOUND} = self.{call.program.name}({_values(call, printer)}, {inner})"
    if call.is_conditional:
        wanted, program = printer.print(call.wanted), f"self.{call.program.name}"
        few = ", FEW_SEARCHES" if call.program.is_search else ""
        given = f"{wanted}, {program}, {_values(call, printer)}, {inner}, {_nothing(call)}{few}"
        head = f"{FOUND} = self.run_where({given})"
    if call.refusal is None:
        return [*_note(call), head, *_taken(call, FOUND)]
    refused = f"require(status, refused == status, Status.{call.refusal[0].name})"
    return [*_note(call), "refused = status.copy()", head, *_taken(call, FOUND), refused]


def _nothing(call: Call) -> str:
    """The results of a program that is not run."""
    return tuple_of(["False" if is_condition(o.value) else "0.0" for o in call.program.outputs])


def every_root(program: Program, given: Sequence[str], joints: int) -> list[str]:
    """The lines that find all roots of a search on plain numbers."""
    places = f"{given.index(START.name)}, {given.index(ONWARD.name)}, {joints}"
    return [f"return every_root(self._{program.name}, given, {places})"]


def _values(call: Call, printer: ScalarPrinter) -> str:
    values = dict(call.given)
    arguments = [printer.value(name, values[name]) for name in call.program.inputs if name in values]
    return f"({''.join(f'{text}, ' for text in arguments).rstrip()})"


def _taken(call: Call, source: str) -> list[str]:
    """The lines that unpack a result: the values that are read get their names, every other one is `_`."""
    targets = [spelled(o.name) if o.name in {name.name for name in call.names} else "_" for o in call.program.outputs]
    last = max((k for k, target in enumerate(targets) if target != "_"), default=-1)
    if last < 0:
        return []
    targets = [*targets[: last + 1], *(["*_"] if last + 1 < len(targets) else [])]
    return taken_apart(targets, source)


def _note(call: Call) -> list[str]:
    return note_lines(call.note)
