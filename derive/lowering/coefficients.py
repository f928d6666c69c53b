"""Coefficients: the constants that multiply one value are added to one constant, and a constant in front of a sum is
multiplied into its terms.

    c * x + d * x                    →  (c + d) * x
    c * (d * x + f * y)              →  (c d) * x + (c f) * y
    c * select(p, d * x, f * y)      →  select(p, (c d) * x, (c f) * y)

Both only where that saves an operation: a value that something else reads is computed anyway.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

import sympy as sp

from derive.ir.graph import PRODUCT, SUM, Graph, Node, Value
from derive.ir.primitives import Select
from derive.ir.symbols import called
from derive.lowering.draft import Draft, Named, Readers, Rewriting, changed, readers_of
from derive.lowering.hoisting import Constant

_ONE = sp.Integer(1)


def collected(draft: Draft, graph: Graph, constant: Constant) -> Draft:
    """The draft in which the coefficients of one value in a sum are added."""
    return changed(draft, _Collecting(graph, constant, readers_of(draft)))


def distributed(draft: Draft, graph: Graph, constant: Constant) -> Draft:
    """The draft in which constants in front of sums are multiplied into the coefficients of their terms."""
    rule = _Distributing(graph, constant, readers_of(draft))
    done = changed(draft, rule)
    for node, value in rule.scaled.items():
        named = draft.names.get(node)
        if named is not None and value.node not in done.names and not value.node.is_leaf:
            name = called(f"scaled_{named.name.name}", named.name)
            done.names[value.node] = Named(name, named.sign * value.sign, named.note, named.order)
    return done


class _Coefficients:
    """Splits a product into its constant coefficient and the rest."""

    def __init__(self, graph: Graph, constant: Constant) -> None:
        self._graph, self._constant = graph, constant

    def split(self, node: Node) -> tuple[Value, Value] | None:
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

    def times(self, first: Node, second: Node) -> Value:
        """The product of two constants; a factor of one that is a divisor of the other cancels."""
        above, below = (Counter(n for node in (first, second) for n in side(node)) for side in (_above, _below))
        return self._product((above - below).elements(), (below - above).elements())

    def _apart(self, nodes: Iterable[Node]) -> tuple[list[Node], list[Node]]:
        fixed, others = list[Node](), list[Node]()
        for node in nodes:
            (fixed if self._constant.allows(node) else others).append(node)
        return fixed, others

    def _product(self, above: Iterable[Node], below: Iterable[Node]) -> Value:
        return self._graph.product((Value(n, 1) for n in above), (Value(n, 1) for n in below))


def _above(node: Node) -> list[Node]:
    return [part.node for part in node.parts] if node.head is PRODUCT else [node]


def _below(node: Node) -> list[Node]:
    return list(node.divisors) if node.head is PRODUCT else []


class _Collecting(Rewriting):
    """Adds the coefficients of a value that a sum holds more than once, if only this sum reads one of the products."""

    def __init__(self, graph: Graph, constant: Constant, readers: Readers) -> None:
        super().__init__(graph)
        self._constant, self._readers = constant, readers
        self._coefficients = _Coefficients(graph, constant)

    def rewritten(self, node: Node, parts: tuple[Value, ...]) -> Value:
        """A sum with one term for each value."""
        if node.head is not SUM or self._constant(node):
            return super().rewritten(node, parts)
        groups: dict[Node, list[tuple[Value, Value]]] = {}
        for before, term in zip(node.parts, parts, strict=True):
            coefficient, rest = self._coefficients.split(term.node) or (self.graph.leaf(_ONE), Value(term.node, 1))
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


class _Distributing(Rewriting):
    """Multiplies the coefficients of the terms of a sum, or of the sides of a choice, by the
    constant in front of it.
    """

    def __init__(self, graph: Graph, constant: Constant, readers: Readers) -> None:
        super().__init__(graph)
        self._constant, self._readers = constant, readers
        self._coefficients = _Coefficients(graph, constant)
        self.scaled: dict[Node, Value] = {}
        """The values that are no longer computed, each with the multiple that is computed instead."""

    def rewritten(self, node: Node, parts: tuple[Value, ...]) -> Value:
        """A product without its constant, where the constant is multiplied into a sum."""
        split = self._coefficients.split(node)
        if split is None or split[1].node.head not in (SUM, Select) or not self._constant(split[0].node):
            return super().rewritten(node, parts)
        (factor, sign), (inner, inner_sign) = split
        if not self._can_scale(inner, factor):
            return super().rewritten(node, parts)
        value = self._multiple(inner, factor)
        return Value(value.node, value.sign * sign * inner_sign)

    def _can_scale(self, start: Node, factor: Node) -> bool:
        """Whether only multiples by this factor read a value and its parts, and each part has a coefficient."""
        seen: set[Node] = set()
        pending = [start]
        while pending:
            node = pending.pop()
            if node in seen or self._constant.allows(node):
                continue
            seen.add(node)
            if node.head in (SUM, Select):
                pending += _scalable(node)
            elif self._coefficients.split(node) is None:
                return False
            for reader in self._readers.get(node, ()):
                if reader is not None and reader.head in (SUM, Select) and node in _scalable(reader):
                    pending.append(reader)
                elif reader is None or not self._is_multiple(reader, node, factor):
                    return False
        return True

    def _is_multiple(self, reader: Node, node: Node, factor: Node) -> bool:
        split = self._coefficients.split(reader)
        return split is not None and split[0].node is factor and split[1].node is node

    def _multiple(self, node: Node, factor: Node) -> Value:
        if self._constant.allows(node):
            return self._coefficients.times(factor, node)
        if node not in self.scaled:
            self.scaled[node] = self._scaled(node, factor)
        return self.scaled[node]

    def _scaled(self, node: Node, factor: Node) -> Value:
        split = self._coefficients.split(node)
        if split is not None:
            (own, _), (rest, _) = split
            return self.graph.product([self._coefficients.times(factor, own), self(Value(rest, 1))])
        multiples = [self._multiple(n, factor) for n in _scalable(node)]
        signed = [Value(m.node, m.sign * p.sign) for m, p in zip(multiples, node.parts[-len(multiples) :], strict=True)]
        return self.graph.sum(signed) if node.head is SUM else self.graph.apply(Select, [self(node.parts[0]), *signed])


def _scalable(node: Node) -> list[Node]:
    """The terms of a sum, the sides of a choice."""
    return [part.node for part in (node.parts if node.head is SUM else node.parts[1:])]
