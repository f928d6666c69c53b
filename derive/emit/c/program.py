"""A program as a C function with early returns, which writes its results at its end."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce

import sympy as sp

from derive.description.mechanism import Role
from derive.emit import refusals, walk
from derive.emit.braced import block
from derive.emit.c.functions import Function, function_name
from derive.emit.c.printer import C, comment, list_of, member, number, spelled, status, text, type_of
from derive.emit.inputs import Inputs
from derive.emit.interface import names_in, read_by
from derive.emit.setup import setup_of
from derive.equations.windows import Window
from derive.ir.constants import TIE
from derive.ir.program import Call, Require, Solve, Status
from derive.ir.reason import Unit
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.parameters import CHECK_LIMITS, TIE_OF_LENGTHS, WARNING_DISTANCE, chooses_by_lengths
from derive.lowering.passes import structured
from derive.lowering.scheduling import decided
from derive.report.reasons import Reasons


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
        types = {name: type_of(symbol) for name, symbol in names.items()}
        declares = self.declared.isdisjoint(call.names)
        assigned = [f"{spelled(name)} = {converted(types[name], place)};" for name, place in own]
        return [
            *comment(call.note),
            f"double {array}[{len(call.program.outputs)}]{' = {0.0}' if call.is_conditional else ''};",
            *lines,
            *(taken(own, types) if declares else assigned),
        ]


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


SEARCHED = "searched"
"""The constant that says whether the machine needs a root search, where this depends on a parameter."""


@dataclass(frozen=True)
class Setup:
    """The function, and the constants that it computes: name → type."""

    lines: list[str]
    constants: Mapping[str, str]


def constants_read(kin: Kinematics) -> set[str]:
    """The constants that a machine needs besides those that its programs read."""
    found = {TIE_OF_LENGTHS.name} if chooses_by_lengths(kin.mechanism) else set()
    found |= {str(j.turns) for j in kin.period_joints if j.is_geared and not j.turns.is_number}
    return found | ({SEARCHED} if _may_be_searched(kin) else set())


def setup(kin: Kinematics, prefix: str, read: Collection[str], inputs: Inputs) -> Setup:
    """The function. read: the constants that other functions read; inputs: what the parameters are called."""
    found, printer = setup_of(kin, read), C(_members(kin, inputs))
    body = Body(Refusals(Reasons({}), printer))
    lines: list[str] = []
    values: dict[str, tuple[str, str]] = {}
    for step in found.steps():
        if isinstance(step, Window):
            lines += _window(found.windows.index(step), step, inputs, printer)
            values |= _window_values(step, read)
        elif isinstance(step, Require):
            lines += body.refusals.of_parameters(step, inputs)
        else:
            lines += body.lines([step])
    values |= {o.name: (type_of(o.value), printer.value(o.value, o.value)) for o in found.outputs()}
    head = [f"const {prefix}_parameters *p = parameters;", f"{prefix}_machine made;"]
    writes = [f"made.{member(name)} = {value};" for name, (_, value) in values.items()]
    tail = [f"made.softkin = (softkin_base){{{', '.join(_base(kin, values, inputs))}}};"]
    inner = [*head, *lines, *writes, *tail, f"*({prefix}_machine *)machine = made;", "return SOFTKIN_OK;"]
    name = "static softkin_status fill_machine(void *machine, const void *parameters, softkin_refusal *why)"
    summary = "The values that depend on the parameters alone, or why the parameters are refused."
    return Setup(function_of(summary, name, inner), {n: kind for n, (kind, _) in values.items()})


def _members(kin: Kinematics, inputs: Inputs) -> dict[str, str]:
    """The spelling of the parameters: real numbers, a flag that is not 0, a sign that is -1 or 1."""
    forms = {Role.FLAG: "(p->{} != 0.0)", Role.SIGN: "(int)p->{}"}
    return {p.name: forms.get(p.role, "p->{}").format(inputs.names[p.name]) for p in kin.parameters}


def _may_be_searched(kin: Kinematics) -> bool:
    return kin.mechanism.search is not None and kin.mechanism.search.where is not None


def _base(kin: Kinematics, values: Mapping[str, tuple[str, str]], inputs: Inputs) -> Iterator[str]:
    """The lines for the members that the structs of all machines begin with."""
    yield "0"
    yield f"p->{inputs.names[CHECK_LIMITS]} != 0.0"
    if _may_be_searched(kin):
        yield values[SEARCHED][1]
    else:
        yield "true" if kin.search_given is not None else "false"
    yield f"p->{inputs.names[WARNING_DISTANCE]}"
    yield values[TIE_OF_LENGTHS.name][1] if chooses_by_lengths(kin.mechanism) else number(TIE)


def _window(index: int, window: Window, inputs: Inputs, printer: C) -> list[str]:
    """The range of an axis. Invalid limits are refused, even where no program reads the range."""
    name, otherwise, lines = f"window_of_{window.key}", "NULL", list[str]()
    if window.fallback:
        condition, low, high = window.fallback[-1]
        lines.append(f"const double range_of_{window.key}[] = {{{printer.print(low)}, {printer.print(high)}}};")
        otherwise = f"range_of_{window.key}"
        if condition != sp.true:
            otherwise = f"{printer.print(condition)} ? {otherwise} : NULL"
    turns = printer.print(window.turns) if window.has_turns and window.turns != 1 else "0.0"
    lower, upper = (f"p->{inputs.names[end]}" for end in window.given)
    given = [f"&LIMITS[{index}]", lower, upper, f"p->{inputs.names[CHECK_LIMITS]} != 0.0", otherwise, turns,
             f"&{name}", f"&made.ends[{index}]", "why"]  # fmt: skip
    call = f"if (softkin_window_of({', '.join(given)}) != SOFTKIN_OK)"
    return [*lines, f"softkin_window {name};", *block(call, ["return SOFTKIN_NOT_INITIALIZED;"])]


def _window_values(window: Window, read: Collection[str]) -> dict[str, tuple[str, str]]:
    words = ("lowest", "highest", "single", "middle")
    return {
        output.name: ("bool" if word == "single" else "double", f"window_of_{window.key}.{word}")
        for word, output in zip(words, window.outputs, strict=False)
        if output.name in read
    }
