"""A program as the body of a Python method on plain numbers, with early returns; `arrays` has the same with masks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.emit.interface import Shape, names, read_by
from derive.emit.python import calls as python_calls
from derive.emit.python.layout import assigned, fits, note_lines, taken_apart, tuple_of
from derive.emit.python.printer import ScalarPrinter, literal, spelled
from derive.emit.python.refusal import PLAIN, Refusals, conjunction
from derive.ir.constants import EDGE
from derive.ir.primitives import NearestPeriod, Select, ToReal
from derive.ir.program import Call, FindRoot, Iterate, Let, Program, Require, Solve
from derive.ir.tree import If, Item, grouped
from derive.lowering.passes import NOTHING, UNCONVERTED, applied, structured
from derive.lowering.scheduling import decided

_SCALAR, _MODULO_TURNS = ScalarPrinter(), ScalarPrinter(modulo_turns=True)


@dataclass(frozen=True)
class Argument:
    """An argument of a method: a tuple of the values that the program reads by name."""

    name: str
    kind: str
    """Its type: `Axes`, `Vector`, `Rotation`, `Signs`, `Turns`."""
    shape: tuple[Shape, ...]
    default: str = ""
    """The value in place of None; empty if a value is required."""

    @property
    def declared(self) -> str:
        """The argument in the head of a function."""
        return f"{self.name}: {self.kind} | None = None" if self.default else f"{self.name}: {self.kind}"

    @property
    def source(self) -> str:
        """Its value."""
        return f"{self.default} if {self.name} is None else {self.name}" if self.default else self.name


@dataclass(frozen=True)
class Method:
    """A program with its place in the generated class."""

    name: str
    summary: str
    program: Program
    arguments: tuple[Argument, ...]
    kind: str
    """The type of the result, where the status is OK; empty if there is none."""
    result: Shape
    is_shared: bool = False
    """Whether other programs call it: then, on arrays, it writes the statuses of its caller."""
    is_explained: bool = False
    """Whether, on plain numbers, it refuses with a reason."""


def scalar_body(method: Method, refusals: Refusals = PLAIN) -> list[str]:
    """The body on plain numbers: the first condition that does not hold refuses."""
    lines = [*unpacked(method), *constant_lines(method), *statement_lines(method.program, refusals, _SCALAR)]
    behind = replace(method, program=decided(method.program))
    return [*lines, f"return {values_of(behind, _SCALAR) or refusals.success}"]


def statement_lines(program: Program, refusals: Refusals, printer: ScalarPrinter) -> list[str]:
    """The statements of a program on plain numbers."""
    return item_lines(structured(applied(UNCONVERTED, program, NOTHING)), refusals, printer)


def item_lines(items: Sequence[Item], refusals: Refusals, printer: ScalarPrinter) -> list[str]:
    """Statements on plain numbers, choices with their sides."""
    lines: list[str] = []
    for item, same in grouped(items):
        if isinstance(item, Require):
            lines += refusals.lines(same)
        elif isinstance(item, Iterate):
            lines += scalar_head(item, printer)
            lines += step_lines(item, printer, lambda call: _called(call, refusals, printer))
            refusal = "" if item.otherwise is None else refusals.of_loop(item.otherwise, item)
            lines += scalar_end(item, conjunction([item.done]), refusal, printer)
        elif isinstance(item, Call):
            lines += _called(item, refusals, printer)
        elif isinstance(item, FindRoot):
            lines += python_calls.scalar_search(item, printer)
        else:
            lines += _item_lines(item, refusals, printer)
    return lines


def _called(call: Call, refusals: Refusals, printer: ScalarPrinter) -> list[str]:
    return python_calls.scalar_lines(call, printer, refusals.of_call(call))


def _item_lines(item: Item, refusals: Refusals, printer: ScalarPrinter) -> list[str]:
    """A binding, or a choice between two sides that bind the same or refuse."""
    if isinstance(item, If):
        comments = [line for comment in item.comments for line in note_lines(comment)]
        holds, fails = (_side(side, refusals, printer) for side in item.sides)
        return [*comments, f"if {conjunction([item.condition])}:", *holds, "else:", *fails]
    if isinstance(item, Require):
        return refusals.lines([item])
    if isinstance(item, Let) and isinstance(item.value, NearestPeriod):
        return _turn_lines(item, item.value, printer)
    assert isinstance(item, Let | Solve)
    return binding_lines(item, printer)


def _side(items: Sequence[Item], refusals: Refusals, printer: ScalarPrinter) -> list[str]:
    return [f"    {line}" for item in items for line in _item_lines(item, refusals, printer)]


def _turn_lines(let: Let, value: NearestPeriod, printer: ScalarPrinter) -> list[str]:
    """A value that is nearly always in its interval: this is tested first, because a call takes longer."""
    name, centre = spelled(let.name.name), printer.print(value.args[1])
    low, high = (literal(side * 180.0 - float(EDGE)) for side in (-1, 1))
    away = name if value.args[1] == 0 else f"{name} - {centre}" if value.args[1].is_Symbol else f"{name} - ({centre})"
    return [
        *let_lines(replace(let, value=value.args[0]), _MODULO_TURNS),
        f"if not {low} <= {away} < {high}:",
        f"    {name} = nearest_period({name}, {centre})",
    ]


def has_search(program: Program) -> bool:
    """Whether a program searches for a root."""
    return any(isinstance(s, FindRoot) for s in program.body)


def binding_lines(statement: Let | Solve, printer: ScalarPrinter) -> list[str]:
    """A statement that binds names and refuses nothing."""
    return let_lines(statement, printer) if isinstance(statement, Let) else solve_lines(statement, printer)


def step_lines(loop: Iterate, printer: ScalarPrinter, called: Callable[[Call], list[str]]) -> list[str]:
    """The step of a loop. called: the lines of a call."""
    lines = (called(s) if isinstance(s, Call) else binding_lines(s, printer) for s in loop.step)
    return _indented([line for one in lines for line in one])


def let_lines(let: Let, printer: ScalarPrinter) -> list[str]:
    """A binding, with the step of the derivation behind it or before it."""
    value = printer.value(let.name, let.value)
    if isinstance(let.value, Select | ToReal) and value.startswith("("):
        value = value[1:-1]
    line = f"{spelled(let.name.name)} = {value}"
    if let.comment and fits(line, let.comment):
        return [f"{line}  # {let.comment}"]
    return [*note_lines(let.comment), line]


def unpacked(method: Method) -> list[str]:
    """The arguments, unpacked to the names that the program reads; a value that it does not read is `_`."""
    read = read_by(method.program)
    lines: list[str] = []
    for argument in method.arguments:
        if read & set(names(argument.shape)):
            lines += taken_apart([_targets(part, read) for part in argument.shape], argument.source)
    return lines


def _targets(shape: Shape, read: set[str]) -> str:
    if isinstance(shape, str):
        return spelled(shape) if shape in read else "_"
    if not read & set(names(shape)):
        return "_"
    return tuple_of([_targets(s, read) for s in shape])


def constant_lines(method: Method, owner: str = "self._constants") -> list[str]:
    """The constants that a method reads, by their names."""
    constants = constants_of(method)
    return [f"k = {owner}", *assigned({spelled(c): f"k.{spelled(c)}" for c in constants})] if constants else []


def constants_of(method: Method) -> list[str]:
    """The names that a method reads besides its arguments, in alphabetical order."""
    given = {name for argument in method.arguments for name in names(argument.shape)}
    return sorted(read_by(method.program) - given)


def values_of(method: Method, printer: ScalarPrinter) -> str:
    """The values that a method returns where nothing refuses, in its shape; empty if it returns nothing."""
    values = {o.name: printer.print(o.value) for o in method.program.outputs}

    def text(shape: Shape) -> str:
        return values[shape] if isinstance(shape, str) else tuple_of([text(s) for s in shape])

    return text(method.result) if method.kind else ""


def solve_lines(system: Solve, printer: ScalarPrinter) -> list[str]:
    """`determinant, x, y = solve(matrix, right)`, matrices by rows."""
    targets = [spelled(system.determinant.name) if system.determinant is not None else "_", *_names(system.names)]
    note = note_lines(system.note)
    matrix, right = _matrix(system.matrix, system.size, printer), _matrix(system.right, system.columns, printer)
    return [*note, *taken_apart(targets, f"solve({matrix}, {right})")]


def scalar_head(loop: Iterate, printer: ScalarPrinter) -> list[str]:
    """The lines that set the start, and open the loop."""
    return _head(loop, [f"{', '.join(_names(loop.state))} = {', '.join(_values(loop, loop.start, printer))}"])


def array_head(loop: Iterate, printer: ScalarPrinter) -> list[str]:
    """The lines that set the start, which may be one for all rows, and open the loop."""
    start = f"initial({', '.join(_values(loop, loop.start, printer))})"
    return _head(loop, taken_apart(_names(loop.state), start))


def _head(loop: Iterate, start: Sequence[str]) -> list[str]:
    return [*note_lines(loop.note), *start, f"for _ in range({loop.limit}):"]


def scalar_end(loop: Iterate, done: str, refusal: str, printer: ScalarPrinter) -> list[str]:
    """The lines that leave the loop, or prepare the next pass; a loop that is never left may refuse."""
    otherwise = [] if loop.otherwise is None else ["else:", f"    {refusal}"]
    return [*_indented([f"if {done}:", "    break"]), *_indented(_assignments(loop, printer)), *otherwise]


def array_end(loop: Iterate, printer: ScalarPrinter) -> list[str]:
    """The lines that leave the loop when every row is done; rows that are done keep their state while others go on."""
    following = [f"{value}," for value in _values(loop, loop.following, printer)]
    return [
        *_indented([f"done = {printer.print(loop.done)}", "if settled(done, status):", "    break"]),
        *_indented(
            [
                *taken_apart(_names(loop.state), "advanced("),
                *_indented(["done,", f"{tuple_of(_names(loop.state))},", "(", *_indented(following), "),"]),
                ")",
            ]
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
