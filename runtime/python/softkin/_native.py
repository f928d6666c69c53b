"""The native core: whether it runs, and the calls that it answers.

The extension `EXTENSION` holds the same programs in C. A call is given to it first; it answers `NotImplemented`
where it is given anything but tuples, lists and arrays of plain numbers, and where the call is refused. Then the method
of the class runs, so that an error has one text.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import wraps
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

from softkin._constants import EXTENSION, SOURCES
from softkin._frame import Frame
from softkin._types import Diagnosis, Solution, Status

if TYPE_CHECKING:
    from softkin._core import Mechanism

CHOICE = "SOFTKIN_CORE"
"""The variable of the environment that chooses `python`, or `native`: an error if there is no extension."""
_ASKED_FOR = f"{CHOICE} is native, but the extension {EXTENSION}"
_STATUSES = tuple(Status)

_Call = Callable[..., Any]


def _extension() -> ModuleType | None:
    """The extension that the environment asks for; None for Python."""
    choice = os.environ.get(CHOICE, "")
    if choice not in ("", "python", "native"):
        raise ImportError(f"{CHOICE} must be python or native, not {choice!r}")
    if choice == "python":
        return None
    try:
        found = import_module(EXTENSION)
    except ImportError as error:
        if choice == "native":
            raise ImportError(f"{_ASKED_FOR} is not installed: {error}") from error
        return None
    if found.SOURCES == SOURCES:
        return found
    if choice == "native":
        raise ImportError(f"{_ASKED_FOR} was made of other sources: install it again")
    return None


_NATIVE = _extension()
_KNOWN: frozenset[str] = frozenset(() if _NATIVE is None else _NATIVE.MACHINES)
CORE = "python" if _NATIVE is None else "native"
"""The core that runs."""


def machine_of(robot: Mechanism, *, is_changed: bool = False) -> Any:
    """The machine in C that the calls use; if a subclass has programs of its own, or is_changed, it answers
    nothing.
    """
    assert _NATIVE is not None
    own: Any = next(cls for cls in type(robot).__mro__ if "KEY" in vars(cls))
    is_changed = is_changed or any(getattr(type(robot), name) is not getattr(own, name) for name in _PROGRAMS)
    values = tuple(robot.parameters[p.name] for p in robot.PARAMETERS)
    return _NATIVE.Machine("" if is_changed else own.KEY, values, Frame, Solution, Diagnosis, _STATUSES)


def take_over(cls: type[Mechanism]) -> bool:
    """Let the native core answer the calls of a class; false if it does not have this machine."""
    if cls.KEY not in _KNOWN:
        return False
    for name, made in _CALLS.items():
        setattr(cls, name, made(getattr(cls, name)))
    return True


def _of_axes(name: str) -> Callable[[_Call], _Call]:
    """A call that takes axes. Python answers where a caller also gives the start of forward kinematics."""

    def made(python: _Call) -> _Call:
        @wraps(python)
        def call(self: Any, axes: Any, *start: Any, **named: Any) -> Any:
            found = NotImplemented if start or named else getattr(self._machine, name)(axes)
            return python(self, axes, *start, **named) if found is NotImplemented else found

        return call

    return made


def _inverse(python: _Call) -> _Call:
    @wraps(python)
    def inverse(self: Any, frame: Any, configuration: Any = None, reference: Any = None) -> Any:
        found = self._machine.inverse(frame, configuration, reference)
        return python(self, frame, configuration, reference) if found is NotImplemented else found

    return inverse


def _inverse_all(python: _Call) -> _Call:
    @wraps(python)
    def inverse_all(self: Any, frame: Any, reference: Any = None) -> Any:
        found = self._machine.inverse_all(frame, reference)
        return python(self, frame, reference) if found is NotImplemented else found

    return inverse_all


def _branches(python: _Call) -> _Call:
    @wraps(python)
    def branches(self: Any, frame: Any, reference: Any = None) -> Any:
        found = self._machine.branches(frame, reference)
        return python(self, frame, reference) if found is NotImplemented else found

    return branches


def _branch(python: _Call) -> _Call:
    @wraps(python)
    def branch(self: Any, frame: Any, signs: Any, reference: Any = None) -> Any:
        found = self._machine.branch(frame, signs, reference)
        return python(self, frame, signs, reference) if found is NotImplemented else found

    return branch


def _solve(python: _Call) -> _Call:
    @wraps(python)
    def solve(self: Any, position: Any, rotation: Any, signs: Any, turns: Any, reference: Any) -> Any:
        found = self._machine.solve(position, rotation, signs, turns, reference)
        return python(self, position, rotation, signs, turns, reference) if found is NotImplemented else found

    return solve


def _batch_of_axes(name: str) -> Callable[[_Call], _Call]:
    """A call of `_native_batch` that takes axes."""

    def made(python: _Call) -> _Call:
        @wraps(python)
        def call(self: Any, axes: Any, *start: Any, **named: Any) -> Any:
            if start or named or not self._machine.answers:
                return python(self, axes, *start, **named)
            from softkin import _native_batch

            return getattr(_native_batch, name)(self, axes)

        return call

    return made


def _inverse_batch(python: _Call) -> _Call:
    @wraps(python)
    def inverse_batch(
        self: Any, positions: Any, rotations: Any = None, configurations: Any = None, references: Any = None
    ) -> Any:
        if not self._machine.answers:
            return python(self, positions, rotations, configurations, references)
        from softkin import _native_batch

        return _native_batch.inverse(self, positions, rotations, configurations, references)

    return inverse_batch


def _inverse_all_batch(python: _Call) -> _Call:
    @wraps(python)
    def inverse_all_batch(self: Any, positions: Any, rotations: Any = None, references: Any = None) -> Any:
        if not self._machine.answers or self._machine.is_searched:
            return python(self, positions, rotations, references)
        from softkin import _native_batch

        return _native_batch.inverse_all(self, positions, rotations, references)

    return inverse_all_batch


_CALLS: dict[str, Callable[[_Call], _Call]] = {
    "branch": _branch,
    "branches": _branches,
    "forward": _of_axes("forward"),
    "forward_batch": _batch_of_axes("forward"),
    "inverse": _inverse,
    "inverse_all": _inverse_all,
    "inverse_all_batch": _inverse_all_batch,
    "inverse_batch": _inverse_batch,
    "jacobian": _of_axes("jacobian"),
    "jacobian_batch": _batch_of_axes("jacobian"),
    "_branch": _solve,
    "_forward": _of_axes("pose"),
    "_jacobian": _of_axes("jacobian"),
    "_singularity": _of_axes("margins"),
}
"""The calls that the native core answers, each with the function that makes the call ask the core first."""
_PROGRAMS = ("_branch", "_forward", "_jacobian", "_limits", "_singularity")
"""The programs of a machine: where a subclass overrides one of them, Python answers all calls."""
