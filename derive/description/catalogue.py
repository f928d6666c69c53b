"""The catalogue: every mechanism file of a folder, in the order of the file names."""

from __future__ import annotations

import importlib.util
import traceback
from dataclasses import replace
from pathlib import Path

from derive.description.mechanism import DescriptionError, Mechanism
from derive.description.validate import validate

MECHANISMS = Path(__file__).resolve().parents[1] / "mechanisms"
Entry = tuple[Path, Mechanism]


def catalogue(folder: Path = MECHANISMS) -> tuple[Entry, ...]:
    """All mechanisms with their files, each followed by its aliases. Raises `DescriptionError`."""
    files = sorted(p for p in folder.glob("*.py") if not p.name.startswith("_"))
    if not files:
        raise DescriptionError(f"{folder}: no mechanism files")
    entries = tuple((path, mechanism) for path in files for mechanism in _with_aliases(load(path)))
    _refuse_duplicates(entries)
    return entries


def load(path: Path) -> Mechanism:
    """The mechanism that a file describes; raises `DescriptionError` naming the file and what is wrong."""
    spec = importlib.util.spec_from_file_location(f"mechanism_{path.stem}", path)
    if spec is None or spec.loader is None:
        raise DescriptionError(f"{path}: not a Python file")
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except DescriptionError as problem:
        raise DescriptionError(f"{path}: {problem}") from None
    except Exception as problem:
        raise DescriptionError(f"{_line_of(problem, path)}: {type(problem).__name__}: {_text(problem)}") from None
    mechanism = getattr(module, "MECHANISM", None)
    if not isinstance(mechanism, Mechanism):
        raise DescriptionError(f"{path}: defines no MECHANISM")
    try:
        return validate(mechanism)
    except DescriptionError as problem:
        raise DescriptionError(f"{path}: {problem}") from None


def _with_aliases(mechanism: Mechanism) -> tuple[Mechanism, ...]:
    """The mechanism and its copies under other names."""
    copies = (replace(mechanism, name=alias, aliases=(), title=None, class_name=None) for alias in mechanism.aliases)
    return (mechanism, *copies)


def _refuse_duplicates(entries: tuple[Entry, ...]) -> None:
    owners: dict[str, Path] = {}
    for path, mechanism in entries:
        first = owners.setdefault(mechanism.name.lower(), path)
        if first is not path:
            raise DescriptionError(f"{path}: the name {mechanism.name!r} is taken by {first}")


def _line_of(problem: Exception, path: Path) -> str:
    """The file with the line of it that failed."""
    if isinstance(problem, SyntaxError):
        return f"{problem.filename or path}:{problem.lineno}"
    lines = [frame.lineno for frame in traceback.extract_tb(problem.__traceback__) if Path(frame.filename) == path]
    return f"{path}:{lines[-1]}" if lines else str(path)


def _text(problem: Exception) -> str:
    return problem.msg if isinstance(problem, SyntaxError) else " ".join(str(problem).split())
