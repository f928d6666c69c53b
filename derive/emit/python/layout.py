"""The layout of Python: `ruff format` runs once over all files. A statement arrives here as one line of any length."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from textwrap import wrap

WIDTH = 120
"""The most columns of a line that can be broken."""
_INDENT = 8
"""Columns in front of the body of a method."""
_FORMAT = (
    *("-m", "ruff", "format", "--isolated", "--no-cache", "--target-version", "py311"),
    *("--line-length", str(WIDTH), "--config", "format.skip-magic-trailing-comma = true"),
)


class UnformattedError(ValueError):
    """Text that is no Python."""


def formatted(files: Mapping[str, str]) -> dict[str, str]:
    """The files, path → text, with every Python file formatted.

    Raises `UnformattedError` if one of them is no Python.
    """
    python = [path for path in files if path.endswith(".py")]
    with tempfile.TemporaryDirectory() as folder:
        for path in python:
            target = Path(folder) / path
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(files[path], encoding="utf-8", newline="\n")
        done = subprocess.run([sys.executable, *_FORMAT, folder], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise UnformattedError(done.stderr.replace(folder, "").strip())
        return {**files, **{path: (Path(folder) / path).read_bytes().decode() for path in python}}


def quoted(text: str) -> str:
    """A text as a literal, with double quotes."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def documented(line: str) -> str:
    """A line of a docstring, which neither ends it nor has an escape."""
    return line.replace("\\", "\\\\").replace('"""', '\\"\\"\\"')


def tuple_of(parts: Sequence[str]) -> str:
    """Expressions as a tuple."""
    return f"({', '.join(parts)}{',' if len(parts) == 1 else ''})"


def repeated(part: str, count: int) -> str:
    """A tuple of that many equal expressions."""
    return f"{count}*({part},)" if count > 1 else f"({part},)"


def taken_apart(targets: Sequence[str], source: str) -> list[str]:
    """`a, b, c = source`."""
    return [f"{', '.join(targets) if len(targets) > 1 else f'({targets[0]},)'} = {source}"]


def assigned(values: Mapping[str, str]) -> list[str]:
    """Statements `a, b = k.a, k.b`, each with as many values as fit in a line of a method. values: name → value."""
    lines: list[str] = []
    together: dict[str, str] = {}
    for name, value in values.items():
        if together and _INDENT + len(_assignment({**together, name: value})) > WIDTH:
            lines.append(_assignment(together))
            together = {}
        together[name] = value
    return [*lines, _assignment(together)] if together else lines


def _assignment(values: Mapping[str, str]) -> str:
    return f"{', '.join(values)} = {', '.join(values.values())}"


def fits(line: str, comment: str) -> bool:
    """Whether a comment fits behind a statement inside one `if` of a method, with spaces around operators."""
    spaced = len(line) + 2 * (line.count("*") + line.count("/"))
    return _INDENT + 4 + spaced + len(f"  # {comment}") <= WIDTH


def note_lines(note: str) -> list[str]:
    """A note as lines of comment that leave room for an indent; no line for an empty note."""
    return wrap(note, WIDTH - 20, initial_indent="# ", subsequent_indent="# ")
