"""The setup program: it computes the constants of a machine from its parameters, or refuses these.

The runtime tests the range of each parameter, and computes the range of each axis: `window`.
"""

from __future__ import annotations

from collections.abc import Collection

import sympy as sp

from derive.emit.braced import block
from derive.emit.inputs import Inputs
from derive.emit.javascript.printer import PRINTER, list_of, spelled, text
from derive.emit.javascript.program import Body, refusals_of
from derive.emit.setup import setup_of
from derive.equations.windows import Window
from derive.ir.program import Require
from derive.kinematics.kinematics import Kinematics
from derive.report.reasons import Reasons


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
