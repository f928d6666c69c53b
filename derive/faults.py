"""The cause why a machine is not derived: its description, with advice on what to do, or the compiler, with advice on
what to report.
"""

from __future__ import annotations

import errno
import platform
import traceback
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

from derive.description.mechanism import DescriptionError
from derive.description.places import in_place
from derive.description.remedies import with_remedy
from derive.solver.unsolved import Unsolved
from derive.witness.disagreement import Disagreement

UNFIT = (DescriptionError, Unsolved, Disagreement)
"""The errors of a wrong description: the message says enough."""
_OF_THE_SYSTEM = (OSError, MemoryError)
"""The errors of the system: the message says enough, and there is nothing to report."""
_NO_FOLDER = "is a file, where a folder is needed: name another one"
_REMEDIES = {
    errno.EEXIST: _NO_FOLDER,
    errno.ENOTDIR: _NO_FOLDER,
    errno.EISDIR: "is a folder, where a file is needed: name another one",
    errno.EACCES: "may not be read or written by this user: change its permissions, or name another one",
    errno.EROFS: "is on a disk that cannot be written: name another one",
    errno.ENOSPC: "no space is left on the disk: make room, and run this again",
}


class GenerationError(Exception):
    """Nothing can be generated; the message names the file and the thing."""


class CompilerError(GenerationError):
    """A mistake of the compiler, whatever the description: the message says what to report."""

    def __init__(self, message: str, trace: str) -> None:
        """trace: the traceback, as Python prints it."""
        super().__init__(message)
        self.trace = trace


@dataclass(frozen=True)
class Failure:
    """A mechanism that cannot be derived, in one message with file and line, and a remedy or what to report."""

    message: str
    trace: str = ""
    """The traceback of a mistake of the compiler; empty if the description is at fault."""

    @property
    def error(self) -> GenerationError:
        """The failure as an error that can be raised."""
        return CompilerError(self.message, self.trace) if self.trace else GenerationError(self.message)


def failure(path: Path | None, problem: Exception) -> Failure:
    """The failure for a problem that occurred while the machine of a file was derived, or without a file."""
    if isinstance(problem, CompilerError):
        return Failure(str(problem), problem.trace)
    if isinstance(problem, UNFIT):
        said = one_line(problem)
        return Failure(in_place(path, said) if path else with_remedy(said))
    if isinstance(problem, _OF_THE_SYSTEM):
        return Failure(f"{_place(path)}{of_the_system(problem)}")
    return Failure(_to_report(path, problem), "".join(traceback.format_exception(problem)))


def error(path: Path | None, problem: Exception) -> GenerationError:
    """The failure as an error that can be raised."""
    return failure(path, problem).error


def one_line(problem: Exception) -> str:
    """The message of a problem as one line."""
    return " ".join(str(problem).split())


def of_the_system(problem: Exception) -> str:
    """The sentence about an error of the system: the file, what is wrong with it, and what to do."""
    if not isinstance(problem, OSError) or problem.strerror is None:
        return _with_its_kind(problem)
    remedy = _REMEDIES.get(problem.errno or 0, problem.strerror.lower())
    return f"{problem.filename}: {remedy}" if problem.filename is not None else remedy


def _to_report(path: Path | None, problem: Exception) -> str:
    """The sentence about a mistake of the compiler."""
    last = traceback.extract_tb(problem.__traceback__)[-1:]
    met = "".join(f" ({Path(frame.filename).name}:{frame.lineno})" for frame in last)
    place = _place(path)
    return (
        f"{place}this is a mistake of the compiler, not of the description: {_with_its_kind(problem)}{met}; "
        f"report it with {_versions()}, the file of the machine, and what --traceback prints"
    )


def _place(path: Path | None) -> str:
    return f"{path}: " if path else ""


def _with_its_kind(problem: Exception) -> str:
    said = one_line(problem)
    return f"{type(problem).__name__}: {said}" if said else type(problem).__name__


def _versions() -> str:
    """The versions of the compiler, the interpreter and the platform."""
    try:
        own = metadata.version("softkin-compiler")
    except metadata.PackageNotFoundError:
        own = "of a source tree"
    return f"softkin-compiler {own}, Python {platform.python_version()}, {platform.system()}"
