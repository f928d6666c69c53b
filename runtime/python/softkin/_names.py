"""Configurations by the names of their branches, and back."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Self

from softkin._configuration import AUTOMATIC, COINCIDE, FIRST, SECOND
from softkin._input import bytes_of
from softkin._types import Configuration, ConfigurationByte, KinematicsError, Status

if TYPE_CHECKING:
    from softkin._core import Mechanism

_OPEN = {"automatic": AUTOMATIC, "coincide": COINCIDE}


class NamedConfiguration(tuple[int, ...]):
    """A configuration, as any tuple of its bytes; its `repr` shows the names."""

    described: tuple[ConfigurationByte, ...]

    def __new__(cls, values: Configuration, described: tuple[ConfigurationByte, ...]) -> Self:
        """values: the bytes; described: what each byte stands for."""
        made = super().__new__(cls, values)
        made.described = described
        return made

    @property
    def names(self) -> dict[str, str | int]:
        """The names of the branches and the numbers of the turns, by the names of the bytes."""
        return names_of(self.described, self)

    def __getnewargs__(self) -> tuple[Configuration, tuple[ConfigurationByte, ...]]:
        """Copying and pickling keep the names."""
        return tuple(self), self.described

    def __repr__(self) -> str:
        """The call that makes it."""
        return f"configuration({', '.join(f'{_keyword(name)}={value!r}' for name, value in self.names.items())})"


def configuration(robot: Mechanism, given: Mapping[str, str | int]) -> NamedConfiguration:
    """The configuration with these branches and turns; all others as in the default."""
    places = {_keyword(byte.name): i for i, byte in enumerate(robot.CONFIGURATION)}
    found: list[int] = list(robot.DEFAULT_CONFIGURATION)
    for name, value in given.items():
        if name not in places:
            known = ", ".join(places) or "none: it has one solution"
            raise _bad(robot, f"it has no branch and no turn {name!r}: the names are {known}")
        found[places[name]] = _byte(robot, robot.CONFIGURATION[places[name]], value)
    return NamedConfiguration(tuple(found), robot.CONFIGURATION)


def named(robot: Mechanism, given: Mapping[str, Any] | str) -> NamedConfiguration:
    """The configuration with these names: branches and turns by the names of bytes, or a text of names of branches.

    A text has one name for each branch byte, in order, or fewer that one byte alone has.
    Raises BAD_INPUT for an unknown name, and for one that several bytes have.
    """
    if isinstance(given, Mapping):
        return configuration(robot, {_keyword(str(name)): value for name, value in given.items()})
    described = [byte for byte in robot.CONFIGURATION if byte.branches]
    words = given.replace(",", " ").split()
    in_order = list(zip(words, described, strict=False))
    if len(words) == len(described) and all(word in byte.branches for word, byte in in_order):
        return configuration(robot, {_keyword(byte.name): word for word, byte in in_order})
    found: dict[str, str | int] = {}
    for word in words:
        owners = [_keyword(byte.name) for byte in described if word in byte.branches]
        if len(owners) != 1 or owners[0] in found:
            why = "is no branch" if not owners else "and another one are branches of one byte"
            if len(owners) > 1:
                why = f"is a branch of {' and of '.join(owners)}: give a mapping, or a name for each branch"
            known = ", ".join(f"{byte.name} ({' or '.join(byte.branches)})" for byte in described)
            known = f"its branches are {known}" if known else "it has one solution"
            raise _bad(robot, f"the configuration {given!r}: {word!r} {why}; {known}")
        found[owners[0]] = word
    return configuration(robot, found)


def names(robot: Mechanism, given: Configuration) -> dict[str, str | int]:
    """The names of a configuration."""
    for byte, value in zip(robot.CONFIGURATION, given, strict=True):
        if byte.kind == "branch" and value not in (AUTOMATIC, FIRST, SECOND, COINCIDE):
            raise _bad(robot, f"{byte.name} must be 0, 1, 2 or 3, not {value}")
    return names_of(robot.CONFIGURATION, given)


def names_of(described: tuple[ConfigurationByte, ...], given: Configuration) -> dict[str, str | int]:
    """The names of bytes that are allowed."""
    found: dict[str, str | int] = {}
    for byte, value in zip(described, given, strict=True):
        by_value = {AUTOMATIC: "automatic", COINCIDE: "coincide"} | dict(
            zip((FIRST, SECOND), byte.branches, strict=False)
        )
        found[byte.name] = by_value[value] if byte.kind == "branch" else value
    return found


def _byte(robot: Mechanism, byte: ConfigurationByte, value: str | int) -> int:
    """The byte for the name of a branch or the number of a turn."""
    if byte.kind == "branch":
        known = dict(zip(byte.branches, (FIRST, SECOND), strict=True)) | _OPEN
        if isinstance(value, str):
            if value in known:
                return known[value]
        elif type(value) is int and value in known.values():
            return value
        raise _bad(robot, f"{byte.name} must be {', '.join(map(repr, known))}, or 0 to 3, not {value!r}")
    if not isinstance(value, str):
        try:
            (number,) = bytes_of((value,), 1)
        except KinematicsError:
            number = 0
        if number == value and type(value) is int:
            return number
    raise _bad(
        robot, f"the turn of {byte.name} must be a whole number from -128 to 127, 0 leaves it open, not {value!r}"
    )


def _keyword(name: str) -> str:
    return name.replace(" ", "_")


def _bad(robot: Mechanism, message: str) -> KinematicsError:
    return KinematicsError(Status.BAD_INPUT, f"{robot.NAME}: {message}")
