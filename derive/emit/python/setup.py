"""The setup program in Python: it computes the constants of a machine from its parameters."""

from __future__ import annotations

from collections.abc import Collection

import sympy as sp

from derive.description.mechanism import Parameter, Role
from derive.emit.inputs import Inputs
from derive.emit.python.entries import inputs
from derive.emit.python.layout import assigned, quoted
from derive.emit.python.printer import ScalarPrinter, spelled
from derive.emit.python.program import binding_lines
from derive.emit.python.refusal import conjunction
from derive.emit.setup import refused_inputs, setup_of
from derive.equations.windows import Window
from derive.ir.program import Require
from derive.kinematics.kinematics import Kinematics

_PRINTER = ScalarPrinter()
_TYPES = {Role.FLAG: "bool", Role.SIGN: "int"}


def keywords(kin: Kinematics) -> str:
    """The parameters of `__init__`: a keyword for each parameter of the machine, with its default where it has one."""
    names = inputs(kin).names
    typed = [f"{names[p.name]}: {_TYPES.get(p.role, 'float')}{_default(p)}" for p in kin.parameters]
    typed.append("limits: Limits | None = None")
    return f"def __init__(self, *, {', '.join(typed)}) -> None:"


def attributes(kin: Kinematics) -> list[str]:
    """The parameters as typed attributes of the class."""
    names = inputs(kin).names
    return [f"{names[p.name]}: {_TYPES.get(p.role, 'float')}" for p in kin.parameters]


def setup_body(kin: Kinematics, read: Collection[str]) -> list[str]:
    """The lines that raise errors for parameters that cannot be, then compute the constants that programs read."""
    found, given = setup_of(kin, read), inputs(kin)
    lines: list[str] = []
    for step in found.steps():
        if isinstance(step, Window):
            lines += _window(step, read)
        elif isinstance(step, Require):
            lines += _refusal(step, given)
        else:
            lines += binding_lines(step, _PRINTER)
    values = {f"self.{spelled(o.name)}": _PRINTER.print(o.value) for o in found.outputs()}
    taken = {spelled(p.name): _value(p, given.names[p.name]) for p in found.parameters(kin)}
    return [*assigned(taken), *lines, *assigned(values)]


def _value(parameter: Parameter, name: str) -> str:
    text = f'p["{name}"]'
    return f"bool({text})" if parameter.role is Role.FLAG else text


def _window(window: Window, read: Collection[str]) -> list[str]:
    """The line that computes the range of an axis. It refuses invalid limits even where no program reads the range."""
    targets = [f"self.{spelled(o.name)}" if o.name in read else "_" for o in window.outputs]
    call = f'machine._window("{window.key}"{_without_limits(window)}{_gear(window)})'
    while targets and targets[-1] == "_":
        targets.pop()
    if not targets:
        return [call]
    return [f"{', '.join([*targets, '*_'] if len(targets) < 4 else targets)} = {call}"]


def _without_limits(window: Window) -> str:
    """The argument with the range of an axis that is given no limits."""
    if not window.fallback:
        return ""
    condition, low, high = window.fallback[-1]
    interval = f"({_PRINTER.print(low)}, {_PRINTER.print(high)})"
    return f", {interval}" if condition == sp.true else f", {interval} if {_PRINTER.print(condition)} else None"


def _gear(window: Window) -> str:
    """The argument with the turns of a joint with a gear per turn of its axis."""
    return f", turns={_PRINTER.print(window.turns)}" if window.has_turns and window.turns != 1 else ""


def _refusal(statement: Require, given: Inputs) -> list[str]:
    message, names = refused_inputs(statement, given)
    refused = ", ".join([quoted(message), *(f'"{name}"' for name in names)])
    return [f"if not ({conjunction([statement.condition])}):", f"    raise machine._refusal({refused})"]


def _default(parameter: Parameter) -> str:
    if parameter.default is None:
        return ""
    if parameter.role is Role.FLAG:
        return f" = {bool(parameter.default)}"
    return f" = {int(parameter.default) if parameter.role is Role.SIGN else parameter.default!r}"
