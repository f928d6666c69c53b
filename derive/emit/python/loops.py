"""Systems of linear equations and iterations in Python. The text is the same on plain numbers and on arrays, except for
the end of an iteration."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from derive.emit.python.layout import note_lines, taken_apart, tuple_of
from derive.emit.python.printer import ScalarPrinter, spelled
from derive.ir.program import Iterate, Solve


def solve_lines(system: Solve, printer: ScalarPrinter) -> list[str]:
    """`determinant, x, y = solve(matrix, right)`, matrices by rows."""
    targets = [spelled(system.determinant.name) if system.determinant is not None else "_", *_names(system.names)]
    note = note_lines(system.note)
    matrix, right = _matrix(system.matrix, system.size, printer), _matrix(system.right, system.columns, printer)
    return [*note, *taken_apart(targets, f"solve({matrix}, {right})")]


def scalar_head(loop: Iterate, printer: ScalarPrinter) -> list[str]:
    """The lines that set the start, and open the loop."""
    return _head(loop, ", ".join(_values(loop, loop.start, printer)))


def array_head(loop: Iterate, printer: ScalarPrinter) -> list[str]:
    """The lines that set the start, which may be one for all rows, and open the loop."""
    return _head(loop, f"initial({', '.join(_values(loop, loop.start, printer))})")


def _head(loop: Iterate, start: str) -> list[str]:
    note = note_lines(loop.note)
    return [*note, f"{', '.join(_names(loop.state))} = {start}", f"for _ in range({loop.limit}):"]


def scalar_end(loop: Iterate, done: str, refusal: str, printer: ScalarPrinter) -> list[str]:
    """The lines that leave the loop, or prepare the next pass; a loop that is never left may refuse."""
    otherwise = [] if loop.otherwise is None else ["else:", f"    {refusal}"]
    return [*_indented([f"if {done}:", "    break"]), *_indented(_assignments(loop, printer)), *otherwise]


def array_end(loop: Iterate, printer: ScalarPrinter) -> list[str]:
    """The lines that leave the loop when every row is done; rows that are done keep their state while others go on."""
    state = ", ".join(_names(loop.state))
    following = [f"{value}," for value in _values(loop, loop.following, printer)]
    return [
        *_indented([f"done = {printer.print(loop.done)}", "if settled(done, status):", "    break"]),
        *_indented(
            [f"{state} = advanced(", "    done,", f"    ({state}),", "    (", *_indented(following, 2), "    ),", ")"]
        ),
        *([] if loop.otherwise is None else [f"require(status, done, Status.{loop.otherwise.name})"]),
    ]


def _assignments(loop: Iterate, printer: ScalarPrinter) -> list[str]:
    values = _values(loop, loop.following, printer)
    return [f"{name} = {value}" for name, value in zip(_names(loop.state), values, strict=True)]


def _values(loop: Iterate, values: Sequence[sp.Basic], printer: ScalarPrinter) -> list[str]:
    """The new values of the state."""
    return [printer.value(name, value) for name, value in zip(loop.state, values, strict=True)]


def _names(symbols: Sequence[sp.Symbol]) -> list[str]:
    return [spelled(symbol.name) for symbol in symbols]


def _matrix(entries: Sequence[sp.Expr], width: int, printer: ScalarPrinter) -> str:
    """A matrix by rows."""
    rows = [entries[i : i + width] for i in range(0, len(entries), width)] if entries else []
    return tuple_of([tuple_of(list(map(printer.print, row))) for row in rows])


def _indented(lines: Sequence[str], steps: int = 1) -> list[str]:
    return [" " * (4 * steps) + line for line in lines]
