"""A program as a C function with early returns, which writes its results at its end."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce

import sympy as sp

from derive.emit import refusals, walk
from derive.emit.braced import block
from derive.emit.c.functions import Function, function_name
from derive.emit.c.printer import C, comment, list_of, spelled, status, text, type_of
from derive.emit.interface import names_in, read_by
from derive.ir.program import Call, FindRoot, Solve, Status
from derive.ir.reason import Unit
from derive.ir.symbols import PLACE
from derive.lowering.passes import structured
from derive.lowering.scheduling import decided
from derive.report.reasons import Reasons

_PLACES = {name.name: f"place->{name.name}" for name in PLACE}


def function_lines(function: Function, machine: str, constants: Mapping[str, str], reasons: Reasons) -> list[str]:
    """The function. machine: the type of the struct of the machine; constants: the spelling of its members."""
    program, read = function.program, read_by(function.program)
    printer = C({name: text for name, text in constants.items() if name not in function.given})
    body = Body(Refusals(reasons, printer), names_in(program))
    types = {s.name: type_of(s) for s in program.inputs}
    own = [(name, place) for name, place in function.given.items() if name in read]
    arguments = taken(own, types)
    lines = body.lines(structured(program))
    values = {o.name: printer.print(o.value) for o in decided(program).outputs}
    writes = [f"{place} = {values[name]};" for name, place in function.results]
    inner = [*arguments, *lines, *writes, "return SOFTKIN_OK;"]
    if function.is_of_machine:
        inner = [f"const {machine} *k = machine;", *inner] if _reads("k", inner) else inner
    given = f"const void *machine, {function.parameters}" if function.is_of_machine else function.parameters
    head = f"static softkin_status {function.name}({given}, softkin_refusal *why)"
    return function_of(function.entry.summary, head, inner)


def function_of(summary: str, head: str, inner: Sequence[str]) -> list[str]:
    """A function; parameters that it does not read are named as such."""
    given = re.sub(r"\[\w*\]", "", head.partition("(")[2].removesuffix(")"))
    names = [re.findall(r"\w+", part)[-1] for part in given.split(",")]
    unread = [f"(void){name};" for name in names if not _reads(name, inner)]
    return [*comment(summary), *block(head, [*unread, *inner])]


def _reads(name: str, lines: Iterable[str]) -> bool:
    return any(re.search(rf"\b{name}\b", re.sub(r"/\*.*|\"(\\.|[^\"])*\"", "", line)) for line in lines)


def taken(own: Sequence[tuple[str, str]], types: Mapping[str, str]) -> list[str]:
    """Variables for values in arrays and structs, with those of one type on one line."""
    lines = []
    for kind in ("double", "int", "bool"):
        names = [(spelled(name), place) for name, place in own if types[name] == kind]
        if names:
            lines.append(f"const {kind} {', '.join(f'{name} = {converted(kind, place)}' for name, place in names)};")
    return lines


def converted(kind: str, place: str) -> str:
    """A value of an array of real numbers, or of bytes, in a type."""
    if kind == "bool":
        return f"{place} != 0.0"
    is_byte = place.startswith(("signs[", "turns["))
    return f"(int){place}" if kind == "int" and not is_byte else place


@dataclass
class Body(walk.Body):
    """The statements of one function."""

    endless, numbering = "int pass = 0;", "_of_"
    read: Collection[str] | None = None
    """The names that are read; None if that is not known."""

    def begin(self, state: Sequence[sp.Symbol], values: Sequence[str]) -> list[str]:
        """The variables of the state of a loop, with their first values."""
        return [f"{type_of(s)} {spelled(s.name)} = {value};" for s, value in zip(state, values, strict=True)]

    def solve(self, system: Solve) -> list[str]:
        """Linear equations: the matrix with its right-hand sides in one array, which then holds the solution."""
        size, columns, declares = system.size, system.columns, self.declared.isdisjoint(system.bound())
        array, word = self.another("system"), "const double " if declares else ""
        rows = [
            [*system.matrix[i * size : (i + 1) * size], *system.right[i * columns : (i + 1) * columns]]
            for i in range(size)
        ]
        printed = list_of(list_of(map(self.printer.print, row)) for row in rows)
        call = f"softkin_solve(&{array}[0][0], {size}, {columns});"
        target = "" if system.determinant is None else f"{word}{spelled(system.determinant.name)} = "
        found = [
            f"{spelled(name.name)} = {array}[{i // columns}][{size + i % columns}]"
            for i, name in enumerate(system.names)
            if self.read is None or name.name in self.read
        ]
        if declares:
            writes = [f"const double {', '.join(found)};"] if found else []
        else:
            writes = [f"{one};" for one in found]
        return [
            *comment(system.note), f"double {array}[{size}][{size + columns}] = {printed};", f"{target}{call}", *writes,
        ]  # fmt: skip

    def call(self, call: Call) -> list[str]:
        """A call, whose arguments and results are one array each."""
        array, arguments, status = map(self.another, ("results", "arguments", "status"))
        names = {name.name: name for name in call.names}
        own = [(o.name, f"{array}[{i}]") for i, o in enumerate(call.program.outputs) if o.name in names]
        why = "why" if call.refusal is None else "NULL"
        lines = [
            f"const double {arguments}[] = {list_of(self.given(call) or ['0.0'])};",
            f"const softkin_status {status} = {function_name(call.program)}(k, {arguments}, {array}, {why});",
            *self.printer.when(f"{status} != SOFTKIN_OK", self.refusals.of_call(call, status)),
        ]
        if call.is_conditional:
            lines = block(f"if ({self.printer.conjunction([call.wanted])})", lines)
        return [
            *comment(call.note),
            f"double {array}[{len(call.program.outputs)}]{' = {0.0}' if call.is_conditional else ''};",
            *lines,
            *taken(own, {name: type_of(symbol) for name, symbol in names.items()}),
        ]

    def search(self, search: FindRoot) -> list[str]:
        """The search for the nearest root."""
        root = self.another("root")
        own = [(name.name, f"{root}[{i}]") for i, name in enumerate(search.names)]
        return [
            *comment(search.note),
            *self.searched(search),
            f"double {root}[{len(search.names)}];",
            f"softkin_nearest_root(&search, {self.sought(search)}, {root});",
            *taken(own, {name.name: type_of(name) for name in search.names}),
        ]

    def searched(self, search: FindRoot) -> list[str]:
        """The search as data."""
        names = ", ".join(f"{function_name(p)}_at" for p in (search.trial, search.finish))
        sides = [f"const int sides[] = {list_of(map(str, search.sides))};"] if search.is_listed else []
        listed = f"{'sides' if sides else 'NULL'}, {len(search.sides)}"
        sizes = f"{directions_of(search)}, {len(search.names)}, {listed}"
        return [
            f"const double arguments[] = {list_of(self.printer.name(s) for s in arguments_read(search))};",
            *sides,
            f"const softkin_search search = {{k, arguments, {names}, {sizes}}};",
        ]

    def sought(self, search: FindRoot) -> str:
        """The start of the scan, and whether the scan is wanted."""
        return f"{self.printer.print(search.start)}, {self.printer.print(search.wanted)}"


def directions_of(search: FindRoot) -> int:
    """The number of directions of a trial."""
    return 0 if search.is_listed else (len(search.trial.outputs) - 4) // 2


def arguments_read(search: FindRoot) -> list[sp.Symbol]:
    """The arguments that the trial or the end of a search reads."""
    given = {s for program in (search.trial, search.finish) for s in search.given(program)}
    return [name for name in search.arguments if name in given]


def of_search(search: FindRoot) -> list[list[str]]:
    """The functions through which the search calls its trial and its end."""
    found = []
    places = _PLACES | {name.name: f"arguments[{i}]" for i, name in enumerate(arguments_read(search))}
    given = "const void *machine, const double *arguments, const softkin_place *place, double *results"
    for program in (search.trial, search.finish):
        name = function_name(program)
        read = search.given(program)
        inner = [
            *([] if {*PLACE} & {*read} else ["(void)place;"]),
            f"const double given[] = {list_of(places[s.name] for s in read)};",
            f"return {name}(machine, given, results, NULL);",
        ]
        found.append(function_of("", f"static softkin_status {name}_at({given})", inner))
    return found


class Refusals(refusals.Refusals):
    """The refusals of one function."""

    largest, smallest = "fmax", "fmin"

    def refused(self, outcome: Status, reason: str = "", missing: str = "", turn: str = "") -> str:
        """The call that fills a refusal; a reason ends in the unit of the missing amount."""
        unit = next((u.value for u in Unit if u.value and reason.endswith(f" [{u.value}]")), "")
        words = reason.removesuffix(f" [{unit}]") if unit else reason
        return f"softkin_refuse(why, {status(outcome)}, {text(words)}, {text(unit)}, {missing or '0.0'}, {turn or '0'})"

    def refused_parameters(self, sentence: str, names: Sequence[str]) -> str:
        return f"softkin_refuse_parameters(why, {text(sentence)}, {text(', '.join(names))})"

    def reasonable(self, values: Sequence[str]) -> str:
        return f"softkin_are_reasonable((const double[]){list_of(values)}, {len(values)})"

    def inside(self, axis: str, lowest: str, highest: str) -> tuple[str, str]:
        return f"const int turn = softkin_turn_inside({axis}, {lowest}, {highest});", "turn != 0"

    def extreme(self, word: str, ends: Sequence[sp.Expr]) -> str:
        """The largest or the smallest of one or more limits: a function of C takes two numbers."""
        return reduce(lambda found, other: f"{word}({found}, {other})", map(self.printer.print, ends))
