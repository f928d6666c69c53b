"""How C and JavaScript spell: expressions, and the parts of statements that the walk over a program puts together."""

from __future__ import annotations

import re
from abc import abstractmethod
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence

import sympy as sp

from derive.emit.expression import ATOM, ExpressionPrinter, parts_of
from derive.ir.primitives import Select


class Braced(ExpressionPrinter):
    """Writes expressions in a language with braces: a choice evaluates only one side."""

    @abstractmethod
    def spelled(self, name: str) -> str:
        """The spelling of a variable of the function."""

    @abstractmethod
    def constant(self, name: sp.Symbol) -> str:
        """The words in front of a variable that gets its value once, with a space behind them."""

    @abstractmethod
    def declared(self, names: Sequence[sp.Symbol]) -> list[str]:
        """The declarations of variables that get their values later."""

    @abstractmethod
    def comment(self, note: str) -> list[str]:
        """A note as lines of comment; no line for an empty one."""

    @abstractmethod
    def commented(self, line: str, note: str) -> list[str]:
        """A statement with a note beside it, or above it if there is no room."""

    @abstractmethod
    def when(self, condition: str, statement: str) -> list[str]:
        """One statement that runs only if a condition holds."""

    def names(self, symbols: Iterable[sp.Symbol]) -> list[str]:
        """The spelling of several variables."""
        return [self.spelled(symbol.name) for symbol in symbols]

    def conjunction(self, conditions: Iterable[sp.Basic]) -> str:
        """Conditions that must all hold, as one."""
        parts = parts_of(conditions)
        if len(parts) == 1:
            return self.print(parts[0])
        printed = ((part, self.print(part)) for part in parts)
        return " && ".join(f"({one})" if isinstance(part, sp.Or) else one for part, one in printed)

    def whole_value(self, name: sp.Symbol, value: sp.Basic) -> str:
        """A value that stands alone behind `=`, where a choice needs no brackets."""
        text = self.value(name, value)
        return text[1:-1] if isinstance(value, Select) and text.startswith("(") else text

    def choice(self, condition: str, first: str, second: str) -> str:
        return f"({condition} ? {first} : {second})"

    def logic(self, word: str) -> str:
        return {"and": "&&", "or": "||", "not": "!"}.get(word, word)

    def _spell(self, node: sp.Basic) -> tuple[str, int]:
        if isinstance(node, sp.Not):
            return f"!{self._text(node.args[0], ATOM)}", ATOM
        return super()._spell(node)


_INDENT = "  "
_COMMENTS = ("//", "/*", "* ")
_PARTS = re.compile(
    r"""
    (?P<text>     "(?:[^"\\]|\\.)*" )
  | (?P<comment>  // | /\* )
  | (?P<opening>  [(\[{] )
  | (?P<closing>  [)\]}] )
  | (?P<operator> [ ] (?: [-+?:] | && | \|\| | AND | OR ) [ ] )
  | (?P<comma>    ,[ ] )
  | (?P<bound>    [ ]=[ ] )
  | (?P<gap>      (?<=") [ ] (?=") )
  | (?P<factor>   [*/] )
    """,
    re.VERBOSE,
)
"""The tokens at which a statement may be broken; the gap is the one between the parts of a text."""
_DEPTHS = {"comma": 0.0, "gap": 0.0, "operator": 0.25, "factor": 0.5, "bound": 100.0}
"""How much deeper than its brackets a place is: a product is deeper than a sum; behind `=` a line ends last of all."""


def harmless(note: str) -> str:
    """A note that neither ends its comment nor begins another one."""
    return note.replace("*/", "* /").replace("/*", "/ *")


def indented(lines: Sequence[str]) -> list[str]:
    """The lines, each with one more indent."""
    return [_INDENT + line if line else line for line in lines]


def block(head: str, lines: Sequence[str]) -> list[str]:
    """`head {`, the lines, `}`."""
    return [f"{head} {{", *indented(lines), "}"]


def broken(line: str, width: int) -> Iterator[str]:
    """The lines of a statement, broken before an operator or behind a comma, first outside of all brackets; the time is
    proportional to its length.
    """
    text = line.lstrip()
    margin = inner = line[: len(line) - len(text)]
    inner += 2 * _INDENT
    begin, places = 0, list(_places(text)) if len(line) > width else []
    while len(margin) + len(text) - begin > width and not text.startswith(_COMMENTS, begin):
        place = _place(places, begin, width - len(margin))
        if place is None:
            break
        yield margin + text[begin:place].rstrip()
        begin, margin = place + (text[place] == " "), inner
    yield margin + text[begin:]


def _place(places: Sequence[tuple[int, float]], begin: int, width: int) -> int | None:
    """The best place to end a line within a width: the least nested one, among equals the last; else the next one."""
    first, far, last = (bisect_right(places, (begin + room, 1e9)) for room in (0, width // 4, width))
    found = places[far:last] or places[first:last] or places[last : last + 1]
    return min(found, key=lambda place: (place[1], -place[0]))[0] if found else None


def _places(text: str) -> Iterator[tuple[int, float]]:
    """The places where a line may end, in their order, each with its depth."""
    depth = 0
    for part in _PARTS.finditer(text):
        kind = part.lastgroup
        if kind == "comment":
            return
        if kind in _DEPTHS:
            at = part.start() if kind == "factor" else part.start() + 1 if kind == "operator" else part.end()
            yield at, depth + _DEPTHS[kind]
        depth += (kind == "opening") - (kind == "closing")
