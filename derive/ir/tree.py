"""A program as a structured tree: statements in order, and choices of which only one side is executed.

if radius > tolerance:
    cos_q4 = x/radius
else:
    cos_q4 = cos(free)
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from types import MappingProxyType

import sympy as sp

from derive.ir.program import Let, Program, Require, Statement
from derive.ir.symbols import names_in, replaced


@dataclass(frozen=True)
class If:
    """A choice: the statements for a true condition, and those for a false one. Both sides bind `names`."""

    condition: sp.Basic
    holds: tuple[Item, ...]
    fails: tuple[Item, ...]
    names: tuple[sp.Symbol, ...]
    """The names that both sides bind and that later statements read."""

    @property
    def comments(self) -> tuple[str, ...]:
        """The comments of the values of `names`, each once: they stand above the choice."""
        own = (s.comment for s in self.holds if isinstance(s, Let) and s.name in self.names)
        return tuple(dict.fromkeys(comment for comment in own if comment))

    @property
    def sides(self) -> tuple[list[Item], list[Item]]:
        """Both sides, without these comments."""
        holds, fails = ([_without_comment(s, self.names) for s in side] for side in (self.holds, self.fails))
        return holds, fails


Item = Statement | If


@dataclass(frozen=True)
class Tree:
    """A program on its way to a language: its statements are in `items`, some of them on the sides of choices."""

    program: Program
    items: tuple[Item, ...]

    @classmethod
    def of(cls, program: Program) -> Tree:
        """A program without choices that have sides."""
        return cls(program, program.body)

    @property
    def wanted(self) -> list[sp.Basic]:
        """The values of the outputs."""
        return [output.value for output in self.program.outputs]

    def with_items(self, items: tuple[Item, ...], values: Mapping[sp.Basic, sp.Basic] = MappingProxyType({})) -> Tree:
        """The tree with other statements. values: what the outputs read in place of some names."""
        outputs = tuple(replace(o, value=replaced(o.value, values)) for o in self.program.outputs)
        return Tree(replace(self.program, outputs=outputs) if values else self.program, items)


def _without_comment(item: Item, names: Sequence[sp.Symbol]) -> Item:
    return replace(item, note="", turn_of="") if isinstance(item, Let) and item.name in names else item


def statements_in(items: Iterable[Item]) -> Iterator[Statement]:
    """The statements of a tree, those on the sides of choices too."""
    for item in items:
        if isinstance(item, If):
            yield from statements_in((*item.holds, *item.fails))
        else:
            yield item


def expressions_in(items: Iterable[Item]) -> Iterator[sp.Basic]:
    """All expressions of a tree, the conditions of choices among them, in order."""
    for item in items:
        yield from (
            (item.condition, *expressions_in((*item.holds, *item.fails))) if isinstance(item, If) else item.children()
        )


def bindings_in(items: Iterable[Item]) -> Iterator[sp.Symbol]:
    """The names that a tree binds, in order; a name that is bound twice comes twice."""
    return (name for s in statements_in(items) for name in s.bound())


def bound_in(items: Iterable[Item]) -> tuple[sp.Symbol, ...]:
    """The names that a tree binds, each once, in order."""
    return tuple(dict.fromkeys(bindings_in(items)))


def bound_behind(item: Item) -> set[sp.Symbol]:
    """What is bound behind a statement; behind a choice, what both sides bind."""
    if not isinstance(item, If):
        return set(item.bound())
    holds, fails = ({name for inner in side for name in bound_behind(inner)} for side in (item.holds, item.fails))
    return holds & fails


def read_in(items: Iterable[Item]) -> set[sp.Symbol]:
    """The names that a tree reads, whether it binds them itself or not."""
    items = tuple(items)
    return set().union(*map(names_in, expressions_in(items)), *(s.reads() for s in statements_in(items)))


def given_to(items: Iterable[Item]) -> set[sp.Symbol]:
    """The names that a tree reads and does not bind itself before."""
    found, bound = set[sp.Symbol](), set[sp.Symbol]()
    for item in items:
        if isinstance(item, If):
            found |= (names_in(item.condition) | given_to(item.holds) | given_to(item.fails)) - bound
            bound |= set(item.names)
        else:
            found |= item.reads() - bound
            bound |= set(item.bound())
    return found


def follows(other: sp.Basic, condition: sp.Basic, truth: sp.Basic) -> bool:
    """Whether another condition has the same truth: what is above a number is above smaller ones, and so on."""
    if not (isinstance(other, sp.StrictGreaterThan) and isinstance(condition, sp.StrictGreaterThan)):
        return False
    if other.lhs != condition.lhs or not (other.rhs.is_number and condition.rhs.is_number):
        return False
    return bool(other.rhs <= condition.rhs if truth == sp.true else other.rhs >= condition.rhs)


def grouped(body: Sequence[Item]) -> Iterator[tuple[Item, tuple[Require, ...]]]:
    """Statements in order; conditions that follow each other and refuse alike, about the same
    subject, come together.
    """

    def key(indexed: tuple[int, Item]) -> tuple[object, ...]:
        index, statement = indexed
        if not isinstance(statement, Require):
            return (index,)
        return statement.otherwise.name, None if statement.reason is None else statement.reason.subject

    for _, group in groupby(enumerate(body), key):
        statements = [statement for _, statement in group]
        yield statements[0], tuple(s for s in statements if isinstance(s, Require))
