"""Expressions as Python: once on plain numbers, once on arrays. The two differ in choice and logic only."""

from __future__ import annotations

from collections.abc import Sequence
from keyword import iskeyword

import sympy as sp

from derive.emit.expression import FUNCTION_KEYS, ExpressionPrinter

TAKEN = frozenset(FUNCTION_KEYS.values()) | {
    "axes", "position", "rotation", "point", "offset", "signs", "turns", "reference",
    "self", "k", "status", "absolute", "require", "passed", "solve", "settled", "initial", "advanced", "done",
    "given", "found",
}  # fmt: skip
"""Names that a generated method uses for itself."""
ARRAY_NAMES = {"abs": "absolute"}
"""Primitives that are called something else on arrays."""


def spelled(name: str) -> str:
    """The spelling of a name: its own, unless Python or the method around it uses that."""
    return f"{name}_" if iskeyword(name) or name in TAKEN else name


def literal(value: float) -> str:
    """The literal of a real number: `2.0`, `0.5`, `1e9`, `1e-12`."""
    if value == 0.0 or 1e-4 <= abs(value) < 1e6:
        return repr(value)
    mantissa, _, exponent = f"{value:e}".partition("e")
    short = f"{mantissa.rstrip('0').rstrip('.')}e{int(exponent)}"
    return short if float(short) == value else repr(value)


class ScalarPrinter(ExpressionPrinter):
    """Plain numbers: a choice is a conditional expression, and only one arm of it is evaluated."""

    def name(self, symbol: sp.Symbol) -> str:
        return symbol.name if symbol.name == "DEGREE" else spelled(symbol.name)

    def number(self, value: float) -> str:
        return literal(value)

    def call(self, key: str, arguments: Sequence[str]) -> str:
        if key == "select":
            condition, first, second = arguments
            return f"({first} if {condition} else {second})"
        return f"{key}({', '.join(arguments)})"

    def logic(self, word: str) -> str:
        return {"true": "True", "false": "False"}.get(word, word)


class ArrayPrinter(ScalarPrinter):
    """Arrays: a choice evaluates both arms, and conditions are masks."""

    def call(self, key: str, arguments: Sequence[str]) -> str:
        return f"{ARRAY_NAMES.get(key, key)}({', '.join(arguments)})"

    def logic(self, word: str) -> str:
        return {"and": "&", "or": "|", "true": "True", "false": "False"}[word]
