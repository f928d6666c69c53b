"""The function of each program, with its arguments and the places of its results."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from derive.emit.interface import POSE, Arrays, Entry, Shape, entries, names, rotation_entry, shared_entries
from derive.ir.program import Program, shared
from derive.kinematics.kinematics import Kinematics

_FRAMES = {"position": "frame", "rotation": "frame", "repaired_rotation": "repaired"}
"""The arrays that are members of a frame, each with the name of the frame."""
_BYTES = ("signs", "turns")


@dataclass(frozen=True)
class Function:
    """A program with its place in the source."""

    entry: Entry
    is_of_machine: bool = True

    @property
    def key(self) -> str:
        """Its name among the programs of a machine, whose table of limits is called `limits`."""
        return "limit" if self.entry.key == "limits" else self.entry.key

    @property
    def program(self) -> Program:
        """Its program."""
        return self.entry.program

    @property
    def name(self) -> str:
        """Its name in the source."""
        return function_name(self.program)

    @property
    def parameters(self) -> str:
        """The declarations of its parameters between the machine and the refusal."""
        given = [f"const {_declared(array)}" for array, _ in self.entry.arguments]
        return ", ".join(dict.fromkeys([*given, *(_declared(array) for array, _ in self.entry.results)]))

    @property
    def given(self) -> Mapping[str, str]:
        """The values that the program reads besides the constants of the machine, each with its place."""
        return dict(places(self.entry.arguments))

    @property
    def results(self) -> tuple[tuple[str, str], ...]:
        """The outputs, each with its place."""
        return tuple(places(self.entry.results))


def function_name(program: Program) -> str:
    """The function of a program: `wrist_centre` → `find_wrist_centre`."""
    return f"find_{program.name.removeprefix('find_')}"


def rotation_function() -> Function:
    """The repair of a commanded rotation, which is the same for all mechanisms."""
    return Function(rotation_entry(), is_of_machine=False)


def functions(kin: Kinematics) -> list[Function]:
    """The functions of a source, each before its callers."""
    asked = entries(kin).values()
    called = shared_entries(kin, shared([entry.program for entry in asked]))
    return [Function(entry) for entry in (*called, *asked)]


def places(arrays: Arrays) -> Iterator[tuple[str, str]]:
    """The values of arrays, each with its place."""
    for array, shape in arrays:
        if array in _FRAMES:
            yield from _members(f"{_FRAMES[array]}->{array.rpartition('_')[2]}", shape)
        else:
            yield from ((name, f"{array}[{i}]") for i, name in enumerate(names(shape)))


def _members(place: str, shape: Shape) -> Iterator[tuple[str, str]]:
    if isinstance(shape, str):
        yield shape, place
    else:
        for i, part in enumerate(shape):
            yield from _members(f"{place}[{i}]", part)


def _declared(array: str) -> str:
    kind = "softkin_frame" if array in _FRAMES else "int8_t" if array in _BYTES else "double"
    return f"{kind} *{_FRAMES.get(array, array)}"


FRAME = dict(places(POSE))
"""The values of a commanded frame, each with its place."""
