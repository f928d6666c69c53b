"""Expressions as text in Python, of plain numbers or of arrays, and functions made of such text."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import count
from math import inf, nan
from typing import Any, NamedTuple

import numpy as np
import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.primitives import VALUES, Root, Select, ToReal
from derive.ir.symbols import Flag, is_count, is_decided


class Words(NamedTuple):
    """How operations are written; what is not here is a call of its function in `VALUES`."""

    between: Mapping[type[sp.Basic], str]
    around: Mapping[type[sp.Basic], str]
    call: str


_BETWEEN = {
    sp.Add: " + ", sp.Mul: " * ", sp.Le: " <= ", sp.Lt: " < ", sp.Ge: " >= ", sp.Gt: " > ", sp.Eq: " == ",
    sp.Ne: " != ",
}  # fmt: skip
NUMBERS = Words(
    {**_BETWEEN, sp.And: " and ", sp.Or: " or "},
    {
        sp.Not: "(not {})", Select: "({1} if {0} else {2})", ToReal: "float({})", sp.Abs: "abs({})",
        Root: "sqrt(max({}, 0.0))",
    },
    "float({}({}))",
)  # fmt: skip
"""Python's own numbers."""
ARRAYS = Words({**_BETWEEN, sp.And: " & ", sp.Or: " | "}, {}, "{}({})")
"""Arrays, whose operators round as `VALUES` do."""
_DEEP = 50
"""A value that is nested so deeply has a line of its own."""


def declared(name: sp.Symbol | None) -> type:
    """The type of a name: a count is made of integers, so never of NaN."""
    return bool if isinstance(name, Flag) else int if is_count(name) else float


class Expressions:
    """The text of expressions, with short names, and what it reads besides its inputs."""

    def __init__(self, words: Words, known: Mapping[str, Any]) -> None:
        self._words = words
        self.known: dict[str, Any] = {"inf": inf, "nan": nan, **known}
        self._names: dict[str, str] = {}
        self._free = count()
        self._before: list[str] = []
        """The lines of what is nested too deeply, to stand before the line that reads it."""

    def name(self, symbol: sp.Symbol) -> str:
        return self._names.setdefault(symbol.name, f"v{len(self._names)}")

    def given(self, what: object) -> str:
        """A name for an object that the text reads."""
        word = f"given_{next(self._free)}"
        self.known[word] = what
        return word

    def before(self, indent: str) -> Iterator[str]:
        """The lines that have to stand before the one that was written last."""
        yield from (indent + line for line in self._before)
        self._before.clear()

    def executed(self, lines: Iterable[str], place: str) -> Callable[..., Any]:
        """The function that lines define, which is called `function`."""
        exec(compile("\n".join(lines), place, "exec"), self.known)  # noqa: S102 (our own text, of no file)
        return self.known["function"]  # type: ignore[no-any-return]

    def text(self, value: sp.Basic, depth: int = 0) -> str:
        """An expression in Python, whose parser reads at most 200 brackets in each other."""
        if depth == _DEEP:
            word = f"deep_{next(self._free)}"
            self._before.append(f"{word} = {self.text(value)}")
            return word
        if isinstance(value, sp.Symbol) and value != DEGREE:
            return self.name(value)
        if is_decided(value):
            return str(value == sp.true)
        if value == DEGREE or isinstance(value, sp.Number | sp.NumberSymbol):
            return f"({np.pi / 180.0 if value == DEGREE else float(value)!r})"
        kind, parts = type(value), [self.text(a, depth + 1) for a in value.args]
        if kind in self._words.between:
            return f"({self._words.between[kind].join(parts)})"
        if kind in self._words.around:
            return self._words.around[kind].format(*parts)
        function = f"of_{kind.__name__.lower()}"
        self.known[function] = VALUES[kind]
        return self._words.call.format(function, ", ".join(parts))
