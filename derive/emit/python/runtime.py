"""The templates of the package, with the constants of the compiler, which the runtime imports."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from textwrap import wrap

from jinja2 import Environment

from derive.description.dimensions import Role
from derive.emit.language import GENERATED, environment
from derive.emit.python import entries
from derive.emit.python.arrays import OF_A_SEARCH
from derive.emit.python.layout import documented
from derive.emit.python.printer import literal
from derive.emit.python.rotation import rotation_functions
from derive.emit.shared_constants import CONSTANTS, STATUSES
from derive.ir import cells, roots
from derive.ir.reason import Why
from derive.report.reasons import NO_MEANING, OTHER_TURN

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
        "cells": _after_docstring(Path(cells.__file__).read_text()),
        "roots": _after_docstring(Path(roots.__file__).read_text()),
        "usual": {role.value: entries.usual(role) for role in Role},
    }
    return found


def _constants() -> dict[str, str]:
    """The literals of the constants that modules of the runtime import, by their names."""
    texts = {"ABOVE": Why.ABOVE.value, "BELOW": Why.BELOW.value, "NO_MEANING": NO_MEANING, "OTHER_TURN": OTHER_TURN}
    values = {**CONSTANTS, **texts, "OF_A_SEARCH": OF_A_SEARCH}
    return {name: _literal(values[name]) for name in sorted(values)}


def _literal(value: str | float | tuple[float, ...]) -> str:
    """The literal of a constant."""
    if isinstance(value, tuple):
        return f"({', '.join(map(literal, value))})"
    return entries.literal(value) if isinstance(value, str) else literal(value)


def _after_docstring(source: str) -> str:
    """The text of a module of the compiler without docstring and first import, as a part of the package."""
    text = source.split("from __future__ import annotations", 1)[1].strip()
    return text.replace("from derive.ir.cells", "from softkin._cells").replace("import TypeVar", "import Any, TypeVar")


def _paragraph(text: str, indent: int = 0) -> str:
    """A text broken into the lines of a docstring, each with an indent."""
    space = " " * indent
    return "\n".join(map(documented, wrap(text, _TEXT, initial_indent=space, subsequent_indent=space)))
