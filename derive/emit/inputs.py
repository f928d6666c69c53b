"""The names of the inputs of a machine in a language: those of the description wherever the language permits them.

One pass decides over all inputs of a machine. Names that can be used as they are come first, so that what replaces
another name never takes the place of one of these.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from derive.description.mechanism import Parameter, Role
from derive.kinematics.kinematics import Kinematics

_WORDS = {
    Role.LENGTH: "length", Role.SIGNED_LENGTH: "length", Role.DISTANCE: "distance", Role.PITCH: "pitch",
    Role.GEAR: "gear", Role.COUPLING: "coupling", Role.RATIO: "ratio", Role.TRANSMISSION: "ratio",
    Role.FLAG: "flag", Role.SIGN: "sign", Role.ANGLE: "angle",
}  # fmt: skip


@dataclass(frozen=True)
class Spelling:
    """How a language writes the names of inputs."""

    wish: Callable[[Parameter], str]
    """The wanted name of an input."""
    others: Callable[[Parameter, str], Iterator[str]]
    """Other names for the input, the best first; an endless iterator."""
    meaning: Callable[[str], str | None]
    """The other meaning that a name has in the language, in words."""
    same: Callable[[str], str] = str
    """The form in which the language compares names: two names with the same form are one."""


@dataclass(frozen=True)
class Inputs:
    """The inputs of one machine in one language."""

    names: Mapping[str, str]
    """Name inside the derivation → name in the language."""
    notes: tuple[str, ...]
    """A sentence for each input that has not the name of its description."""
    inner: Mapping[str, str]
    """The entries of `names` that differ from the name inside the derivation."""

    def reworded(self, text: str) -> str:
        """A sentence about the derivation, in the names of the language."""
        return re.sub(r"[a-z]\w*", lambda found: self.inner.get(found.group(), found.group()), text)


def inputs_of(kinematics: Kinematics, spelling: Spelling, taken: Mapping[str, str]) -> Inputs:
    """The names of all inputs, and the notes on them.

    taken: further names that an input cannot have, each with what it means.
    """
    meanings = {spelling.same(name): meaning for name, meaning in taken.items()}
    names: dict[str, str] = {}

    def meaning_of(name: str) -> str | None:
        return meanings.get(spelling.same(name)) or spelling.meaning(name)

    def take(p: Parameter, name: str) -> None:
        names[p.name] = name
        meanings[spelling.same(name)] = f'the input for "{p.meaning}"'

    stated = {p.name for p in kinematics.mechanism.parameters}
    ordered = sorted(kinematics.parameters, key=lambda p: p.name in stated)  # inputs that every machine has come first
    refused: list[tuple[Parameter, str]] = []
    for p in ordered:
        wish = spelling.wish(p)
        if (meaning := meaning_of(wish)) is None:
            take(p, wish)
        else:
            refused.append((p, meaning))
    notes = []
    for p, meaning in refused:
        wish = spelling.wish(p)
        name = next(other for other in spelling.others(p, wish) if meaning_of(other) is None)
        take(p, name)
        notes.append(f"The parameter {p.given_name} is called {name} here, because {wish} is {meaning}.")
    inner = {p.name: names[p.name] for p in kinematics.parameters if p.given}
    return Inputs({p.name: names[p.name] for p in kinematics.parameters}, tuple(notes), inner)


def word_of(parameter: Parameter) -> str:
    """The kind of a parameter, as a word that can be appended to its name."""
    return _WORDS[parameter.role]
