"""The layout of JavaScript: indents, comments, and long statements broken outside of texts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from textwrap import wrap

WIDTH = 120
"""The most columns of a line."""
_INDENT = "  "
_COMMENT = 100
"""The most columns of a comment that stands above a statement."""
_BREAKS = (" + ", " - ", " && ", " || ", " ? ", " : ")


def indented(lines: Sequence[str]) -> list[str]:
    """The lines, each with one more indent."""
    return [_INDENT + line if line else line for line in lines]


def comment(note: str) -> list[str]:
    """A note as lines of comment; no line for an empty one."""
    return wrap(note, _COMMENT, initial_indent="// ", subsequent_indent="// ")


def commented(line: str, note: str) -> list[str]:
    """A statement with a note beside it, or above it where there is no room in most places."""
    beside = f"{line} // {note}"
    return [beside] if note and len(beside) <= _COMMENT else [*comment(note), line]


def block(head: str, lines: Sequence[str]) -> list[str]:
    """`head {`, the lines, `}`."""
    return [f"{head} {{", *indented(lines), "}"]


def laid_out(lines: Sequence[str]) -> list[str]:
    """Lines of which none that can be broken is too wide."""
    return [part for line in lines for part in _broken(line)]


def _broken(line: str) -> Iterator[str]:
    """The lines of a statement, broken before an operator or behind a comma, first outside of all brackets."""
    margin = line[: len(line) - len(line.lstrip())]
    rest, inner = line.lstrip(), margin + 2 * _INDENT
    while len(margin) + len(rest) > WIDTH and not rest.startswith("//"):
        place = _place(rest, WIDTH - len(margin))
        if place is None:
            break
        yield margin + rest[:place].rstrip()
        rest, margin = rest[place:].lstrip(), inner
    yield margin + rest


def _place(text: str, width: int) -> int | None:
    """The best place to break within a width: the least nested one, among equals the last."""
    places = [(depth, -at) for at, depth in _places(text)]
    fitting = [place for place in places if -place[1] <= width]
    far = [place for place in fitting if -place[1] > width // 4]
    return -min(far or fitting or places)[1] if places else None


def _places(text: str) -> Iterator[tuple[int, float]]:
    """The places where a line may end, each with its depth: a sum is deeper than a list, and a product than a sum."""
    depth, is_text, escaped = 0, False, False
    for at, character in enumerate(text):
        if is_text:
            is_text, escaped = escaped or character != '"', character == "\\" and not escaped
        elif character == '"':
            is_text = True
        elif text.startswith("//", at):
            return
        elif character in "([{":
            depth += 1
        elif character in ")]}":
            depth -= 1
        elif text.startswith(_BREAKS, at):
            yield at + 1, depth + 0.25
        elif character in "*/":
            yield at, depth + 0.5
        elif text.startswith(", ", at):
            yield at + 2, depth
