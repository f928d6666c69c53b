"""Systems of linear equations and iterations in Structured Text: local arrays of fixed size, bounded loops, EXIT."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import sympy as sp

from derive.emit.braces import indented
from derive.emit.st.expression import StructuredText
from derive.emit.st.layout import conjunction, wrapped
from derive.ir.program import Iterate, Solve, Statement

_MATRIX, _RIGHT, _PASS, _CONVERGED = "coefficients", "unknowns", "iteration", "converged"
LOCALS = (_MATRIX, _RIGHT, _PASS, _CONVERGED)
"""The names that no temporary variable may have."""


def declarations(body: Iterable[Statement]) -> tuple[str, ...]:
    """The variables that systems and loops need besides the temporary variables of the program."""
    loops = [s for s in body if isinstance(s, Iterate)]
    systems = [s for s in body if isinstance(s, Solve)] + [i for s in loops for i in s.step if isinstance(i, Solve)]
    found = tuple(f"{name} : ARRAY[1..6, 1..6] OF LREAL;" for name in (_MATRIX, _RIGHT)) if systems else ()
    passes = (f"{_PASS} : INT;",) if loops else ()
    return (*found, *passes, *((f"{_CONVERGED} : BOOL;",) if any(s.otherwise is not None for s in loops) else ()))


def solve_lines(system: Solve, printer: StructuredText) -> Iterator[str]:
    """The lines that fill the matrix and the right-hand sides, solve, and read the solution from the same arrays."""
    if system.size > 6 or system.columns > 6:
        raise ValueError("Softkin_Solve knows at most six unknowns and six right-hand sides")
    yield from _filled(_MATRIX, system.matrix, system.size, printer)
    yield from _filled(_RIGHT, system.right, system.columns, printer)
    target = "" if system.determinant is None else f"{printer.name(system.determinant)} := "
    given = f"aMatrix := {_MATRIX}, aRight := {_RIGHT}, iSize := {system.size}, iColumns := {system.columns}"
    yield from wrapped(f"{target}Softkin_Solve({given});")
    for name, element in elements(system).items():
        if printer.names[name] != element:
            yield f"{printer.names[name]} := {element};"


def elements(system: Solve) -> dict[str, str]:
    """The array elements that hold the solution, by the names of the unknowns."""
    return {
        n.name: f"{_RIGHT}[{k // system.columns + 1}, {k % system.columns + 1}]" for k, n in enumerate(system.names)
    }


def kept(body: Sequence[Statement]) -> dict[str, str]:
    """The unknowns that need no variables, because outputs read the array: those of a system with several right-hand
    sides at the end of a program.
    """
    last = body[-1] if body else None
    return elements(last) if isinstance(last, Solve) and last.columns > 1 else {}


def loop_lines(loop: Iterate, step: Sequence[str], printer: StructuredText, refusal: Sequence[str]) -> Iterator[str]:
    """The lines of an iteration: the start, the bounded loop with the step, and what refuses without convergence."""
    yield from _assigned(loop.state, loop.start, printer)
    if refusal:
        yield f"{_CONVERGED} := FALSE;"
    yield f"FOR {_PASS} := 1 TO {loop.limit} DO"
    yield from indented(step)
    parts = [printer.print(part) for part in sp.ordered(sp.And.make_args(loop.done))]
    leave = [f"{_CONVERGED} := TRUE;", "EXIT;"] if refusal else ["EXIT;"]
    yield from indented([*conjunction("IF ", parts, " THEN"), *indented(leave), "END_IF"])
    yield from indented(list(_assigned(loop.state, loop.following, printer)))
    yield "END_FOR"
    if refusal:
        yield from (f"IF NOT {_CONVERGED} THEN", *indented(refusal), "END_IF")


def _assigned(names: Sequence[sp.Symbol], values: Sequence[sp.Expr], printer: StructuredText) -> Iterator[str]:
    for name, value in zip(names, values, strict=True):
        yield from wrapped(f"{printer.name(name)} := {printer.value(name, value)};")


def _filled(array: str, entries: Sequence[sp.Expr], width: int, printer: StructuredText) -> Iterator[str]:
    for k, entry in enumerate(entries):
        yield from wrapped(f"{array}[{k // width + 1}, {k % width + 1}] := {printer.print(entry)};")
