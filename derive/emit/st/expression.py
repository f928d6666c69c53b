"""Expressions in Structured Text."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp
from sympy.core.relational import Relational

from derive.emit.expression import ExpressionPrinter, is_size_test
from derive.ir.constants import LARGEST
from derive.ir.primitives import Select


def literal(value: float) -> str:
    """A LREAL literal: always with a point, the exponent with a capital E."""
    mantissa, _, exponent = repr(float(value)).partition("e")
    if "." not in mantissa:
        mantissa += ".0"
    if exponent:
        return f"{mantissa}E{int(exponent)}"
    digits = mantissa.rstrip("0").rstrip(".").rstrip("0")
    zeros = len(mantissa.split(".")[0]) - len(digits)
    return f"{digits}.0E{zeros}" if mantissa.endswith(".0") and zeros >= 6 and len(digits) == 1 else mantissa


def limits_of(expression: sp.Basic) -> tuple[sp.Expr, sp.Expr, sp.Expr] | None:
    """The lower limit, the value and the upper limit of a choice that keeps a value inside limits."""
    if not (isinstance(expression, Select) and isinstance(expression.args[2], Select)):
        return None
    (above, high, _), (below, low, value) = expression.args, expression.args[2].args
    is_limited = _is_comparison(above, sp.Gt, value, high) and _is_comparison(below, sp.Lt, value, low)
    return (low, value, high) if is_limited and low.is_number and high.is_number else None


def _is_comparison(condition: sp.Basic, kind: type[Relational], left: sp.Expr, right: sp.Expr) -> bool:
    return isinstance(condition, kind) and condition.args == (left, right)


class StructuredText(ExpressionPrinter):
    """Writes an expression, given the spelling of every name in it."""

    functions, shared_function = {"sin": "SIN", "cos": "COS", "abs": "ABS"}, "Softkin_{words}"
    square_root = "SQRT"

    def __init__(self, names: Mapping[str, str]) -> None:
        self.names = names

    def print(self, expression: sp.Basic) -> str:
        """The expression as text. The size of an input is tested by comparisons, which are defined for every input."""
        if is_size_test(expression):
            return " AND ".join(f"({part})" for part in self.parts(expression))
        if (limits := limits_of(expression)) is not None:
            return f"LIMIT({', '.join(map(self.print, limits))})"
        return super().print(expression)

    def parts(self, condition: sp.Basic) -> list[str]:
        """A condition as conditions that all hold: the size of an input is tested by two comparisons."""
        if not is_size_test(condition):
            return [self.print(condition)]
        value, largest = self.print(condition.lhs.args[0]), literal(float(LARGEST))
        return [f"{value} >= -{largest}", f"{value} <= {largest}"]

    def name(self, symbol: sp.Symbol) -> str:
        """The spelling of a symbol."""
        return self.names[symbol.name]

    def number(self, value: float) -> str:
        """A LREAL literal."""
        return literal(value)

    def choice(self, condition: str, first: str, second: str) -> str:
        """The first or the second of two printed values."""
        return f"SEL({condition}, {second}, {first})"

    def larger(self, first: str, second: str) -> str:
        """The larger of two printed numbers."""
        return f"MAX({second}, {first})"

    def factor(self, expression: sp.Basic) -> str:
        """A whole number converted to a real number."""
        return f"INT_TO_LREAL({self.whole(expression)})"

    def logic(self, word: str) -> str:
        """The spelling of a logical word."""
        return word.upper()

    def comparison(self, operator: str) -> str:
        """The spelling of a comparison: `=` and `<>` for equality and its opposite."""
        return {"==": "=", "!=": "<>"}.get(operator, operator)
