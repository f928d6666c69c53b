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

from derive.emit.braced import Braced, block, broken, harmless
from derive.ir.constants import DEGREE
from derive.ir.program import Status
from derive.ir.symbols import is_condition, is_count

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
    "accelerations arguments axes context cos fabs finish found frame given joints k lane machine made margins missed "
    "misses near otherwise p parameters pass place reference results root rotation rows search signs sin sizes speeds "
    "sqrt start status statuses system take turn turns values wanted why".split()
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


def declarations(names: Sequence[sp.Symbol]) -> list[str]:
    """Variables without a value, of one type a line."""
    lines = []
    for kind in ("double", "int", "bool"):
        own = [spelled(name.name) for name in names if type_of(name) == kind]
        lines += [f"{kind} {', '.join(own)};"] if own else []
    return lines


WIDTH = 110
"""The largest number of columns of a line."""
_COMMENT = 100
"""The largest number of columns of a comment that stands above a statement."""


def comment(note: str, begin: str = "/*") -> list[str]:
    """A note as one comment; no line for an empty one. begin: `/**` for documentation in the header."""
    lines = wrap(harmless(note), _COMMENT, break_on_hyphens=False)
    if not lines:
        return []
    return [*(f"{begin if i == 0 else ' *'} {line}" for i, line in enumerate(lines[:-1])),
            f"{begin if len(lines) == 1 else ' *'} {lines[-1]} */"]  # fmt: skip


def commented(line: str, note: str) -> list[str]:
    """A statement with a note beside it, or above it if there is no room in most places."""
    beside = f"{line} /* {harmless(note)} */"
    return [beside] if note and len(beside) <= _COMMENT else [*comment(note), line]


def laid_out(lines: Sequence[str]) -> list[str]:
    """The lines, broken where they are too wide and can be broken."""
    return [part for line in lines for part in broken(line, WIDTH)]


def page(text: str) -> str:
    """A whole text, whose lines and comments are broken where they are too wide and can be broken."""
    lines = (
        part for line in text.split("\n") for part in (_wrapped(line) if _is_comment(line) else broken(line, WIDTH))
    )
    return "\n".join(lines)


def _is_comment(line: str) -> bool:
    return line.lstrip().startswith(("/*", "* "))


def _wrapped(line: str) -> list[str]:
    """A line of a comment, on as many lines as it needs."""
    margin = line[: len(line) - len(line.lstrip())]
    if len(line) <= WIDTH:
        return [line]
    inner = margin + (" * " if line.lstrip().startswith("/*") else "* ")
    return wrap(line, WIDTH, subsequent_indent=inner, break_on_hyphens=False, drop_whitespace=True)


@dataclass
class C(Braced):
    """Writes expressions and the parts of statements. members: the spelling of values in a struct."""

    functions = {
        "sin": "sin", "cos": "cos", "abs": "fabs", "atan2": "softkin_angle_of", "nearest_period": "softkin_on_turn",
    }  # fmt: skip
    shared_function = "softkin_{snake}"
    radian = "SOFTKIN_RADIAN"
    members: Mapping[str, str] = field(default_factory=dict)

    spelled = staticmethod(spelled)
    declared = staticmethod(declarations)
    number = staticmethod(number)
    comment = staticmethod(comment)
    commented = staticmethod(commented)

    def name(self, symbol: sp.Symbol) -> str:
        if symbol == DEGREE:
            return "SOFTKIN_DEGREE"
        return self.members.get(symbol.name) or spelled(symbol.name)

    def constant(self, name: sp.Symbol) -> str:
        return f"const {type_of(name)} "

    def when(self, condition: str, statement: str) -> list[str]:
        return block(f"if ({condition})", [statement])
