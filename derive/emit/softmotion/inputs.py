"""The inputs of a function block: type, default, range and unit of every parameter."""

from __future__ import annotations

from dataclasses import dataclass

from derive.description.mechanism import Parameter, Role
from derive.emit.st.expression import literal
from derive.emit.st.names import input_name
from derive.ir.constants import (
    LARGEST,
)

_DIMENSIONLESS = ("", "1")


@dataclass(frozen=True)
class Input:
    """A VAR_INPUT, or the input of a configuration block."""

    name: str
    type: str
    default: str
    meaning: str
    range: str = ""
    unit: str = ""


def parameter_input(parameter: Parameter) -> Input:
    """The input for a parameter of the machine."""
    kind, default = _value(parameter)
    unit = "" if parameter.unit in _DIMENSIONLESS else parameter.unit
    interval = "" if parameter.role is Role.FLAG else _range(parameter)
    return Input(input_name(parameter), kind, default, parameter.meaning, interval, unit)


def _value(parameter: Parameter) -> tuple[str, str]:
    default = parameter.default or 0.0
    if parameter.role is Role.FLAG:
        return "BOOL", "TRUE" if default else "FALSE"
    if parameter.role is Role.SIGN:
        return "INT", str(int(default))
    return "LREAL", literal(default)


def _range(parameter: Parameter) -> str:
    """A range as SoftMotion writes half-open intervals; an end that is the largest allowed input is infinite."""
    largest = float(LARGEST)
    left, low = ("]", "-inf") if parameter.low <= -largest else ("[", f"{parameter.low:g}")
    right, high = ("[", "+inf") if parameter.high >= largest else ("]", f"{parameter.high:g}")
    return f"{']' if parameter.low_open else left}{low} .. {high}{right}"
