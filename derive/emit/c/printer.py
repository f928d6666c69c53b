"""Expressions in C.

Names of the derivation stay as they are, in small letters; names that all machines share begin with `softkin_`.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from textwrap import wrap

import sympy as sp

from derive.emit.expression import ATOM, PRODUCT, ExpressionPrinter, is_never_negative
from derive.ir.constants import DEGREE
from derive.ir.primitives import Root
from derive.ir.program import Status
from derive.ir.symbols import is_condition, is_count

_FUNCTIONS = {
    "sin": "sin", "cos": "cos", "abs": "fabs", "root": "softkin_root", "atan2": "softkin_angle_of",
    "nearest_period": "softkin_on_turn", "nearest_on_arc": "softkin_nearest_on_arc",
}  # fmt: skip
WORDS = frozenset(
    "auto break case char const continue default do double else enum extern float for goto if inline int long "
    "register restrict return short signed sizeof static struct switch typedef union unsigned void volatile while "
    "bool true false asm typeof near far huge interrupt linux unix i386 alignas alignof atomic complex imaginary "
    "and and_eq bitand bitor catch class compl const_cast constexpr decltype delete dynamic_cast explicit export "
    "friend mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public "
    "reinterpret_cast static_assert static_cast template this thread_local throw try typeid typename using virtual "
    "wchar_t xor xor_eq errno stdin stdout stderr EOF NULL NAN INFINITY HUGE_VAL DOMAIN OVERFLOW UNDERFLOW MAXFLOAT "
    "I PI DEG_TO_RAD RAD_TO_DEG HIGH LOW".split()
)
"""Words of C and C++, and macros of compilers and libraries, which cannot be names."""
_RESERVED = re.compile(r"_[A-Z_]|softkin_|SOFTKIN_|(M|FP|HUGE|INT\d*|UINT\d*|SIZE|MATH)_[A-Z0-9_]+$")
"""The beginnings of names that belong to the compiler, its library or the shared header."""
_TAKEN = frozenset(
    "arguments axes context cos fabs finish found frame given joints k lane machine made margins missed misses near "
    "otherwise p parameters pass place reference results root rotation rows search signs sin sizes sqrt start status "
    "statuses system take turn turns values wanted why".split()
)
"""Names that a printed function needs for its own variables and for the functions that it calls."""
_TEXT = 80
"""The most columns of a text; a longer one is written as several."""


def spelled(name: str) -> str:
    """The name of a variable: unchanged, unless it is a word of C, or the printed function uses it already."""
    return _outside(name) if name not in _TAKEN else f"{name}_"


def is_reserved(name: str) -> bool:
    """Whether a name has another meaning in C, in C++ or in what a source includes."""
    return name in WORDS or bool(_RESERVED.match(name))


def _outside(name: str) -> str:
    """The name, or one like it that has no other meaning."""
    return f"own_{name.strip('_')}_" if is_reserved(name) else name


def member(name: str) -> str:
    """The name of a constant in the struct of a machine."""
    return f"{name}_" if name in ("softkin", "ends") else _outside(name)


def names_of(symbols: Iterable[sp.Symbol]) -> list[str]:
    """The names of several variables."""
    return [spelled(symbol.name) for symbol in symbols]


def type_of(name: sp.Basic) -> str:
    """The type of a name or a value."""
    return "bool" if is_condition(name) else "int" if is_count(name) else "double"


def text(value: str) -> str:
    """A literal text; the texts that a long one is broken into follow each other."""
    parts = wrap(value, _TEXT, drop_whitespace=False, break_on_hyphens=False) or [""]
    quoted = (json.dumps(part, ensure_ascii=False) for part in parts)
    return " ".join(re.sub(r"\?(?=\?)", r"?\\", part) for part in quoted)  # ??/ would be a backslash


def status(value: Status) -> str:
    """A status."""
    return f"SOFTKIN_{value.name}"


def list_of(parts: Iterable[str]) -> str:
    """Expressions as the values of an array."""
    return f"{{{', '.join(parts)}}}"


def number(value: float) -> str:
    """A literal of a real number."""
    text = repr(float(value))
    if large := re.fullmatch(r"(-?\d+?)(0{6,})\.0", text):
        return f"{large[1]}e{len(large[2])}"
    mantissa, letter, exponent = text.partition("e")
    return f"{mantissa}e{int(exponent)}" if letter else mantissa


@dataclass
class C(ExpressionPrinter):
    """Writes expressions: a choice evaluates only one side. members: the spelling of values in a struct."""

    members: Mapping[str, str] = field(default_factory=dict)

    def _spell(self, node: sp.Basic) -> tuple[str, int]:
        if isinstance(node, sp.Not):
            return f"!{self._text(node.args[0], ATOM)}", ATOM
        if node.is_Mul and 1 / DEGREE in node.args:
            return f"{self._text(node * DEGREE, PRODUCT)}*SOFTKIN_RADIAN", PRODUCT
        if isinstance(node, Root) and is_never_negative(node.args[0]):
            return f"sqrt({self.print(node.args[0])})", ATOM
        return super()._spell(node)

    def name(self, symbol: sp.Symbol) -> str:
        if symbol == DEGREE:
            return "SOFTKIN_DEGREE"
        return self.members.get(symbol.name) or spelled(symbol.name)

    def number(self, value: float) -> str:
        return number(value)

    def call(self, key: str, arguments: Sequence[str]) -> str:
        if key == "select":
            condition, first, second = arguments
            return f"({condition} ? {first} : {second})"
        return f"{_FUNCTIONS[key]}({', '.join(arguments)})"

    def logic(self, word: str) -> str:
        return {"and": "&&", "or": "||", "not": "!"}.get(word, word)
