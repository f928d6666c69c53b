"""Expressions in Python, on plain numbers and on arrays. The two differ in choices and in logic only."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Sequence
from keyword import iskeyword

import sympy as sp

from derive.emit.expression import ATOM, COMPARE, ExpressionPrinter, magnitude_tests
from derive.ir.constants import DEGREE
from derive.ir.primitives import FUNCTIONS, KEYS, Atan2, Root, Select
from derive.optimize.inline import Grouped

_PRIMITIVES = frozenset(KEYS[one] for one in FUNCTIONS)
TAKEN = _PRIMITIVES | {
    "axes", "position", "rotation", "point", "offset", "signs", "speeds", "turns", "reference",
    "self", "k", "status", "absolute", "require", "passed", "solve", "settled", "initial", "advanced", "done",
    "given", "found", "frame", "arctan2", "sqrt", "elsewhere", "degrees", "no_offsets", "opposite", "holds",
    "reasonable", "p", "machine", "joints", "every", "refused", "base_axis", "flange_axis", "start_position",
    "start_rotation", "beyond", "beyond_turn", "turn_inside", "every_root",
    "find_platform", "finish", "finish_root", "try_joint", "unrolled", "np", "any", "bool", "float", "isinstance",
    "range", "tuple", "max", "min", "super", "zip", "len",
}  # fmt: skip
"""Names that a generated method needs for its own variables."""


def spelled(name: str) -> str:
    """The spelling of a name: unchanged, unless Python or the generated method uses that name already."""
    return f"{name}_" if iskeyword(name) or name in TAKEN else name


def literal(value: float) -> str:
    """The literal of a real number: `2.0`, `0.5`, `1e9`, `1e-12`."""
    if value == 0.0 or 1e-4 <= abs(value) < 1e6:
        return repr(value)
    mantissa, _, exponent = f"{value:e}".partition("e")
    short = f"{mantissa.rstrip('0').rstrip('.')}e{int(exponent)}"
    return short if float(short) == value else repr(value)


def primitives_in(lines: Iterable[str]) -> list[str]:
    """The primitives and constants that statements use, in alphabetical order."""
    known = _PRIMITIVES - {"abs", "select"} | {"DEGREE", "RADIAN", "reasonable", "arctan2", "solve", "sqrt"}
    return sorted(words(lines) & known)


def words(lines: Iterable[str]) -> set[str]:
    """The words of statements, except those in strings and comments."""
    return {
        word for line in lines for word in re.findall(r"[A-Za-z_]\w*", re.sub(r'"[^"]*"', "", line).partition("#")[0])
    }


class ScalarPrinter(ExpressionPrinter):
    """Writes expressions on plain numbers: a choice is a conditional expression that evaluates one side only.

    A call takes longer than a short expression, so the root of a sum of squares or of a name, and the absolute value of
    a name, are written out. In the arguments of an angle, adding 0 removes the sign of a zero.
    """

    def __init__(self, *, modulo_turns: bool = False, for_valid_input: bool = False) -> None:
        """modulo_turns: whether -180 and 180 degrees are the same, so that the sign of a zero sine does not matter.

        for_valid_input: whether sine and cosine of an angle are known not to vanish together.
        """
        self.modulo_turns, self.for_valid_input = modulo_turns, for_valid_input

    def _spell(self, node: sp.Basic) -> tuple[str, int]:
        if isinstance(node, Grouped):
            return self._spell(node.args[0])
        if (
            isinstance(node, sp.LessThan)
            and isinstance(node.lhs, sp.Abs)
            and node.lhs.args[0].is_Symbol
            and node.rhs.is_positive
        ):
            bound, value = self.print(node.rhs), self.print(node.lhs.args[0])
            return f"-{bound} <= {value} <= {bound}", COMPARE
        if (
            isinstance(node, Select)
            and isinstance(node.args[1], Root)
            and node.args[0] == sp.Gt(node.args[1].args[0], 0)
        ):
            condition, (radicand,), otherwise = node.args[0], node.args[1].args, node.args[2]
            return f"(sqrt({self.print(radicand)}) if {self.print(condition)} else {self.print(otherwise)})", ATOM
        if isinstance(node, Root) and node.args[0].is_Symbol:
            text = self.print(node.args[0])
            return f"(sqrt({text}) if {text} > 0.0 else 0.0)", ATOM
        return super()._spell(node)

    def name(self, symbol: sp.Symbol) -> str:
        return symbol.name if symbol.name == "DEGREE" else spelled(symbol.name)

    def number(self, value: float) -> str:
        return literal(value)

    def choice(self, condition: str, first: str, second: str) -> str:
        return f"({first} if {condition} else {second})"

    def call(self, key: str, arguments: Sequence[str]) -> str:
        if key == "atan2":
            sine, cosine = arguments
            first, second = ("" if is_free else " + 0.0" for is_free in (self.modulo_turns, self.for_valid_input))
            return f"arctan2({sine}{first}, {cosine}{second})"
        return super().call(key, arguments)

    def larger(self, first: str, second: str) -> str:
        return f"max({second}, {first})"

    def logic(self, word: str) -> str:
        return {"true": "True", "false": "False"}.get(word, word)


class ArrayPrinter(ScalarPrinter):
    """Writes expressions on arrays: a choice evaluates both sides, and conditions are masks. Constants are attributes:
    `k.arm_length`.
    """

    functions = {"abs": "absolute"}
    radian = ""

    def __init__(self, constants: Collection[str] = (), *, modulo_turns: bool = False) -> None:
        """constants: the names of the constants; modulo_turns: as in `ScalarPrinter`."""
        super().__init__(modulo_turns=modulo_turns)
        self.constants = frozenset(constants)

    def larger(self, first: str, second: str) -> str:
        return ""  # NumPy's maximum of NaN and a number is NaN

    def name(self, symbol: sp.Symbol) -> str:
        return f"k.{spelled(symbol.name)}" if symbol.name in self.constants else super().name(symbol)

    def _spell(self, node: sp.Basic) -> tuple[str, int]:
        if isinstance(node, sp.Not):
            return f"opposite({self.print(node.args[0])})", ATOM
        if checked := magnitude_tests([node], 1):
            return f"reasonable({', '.join(map(self.print, checked))})", ATOM
        if self.modulo_turns and node.is_Mul and len(node.args) == 2 and 1 / DEGREE in node.args:
            (angle,) = (factor for factor in node.args if factor != 1 / DEGREE)
            if isinstance(angle, Atan2):
                return f"degrees({', '.join(map(self.print, angle.args))})", ATOM
        return ExpressionPrinter._spell(self, node)

    def choice(self, condition: str, first: str, second: str) -> str:
        return f"select({condition}, {first}, {second})"

    def call(self, key: str, arguments: Sequence[str]) -> str:
        return ExpressionPrinter.call(self, key, arguments)

    def logic(self, word: str) -> str:
        return {"and": "&", "or": "|", "true": "True", "false": "False"}[word]
