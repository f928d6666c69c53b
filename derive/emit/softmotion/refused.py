"""The reasons why Initialize refuses an input, in the words of the Python package."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from derive.description.mechanism import Parameter, Role
from derive.emit.softmotion.inputs import inputs
from derive.emit.st.names import respelled
from derive.ir.constants import LEAST
from derive.kept import kept_by_identity
from derive.kinematics.kinematics import Kinematics

_MOST_NAMED = 3


@kept_by_identity(10)
def refused_texts(kinematics: Kinematics) -> dict[str, str]:
    """The text of every refusal, by the sentence of its condition: the inputs, then the condition on them.

    A condition on a single input gives the range of that input and the condition.
    """
    spelled = inputs(kinematics).names
    found: dict[str, str] = {}
    for require in kinematics.setup_less_windows.requires():
        assert require.reason is not None
        sentence = require.reason.subject.name
        read = {symbol.name for symbol in require.condition.free_symbols}
        named = [p for p in kinematics.parameters if p.name in read]
        needed = sentence
        if len(named) == 1:
            is_its_range = sentence == f"{named[0].name}: {named[0].meaning}"
            needed = f"it must be {_allowed(named[0])}" + ("" if is_its_range else f" ({sentence})")
        names = _listed([spelled[p.name] for p in named])
        wrong = "is not allowed: " if len(named) == 1 else ": "
        text = f"{names} {wrong}{needed}".replace(" :", ":") if named else f"the parameters must give {needed}"
        if len(named) > 1:
            text = _spelled(text, named, spelled)
        found[sentence] = respelled(text, spelled)
    return found


def _spelled(text: str, named: Sequence[Parameter], spelled: Mapping[str, str]) -> str:
    """The text with the spelling of the inputs that it is about, also of an input whose name is one plain word."""
    names = {p.name: spelled[p.name] for p in named if "_" not in p.name}
    return re.sub(r"\b[a-z]+\b", lambda found: names.get(found[0], found[0]), text)


def _listed(names: Sequence[str]) -> str:
    """The names, at most three of them."""
    if len(names) <= _MOST_NAMED:
        return ", ".join(names)
    return f"{names[0]} and {len(names) - 1} others"


def _allowed(parameter: Parameter) -> str:
    """The values that are allowed, in words."""
    if parameter.role is Role.SIGN:
        return "1 or -1"
    least = max(parameter.low, float(LEAST))
    low = f"more than {least:g}" if parameter.low_open else f"at least {parameter.low:g}"
    is_never_zero = parameter.role in (Role.SIGNED_LENGTH, Role.TRANSMISSION)
    size = f", and more than {float(LEAST):g} in size" if is_never_zero else ""
    return f"{low} and at most {parameter.high:g}{size}"
