"""The layout of JavaScript: indents, comments, and long statements broken outside of texts."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap

from derive.emit.braces import broken, harmless

WIDTH = 120
"""The most columns of a line."""
_COMMENT = 100
"""The most columns of a comment that stands above a statement."""


def comment(note: str) -> list[str]:
    """A note as lines of comment; no line for an empty one."""
    return wrap(harmless(note), _COMMENT, initial_indent="// ", subsequent_indent="// ")


def commented(line: str, note: str) -> list[str]:
    """A statement with a note beside it, or above it if there is no room in most places."""
    beside = f"{line} // {note}"
    return [beside] if note and len(beside) <= _COMMENT else [*comment(note), line]


def laid_out(lines: Sequence[str]) -> list[str]:
    """Lines of which none that can be broken is too wide."""
    return [part for line in lines for part in broken(line, WIDTH)]
