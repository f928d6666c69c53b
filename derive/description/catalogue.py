"""The catalogue: every mechanism file of a folder, in the order of the file names."""

from __future__ import annotations

import re
import traceback
from collections.abc import Mapping, Sequence
from dataclasses import replace
from importlib.machinery import SOURCE_SUFFIXES, ModuleSpec, SourceFileLoader
from importlib.util import module_from_spec
from pathlib import Path
from types import ModuleType

from derive.description.dimensions import Parameter
from derive.description.fields import is_field
from derive.description.joints import Joint
from derive.description.mechanism import DescriptionError, Mechanism
from derive.description.places import in_place, line_of_field
from derive.description.remedies import did_you_mean, with_remedy
from derive.description.validate import validate

_COMPILER = Path(__file__).resolve().parents[1]
MECHANISMS = _COMPILER / "mechanisms"
Entry = tuple[Path, Mechanism]


def catalogue(folder: Path = MECHANISMS) -> tuple[Entry, ...]:
    """All mechanisms with their files, each followed by its aliases. Raises `DescriptionError`."""
    entries, faults = catalogue_and_faults(folder)
    if faults:
        raise DescriptionError(faults[0])
    return entries


def catalogue_and_faults(folder: Path) -> tuple[tuple[Entry, ...], list[str]]:
    """The mechanisms of a folder that can be read, and what is wrong with the other files. Raises `DescriptionError`
    if there is no file.
    """
    files = sorted(p for p in folder.glob("*.py") if not p.name.startswith("_"))
    if not files:
        raise DescriptionError(f"{folder}: no mechanism files")
    entries: list[Entry] = []
    faults: list[str] = []
    for path in files:
        try:
            mechanisms = _with_aliases(load(path))
            _refuse_taken(path, mechanisms, entries)
            entries += [(path, mechanism) for mechanism in mechanisms]
        except DescriptionError as problem:
            faults.append(str(problem))
    return tuple(entries), faults


def load(path: Path) -> Mechanism:
    """The mechanism that a file describes; raises `DescriptionError` naming the file, the line, and what is wrong."""
    return load_with_variables(path)[0]


def load_with_variables(path: Path) -> tuple[Mechanism, dict[str, str]]:
    """As `load`, and the variable of the file for the name of each joint and parameter that has one."""
    values = vars(_executed(path))
    variables = {value.name: word for word, value in values.items() if isinstance(value, Joint | Parameter)}
    return _mechanism_of(path, values), variables


def _mechanism_of(path: Path, values: Mapping[str, object]) -> Mechanism:
    """The mechanism of a file with these variables, validated."""
    mechanism = values.get("MECHANISM")
    if not isinstance(mechanism, Mechanism):
        raise DescriptionError(in_place(path, "defines no MECHANISM"))
    try:
        return validate(mechanism, {str(v.symbol): v.name for v in values.values() if isinstance(v, Joint | Parameter)})
    except DescriptionError as problem:
        raise DescriptionError(in_place(path, str(problem))) from None
    except Exception as problem:  # an error that no check foresees also belongs to this file
        if _is_of_the_compiler(problem):
            raise
        raise DescriptionError(in_place(path, f"{type(problem).__name__}: {_text(problem)}")) from None


class _Loader(SourceFileLoader):
    """The loader of a description: it leaves no compiled module beside it."""

    def set_data(self, path: str, data: object, *, _mode: int = 0) -> None:
        """Write nothing."""


def _executed(path: Path) -> ModuleType:
    """The module of a file, executed: where that fails, the message names the line of the file."""
    if not path.is_file():
        raise DescriptionError(f"{path}: there is no such file; `softkin new {path}` writes one")
    if path.suffix not in SOURCE_SUFFIXES:
        raise DescriptionError(f"{path}: not a Python file: a description is a file whose name ends in .py")
    if b"\0" in (data := path.read_bytes()):
        line = data[: data.index(b"\0")].count(b"\n") + 1
        raise DescriptionError(f"{path}:{line}: the line holds a byte that is 0, and no text has one: remove it")
    loader = _Loader(f"mechanism_{path.stem}", str(path))
    module = module_from_spec(ModuleSpec(loader.name, loader, origin=loader.path))
    module.__file__ = loader.path
    try:
        loader.exec_module(module)
    except (Exception, SystemExit) as problem:
        if _is_of_the_compiler(problem):
            raise
        raise DescriptionError(_fault(problem, path)) from None
    return module


def _fault(problem: BaseException, path: Path) -> str:
    """What went wrong while a file was executed, with its line and what to do."""
    if isinstance(problem, DescriptionError):
        text = str(problem)
    elif isinstance(problem, SystemExit):
        text = "the description ends the program"
    else:
        text = f"{type(problem).__name__}: {_text(problem)}"
    field = re.match(r"(\w+) must", text)
    place = f"{path}:{line_of_field(path, field[1])}" if field and is_field(field[1]) else _line_of(problem, path)
    meant = _meant(problem)
    return f"{place}: {text}; {meant}" if meant else f"{place}: {with_remedy(text)}"


def _meant(problem: BaseException) -> str:
    """The name that was meant: one that the file has, or an attribute of what it asks; empty if none is like it."""
    if isinstance(problem, AttributeError):
        return did_you_mean(problem.name or "", [] if problem.obj is None else dir(problem.obj))
    if isinstance(problem, NameError):
        frames = [frame for frame, _ in traceback.walk_tb(problem.__traceback__)]
        return did_you_mean(problem.name or "", [*frames[-1].f_globals, *frames[-1].f_locals])
    return ""


def _with_aliases(mechanism: Mechanism) -> tuple[Mechanism, ...]:
    """The mechanism and its copies under other names."""
    copies = (replace(mechanism, name=alias, aliases=(), title=None, class_name=None) for alias in mechanism.aliases)
    return (mechanism, *copies)


def _refuse_taken(path: Path, mechanisms: tuple[Mechanism, ...], entries: Sequence[Entry]) -> None:
    """Refuse a mechanism whose file or class has a name in use: it would replace the other one."""
    owners = {key: (owner, mechanism.name) for owner, mechanism in entries for key in _in_files(mechanism)}
    for mechanism in mechanisms:
        for owner, other in (owners[key] for key in sorted(_in_files(mechanism)) if key in owners):
            is_same = mechanism.name.lower() == other.lower()
            like = "" if is_same else f", where it is {other!r}: _, capitals, Kin_ and Machine do not count"
            raise DescriptionError(f"{path}: the name {mechanism.name!r} is taken by {owner}{like}")
        owners |= dict.fromkeys(_in_files(mechanism), (path, mechanism.name))


def _in_files(mechanism: Mechanism) -> set[str]:
    """The names of a mechanism and its class as languages write them, compared without `_`, without case, and without
    the word that a language adds to a name in use.
    """
    names = (mechanism.name, mechanism.class_name or mechanism.name)
    short = (name.removeprefix("Kin_").removeprefix("Softkin_") for name in names)
    return {mechanism.name.lower(), *(name.replace("_", "").lower().removesuffix("machine") for name in short)}


def _line_of(problem: BaseException, path: Path) -> str:
    """The file with the line of it that failed."""
    if isinstance(problem, SyntaxError):
        data = path.read_bytes()
        return f"{problem.filename or path}:{problem.lineno or data.count(bytes([10]), 0, data.find(0)) + 1}"
    frames = traceback.extract_tb(problem.__traceback__)
    lines = [frame.lineno for frame in frames if Path(frame.filename).resolve() == path.resolve()]
    return f"{path}:{lines[-1]}" if lines else str(path)


def _is_of_the_compiler(problem: BaseException) -> bool:
    """Whether a name is missing in the compiler itself, and not in a file that describes a machine."""
    frames = traceback.extract_tb(problem.__traceback__)
    place = Path(frames[-1].filename).resolve() if frames else Path()
    is_inside = _COMPILER in place.parents and MECHANISMS not in place.parents
    return is_inside and isinstance(problem, NameError | ImportError | SyntaxError)


def _text(problem: BaseException) -> str:
    return problem.msg if isinstance(problem, SyntaxError) else " ".join(str(problem).split())
