"""The layout of C: indents, comments, and long statements broken outside of texts."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap

from derive.emit.braces import broken, harmless

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
