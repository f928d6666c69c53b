"""The function of each program: the arrays that it takes apart, and the shape of its result."""

from __future__ import annotations

from dataclasses import dataclass

from derive.drawing.parts import Parts
from derive.emit.interface import POSE, Arrays, Entry, Shape, axes_of, entries, rotation_entry, shared_entries
from derive.emit.javascript.printer import function_name
from derive.ir.program import Program
from derive.kinematics.kinematics import Kinematics


@dataclass(frozen=True)
class Function:
    """A program with its place in the module."""

    entry: Entry

    @property
    def program(self) -> Program:
        """Its program."""
        return self.entry.program

    @property
    def name(self) -> str:
        """Its name in the module."""
        return function_name(self.program.name)

    @property
    def arguments(self) -> Arrays:
        """Each with the names that the program reads of it."""
        return tuple((_camel(array), shape) for array, shape in self.entry.arguments)

    @property
    def result(self) -> tuple[Shape, ...] | None:
        """None if the program only refuses."""
        shapes = tuple(shape for _, shape in self.entry.results)
        return shapes if len(shapes) > 1 else shapes[0] if shapes else None

    @property
    def key(self) -> str:
        """Its name among the programs that the runtime calls; empty if only other programs call it."""
        return _camel(self.entry.key)


def rotation_function() -> Function:
    """The repair of a commanded rotation, which is the same for all mechanisms."""
    return Function(rotation_entry())


def functions(kin: Kinematics, parts: Parts | None) -> list[Function]:
    """The functions of a module, each before its callers. parts: the drawn parts of a machine that has a drawing."""
    found = [*shared_entries(kin, kin.shared), *entries(kin).values()]
    if parts is not None:
        text = "What is drawn: amounts and points, as `parts` of the description counts them."
        found.append(Entry("parts", text, parts.program, (*axes_of(kin), *POSE), (("parts", parts.names),)))
    return [Function(entry) for entry in found]


def _camel(name: str) -> str:
    """`search_given` → `searchGiven`."""
    first, *others = name.split("_")
    return first + "".join(word.capitalize() for word in others)
