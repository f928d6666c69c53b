"""Hoisting: a value that depends on parameters alone is computed once, by the setup, and its name says what it is.

x = l1 * cos_q + l2 - l3         →  setup: l2_minus_l3 = l2 - l3;   x = l1 * cos_q + l2_minus_l3
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.graph import PRODUCT, SUM, Graph, Node, Value, reached
from derive.ir.primitives import Root
from derive.ir.program import Let, Output, Program
from derive.ir.symbols import Names
from derive.lowering.draft import Draft, Named, Rewriting, values_of
from derive.lowering.wording import name_for
from derive.lowering.writing import is_condition, written


class Constant:
    """Whether a node depends on constants of a machine, and on nothing else."""

    def __init__(self, constants: Iterable[str]) -> None:
        self._names = frozenset(constants)
        self._known: dict[Node, tuple[bool, bool]] = {}

    def __call__(self, node: Node) -> bool:
        """Whether a node is a constant, but no number."""
        return self._classified(node) == (True, True)

    def allows(self, node: Node) -> bool:
        """Whether a node is a constant or a number."""
        return self._classified(node)[0]

    def _classified(self, node: Node) -> tuple[bool, bool]:
        known = self._known.get(node)
        if known is None:
            if node.is_leaf:
                is_name = isinstance(node.head, sp.Symbol) and node.head != DEGREE
                known = (not is_name or str(node.head) in self._names, is_name)
            else:
                inner = [self._classified(n) for n in node.read]
                known = (all(i[0] for i in inner), any(i[1] for i in inner))
            self._known[node] = known
        return known


class Gathering(Rewriting):
    """Gathers the constants of a sum in one term, and those of a product in one factor."""

    def __init__(self, graph: Graph, constant: Constant) -> None:
        super().__init__(graph)
        self.constant = constant

    def rewritten(self, node: Node, parts: tuple[Value, ...]) -> Value:
        """A sum or a product with its constants as one part; a constant stays as it was written."""
        if self.constant(node):
            return super().rewritten(node, parts)
        if node.head is SUM:
            fixed, others = self._apart(parts)
            if others and len(fixed) > 1 and any(self.constant(v.node) for v in fixed):
                return self.graph.sum([self.graph.sum(fixed), *others])
        if node.head is PRODUCT:
            below = self.divisors(node)
            fixed, others = self._apart(parts)
            fixed_below, others_below = self._apart(below)
            together = [*fixed, *fixed_below]
            if (others or others_below) and len(together) > 1 and any(self.constant(v.node) for v in together):
                if fixed:
                    return self.graph.product([self.graph.product(fixed, fixed_below), *others], others_below)
                return self.graph.product(others, [self.graph.product(fixed_below), *others_below])
            if others and fixed_below and any(self.constant(v.node) for v in fixed_below):
                return self.graph.product([self.graph.product([], fixed_below), *others], others_below)
        return super().rewritten(node, parts)

    def _apart(self, values: Iterable[Value]) -> tuple[list[Value], list[Value]]:
        """The constants and numbers, and the other values."""
        fixed, others = list[Value](), list[Value]()
        for value in values:
            (fixed if self.constant.allows(value.node) else others).append(value)
        return fixed, others


def hoisted(
    drafts: Sequence[Draft], constant: Constant, taken: Iterable[str], known: Mapping[Node, Named]
) -> tuple[dict[Node, Named], tuple[Let, ...]]:
    """The constants that the drafts read, by name, and their bindings. taken: names that are not free; known: constants
    that are bound elsewhere.
    """
    read = {node for draft in drafts for node in _constants_read(draft, constant)}
    given = {node: named for draft in reversed(drafts) for node, named in draft.names.items()}
    readers = _readers(drafts)
    varying = {named.name.name for d in drafts for n, named in d.names.items() if not constant(n)}
    free = Names({*taken, *varying})
    names = {node: named for node, named in known.items() if not node.is_leaf}
    elsewhere = dict(names)

    def called(node: Node) -> sp.Expr | None:
        return names[node].sign * names[node].name if node in names else None

    inner = {node for node in reached(read) if node in given}
    for order, node in enumerate(sorted((read | inner) - elsewhere.keys(), key=lambda n: n.place)):
        named = given.get(node)
        if named is not None:
            names[node] = replace(named, name=free.fresh(named.name.name, named.name), order=order)
            continue
        proposal = name_for(Value(node, 1), called, readers.get(node, ""))
        names[node] = Named(free.fresh(proposal), 1, "", order)
    own = {node: named for node, named in names.items() if node not in elsewhere}
    outputs = tuple(Output(named.name.name, named.name) for named in own.values())
    values = tuple(Value(node, named.sign) for node, named in own.items())
    draft = Draft(Program("constants", (), (), outputs), [], values, own)
    program = written(draft, elsewhere, {*taken, *varying})
    return names, program.lets()


def _constants_read(draft: Draft, constant: Constant) -> Iterator[Node]:
    """The constants, and roots of numbers, that a statement or a value that is no constant reads."""

    def is_largest(node: Node) -> bool:
        is_root_of_number = node.head is Root and constant.allows(node)
        return (constant(node) or is_root_of_number) and not node.is_leaf and not is_condition(node)

    return filter(is_largest, reached((value.node for value in values_of(draft)), is_largest))


def _readers(drafts: Sequence[Draft]) -> dict[Node, str]:
    """For each node that is read: the name of the value that reads it first."""
    found: dict[Node, str] = {}
    for draft in drafts:
        for reader, named in draft.names.items():
            for node in reached(reader.read, draft.names.__contains__):
                if node not in draft.names:
                    found.setdefault(node, named.name.name)
    return found
