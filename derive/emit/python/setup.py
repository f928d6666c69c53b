"""The setup program as the function that makes the constants of a machine from its parameters."""

from __future__ import annotations

from derive.description.mechanism import Parameter, Role
from derive.emit.python.layout import fold
from derive.emit.python.printer import ScalarPrinter, literal, spelled
from derive.emit.python.program import binding_lines
from derive.emit.python.refusal import conjunction
from derive.ir.constants import (
    UNLIMITED,
)
from derive.ir.program import (
    Call,
    FindRoot,
    Iterate,
    Require,
)
from derive.ir.types import Type, type_of
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.parameters import limited_keys

_PRINTER = ScalarPrinter()
_TYPES = {Role.FLAG: "bool", Role.SIGN: "int"}
_KINDS = {Type.BOOL: "bool", Type.INT: "int"}


def keywords(parameters: tuple[Parameter, ...]) -> list[str]:
    """The head of `__init__`: every parameter as a keyword, with its default where it has one."""
    typed = (f"{p.name}: {_TYPES.get(p.role, 'float')}{_default(p)}" for p in parameters)
    return fold(f"def __init__(self, *, {', '.join(typed)}) -> None:")


def accepted(parameters: tuple[Parameter, ...]) -> list[str]:
    """The statement that takes every parameter in."""
    return fold(f"values = self._accept({', '.join(p.name for p in parameters)})")


def setup_head(parameters: tuple[Parameter, ...]) -> list[str]:
    """The head of the setup function."""
    typed = (f"{spelled(p.name)}: {_TYPES.get(p.role, 'float')}" for p in parameters)
    return fold(f"def _setup(self, {', '.join(typed)}) -> Constants:")


def setup_body(kin: Kinematics) -> list[str]:
    """Conditions as errors that name the parameters, then the constants."""
    inputs = [s.name for s in kin.setup.inputs]
    lines: list[str] = []
    for statement in kin.setup.body:
        if isinstance(statement, Iterate | Call | FindRoot):
            raise TypeError("what depends on parameters alone is straight-line: a setup program neither iterates nor calls")
        lines += _refusal(statement, inputs) if isinstance(statement, Require) else binding_lines(statement, _PRINTER)
    values = (f"{spelled(o.name)}={_PRINTER.print(o.value)}" for o in kin.setup.outputs)
    return [*lines, *fold(f"return Constants({', '.join(values)})")]


def constants(kin: Kinematics) -> dict[str, str]:
    """The constants with their types."""
    return {spelled(o.name): _KINDS.get(type_of(o.value), "float") for o in kin.setup.outputs}


def tested_limits(kin: Kinematics) -> list[str]:
    """The unrolled functions; where limits are not tested, they are nowhere."""
    keys = limited_keys(kin.mechanism)
    bounds = [(f"lowest_{key}", -1) for key in keys] + [(f"highest_{key}", 1) for key in keys]
    values = ", ".join(f"{name}={literal(side * float(UNLIMITED))}" for name, side in bounds)
    functions = "self._all_checked, self._all_trusted, self._one_trusted"
    if not bounds:
        return [f"{functions} = unrolled(self._constants)"]
    return [
        "tested = self._constants",
        "if not self.checks_limits:",
        *fold(f"tested = tested._replace({values})", 4),
        f"{functions} = unrolled(tested)",
    ]


def _refusal(statement: Require, inputs: list[str]) -> list[str]:
    read = {s.name for s in statement.condition.free_symbols}
    values = "".join(f", {spelled(name)}={spelled(name)}" for name in inputs if name in read)
    assert statement.reason is not None
    message = statement.reason.subject.name.replace('"', "'")
    error = f'raise self._refusal("{message}"{values})'
    return [*fold(f"if not ({conjunction([statement.condition])}):"), *fold(error, 4)]


def _default(parameter: Parameter) -> str:
    if parameter.default is None:
        return ""
    if parameter.role is Role.FLAG:
        return f" = {bool(parameter.default)}"
    return f" = {int(parameter.default) if parameter.role is Role.SIGN else parameter.default!r}"
