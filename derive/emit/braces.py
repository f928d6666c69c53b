"""The layout of statements: notes, indents, blocks with braces, and long statements broken outside of texts."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator, Sequence

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
