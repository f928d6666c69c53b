"""Calls of programs that several programs share: the arguments and the results are one tuple each, in the order of
the program."""

from __future__ import annotations

import sympy as sp

from derive.emit.python.layout import note_lines, taken_apart, tuple_of
from derive.emit.python.printer import ScalarPrinter, spelled
from derive.ir.program import Call, FindRoot
from derive.ir.symbols import PLACE, is_condition

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
        head = f"{FOUND} = run_where({wanted}, {program}, {_values(call, printer)}, {inner}, {_nothing(call)})"
    if call.refusal is None:
        return [*_note(call), head, *_taken(call, FOUND)]
    refused = f"require(status, refused == status, Status.{call.refusal[0].name})"
    return [*_note(call), "refused = status.copy()", head, *_taken(call, FOUND), refused]


def _nothing(call: Call) -> str:
    """The results of a program that is not run."""
    return tuple_of(["False" if is_condition(o.value) else "0.0" for o in call.program.outputs])


def scalar_search(search: FindRoot, printer: ScalarPrinter) -> list[str]:
    """The lines that find the root of a trial on plain numbers."""
    return _found(search, _looked_for(search, "nearest_root", ("self._", ""), printer))


def array_search(search: FindRoot, printer: ScalarPrinter) -> list[str]:
    """The lines that find the root of a trial on arrays, for the rows that are not refused."""
    return _found(search, _looked_for(search, "nearest_root", ("self.", "status, "), printer))


def every_root(search: FindRoot, printer: ScalarPrinter) -> list[str]:
    """The lines that find all roots of a trial on plain numbers."""
    return [f"return {_looked_for(search, 'every_root', ('self._', ''), printer)}"]


def _found(search: FindRoot, text: str) -> list[str]:
    return [*_note(search), f"{FOUND} = {text}", *taken_apart([spelled(n.name) for n in search.names], FOUND)]


def _looked_for(search: FindRoot, function: str, spelling: tuple[str, str], printer: ScalarPrinter) -> str:
    prefix, status = spelling
    programs = ", ".join(f"{prefix}{p.name}" for p in (search.trial, search.finish))
    given = ", ".join(tuple_of([_given(s, printer) for s in search.given(p)]) for p in (search.trial, search.finish))
    values = f"{printer.print(search.start)}, {printer.print(search.wanted)}, {status}{given}, {len(search.names)}"
    sides = f"({', '.join(map(str, search.sides))},)"
    scan = "" if status else f", self._array_programs().{search.trial.name}"
    return f"{function}({programs}, {values}{f', sides={sides}' if search.is_listed else scan})"


def _given(name: sp.Symbol, printer: ScalarPrinter) -> str:
    """An argument of a trial: a value, or the name of a coordinate that the search sets."""
    return f'"{name.name}"' if name in PLACE else printer.name(name)


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


def _note(call: Call | FindRoot) -> list[str]:
    return note_lines(call.note)
