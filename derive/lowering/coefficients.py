"""Coefficients: the constants that multiply one value in a sum are added to one constant.

    c * x + d * x  →  (c + d) * x

Only where that saves an operation: a product that something else reads is computed anyway.
"""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp

from derive.ir.graph import PRODUCT, SUM, Graph, Node, Value
from derive.lowering.draft import Draft, Readers, Rewriting, changed, readers_of
from derive.lowering.hoisting import Constant

_ONE = sp.Integer(1)


def collected(draft: Draft, graph: Graph, constant: Constant) -> Draft:
    """The draft in which the coefficients of one value in a sum are added."""
    return changed(draft, _Collecting(graph, constant, readers_of(draft)))


class _Collecting(Rewriting):
    """Adds the coefficients of a value that a sum holds more than once, if only this sum reads one of the products."""

    def __init__(self, graph: Graph, constant: Constant, readers: Readers) -> None:
        super().__init__(graph)
        self._constant, self._readers = constant, readers

    def rewritten(self, node: Node, parts: tuple[Value, ...]) -> Value:
        """A sum with one term for each value."""
        if node.head is not SUM or self._constant(node):
            return super().rewritten(node, parts)
        groups: dict[Node, list[tuple[Value, Value]]] = {}
        for before, term in zip(node.parts, parts, strict=True):
            coefficient, rest = self._split(term.node) or (self.graph.leaf(_ONE), Value(term.node, 1))
            sign = term.sign * coefficient.sign * rest.sign
            groups.setdefault(rest.node, []).append((before, Value(coefficient.node, sign)))
        if len(groups) == len(parts):
            return super().rewritten(node, parts)
        together = dict(zip(node.parts, parts, strict=True))
        return self.graph.sum(v for rest, terms in groups.items() for v in self._terms(rest, terms, together))

    def _terms(self, rest: Node, terms: list[tuple[Value, Value]], together: dict[Value, Value]) -> list[Value]:
        total = self.graph.sum(coefficient for _, coefficient in terms)
        is_saved = any(len(self._readers.get(before.node, ())) == 1 and before.node is not rest for before, _ in terms)
        if len(terms) > 1 and is_saved and (self._constant(total.node) or total.node.is_number):
            return [self.graph.product([total, Value(rest, 1)])]
        return [together[before] for before, _ in terms]

    def _split(self, node: Node) -> tuple[Value, Value] | None:
        """The coefficient, with the numbers in it, and the value that it multiplies; None for a constant, and where the
        node is no product.
        """
        if node.head is not PRODUCT or self._constant.allows(node):
            return None
        fixed, others = self._apart(part.node for part in node.parts)
        fixed_below, others_below = self._apart(node.divisors)
        if not fixed and not fixed_below:
            return None
        return self._product(fixed, fixed_below), self._product(others, others_below)

    def _apart(self, nodes: Iterable[Node]) -> tuple[list[Node], list[Node]]:
        fixed, others = list[Node](), list[Node]()
        for node in nodes:
            (fixed if self._constant.allows(node) else others).append(node)
        return fixed, others

    def _product(self, above: Iterable[Node], below: Iterable[Node]) -> Value:
        return self.graph.product((Value(n, 1) for n in above), (Value(n, 1) for n in below))
