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
from derive.emit.setup import own_setup, parameters_read
from derive.equations.windows import Window, windows
from derive.ir.program import Call, FindRoot, Iterate, Require
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
    by_refusal = {window.refusal: window for window in windows(kin.mechanism)}
    program = own_setup(kin, read)
    lines: list[str] = []
    for statement in program.body:
        if isinstance(statement, Iterate | Call | FindRoot):
            raise TypeError(
                "what depends on parameters alone is straight-line: a setup program neither iterates nor calls"
            )
        window = by_refusal.get(statement.reason) if isinstance(statement, Require) and statement.reason else None
        if window:
            lines += _window(window, read)
        elif isinstance(statement, Require):
            lines += _refusal(statement, inputs(kin))
        else:
            lines += binding_lines(statement, _PRINTER)
    ends = {o.name for window in by_refusal.values() for o in window.outputs}
    values = {f"self.{spelled(o.name)}": _PRINTER.print(o.value) for o in program.outputs if o.name not in ends}
    names = inputs(kin).names
    given = {spelled(p.name): _value(p, names[p.name]) for p in parameters_read(kin, program, by_refusal.values())}
    return [*assigned(given), *lines, *assigned(values)]


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
    read = {s.name for s in statement.condition.free_symbols}
    names = "".join(f', "{name}"' for inner, name in given.names.items() if inner in read)
    assert statement.reason is not None
    message = given.told(statement.reason.subject.name)
    return [f"if not ({conjunction([statement.condition])}):", f"    raise machine._refusal({quoted(message)}{names})"]


def _default(parameter: Parameter) -> str:
    if parameter.default is None:
        return ""
    if parameter.role is Role.FLAG:
        return f" = {bool(parameter.default)}"
    return f" = {int(parameter.default) if parameter.role is Role.SIGN else parameter.default!r}"
