"""The layout of C: indents, comments, and long statements broken outside of texts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from textwrap import wrap

WIDTH = 110
"""The most columns of a line."""
_INDENT = "  "
_COMMENT = 100
"""The most columns of a comment that stands above a statement."""
_BREAKS = (" + ", " - ", " && ", " || ", " ? ", " : ")


def indented(lines: Sequence[str]) -> list[str]:
    """The lines, each with one more indent."""
    return [_INDENT + line if line else line for line in lines]


def harmless(note: str) -> str:
    """A note that neither ends its comment nor begins another one."""
    return note.replace("*/", "* /").replace("/*", "/ *")


def comment(note: str, begin: str = "/*") -> list[str]:
    """A note as one comment; no line for an empty one. begin: `/**` where readers of the header are told."""
    lines = wrap(harmless(note), _COMMENT, break_on_hyphens=False)
    if not lines:
        return []
    return [*(f"{begin if i == 0 else ' *'} {line}" for i, line in enumerate(lines[:-1])),
            f"{begin if len(lines) == 1 else ' *'} {lines[-1]} */"]  # fmt: skip


def commented(line: str, note: str) -> list[str]:
    """A statement with a note beside it, or above it where there is no room in most places."""
    beside = f"{line} /* {harmless(note)} */"
    return [beside] if note and len(beside) <= _COMMENT else [*comment(note), line]


def block(head: str, lines: Sequence[str]) -> list[str]:
    """`head {`, the lines, `}`."""
    return [f"{head} {{", *indented(lines), "}"]


def laid_out(lines: Sequence[str]) -> list[str]:
    """Lines of which none that can be broken is too wide."""
    return [part for line in lines for part in _broken(line)]


def page(text: str) -> str:
    """A whole text of which no line that can be broken is too wide, comments among them."""
    lines = (part for line in text.split("\n") for part in (_wrapped(line) if _is_comment(line) else _broken(line)))
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


def _broken(line: str) -> Iterator[str]:
    """The lines of a statement, broken before an operator or behind a comma, first outside of all brackets."""
    margin = line[: len(line) - len(line.lstrip())]
    rest, inner = line.lstrip(), margin + 2 * _INDENT
    while len(margin) + len(rest) > WIDTH and not rest.startswith(("/*", "* ")):
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
        elif text.startswith("/*", at):
            return
        elif character in "([{":
            depth += 1
        elif character in ")]}":
            depth -= 1
        elif text.startswith(_BREAKS, at):
            yield at + 1, depth + 0.25
        elif text.startswith(", ", at):
            yield at + 2, depth
        elif character == " " and text[at - 1 : at + 2] == '" "':  # between the parts of a text
            yield at + 1, depth
        elif character in "*/":
            yield at, depth + 0.5
