"""Opening: a sum that only one other sum reads is merged into it, where terms of both then make a pair that is already
computed.

    first = x - a,   second = b + a,   third = x - second     →  third = first - b

This saves one addition, because `second` is not computed. No other sum is changed: terms stay in the sums in which they
were written.
"""

from __future__ import annotations

from itertools import combinations
from typing import TypeAlias

from derive.ir.graph import SUM, Graph, Node, Value
from derive.lowering.draft import Draft, Readers, Rewriting, changed, readers_of
from derive.lowering.hoisting import Constant

_Pair: TypeAlias = frozenset[Value]
"""Two terms, the first node with a plus."""


def opened(draft: Draft, graph: Graph, constant: Constant) -> Draft:
    """The draft with such sums merged into those that read them."""
    return changed(draft, _Opening(graph, constant, readers_of(draft)))


class _Opening(Rewriting):
    def __init__(self, graph: Graph, constant: Constant, readers: Readers) -> None:
        super().__init__(graph)
        self._constant, self._readers = constant, readers
        self._pairs = {p for node in readers if self._is_sum(node) for p in _pairs(node.parts)}

    def rewritten(self, node: Node, parts: tuple[Value, ...]) -> Value:
        """A sum into which such parts are merged."""
        if not self._is_sum(node):
            return super().rewritten(node, parts)
        terms: list[Value] = []
        for before, term in zip(node.parts, parts, strict=True):
            terms += self._opened(before, node) or [term]
        return self.graph.sum(terms)

    def _opened(self, term: Value, reader: Node) -> list[Value]:
        """The terms of a part, with the sign of the part; none if the part stays."""
        if not self._is_sum(term.node) or len(self._readers.get(term.node, ())) != 1:  # a named part may be unread
            return []
        inner = [Value(t.node, t.sign * term.sign) for t in term.node.parts]
        others = [t for t in reader.parts if t is not term]
        if any(_pair(one, other) in self._pairs for one in inner for other in others):
            return [self(t) for t in inner]
        return []

    def _is_sum(self, node: Node) -> bool:
        return node.head is SUM and not self._constant(node)


def _pairs(terms: tuple[Value, ...]) -> list[_Pair]:
    return [
        _pair(one, other) for one, other in combinations(terms, 2) if not (one.node.is_number or other.node.is_number)
    ]


def _pair(one: Value, other: Value) -> _Pair:
    first, second = sorted((one, other), key=lambda v: v.node.place)
    return frozenset((Value(first.node, 1), Value(second.node, first.sign * second.sign)))
