"""Expressions in JavaScript.

Names of the derivation stay as they are, in small letters; names of the runtime contain a capital letter.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from textwrap import wrap

import sympy as sp

from derive.emit.braced import Braced, broken, harmless
from derive.ir.constants import DEGREE
from derive.ir.primitives import FUNCTIONS, KEYS, Select
from derive.ir.program import Status

_WORDS = frozenset(
    "arguments await break case catch class const continue debugger default delete do else enum eval export extends "
    "false finally for function if implements import in instanceof interface let new null package private protected "
    "public return static super switch this throw true try typeof undefined var void while with yield".split()
)
"""Words of JavaScript, which cannot be names."""
TAKEN = frozenset({"axes", "found", "given", "k", "p", "pass", "point", "offset", "position", "reference", "refuse",
                   "rotation", "signs", "speeds", "start", "turn", "turns", "window"})  # fmt: skip
"""Names that a printed function needs for its own variables."""


def spelled(name: str) -> str:
    """The spelling of a name: unchanged, unless it is a word of JavaScript, or the printed function uses it already."""
    return f"{name}_" if name in _WORDS or name in TAKEN else name


def text(value: object) -> str:
    """A literal text, or plain data."""
    return json.dumps(value, ensure_ascii=False)


def status(value: Status) -> str:
    """A status."""
    return f"Status.{value.name}"


def list_of(parts: Iterable[str]) -> str:
    """Expressions as an array."""
    return f"[{', '.join(parts)}]"


def function_name(program: str) -> str:
    """The function of a program: `wrist_centre` → `findWristCentre`. No name of the derivation is written like this."""
    return "find" + "".join(word[:1].upper() + word[1:] for word in program.split("_"))


WIDTH = 120
"""The most columns of a line."""
_COMMENT = 100
"""The most columns of a comment that stands above a statement."""


def comment(note: str) -> list[str]:
    """A note as lines of comment; no line for an empty one."""
    return wrap(harmless(note), _COMMENT, initial_indent="// ", subsequent_indent="// ")


def commented(line: str, note: str) -> list[str]:
    """A statement with a note beside it, or above it if there is no room in most places."""
    beside = f"{line} // {note}"
    return [beside] if note and len(beside) <= _COMMENT else [*comment(note), line]


def laid_out(lines: Sequence[str]) -> list[str]:
    """Lines of which none that can be broken is too wide."""
    return [part for line in lines for part in broken(line, WIDTH)]


class JavaScript(Braced):
    """Writes expressions and the parts of statements."""

    functions = {
        "sin": "Math.sin", "cos": "Math.cos", "abs": "Math.abs", "root": "squareRoot", "atan2": "angleOf",
    }  # fmt: skip
    shared_function = "{camel}"
    square_root = "Math.sqrt"

    spelled = staticmethod(spelled)
    comment = staticmethod(comment)
    commented = staticmethod(commented)

    def name(self, symbol: sp.Symbol) -> str:
        return symbol.name if symbol == DEGREE else spelled(symbol.name)

    def number(self, value: float) -> str:
        mantissa, letter, exponent = repr(value).removesuffix(".0").partition("e")
        return f"{mantissa}e{int(exponent)}" if letter else mantissa

    def larger(self, first: str, second: str) -> str:
        return f"Math.max({second}, {first})"

    def comparison(self, operator: str) -> str:
        return {"==": "===", "!=": "!=="}.get(operator, operator)

    def constant(self, name: sp.Symbol) -> str:
        return "const "

    def declared(self, names: Sequence[sp.Symbol]) -> list[str]:
        return [f"let {', '.join(self.names(names))};"] if names else []

    def when(self, condition: str, statement: str) -> list[str]:
        return [f"if ({condition}) {statement}"]


PRINTER = JavaScript()
RUNTIME = frozenset(JavaScript.function(KEYS[one]) for one in FUNCTIONS if one is not Select) | {
    "DEGREE", "RADIAN", "Machine", "Refusal", "Status", "everyRoot", "isReasonable", "refuse",
    "solveLinear", "turnInside",
}  # fmt: skip
"""The names that a module may import from the runtime."""
