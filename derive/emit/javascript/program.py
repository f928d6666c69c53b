"""A program as a JavaScript function with early returns: a refusal returns a `Refusal`, anything else an array."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import sympy as sp

from derive.emit import refusals, walk
from derive.emit.braced import block
from derive.emit.inputs import Inputs
from derive.emit.interface import Shape, names, read_by
from derive.emit.javascript.functions import Function
from derive.emit.javascript.printer import PRINTER, comment, function_name, list_of, spelled, status, text
from derive.emit.setup import setup_of
from derive.equations.windows import Window
from derive.ir.program import Call, FindRoot, Require, Solve, Status
from derive.ir.symbols import PLACE, is_condition
from derive.kinematics.kinematics import Kinematics
from derive.lowering.passes import structured
from derive.lowering.scheduling import decided
from derive.report.reasons import Reasons

_PLACE = "({ tried, side, freed, freed_angle }) => "


def function_lines(function: Function, refusals: Refusals) -> list[str]:
    """The function: it takes its arguments apart, then makes the statements of the program in their order."""
    read = read_by(function.program)
    constants = sorted(read - function.entry.given)
    head = [f"const {{ {', '.join(map(_taken, constants))} }} = k;"] if constants else []
    given = [(name, shape) for name, shape in function.arguments if read & set(names(shape))]
    head += [f"const {_target(shape, read)} = {name};" for name, shape in given]
    lines = Body(refusals).lines(structured(function.program))
    values = {o.name: PRINTER.print(o.value) for o in decided(function.program).outputs}
    result = "null" if function.result is None else _value(function.result, values)
    taken = ", ".join(["k", *(name for name, _ in function.arguments)])
    text = block(f"function {function.name}({taken})", [*head, *lines, f"return {result};"])
    return [f"/** {function.entry.summary} */", *text]


def _taken(constant: str) -> str:
    return constant if spelled(constant) == constant else f"{constant}: {spelled(constant)}"


def _target(shape: Shape, read: set[str]) -> str:
    """A pattern that takes an array apart; values that are not read have no name."""
    if isinstance(shape, str):
        return spelled(shape) if shape in read else ""
    return list_of(_trimmed([_target(part, read) if read & set(names(part)) else "" for part in shape]))


def _value(shape: Shape, values: dict[str, str]) -> str:
    return values[shape] if isinstance(shape, str) else list_of(_value(part, values) for part in shape)


@dataclass
class Body(walk.Body):
    """The statements of one function."""

    endless, numbering = "let pass = 0; ", ""

    def begin(self, state: Sequence[sp.Symbol], values: Sequence[str]) -> list[str]:
        """The variables of the state of a loop, with their first values."""
        pairs = zip(PRINTER.names(state), values, strict=True)
        return [f"let {', '.join(f'{name} = {value}' for name, value in pairs)};"]

    def solve(self, system: Solve) -> list[str]:
        """`[determinant, x, y] = solveLinear(matrix, right)`, matrices by rows."""
        targets = ["" if system.determinant is None else spelled(system.determinant.name), *PRINTER.names(system.names)]
        matrix, right = _matrix(system.matrix, system.size), _matrix(system.right, system.columns)
        word = "const " if self.declared.isdisjoint(system.bound()) else ""
        return [*comment(system.note), f"{word}{list_of(targets)} = solveLinear({matrix}, {right});"]

    def call(self, call: Call) -> list[str]:
        """A call, whose arguments and results are one array each."""
        found = self.another("found")
        value = f"{function_name(call.program.name)}(k, {list_of(self.given(call))})"
        if call.is_conditional:
            nothing = list_of("false" if is_condition(o.value) else "0.0" for o in call.program.outputs)
            value = f"{PRINTER.conjunction([call.wanted])} ? {value} : {nothing}"
        wanted = {name.name for name in call.names}
        taken = _trimmed([spelled(o.name) if o.name in wanted else "" for o in call.program.outputs])
        word = "const " if self.declared.isdisjoint(call.names) else ""
        tail = [f"{word}{list_of(taken)} = {found};"] if taken else []
        refused = PRINTER.when(f"{found} instanceof Refusal", self.refusals.of_call(call, found))
        return [*comment(call.note), f"const {found} = {value};", *refused, *tail]

    def search(self, search: FindRoot) -> list[str]:
        """The search for the nearest root."""
        return [*comment(search.note), f"const {list_of(PRINTER.names(search.names))} = {looked_for(search)};"]


def looked_for(search: FindRoot, function: str = "nearestRoot") -> str:
    """The call of the root scan, whose trials are functions of the place."""
    programs = [
        f"{_PLACE}{function_name(p.name)}(k, {list_of(_given(s) for s in search.given(p))})"
        for p in (search.trial, search.finish)
    ]
    values = [PRINTER.print(search.start), PRINTER.print(search.wanted), str(len(search.names))]
    values += [list_of(map(str, search.sides))] if search.is_listed else []
    return f"{function}({', '.join([*programs, *values])})"


def _given(name: sp.Symbol) -> str:
    """An argument of a trial: a part of the place, which the search sets, or a value."""
    return name.name if name in PLACE else PRINTER.name(name)


def _matrix(entries: Sequence[sp.Expr], width: int) -> str:
    rows = [entries[i : i + width] for i in range(0, len(entries), width)] if entries else []
    return list_of(list_of(map(PRINTER.print, row)) for row in rows)


def _trimmed(targets: list[str]) -> list[str]:
    while targets and not targets[-1]:
        targets.pop()
    return targets


class Refusals(refusals.Refusals):
    """The refusals of one mechanism."""

    largest, smallest = "Math.max", "Math.min"

    def refused(self, outcome: Status, reason: str = "", missing: str = "", turn: str = "") -> str:
        given = [status(outcome), text(reason) if reason else "", missing or ("0" if turn else ""), turn]
        return f"refuse({', '.join(filter(None, given))})"

    def refused_parameters(self, sentence: str, names: Sequence[str]) -> str:
        return f"refuseParameters({text(sentence)}, {text(names)})"

    def reasonable(self, values: Sequence[str]) -> str:
        return f"isReasonable({', '.join(values)})"

    def inside(self, axis: str, lowest: str, highest: str) -> tuple[str, str]:
        return f"const turn = turnInside({axis}, {lowest}, {highest});", "turn"


def refusals_of(reasons: Reasons) -> Refusals:
    """The refusals of a mechanism with these reasons."""
    return Refusals(reasons, PRINTER)


def setup_lines(kin: Kinematics, read: Collection[str], inputs: Inputs) -> list[str]:
    """The function. read: the constants that other functions read; inputs: what the parameters are called."""
    found, body = setup_of(kin, read), Body(refusals_of(Reasons({})))
    lines: list[str] = []
    values: dict[str, str] = {}
    for step in found.steps():
        if isinstance(step, Window):
            lines += _window(step, read, values)
        elif isinstance(step, Require):
            lines += body.refusals.of_parameters(step, inputs)
        else:
            lines += body.lines([step])
    values |= {o.name: PRINTER.print(o.value) for o in found.outputs()}
    given = [(inputs.names[p.name], spelled(p.name)) for p in found.parameters(kin)]
    taken = [name if name == inner else f"{name}: {inner}" for name, inner in given]
    head = [f"const {{ {', '.join(taken)} }} = p;"] if taken else []
    result = [f"{name}: {value}," if name != value else f"{name}," for name, value in values.items()]
    inner = [*head, *lines, "return {", *(f"  {line}" for line in result), "};"]
    return [
        "/** The values that depend on the parameters alone, or why the parameters are refused. */",
        *block("function findConstants(p, window)", inner),
    ]


def _window(window: Window, read: Collection[str], values: dict[str, str]) -> list[str]:
    """The range of an axis. Invalid limits are refused, even where no program reads the range."""
    given, place = [text(window.key)], f"window_of_{window.key}"
    if window.fallback:
        condition, low, high = window.fallback[-1]
        interval = list_of([PRINTER.print(low), PRINTER.print(high)])
        given.append(interval if condition is sp.true else f"{PRINTER.print(condition)} ? {interval} : null")
    if window.has_turns and window.turns != 1:
        given += ["null"] * (2 - len(given)) + [PRINTER.print(window.turns)]
    for index, output in enumerate(window.outputs):
        if output.name in read:
            values[output.name] = f"{place}[{index}]"
    call = f"const {place} = window({', '.join(given)});"
    return [call, f"if ({place} instanceof Refusal) return {place};"]
