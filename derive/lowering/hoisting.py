"""Hoisting: what depends on parameters alone is computed once, by the setup, under a name that says what it is.

    x = l1 * cos_q + l2 - l3         →  setup: l2_minus_l3 = l2 - l3;   x = l1 * cos_q + l2_minus_l3
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.graph import PRODUCT, SUM, Graph, Node, Value
from derive.ir.names import Names
from derive.ir.program import Let, Output, Program
from derive.ir.symbols import count, is_count
from derive.lowering.draft import Draft, Named, Rewriting
from derive.lowering.wording import said
from derive.lowering.writing import is_condition, read_values, written


class Constant:
    """Whether a node depends on the constants of a machine alone, and on one of them."""

    def __init__(self, constants: Iterable[str]) -> None:
        self._names = frozenset(constants)
        self._known: dict[Node, tuple[bool, bool]] = {}

    def __call__(self, node: Node) -> bool:
        """Whether it is a constant, but no number."""
        return self._look(node) == (True, True)

    def allows(self, node: Node) -> bool:
        """Whether it is a constant or a number."""
        return self._look(node)[0]

    def _look(self, node: Node) -> tuple[bool, bool]:
        known = self._known.get(node)
        if known is None:
            if node.is_leaf:
                is_name = isinstance(node.head, sp.Symbol) and node.head != DEGREE
                known = (not is_name or str(node.head) in self._names, is_name)
            else:
                inner = [self._look(n) for n in node.sources()]
                known = (all(i[0] for i in inner), any(i[1] for i in inner))
            self._known[node] = known
        return known


class Gathering(Rewriting):
    """Puts the constants of a sum, and those of a product, together."""

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
        return super().rewritten(node, parts)

    def _apart(self, values: Iterable[Value]) -> tuple[list[Value], list[Value]]:
        """The constants and numbers, and the others."""
        fixed, others = list[Value](), list[Value]()
        for value in values:
            (fixed if self.constant.allows(value.node) else others).append(value)
        return fixed, others


def hoisted(
    drafts: Sequence[Draft], constant: Constant, taken: Iterable[str]
) -> tuple[dict[Node, Named], tuple[Let, ...]]:
    """The constants that the drafts read, by name, and their bindings. taken: names that are not free."""
    read = sorted({node for draft in drafts for node in _constants_read(draft, constant)}, key=lambda n: n.place)
    given = {node: named for draft in reversed(drafts) for node, named in draft.names.items()}
    readers = _readers(drafts, constant)
    varying = {named.name.name for d in drafts for n, named in d.names.items() if not constant(n)}
    free = Names({*taken, *varying})
    names: dict[Node, Named] = {}

    def called(node: Node) -> sp.Symbol | None:
        return names[node].name if node in names else None

    inner = {n for top in read for n in _below(top) if n in given and not n.is_leaf}
    for order, node in enumerate(sorted({*read, *inner}, key=lambda n: n.place)):
        own = given.get(node)
        if own is not None:
            like = count(own.name.name) if is_count(own.name) else None
            names[node] = replace(own, name=free.fresh(own.name.name, like), order=order)
            continue
        proposal = said(Value(node, 1), called, readers.get(node, "constant"))
        names[node] = Named(free.fresh(proposal), 1, "", order)
    outputs = tuple(Output(named.name.name, named.name) for named in names.values())
    values = tuple(Value(node, named.sign) for node, named in names.items())
    program = written(Draft(Program("constants", (), (), outputs), [], values, dict(names)), {}, {*taken, *varying})
    return names, program.lets()


def _constants_read(draft: Draft, constant: Constant) -> set[Node]:
    """The largest constants that a draft reads: those that something else reads, or a statement."""
    found: set[Node] = set()
    seen: set[Node] = set()
    pending = [value.node for item in draft.items for value in read_values(item)]
    pending += [value.node for value in draft.outputs]
    while pending:
        node = pending.pop()
        if node in seen or node.is_leaf:
            continue
        seen.add(node)
        if constant(node) and not is_condition(node):
            found.add(node)
        else:
            pending += node.sources()
    return found


def _below(top: Node) -> Iterator[Node]:
    """What a node reads, whatever lies between."""
    seen: set[Node] = set()
    pending = list(top.sources())
    while pending:
        node = pending.pop()
        if node not in seen:
            seen.add(node)
            yield node
            pending += node.sources()


def _readers(drafts: Sequence[Draft], constant: Constant) -> dict[Node, str]:
    """The names of the values that read the constants first."""
    found: dict[Node, str] = {}
    for draft in drafts:
        for reader, named in draft.names.items():
            seen: set[Node] = set()
            pending = list(reader.sources())
            while pending:
                node = pending.pop()
                if node not in seen and node not in draft.names:
                    seen.add(node)
                    found.setdefault(node, named.name.name)
                    pending += node.sources()
    return found
