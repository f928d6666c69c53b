"""The public side of the harness: compile texts, make instances, call them."""

from __future__ import annotations

from ast import Module
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import cached_property, lru_cache
from types import CodeType
from typing import Any

from . import ast, python_names, stubs
from . import st_types as types
from .check_expressions import block_parameters
from .faults import StError, StFault
from .initial_values import default, initial
from .instance import Entry, Function, Instance, Origin
from .layers import Texts, declarations_of, layer_of
from .marks import marked, marked_code
from .runtime import ENVIRONMENT, Cell, Matrix
from .translate_statements import Source
from .universe import Universe

__all__ = ["Cell", "Library", "StError", "StFault", "compile_st"]

FILENAME = "<structured text>"
"""The file of all translations, as their traces name it."""
Instrument = Callable[[str], Module]
"""What reads a part of a translation, and changes it."""


def compile_st(
    texts: Mapping[str, str],
    order: str = "rows",
    matrix_size: int = 72,
    max_config_data: int = 31,
    instrument: Instrument | None = None,
) -> Library:
    """Parse, check and translate texts (name -> Structured Text). Raises StError.

    `instrument` may read the translated source, part by part, and change it, so that running it can be watched.
    """
    translated = _translated(tuple(texts.items()), matrix_size, max_config_data)
    return Library(translated, stubs.MatrixAccess(order), matrix_size, instrument)


@dataclass(frozen=True, eq=False)
class Translated:
    """Texts, checked and translated. Libraries with another order of the matrix share it: nobody writes into it."""

    universe: Universe
    own: tuple[ast.Declaration, ...]
    source: Source

    @cached_property
    def python(self) -> str:
        return "\n".join(self.source.lines)

    @cached_property
    def parts(self) -> tuple[str, ...]:
        """The translation text by text, each below as many empty lines as stand before it: what many libraries begin
        with is compiled once.
        """
        lines, places = self.source.lines, self.source.places
        starts = [n for n, line in enumerate(lines) if line and not line[0].isspace()]
        files = ["" if (place := places[n]) is None else place.file for n in starts]
        first = [n for n, file, before in zip(starts, files, [None, *files], strict=False) if file != before]
        ends = [*first[1:], len(lines)]
        return tuple("\n" * start + "\n".join(lines[start:end]) for start, end in zip(first, ends, strict=True))

    def code(self, instrument: Instrument | None) -> Iterator[CodeType]:
        """What defines all objects, in the order of the texts."""
        return (_code(part, instrument) for part in self.parts)

    @cached_property
    def marked_code(self) -> dict[str, CodeType]:
        """The same, function by function, with a flag set before every statement."""
        return {name: code for part in self.parts for name, code in _marked(part).items()}


@lru_cache(maxsize=500)
def _code(part: str, instrument: Instrument | None) -> CodeType:
    return compile(part if instrument is None else instrument(part), FILENAME, "exec")


@lru_cache(maxsize=500)
def _marked(part: str) -> dict[str, CodeType]:
    return marked_code(part, FILENAME)


@lru_cache(maxsize=8)
def _translated(texts: Texts, matrix_size: int, max_config_data: int) -> Translated:
    layer = layer_of(texts, matrix_size, max_config_data)
    own = tuple(declaration for file, text in texts for declaration in declarations_of(text, file))
    return Translated(layer.universe, own, layer.whole())


@lru_cache(maxsize=2000)
def _made_by(value: str) -> CodeType:
    """The code of a function that makes a value: thousands of parameters have the same few."""
    return compile(f"lambda: {value}", FILENAME, "eval")


class Library:
    """Compiled texts. `objects` holds their declarations by name, in the order of the texts."""

    def __init__(
        self, translated: Translated, access: stubs.MatrixAccess, matrix_size: int, instrument: Instrument | None = None
    ) -> None:
        # Typed loosely: what a declaration has depends on its kind, and a test knows the kind.
        self.objects: dict[str, Any] = {declaration.name: declaration for declaration in translated.own}
        self.python = translated.python
        self.origin = Origin(FILENAME, translated.source.places)
        self._translated, self._universe = translated, translated.universe
        self._access = access
        self._functions: dict[str, Function] = {}
        self._names: dict[str, Any] = dict(ENVIRONMENT)
        self._names["Instance"] = type("Instance", (Instance,), {"__slots__": (), "origin": self.origin})
        self._names["class_smc_matrix3"] = type("Matrix3", (Matrix,), {"__slots__": (), "size": matrix_size})
        for name, function in stubs.natives(access).items():
            self._names["function_" + name] = function
        for code in translated.code(instrument):
            exec(code, self._names)
        self._list_routines()

    def _list_routines(self) -> None:
        """Give every class of a block the table of what Python may call on it."""
        for declaration in self.objects.values():
            found = self._universe.find(declaration.name)
            if isinstance(found, types.Block):
                made = self._names[python_names.type_class(found)]
                made.routines = self._routines(found)
                made.cells = frozenset(
                    p.name for p in block_parameters(found) if p.is_reference and types.is_scalar(p.type)
                )

    def _routines(self, block: types.Block) -> dict[str, Entry]:
        inherited = self._routines(block.base) if block.base else {}
        made = self._names[python_names.type_class(block)]
        own = {
            key: self._entry(getattr(made, python_names.method(routine.name)), routine)
            for key, routine in block.methods.items()
        }
        return inherited | own

    def _entry(self, function: Any, routine: types.Routine) -> Entry:
        defaults = [
            eval(_made_by(initial(parameter, self._universe.meaning)), self._names) for parameter in routine.parameters
        ]
        return Entry(function, routine, defaults)

    def new(self, name: str) -> Any:
        """A fresh instance of a block, or a fresh value of a declared or library type."""
        found = self._universe.find_path(name)
        if not isinstance(found, types.Type):
            raise KeyError(f"{name} is no type")
        return eval(default(found), self._names)

    def function(self, name: str) -> Function:
        if name not in self._functions:
            self._functions[name] = self._find_function(name)
        return self._functions[name]

    def _find_function(self, name: str) -> Function:
        found = self._universe.find_path(name)
        if not isinstance(found, types.Routine):
            raise KeyError(f"{name} is no function")
        return Function(self._entry(self._names[python_names.function(found)], found), self.origin)

    def watched(self, ran: list[bool]) -> AbstractContextManager[None]:
        """While this is open, every statement that runs sets the flag of its line in the translation, from 1."""
        return marked(self._names, self._translated.marked_code, ran)

    def flags(self) -> list[bool]:
        """A flag for every line of the translation, from 1: none ran."""
        return [False] * (len(self.origin.places) + 1)

    def constant(self, name: str) -> Any:
        found = self._universe.find_path(name)
        if not isinstance(found, types.Variable):
            raise KeyError(f"{name} is no global variable")
        kept = self._names.get(python_names.global_variable(found))
        return eval(initial(found, self._universe.meaning), self._names) if kept is None else kept

    def set_rotation(self, matrix: Matrix, rows: stubs.Rows) -> None:
        """Write a rotation, given as rows, in the storage order of this library."""
        self._access.set(matrix, rows)

    def get_rotation(self, matrix: Matrix) -> stubs.Rows:
        return self._access.get(matrix)
