"""The templates of the package, with the constants of the compiler that they print: the runtime states none itself."""

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
from derive.ir import cells, roots
from derive.ir.constants import (
    EDGE,
    EXACT_ROTATION,
    FINISHED,
    FREE_ANGLE,
    GEARED_TURN,
    HELD,
    LARGEST,
    LEAST,
    LIMIT,
    ONE_TURN,
    PIVOT,
    ROTATION,
    SINGULAR,
    SOLVABLE,
    TIE,
    TRIALS,
    UNLIMITED,
)
from derive.ir.program import Status
from derive.ir.reason import Why
from derive.report.reasons import NO_MEANING, OTHER_TURN

NAME = "python"
"""The folder of the templates."""
_VERSION = "0.1.0"
"""The version of the package, and of each package that is made for a user's machines."""
_OF_THE_SEARCH = (
    *("AHEAD", "ASIDE", "BENT", "CELLS", "CLOSING", "FINEST", "FLAT", "GAP", "NARROW", "NEAR_ZERO"),
    *("NEXT", "RESERVE", "RIM", "SEAM", "SHIFTS", "TOUCHED", "TURNED", "VANISHING"),
)

_TEXT = 110
"""The most columns of a line of a docstring."""
_CHUNK = 8192
"""The rows of a batch that are computed together: an array then has 64 KiB."""
_MEANINGS = {
    Status.OK: "no error",
    Status.NOT_INITIALIZED: "a parameter is not allowed",
    Status.BAD_INPUT: "numbers must be finite and at most 1e9 in size, and a rotation must be one",
    Status.UNREACHABLE: "out of reach or beyond a limit",
    Status.IMPOSSIBLE: "the mechanism cannot be assembled there, or a joint is undetermined",
    Status.INVALID_COUPLING: "this pair of position and orientation kinematics is impossible",
}


@cache
def templates() -> Environment:
    """The templates, which know the constants."""
    found = environment(NAME)
    found.filters |= {"paragraph": _paragraph, "literal": entries.literal}
    found.globals |= {
        "generated": GENERATED,
        "statuses": [{"name": s.name, "softmotion": s.value, "meaning": _MEANINGS[s]} for s in Status],
        "version": _VERSION,
        "chunk": _CHUNK,
        "values_of_a_search": OF_A_SEARCH,
        "edge": literal(float(EDGE)),
        "held": literal(float(HELD)),
        "free_angle": literal(float(FREE_ANGLE)),
        "largest": literal(float(LARGEST)),
        "least": literal(float(LEAST)),
        "rotation": rotation_functions(),
        "largest_error": literal(float(ROTATION)),
        "search_constants": {name: _literal((vars(cells) | vars(roots))[name]) for name in _OF_THE_SEARCH},
        "exact": literal(float(EXACT_ROTATION)),
        "one_turn": literal(int(ONE_TURN)),
        "geared_turn": literal(float(GEARED_TURN)),
        "pivot": literal(float(PIVOT)),
        "singular": literal(float(SINGULAR)),
        "cells": _after_docstring(Path(cells.__file__).read_text()),
        "roots": _after_docstring(Path(roots.__file__).read_text()),
        "trials": TRIALS,
        "finished": FINISHED,
        "solvable": literal(float(SOLVABLE)),
        "tie": literal(float(TIE)),
        "no_meaning": NO_MEANING,
        "below": entries.literal(Why.BELOW.value),
        "above": entries.literal(Why.ABOVE.value),
        "other_turn": entries.literal(OTHER_TURN),
        "kinds_of_parameters": {role.value: entries.usual(role) for role in Role},
        "limit": literal(float(LIMIT)),
        "unlimited": literal(float(UNLIMITED)),
    }
    return found


def _literal(value: float | tuple[float, ...]) -> str:
    """The literal of a constant of the search."""
    return f"({', '.join(map(literal, value))})" if isinstance(value, tuple) else literal(value)


def _after_docstring(source: str) -> str:
    """The text of a module of the compiler without docstring and first import, as a part of the package."""
    text = source.split("from __future__ import annotations", 1)[1].strip()
    return text.replace("from derive.ir.cells", "from softkin._cells").replace("import TypeVar", "import Any, TypeVar")


def _paragraph(text: str, indent: int = 0) -> str:
    """A text broken into the lines of a docstring, each with an indent."""
    space = " " * indent
    return "\n".join(map(documented, wrap(text, _TEXT, initial_indent=space, subsequent_indent=space)))
