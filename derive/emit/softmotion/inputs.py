"""The inputs of a function block: type, default, range and unit of every parameter."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count

from derive.description.mechanism import Parameter, Role
from derive.emit.inputs import Inputs, Spelling, inputs_of, word_of
from derive.emit.st.expression import literal
from derive.emit.st.layout import sentence
from derive.emit.st.names import capitalized, of_methods, stored_name
from derive.emit.st.reserved import clash
from derive.ir.constants import LARGEST
from derive.kept import kept_by_identity
from derive.kinematics.kinematics import Kinematics

_DIMENSIONLESS = ("", "1")
_PREFIX = {Role.FLAG: "x", Role.SIGN: "i"}


@dataclass(frozen=True)
class Input:
    """A VAR_INPUT, or the input of a configuration block."""

    name: str
    type: str
    default: str
    meaning: str
    range: str = ""
    unit: str = ""


@kept_by_identity(10)
def inputs(kinematics: Kinematics) -> Inputs:
    """The names of the inputs of a block: none is another variable of the block, or of one of its methods."""
    stored = {stored_name(o.name): "a variable of the block" for o in kinematics.setup.outputs}
    local = dict.fromkeys(of_methods(), "a method or a variable of one")
    return inputs_of(kinematics, _TEXT, stored | local)


def _others(parameter: Parameter, wish: str) -> Iterator[str]:
    """The name with the kind of the parameter behind it."""
    longer = f"{wish}{capitalized(word_of(parameter))}"
    yield longer
    yield from (f"{longer}{number}" for number in count(2))


def wanted_name(parameter: Parameter) -> str:
    """The wanted name of an input: `dLinkLength1`, `xFlangeDown`, `iDirectionR`. `inputs` says which name it has."""
    return _PREFIX.get(parameter.role, "d") + capitalized(parameter.given_name)


_TEXT = Spelling(wanted_name, _others, clash, str.lower)


def parameter_input(parameter: Parameter, name: str) -> Input:
    """The input for a parameter of the machine."""
    kind, default = _value(parameter)
    unit = "" if parameter.unit in _DIMENSIONLESS else parameter.unit
    interval = "" if parameter.role is Role.FLAG else _range(parameter)
    return Input(name, kind, default, sentence(parameter.meaning), interval, unit)


def _value(parameter: Parameter) -> tuple[str, str]:
    default = parameter.default or 0.0
    if parameter.role is Role.FLAG:
        return "BOOL", "TRUE" if default else "FALSE"
    if parameter.role is Role.SIGN:
        return "INT", str(int(default))
    return "LREAL", literal(default)


def _range(parameter: Parameter) -> str:
    """The usual range, or else the allowed one, as SoftMotion writes half-open intervals; an end that is the largest
    allowed input is infinite.
    """
    largest = float(LARGEST)
    least, most = parameter.shown
    left, low = ("]", "-inf") if least <= -largest else ("[", f"{least:g}")
    right, high = ("[", "+inf") if most >= largest else ("]", f"{most:g}")
    return f"{']' if parameter.low_open else left}{low} .. {high}{right}"
