"""The setup program: it computes the constants of a machine from its parameters, or refuses these.

The runtime tests the range of each parameter, and computes the range of each axis: `window`.
"""

from __future__ import annotations

from collections.abc import Collection

import sympy as sp

from derive.emit.braces import block
from derive.emit.inputs import Inputs
from derive.emit.javascript.layout import comment, commented
from derive.emit.javascript.printer import PRINTER, list_of, spelled, text
from derive.emit.javascript.program import solved, without_brackets
from derive.emit.javascript.refusal import condition_of
from derive.emit.setup import own_setup, parameters_read
from derive.equations.windows import Window, windows
from derive.ir.program import Let, Require, Solve
from derive.kinematics.kinematics import Kinematics


def setup_lines(kin: Kinematics, read: Collection[str], inputs: Inputs) -> list[str]:
    """The function. read: the constants that other functions read; inputs: what the parameters are called."""
    by_refusal = {window.refusal: window for window in windows(kin.mechanism)}
    program = own_setup(kin, read)
    lines: list[str] = []
    values: dict[str, str] = {}
    for statement in program.body:
        window = by_refusal.get(statement.reason) if isinstance(statement, Require) and statement.reason else None
        if window is not None:
            lines += _window(window, read, values)
        elif isinstance(statement, Require):
            lines += _refusal(statement, inputs)
        elif isinstance(statement, Let):
            value = without_brackets(statement.value, PRINTER.value(statement.name, statement.value))
            lines += commented(f"const {spelled(statement.name.name)} = {value};", statement.comment)
        elif isinstance(statement, Solve):
            lines += [*comment(statement.note), f"const {solved(statement)};"]
        else:
            raise TypeError("what depends on parameters alone is straight-line: it neither iterates nor calls")
    ends = {o.name for window in by_refusal.values() for o in window.outputs}
    values |= {o.name: PRINTER.print(o.value) for o in program.outputs if o.name not in ends}
    given = [(inputs.names[p.name], spelled(p.name)) for p in parameters_read(kin, program, by_refusal.values())]
    taken = [name if name == inner else f"{name}: {inner}" for name, inner in given]
    head = [f"const {{ {', '.join(taken)} }} = p;"] if taken else []
    result = [f"{name}: {value}," if name != value else f"{name}," for name, value in values.items()]
    body = [*head, *lines, "return {", *(f"  {line}" for line in result), "};"]
    return [
        "/** The values that depend on the parameters alone, or why the parameters are refused. */",
        *block("function findConstants(p, window)", body),
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


def _refusal(statement: Require, inputs: Inputs) -> list[str]:
    """A condition on several parameters, with its sentence and their names."""
    assert statement.reason is not None
    read = {s.name for s in statement.condition.free_symbols}
    given = text([name for inner, name in inputs.names.items() if inner in read])
    refused = f"return refuseParameters({text(inputs.told(statement.reason.subject.name))}, {given});"
    return [*comment(statement.note), *block(f"if (!({condition_of([statement.condition])}))", [refused])]
