"""A program as statements of Structured Text: assignments, early returns, and the expressions of its outputs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

import sympy as sp

from derive.emit.braced import indented
from derive.emit.st.expression import StructuredText, limits_of
from derive.emit.st.layout import INSIDE, WIDTH, commented, conjunction, wrapped
from derive.emit.st.names import respelled, spellings, type_name
from derive.emit.st.refusal import Refusal
from derive.emit.st.shared import (
    FILLED,
    OUTCOME,
    TYPE_OF_START,
    call_lines,
    fills_start,
    result_names,
    structure_of,
    structures_of,
)
from derive.emit.st.stretches import SIDE, has_sides, stretch_lines
from derive.ir.constants import DEGREE
from derive.ir.primitives import Root, Select
from derive.ir.program import Call, Iterate, Let, Program, Require, Solve, Statement, reason_expressions
from derive.ir.symbols import names_in
from derive.ir.tree import If, Item, bound_in, read_in, statements_in
from derive.ir.types import type_of
from derive.lowering.passes import structured
from derive.lowering.scheduling import decided

_SHORT = 72
"""The most columns of a selection that stays on one line."""


@dataclass(frozen=True)
class Printed:
    """A program in Structured Text."""

    variables: tuple[tuple[str, str], ...]
    """Its temporary variables, with their types."""
    declarations: tuple[str, ...]
    """Further variables, with their types."""
    body: str
    outputs: Mapping[str, str]
    """The expression of every output, by its neutral name."""


def printed(
    program: Program,
    given: Mapping[str, str],
    stored: Mapping[str, str],
    taken: Iterable[str],
    refusal: Refusal,
    *,
    is_branch: bool = False,
    block: str = "",
) -> Printed:
    """A program in Structured Text. is_branch: whether it is one of several branches, which share their stretches;
    block: the name of the block, which stands in the types of structures.

    given: the spellings of the values that it reads; stored: those of the values that it binds to instance variables.
    All other values are bound to temporary variables, whose names are not in `taken`.
    """
    items = structured(program)
    structures = structures_of({call.program.name: call.program for call in program.calls()}.values())
    stored = {**stored, **kept(program.body)}
    for called, _ in structures:
        stored |= result_names(called)
    unread = _unread(program, items)
    own = {name.name: name for name in bound_in(items) if name.name not in stored and name not in unread}
    whole = [s.variable for _, s in structures]
    temporaries = spellings(own, (*taken, *LOCALS, OUTCOME, FILLED, *whole, *((SIDE,) if is_branch else ())))
    printer = StructuredText({**given, **stored, **temporaries, DEGREE.name: "DEGREE"})
    side = (f"{SIDE} : INT;",) if is_branch and has_sides(program) else ()
    if not is_branch:
        body = _body(items, printer, refusal)
    else:
        body = stretch_lines(program, printer, refusal, lambda part, width: _body(part, printer, refusal, width))
    return Printed(
        variables=tuple((temporaries[name], type_name(type_of(symbol))) for name, symbol in own.items()),
        declarations=(
            *declarations(program.body),
            *_outcome(program, refusal),
            *side,
            *((f"{FILLED} : {TYPE_OF_START};",) if fills_start(program, printer) else ()),
            *(f"{s.variable} : {s.type_in(block)};" for _, s in structures),
        ),
        body="\n".join(body),
        outputs={o.name: printer.print(o.value) for o in decided(program).outputs},
    )


def _unread(program: Program, items: Sequence[Item]) -> set[sp.Symbol]:
    """The unknowns of systems that nothing reads: they stay in their array."""
    statements = list(statements_in(items))
    told = [*(o.value for o in decided(program).outputs), *(e for s in statements for e in reason_expressions(s))]
    return {n for s in statements if isinstance(s, Solve) for n in s.names} - read_in(items).union(*map(names_in, told))


def _outcome(program: Program, refusal: Refusal) -> Iterator[str]:
    if any(call.program.refuses for call in program.calls()):
        yield f"{OUTCOME} : {refusal.type};"


def _body(body: Sequence[Item], printer: StructuredText, refusal: Refusal, width: int = WIDTH) -> Iterator[str]:
    for kind, group in groupby(body, key=lambda s: _kind(s, printer, refusal)):
        statements = list(group)
        first = statements[0]
        if isinstance(first, If):
            yield from commented(list(_sides(first, printer, refusal, width)), _note_of(first, printer.names), width)
            continue
        if isinstance(first, Solve):
            yield from commented([*solve_lines(first, printer), ""], respelled(first.note, printer.names))
            continue
        if isinstance(first, Call):
            yield from commented([*call_lines(first, printer, refusal), ""], respelled(first.note, printer.names))
            continue
        if isinstance(first, Iterate):
            if any(c.is_conditional and structure_of(c.program) is not None for c in first.calls()):
                raise ValueError(f"{first.note}: a pass that does not call reads the structure of the pass before")
            step = list(_body(first.step, printer, refusal, width - INSIDE))
            refused = () if first.otherwise is None else refusal.of_loop(first.otherwise, first)
            lines = list(loop_lines(first, step, printer, refused))
            yield from ("", *commented(lines, respelled(first.note, printer.names)), "")
            continue
        lets = [s for s in statements if isinstance(s, Let)]
        if isinstance(first, Require):
            lines = refusal.lines([s for s in statements if isinstance(s, Require)], printer)
            yield from commented(lines, respelled(refusal.note(first), printer.names))
        elif isinstance(kind[0], str):
            yield from commented(_choice(kind[0], lets, printer, width), _notes(lets, printer.names), width)
        else:
            yield from _assignments(lets, printer, width)


def _sides(choice: If, printer: StructuredText, refusal: Refusal, width: int) -> Iterator[str]:
    """The lines of a choice, each side with the values that it alone needs. A note on a value that both sides bind
    stands above the choice.
    """

    def side(items: Sequence[Item]) -> list[str]:
        return indented(list(_body(items, printer, refusal, width - INSIDE)))

    holds, fails = choice.sides
    yield from wrapped(f"IF {printer.print(choice.condition)} THEN", width)
    yield from side(holds)
    match choice.fails:
        case (If() as other,) if not (note := _note_of(other, printer.names)) or note == _note_of(
            choice, printer.names
        ):
            first, *others = _sides(other, printer, refusal, width - INSIDE)
            yield from (f"ELS{first}", *others)
        case _:
            yield from ("ELSE", *side(fails), "END_IF")


def _note_of(choice: If, names: Mapping[str, str]) -> str:
    return "; ".join(dict.fromkeys(respelled(comment, names) for comment in choice.comments))


def _kind(statement: Item, printer: StructuredText, refusal: Refusal) -> tuple[str | None, object]:
    """The key by which consecutive statements are grouped and printed together: selections by one condition become one
    IF, and a refusal says which conditions it refuses together.
    """
    if isinstance(statement, Require):
        return None, (Require, refusal.key(statement))
    if not isinstance(statement, Let):
        return None, statement
    if isinstance(statement.value, Select) and limits_of(statement.value) is None:
        return printer.print(statement.value.args[0]), ""
    return None, ""


def _notes(lets: Sequence[Let], names: Mapping[str, str]) -> str:
    return "; ".join(dict.fromkeys(respelled(let.comment, names) for let in lets if let.comment))


def _assignments(lets: Sequence[Let], printer: StructuredText, width: int) -> Iterator[str]:
    comment = ""
    for let in lets:
        lines = wrapped(_assignment(let, let.value, printer), width)
        yield from commented(lines, "" if let.comment == comment else respelled(let.comment, printer.names), width)
        comment = let.comment


def _choice(condition: str, lets: Sequence[Let], printer: StructuredText, width: int) -> list[str]:
    """The lines of selections by one condition: SEL for a single one that is short or has simple values, else IF."""
    whole = [_assignment(let, let.value, printer) for let in lets]
    if len(lets) == 1 and (len(whole[0]) <= _SHORT or all(map(_is_slight, lets[0].value.args[1:]))):
        return wrapped(whole[0], width)

    def side(place: int) -> list[str]:
        values = [_assignment(let, let.value.args[place], printer) for let in lets]
        return indented([line for value in values for line in wrapped(value, width - INSIDE)])

    return [*wrapped(f"IF {condition} THEN", width), *side(1), "ELSE", *side(2), "END_IF"]


def _is_slight(value: sp.Expr) -> bool:
    """Whether a value takes at most one operation, and no division."""
    inner = [a for a in value.args if a != -1]
    return isinstance(value, sp.Symbol | sp.Number | sp.Add | sp.Mul | Root) and all(_is_atom(a) for a in inner)


def _is_atom(value: sp.Expr) -> bool:
    return not value.args or (-value).is_Symbol


def _assignment(let: Let, value: sp.Expr, printer: StructuredText) -> str:
    return f"{printer.name(let.name)} := {printer.value(let.name, value)};"


_PASS, _CONVERGED = "iteration", "converged"


@dataclass(frozen=True)
class _Arrays:
    """A function that solves linear equations, the arrays that it is given, and what they hold at most."""

    function: str
    matrix: str
    right: str
    rows: int
    columns: int

    @property
    def declarations(self) -> tuple[str, ...]:
        """The variables."""
        return (
            f"{self.matrix} : ARRAY[1..{self.rows}, 1..{self.rows}] OF LREAL;",
            f"{self.right} : ARRAY[1..{self.rows}, 1..{self.columns}] OF LREAL;",
        )


_SOLVERS = (
    _Arrays("Softkin_Solve", "coefficients", "unknowns", 6, 6),
    _Arrays("Softkin_SolveMany", "manyCoefficients", "manyUnknowns", 18, 10),
)
LOCALS = (*(name for s in _SOLVERS for name in (s.matrix, s.right)), _PASS, _CONVERGED)
"""The names that no temporary variable may have."""


def declarations(body: Iterable[Statement]) -> tuple[str, ...]:
    """The variables that systems and loops need besides the temporary variables of the program."""
    loops = [s for s in body if isinstance(s, Iterate)]
    systems = [s for s in body if isinstance(s, Solve)] + [i for s in loops for i in s.step if isinstance(i, Solve)]
    solvers = {_solver(s) for s in systems}
    found = tuple(line for s in _SOLVERS if s in solvers for line in s.declarations)
    passes = (f"{_PASS} : INT;",) if loops else ()
    return (*found, *passes, *((f"{_CONVERGED} : BOOL;",) if any(s.otherwise is not None for s in loops) else ()))


def solve_lines(system: Solve, printer: StructuredText) -> Iterator[str]:
    """The lines that fill the matrix and the right-hand sides, solve, and read the solution from the same arrays."""
    solver = _solver(system)
    yield from _filled(solver.matrix, system.matrix, system.size, printer)
    yield from _filled(solver.right, system.right, system.columns, printer)
    target = "" if system.determinant is None else f"{printer.name(system.determinant)} := "
    arrays = f"aMatrix := {solver.matrix}, aRight := {solver.right}"
    given = f"{arrays}, iSize := {system.size}, iColumns := {system.columns}"
    yield from wrapped(f"{target}{solver.function}({given});")
    for name, element in elements(system).items():
        if printer.names.get(name, element) != element:
            yield f"{printer.names[name]} := {element};"


def _solver(system: Solve) -> _Arrays:
    """The function that solves a system: the smallest that has room for it."""
    for solver in _SOLVERS:
        if system.size <= solver.rows and system.columns <= solver.columns:
            return solver
    most = _SOLVERS[-1]
    raise ValueError(f"{most.function} knows at most {most.rows} unknowns and {most.columns} right-hand sides")


def elements(system: Solve) -> dict[str, str]:
    """The array elements that hold the solution, by the names of the unknowns."""
    return {
        n.name: f"{_solver(system).right}[{k // system.columns + 1}, {k % system.columns + 1}]"
        for k, n in enumerate(system.names)
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
