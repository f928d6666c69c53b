"""What all kinds of statements have in common: names, expressions and programs, to be read and to be changed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, Self

import sympy as sp

from derive.ir.symbols import names_in

if TYPE_CHECKING:
    from derive.ir.program import Program


class Common:
    """What every statement answers, because its kind names its fields: a pass that asks no more knows a new kind, too.

    Such a field holds one expression (or name, or program), a statement, None, or a tuple of these.
    """

    expression_fields: ClassVar[tuple[str, ...]]
    """The fields with expressions, in the order of their evaluation."""
    name_fields: ClassVar[tuple[str, ...]] = ()
    """The fields with names that it binds."""
    program_fields: ClassVar[tuple[str, ...]] = ()
    """The fields with programs that it runs."""
    is_straight: ClassVar[bool] = True
    """Whether it takes as long for all values: it neither repeats anything nor runs another program."""

    @property
    def refuses(self) -> bool:
        """Whether it may end the program."""
        return False

    def bound(self) -> tuple[sp.Symbol, ...]:
        """The names that it binds, in order."""
        return tuple(_leaves(self._values(self.name_fields), lambda inner: inner.bound()))

    def with_names(self, name: Callable[[sp.Symbol], sp.Symbol]) -> Self:
        """The same statement, in which the names that it binds are changed."""
        return self._changed(self.name_fields, name, lambda inner: inner.with_names(name))

    def children(self) -> tuple[sp.Basic, ...]:
        """Its expressions, in the order of their evaluation, without those of its reason."""
        return tuple(_leaves(self._values(self.expression_fields), lambda inner: inner.children()))

    def with_children(self, values: Iterable[sp.Basic]) -> Self:
        """The same statement with other expressions, in the order of `children`."""
        rest = iter(values)
        return self._changed(self.expression_fields, lambda _: next(rest), lambda inner: inner.with_children(rest))

    def reads(self) -> set[sp.Symbol]:
        """The names that it reads and does not bind itself, without those of its reason."""
        return set[sp.Symbol]().union(*map(names_in, self.children()))

    def programs(self) -> tuple[Program, ...]:
        """The programs that it runs."""
        return tuple(_leaves(self._values(self.program_fields), lambda inner: inner.programs()))

    def calling(self, programs: Mapping[str, Program]) -> Self:
        """The same statement, which runs the programs that now have the names of its own."""
        return self._changed(
            self.program_fields, lambda program: programs[program.name], lambda inner: inner.calling(programs)
        )

    def _values(self, fields: Iterable[str]) -> tuple[Any, ...]:
        return tuple([getattr(self, field) for field in fields])

    def _changed(self, fields: Iterable[str], leaf: Callable[[Any], Any], inner: Callable[[Common], Common]) -> Self:
        changes = {field: _mapped(getattr(self, field), leaf, inner) for field in fields}
        return replace(self, **changes) if changes else self  # type: ignore[type-var]


def _leaves(value: Any, inner: Callable[[Common], Iterable[Any]]) -> Iterator[Any]:
    """What stands in a field; of a statement what `inner` gives."""
    if isinstance(value, tuple):
        for part in value:
            yield from _leaves(part, inner)
    elif isinstance(value, Common):
        yield from inner(value)
    elif value is not None:
        yield value


def _mapped(value: Any, leaf: Callable[[Any], Any], inner: Callable[[Common], Common]) -> Any:
    """A field in which all that `_leaves` finds is changed."""
    if isinstance(value, tuple):
        return tuple([_mapped(part, leaf, inner) for part in value])
    if isinstance(value, Common):
        return inner(value)
    return None if value is None else leaf(value)
