"""Texts checked and translated on what others have in common with them: that is done once.

Nearly every library begins with the stand-ins and the shared objects, and only its last text is new.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

from . import ast, library_interfaces, stubs
from . import st_types as types
from .check import check
from .faults import Place, StError
from .parse import parse
from .translate import globals_of, translate
from .translate_statements import Source
from .universe import Universe

Texts = tuple[tuple[str, str], ...]
"""The name of each, and its Structured Text."""


@dataclass(frozen=True, eq=False)
class Layer:
    """Objects that others can be translated on: nobody writes into it."""

    universe: Universe
    source: Source
    """Without the globals, which come last."""

    def followed_by(self, universe: Universe, declarations: Sequence[ast.Declaration]) -> Layer:
        """With more objects, which the universe knows."""
        source = Source(self.source.lines[:], self.source.places[:])
        translate(universe, declarations, check(universe, declarations), stubs.EXTRA_INITIALISATION, source)
        return Layer(universe, source)

    def whole(self) -> Source:
        """The source with the globals."""
        source = Source(self.source.lines[:], self.source.places[:])
        globals_of(self.universe, source)
        return source


def layer_of(texts: Texts, matrix_size: int, max_config_data: int) -> Layer:
    """The last text on the others; all of them at once where the others need it, or where it declares a name that they
    find. Raises StError.
    """
    last = [declaration for file, text in texts[-1:] for declaration in declarations_of(text, file)]
    try:
        others = _at_once(texts[:-1], matrix_size, max_config_data)
    except StError:
        return _at_once(texts, matrix_size, max_config_data)
    if any(others.universe.find(name) is not None for declaration in last for name in _declared(declaration)):
        return _at_once(texts, matrix_size, max_config_data)
    universe = others.universe.copy()
    universe.add(last, "")
    return others.followed_by(universe, last)


@lru_cache(maxsize=8)
def _at_once(texts: Texts, matrix_size: int, max_config_data: int) -> Layer:
    universe = Universe()
    universe.declare("SM3M", "SMC_Matrix3", types.Opaque("SMC_Matrix3", matrix_size), Place("SM3M", 0))
    everything: list[ast.Declaration] = []
    for space, declarations in _stub_declarations(max_config_data).items():
        universe.add(list(declarations), space)
        everything += declarations
    own = [declaration for file, text in texts for declaration in declarations_of(text, file)]
    universe.add(own, "")
    return Layer(universe, Source()).followed_by(universe, everything + own)


def _declared(declaration: ast.Declaration) -> Iterator[str]:
    """The names that a declaration may give a meaning outside of it."""
    yield declaration.name
    if isinstance(declaration, ast.Globals):
        yield from (variable.name for variable in declaration.variables)
    if isinstance(declaration, ast.Enumeration):
        yield from (name for name, _ in declaration.members)


@lru_cache(maxsize=256)
def declarations_of(text: str, file: str) -> tuple[ast.Declaration, ...]:
    """A text that stands in many libraries is parsed once: nobody writes into a syntax tree."""
    return tuple(parse(text, file))


@lru_cache
def _stub_declarations(max_config_data: int) -> dict[str, tuple[ast.Declaration, ...]]:
    found = {space: tuple(parse(text, space)) for space, text in stubs.texts(max_config_data).items()}
    return found | {"TRAFO": (*found["TRAFO"], *library_interfaces.declared())}
