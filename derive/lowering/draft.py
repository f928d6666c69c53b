"""Programs as drafts: the values in a graph, and a table of their names and of the places of statements.

A draft is read from a program, changed, and written as a program again. A name belongs to a value: two statements that
bind equal values bind one name, and a value that is read twice without a name gets one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import sympy as sp

from derive.ir.graph import PRODUCT, Graph, Node, Value
from derive.ir.primitives import Root
from derive.ir.program import Iterate, Let, Program, Statement, reason_expressions

_ONE = sp.Integer(1)


@dataclass(frozen=True)
class Named:
    """The name of a node: `name` is bound to the node, or to its negative."""

    name: sp.Symbol
    sign: int
    note: str
    order: int
    """The place at which the program bound the name."""
    turn_of: str = ""
    """See `Let`."""


@dataclass(frozen=True)
class Effect:
    """A statement other than a `Let`, and the values of its expressions."""

    statement: Statement
    read: tuple[tuple[sp.Basic, Value], ...]
    refused: tuple[tuple[sp.Basic, Value], ...]
    """The values that are computed where it refuses, and nowhere else."""

    @property
    def values(self) -> tuple[Value, ...]:
        """The values that it reads."""
        return tuple(value for _, value in self.read)

    def changed(self, change: Callable[[Value], Value]) -> Effect:
        """A copy in which every value is changed."""
        read, refused = (tuple((e, change(v)) for e, v in pairs) for pairs in (self.read, self.refused))
        return Effect(self.statement, read, refused)

    def calling(self, programs: Mapping[str, Program]) -> Effect:
        """The same, which runs the programs that now have the names of its own."""
        return replace(self, statement=self.statement.calling(programs))


@dataclass(frozen=True)
class Loop:
    """An iteration: its start, the statements of its step, its condition to end, and its next state."""

    statement: Iterate
    start: tuple[Value, ...]
    step: tuple[Effect | Node, ...]
    ending: tuple[Value, ...]

    def calling(self, programs: Mapping[str, Program]) -> Loop:
        """The same, which runs the programs that now have the names of its own."""
        return replace(self, step=tuple(s if isinstance(s, Node) else s.calling(programs) for s in self.step))


Item = Effect | Loop


@dataclass
class Draft:
    """A program between reading and writing."""

    program: Program
    items: list[Item]
    outputs: tuple[Value, ...]
    names: dict[Node, Named]


@dataclass
class Reader:
    """Reads programs into one graph."""

    graph: Graph = field(default_factory=Graph)
    _roots: dict[sp.Basic, Value] = field(default_factory=dict)
    """The roots of constants that have names: a program that reads the name reads the same value."""

    def draft(self, program: Program) -> Draft:
        """The draft of a program."""
        reading = _Reading(self.graph, _bound=dict(self._roots))
        items = [item for order, s in enumerate(program.body) for item in reading.items(s, order)]
        outputs = tuple(reading.value(o.value) for o in program.outputs)
        return Draft(program, items, outputs, reading.names)

    def constant(self, let: Let) -> tuple[Node, Named]:
        """The node and the name of a value that is bound outside of all programs."""
        value = _Reading(self.graph).value(let.value)
        if value.node.head is Root:
            self._roots[let.name] = value
        return value.node, Named(let.name, value.sign, "", 0)


@dataclass
class _Reading:
    graph: Graph
    names: dict[Node, Named] = field(default_factory=dict)
    _bound: dict[sp.Basic, Value] = field(default_factory=dict)
    """The values of the names and expressions that have been read."""

    def items(self, statement: Statement, order: int) -> Iterator[Item]:
        """The items of a statement in a draft; a binding gives none, because it only names a value."""
        if isinstance(statement, Let):
            self._bind(statement, order)
        elif isinstance(statement, Iterate):
            yield self._loop(statement, order)
        else:
            yield self._effect(statement)

    def _bind(self, let: Let, order: int) -> Node | None:
        """Name a value and return its node; None if the value has a name already, or needs none."""
        value = self.value(let.value)
        self._bound[let.name] = value
        if value.node.is_leaf or value.node in self.names:
            return None
        self.names[value.node] = Named(let.name, value.sign, let.note, order, let.turn_of)
        return value.node

    def _effect(self, statement: Statement) -> Effect:
        found = statement.children(), reason_expressions(statement)
        return Effect(statement, *(tuple((e, self.value(e)) for e in expressions) for expressions in found))

    def _loop(self, loop: Iterate, order: int) -> Loop:
        start = tuple(map(self.value, loop.start))
        step: list[Effect | Node] = []
        for inner in loop.step:
            if isinstance(inner, Let):
                node = self._bind(inner, order)
                step += [] if node is None else [node]
            else:
                step.append(self._effect(inner))
        ending = tuple(map(self.value, (loop.done, *loop.following)))
        return Loop(loop, start, tuple(step), ending)

    def value(self, expression: sp.Basic) -> Value:
        """An expression as a value of the graph."""
        known = self._bound.get(expression)
        if known is None:
            known = self._bound[expression] = self._read(expression)
        return known

    def _read(self, e: sp.Basic) -> Value:
        if not e.args or isinstance(e, sp.Number):
            return self.graph.leaf(e)
        if isinstance(e, sp.Add):
            return self.graph.sum(map(self.value, e.args))
        if isinstance(e, sp.Mul | sp.Pow):
            above, below = list[Value](), list[Value]()
            for factor in sp.Mul.make_args(e):
                base, exponent = factor.as_base_exp() if isinstance(factor, sp.Pow) else (factor, _ONE)
                (above if exponent.is_positive else below).extend([self.value(base)] * abs(int(exponent)))
            return self.graph.product(above, below)
        return self.graph.apply(e.func, [self.value(a) for a in e.args])


def changed(draft: Draft, change: Callable[[Value], Value]) -> Draft:
    """The draft with every value changed. If two values become one, so do their names."""
    names: dict[Node, Named] = {}
    for node, named in draft.names.items():
        value = change(Value(node, 1))
        if not value.node.is_leaf and value.node not in names:
            names[value.node] = named if value.sign > 0 else replace(named, sign=-named.sign)
    items = [_changed(item, change) for item in draft.items]
    return Draft(draft.program, items, tuple(map(change, draft.outputs)), names)


def _changed(item: Item, change: Callable[[Value], Value]) -> Item:
    if isinstance(item, Effect):
        return item.changed(change)
    step: list[Effect | Node] = []
    for inner in item.step:
        if isinstance(inner, Node):
            step.append(change(Value(inner, 1)).node)
        else:
            step.append(inner.changed(change))
    start, ending = tuple(map(change, item.start)), tuple(map(change, item.ending))
    return replace(item, start=start, step=tuple(step), ending=ending)


class Rewriting:
    """A change of values from the leaves up: `rewritten` returns the new value of a node whose parts are changed."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self._done: dict[Node, Value] = {}

    def __call__(self, value: Value) -> Value:
        """The new value in place of a value."""
        done, pending = self._done, [] if value.node in self._done else [value.node]
        while pending:
            node = pending[-1]
            if node in done:
                pending.pop()
            elif (known := self.known(node)) is not None:
                done[node] = known
            elif missing := [n for n in node.read if n not in done]:
                pending += missing
            else:
                done[node] = self.rewritten(node, tuple([self._read(p) for p in node.parts]))
        return self._read(value)

    def known(self, node: Node) -> Value | None:
        """The new value in place of a node, where it is known without those of its parts."""
        return None

    def _read(self, value: Value) -> Value:
        done = self._done[value.node]
        return done if value.sign > 0 else -done

    def divisors(self, node: Node) -> list[Value]:
        """The divisors of a product, changed."""
        return [self._done[d] for d in node.divisors]

    def rewritten(self, node: Node, parts: tuple[Value, ...]) -> Value:
        """The new value in place of a node, given its changed parts."""
        if parts == node.parts and all(self._done[n] == (n, 1) for n in node.divisors):
            return Value(node, 1)
        if node.head is sp.Add:
            return self.graph.sum(parts)
        if node.head is PRODUCT:
            return self.graph.product(parts, self.divisors(node))
        assert isinstance(node.head, type)
        return self.graph.apply(node.head, parts)


def values_of(draft: Draft) -> Iterator[Value]:
    """The values that the statements and the outputs of a draft read."""
    for item in draft.items:
        yield from read_values(item)
    yield from draft.outputs


def read_values(item: Item) -> Iterator[Value]:
    """The values that a statement reads, those of a loop's step as well."""
    if isinstance(item, Effect):
        yield from item.values
        return
    yield from item.start
    for inner in item.step:
        yield from [Value(inner, 1)] if isinstance(inner, Node) else inner.values
    yield from item.ending


Readers: TypeAlias = Mapping[Node, tuple[Node | None, ...]]
"""For each node: the nodes that read it, and None for each statement or output that reads it."""


def readers_of(draft: Draft) -> Readers:
    """The readers of all nodes of a draft; the amount of a reason is a reader, too."""
    found: dict[Node, list[Node | None]] = {}
    pending: list[Node] = []

    def read(node: Node, reader: Node | None) -> None:
        if node not in found:
            found[node] = []
            pending.append(node)
        found[node].append(reader)

    refused = (value for item in draft.items if isinstance(item, Effect) for _, value in item.refused)
    for value in (*values_of(draft), *refused):
        read(value.node, None)
    while pending:
        reader = pending.pop()
        for node in reader.read:
            read(node, reader)
    return {node: tuple(readers) for node, readers in found.items()}
