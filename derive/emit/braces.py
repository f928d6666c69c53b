"""The layout of languages with braces: notes, indents, blocks, and long statements broken outside of texts."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

_INDENT = "  "
_COMMENTS = ("//", "/*")
_PARTS = re.compile(
    r"""
    (?P<text>     "(?:[^"\\]|\\.)*" )
  | (?P<comment>  // | /\* )
  | (?P<opening>  [(\[{] )
  | (?P<closing>  [)\]}] )
  | (?P<operator> [ ] (?: [-+?:] | && | \|\| ) [ ] )
  | (?P<comma>    ,[ ] )
  | (?P<gap>      (?<=") [ ] (?=") )
  | (?P<factor>   [*/] )
    """,
    re.VERBOSE,
)
"""The tokens at which a statement may be broken; the gap is the one between the parts of a text."""


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
    """The lines of a statement, broken before an operator or behind a comma, first outside of all brackets."""
    margin = line[: len(line) - len(line.lstrip())]
    rest, inner = line.lstrip(), margin + 2 * _INDENT
    while len(margin) + len(rest) > width and not rest.startswith((*_COMMENTS, "* ")):
        place = _place(rest, width - len(margin))
        if place is None:
            break
        yield margin + rest[:place].rstrip()
        rest, margin = rest[place:].lstrip(), inner
    yield margin + rest


def _place(text: str, width: int) -> int | None:
    """The best place to break within a width: the least nested one, among equals the last; else after the target."""
    places = [(depth, -at) for at, depth in _places(text)]
    fitting = [place for place in places if -place[1] <= width]
    far = [place for place in fitting if -place[1] > width // 4]
    bound = text.partition('"')[0].find(" = ")
    if not fitting and bound > 0:
        return bound + 3
    return -min(far or fitting or places)[1] if places else None


def _places(text: str) -> Iterator[tuple[int, float]]:
    """The places where a line may end, each with its depth: a sum is deeper than a list, and a product than a sum."""
    depth = 0
    for part in _PARTS.finditer(text):
        kind = part.lastgroup
        if kind == "comment":
            return
        if kind == "opening":
            depth += 1
        elif kind == "closing":
            depth -= 1
        elif kind == "operator":
            yield part.start() + 1, depth + 0.25
        elif kind in ("comma", "gap"):
            yield part.end(), depth
        elif kind == "factor":
            yield part.start(), depth + 0.5
