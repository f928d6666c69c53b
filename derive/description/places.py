"""The place in a file where a description is wrong, and what to do: the line of the thing that a message quotes."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from derive.description.remedies import with_remedy

_QUOTED = re.compile(r"'([^']+)'")
_FIELDS = (
    (
        r"chain reads|^the chain|a flip must|the mechanism needs either|is not commanded but",
        ("chain", "closure", "rods"),
    ),
    (r"^closure reads|^the closure has", ("closure", "rods")),
    (r"^positive reads", ("positive",)),
    (r"cannot name a function block", ("name", "aliases")),
    (r"cannot name a class", ("class_name",)),
    (r"cannot name a family", ("family",)),
    (r"^periods", ("periods",)),
    (r"^held|held joints|too many: .* held=", ("held", "task")),
    (r"^surplus", ("surplus",)),
    (r"^load", ("load",)),
    (r"the task commands|commands no direction", ("task",)),
    (r"has no joints|joints? too many", ("joints",)),
    (r"offset_interface", ("offset_interface", "task")),
    (r"home", ("home",)),
    (r"assembly", ("assembly",)),
    (r"two-root steps", ("assembly", "rods")),
    (r"needs a rod", ("rods", "closure")),
    (r"^constraint|break the constraint", ("constraints",)),
    (r"does not determine|no subproblem|must not vanish", ("chain", "closure", "rods")),
)
"""Words of a message, and the fields of a mechanism that it is then about."""


def in_place(path: Path, problem: str) -> str:
    """The problem with its file, its line and its remedy."""
    return f"{path}:{line_of(path, problem)}: {with_remedy(problem)}"


def line_of(path: Path, problem: str) -> int:
    """The line of a message: that of the thing that it quotes, else of the field, else of the mechanism."""
    try:
        tree = ast.parse(path.read_text(encoding="utf-8"))
    except (OSError, SyntaxError, ValueError):
        return 1
    stated = _fields(tree)
    quoted = _QUOTED.findall(problem)
    named = (line for word in quoted for line in _naming(tree, word))
    said = (
        stated[field] for words, fields in _FIELDS if re.search(words, problem) for field in fields if field in stated
    )
    if re.match(r"chain reads|closure reads|positive reads|periods|held|surplus names|load", problem):
        return next(said, stated.get("", 1))
    return next(named, next(said, stated.get("", 1)))


def line_of_field(path: Path, field: str) -> int:
    """The line of a field of the mechanism, else that of the mechanism."""
    stated = _fields(ast.parse(path.read_text(encoding="utf-8")))
    return stated.get(field, stated.get("", 1))


def _fields(tree: ast.Module) -> dict[str, int]:
    """The lines of the fields of the mechanism, and under "" that of the mechanism."""
    found: dict[str, int] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "Mechanism":
            found |= {"": node.lineno, **{k.arg: k.value.lineno for k in node.keywords if k.arg}}
    return found


def _naming(tree: ast.Module, word: str) -> Iterator[int]:
    """The lines of the calls whose first argument is the name, the last one first: a repetition is the fault."""
    found = (
        node.lineno
        for node in ast.walk(tree)
        if isinstance(node, ast.Call)
        and any(isinstance(a, ast.Constant) and str(a.value).lower() == word.lower() for a in node.args[:1])
    )
    yield from sorted(found, reverse=True)
