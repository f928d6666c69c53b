"""`derive` and `check` with files: machines of the user's own, each by itself: a fault of one stops no other."""

from __future__ import annotations

import argparse
import re
import sys
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Sequence
from keyword import iskeyword
from pathlib import Path

from derive.command.stages import Stages
from derive.description.catalogue import load
from derive.description.errors import printable
from derive.description.mechanism import DescriptionError, Mechanism
from derive.description.places import line_of
from derive.faults import CompilerError, GenerationError, error, of_the_system
from derive.form.deviations import with_deviations
from derive.output import ForeignFolder, differences, replace_beside_others, replace_parts
from derive.pipeline import WRITTEN, derive_one, files_of, languages, unwritten

WRONG, MISTAKEN = 2, 3
"""Status of a machine that cannot be right, and of a mistake of the compiler."""
_TAKEN = ("softkin", "derive", "numpy", "scipy", "sympy", "casadi", "matplotlib")
"""Packages that a user of the machine may have installed, besides the modules of Python."""


def complain(message: str) -> None:
    """Print a message, with paths as the user would type them."""
    print(f"error: {printable(message).replace(f'{Path.cwd()}/', '')}", file=sys.stderr, flush=True)


def refused(problem: Exception, with_trace: bool, status: int = WRONG) -> int:
    """Print the problem, and return the status: `MISTAKEN` for a mistake of the compiler, else the given one.

    with_trace: whether the traceback of such a mistake is printed.
    """
    complain(of_the_system(problem) if isinstance(problem, OSError) else str(problem))
    if not isinstance(problem, CompilerError):
        return status
    if with_trace:
        print(problem.trace, file=sys.stderr, flush=True)
    return MISTAKEN


def derive(options: argparse.Namespace) -> int:
    """Derive machines and write them; returns 2 where one cannot be derived, 3 for a mistake of the compiler."""
    files = described(options.files)
    if options.package and len(files) > 1:
        raise GenerationError("--package names the package of one machine: derive one file at a time")
    packages = [package_of(path, options.package) for path in files]
    folders = [options.out if len(files) == 1 else options.out / package for package in packages]
    for folder, count in Counter(folders).items():
        if count > 1:
            raise GenerationError(f"{count} files would be written into {folder}: give them different names")
    targets = dict(zip(files, zip(packages, folders, strict=True), strict=True))

    def written(path: Path, stages: Stages) -> None:
        package, folder = targets[path]
        refuse_another(folder, package)
        data = _derived(path, package, options, stages)
        stages.report("write", "")
        if options.language:
            replace_parts(folder, data)
        elif any(differences(folder, data)):
            replace_beside_others(folder, data)
        stages.report("write", str(folder / next(iter(data))) if len(data) == 1 else f"{len(data)} files in {folder}")
        for hint in _next(path, folder, package, data):
            stages.line(f"  {hint}")

    return each(files, written, options.keep_going, options.traceback)


def _next(path: Path, folder: Path, package: str, data: Collection[str]) -> Iterator[str]:
    """What a user may do with what was written."""
    picture = next((name for name in sorted(data) if name.endswith(".png")), None)
    if picture:
        yield f"picture: {folder / picture}"
    if f"python/{package}/__init__.py" in data:
        elsewhere = f"; not beside {path.name}, which Python would find first" if package == path.stem else ""
        yield f"next: pip install {folder / 'python'}, then import {package} in Python{elsewhere}"


def check(options: argparse.Namespace) -> int:
    """Derive and measure machines, and write nothing; the status is that of `derive`."""
    files = described(options.files)
    return each(
        files,
        lambda path, stages: stages.line(f"  {len(_derived(path, 'checked', options, stages))} files, not written"),
        options.keep_going,
        options.traceback,
    )


def described(given: Sequence[Path]) -> list[Path]:
    """The descriptions that files and folders hold, each once. Raises `GenerationError` for a folder without one."""
    found: list[Path] = []
    for path in given:
        inside = sorted(p for p in path.glob("*.py") if not p.name.startswith("_")) if path.is_dir() else [path]
        if not inside:
            raise GenerationError(f"{path}: there is no description in this folder; `softkin new` writes one")
        found += [p for p in inside if p not in found]
    return found


def package_of(path: Path, wanted: str | None) -> str:
    """The name of the package: that of the file, in small letters. Raises `GenerationError` if it cannot be one."""
    name = wanted or re.sub(r"\W+", "_", path.stem, flags=re.ASCII).strip("_").lower()
    name = f"machine_{name}" if not wanted and name[:1].isdigit() else name
    if not (name.isidentifier() and name.isascii()) or iskeyword(name):
        raise GenerationError(f"{path}: {name!r} cannot name a Python package: give another one with --package")
    if name in sys.stdlib_module_names or name in _TAKEN:
        raise GenerationError(f"{path}: {name!r} is a package that exists: give another name with --package")
    return name


def refuse_another(folder: Path, package: str) -> None:
    """Refuse to replace the files of another machine."""
    for other in sorted((folder / "python").glob("*/_core.py")):
        if other.parent.name != package:
            raise ForeignFolder(
                f"{folder} holds the machine {other.parent.name!r}: derive into another folder with --out, or remove it"
            )


def each(
    files: Sequence[Path], work: Callable[[Path, Stages], None], keep_going: bool, with_trace: bool = False
) -> int:
    """Do the work for every file, and print the result of each; returns the worst status."""
    statuses: list[int] = []
    tried = 0
    for path in files:
        tried += 1
        found: Exception | None = None
        with Stages(sys.stdout) as stages:
            try:
                stages.line(str(path))
                work(path, stages)
            except Exception as problem:  # one bad file never stops another, whatever is wrong with it
                found = problem
                stages.line("  refused")
        if found is not None:
            is_told = isinstance(found, DescriptionError | GenerationError | ForeignFolder | OSError)
            statuses.append(refused(found if is_told else error(path, found), with_trace))
            if not keep_going:
                break
    if len(files) > 1:
        left = f", {len(files) - tried} not tried" if tried < len(files) else ""
        print(f"{tried - len(statuses)} of {len(files)} derived, {len(statuses)} refused{left}")
    return max(statuses, default=0)


def _derived(path: Path, package: str, options: argparse.Namespace, stages: Stages) -> dict[str, bytes]:
    """All files of one machine. Raises `GenerationError` with file, line and remedy."""
    profile = options.profile
    outputs = languages(profile, package, options.language or WRITTEN)
    mechanism = load(path)
    stages.line(f"  {_described(mechanism)}")
    try:
        mechanism = with_deviations(mechanism) if options.calibrated else mechanism
        built = derive_one(mechanism, profile, stages.report, [language.name for language in outputs])
        files = files_of([built], [one for one in outputs if one.name in built.parts])
    except Exception as problem:
        raise error(path, problem) from None
    if built.undrawn:
        stages.line(f"  warning: {path}:{line_of(path, built.undrawn)}: not drawn: {built.undrawn}")
    for note in built.notes(options.language or ()):
        stages.line(f"  note: {note}")
    for note in unwritten(built, outputs, mechanism):
        stages.line(f"  note: {note}")
    return files


def _described(mechanism: Mechanism) -> str:
    """The machine in one line."""
    task = ", ".join(mechanism.task.position)
    turning = mechanism.task.turning.value
    commanded = {"none": task, "about z": f"{task} and the turn about z"}
    commanded |= {"direction": f"{task} and a direction" if task else "a direction"}
    commanded |= {word: f"{task}, {word}" for word in ("pitch", "pitch and roll")}
    text = commanded.get(turning, f"{task} and the whole rotation" if task else "the rotation")
    axes = " ".join(j.name for j in mechanism.joints) or "none"
    return f"{mechanism.name}: axes {axes}; commanded: {text or turning}"
