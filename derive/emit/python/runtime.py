"""The templates of the package, with the constants of the compiler, which the runtime imports."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from textwrap import wrap

from jinja2 import Environment

from derive.description.dimensions import Role
from derive.emit.interface import rotation_entry
from derive.emit.language import CONSTANTS, GENERATED, OF_POSES, STATUSES, environment
from derive.emit.python import entries
from derive.emit.python.arrays import CALLED, TYPES, array_body, named_in
from derive.emit.python.layout import documented
from derive.emit.python.methods import ROTATION_ARGUMENT
from derive.emit.python.printer import ScalarPrinter, literal, primitives_in
from derive.emit.python.program import Method, scalar_body
from derive.emit.python.refusal import explained
from derive.equations.rotation_repair import rotation_program, surely_exact
from derive.ir.constants import SAME_ROTATION
from derive.ir.passes import without_reasons
from derive.ir.reason import Why
from derive.report.reasons import NO_MEANING, OTHER_TURN, reasons_of_rotation

NAME = "python"
"""The folder of the templates."""
_VERSION = "0.1.0"
"""The version of the package, and of each package that is made for a user's machines."""

_TEXT = 110
"""The most columns of a line of a docstring."""


@cache
def templates() -> Environment:
    """The templates, which know the constants."""
    found = environment(NAME)
    found.filters |= {"paragraph": _paragraph, "literal": entries.literal}
    found.globals |= {
        "generated": GENERATED,
        "statuses": STATUSES,
        "version": _VERSION,
        "rotation": rotation_functions(),
        "constants": _constants(),
        "usual": {role.value: entries.usual(role) for role in Role},
    }
    return found


def _constants() -> dict[str, str]:
    """The literals of the constants that modules of the runtime import, by their names."""
    texts = {"ABOVE": Why.ABOVE.value, "BELOW": Why.BELOW.value, "NO_MEANING": NO_MEANING, "OTHER_TURN": OTHER_TURN}
    values = {**CONSTANTS, **OF_POSES, **texts, "SAME_ROTATION": float(SAME_ROTATION)}
    return {name: _literal(values[name]) for name in sorted(values)}


def _literal(value: str | float | tuple[float, ...]) -> str:
    """The literal of a constant."""
    if isinstance(value, tuple):
        return f"({', '.join(map(literal, value))})"
    return entries.literal(value) if isinstance(value, str | int) else literal(value)


def _paragraph(text: str, indent: int = 0) -> str:
    """A text broken into the lines of a docstring, each with an indent."""
    space = " " * indent
    return "\n".join(map(documented, wrap(text, _TEXT, initial_indent=space, subsequent_indent=space)))


def rotation_functions() -> dict[str, object]:
    """The values that the templates read: the bodies of both functions, and the names that they call."""
    entry = rotation_entry()
    method = Method(
        "made_rotation", entry.summary, entry.program, (ROTATION_ARGUMENT,), "Rotation", ROTATION_ARGUMENT.shape
    )
    plain = _with_shortcut(scalar_body(method, explained(reasons_of_rotation())))
    arrays = array_body(replace(method, program=without_reasons(method.program)))
    return {
        "plain": plain,
        "primitives": primitives_in(plain),
        "arrays": arrays,
        "helpers": sorted(named_in(arrays, CALLED | TYPES), key=lambda n: (n[0].islower(), n)),
    }


def _with_shortcut(lines: Sequence[str]) -> list[str]:
    """The lines, with an early return for an exact rotation, as nearly every call has, in front of the first value."""
    first = rotation_program().lets()[0].name.name
    place = next(k for k, line in enumerate(lines) if line.startswith(f"{first} = "))
    conditions = " and ".join(map(ScalarPrinter().print, surely_exact()))
    shortcut = [f"if {conditions}:", f"    return {ROTATION_ARGUMENT.name}"]
    return [*lines[:place], *shortcut, *lines[place:]]
