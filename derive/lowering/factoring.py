"""Factoring: where terms of a sum have a factor or a divisor in common, the sum is multiplied or divided by it once.

a * c / d + b * s / d    →  (a * c + b * s) / d
s * x - s * y + x        →  s * (x - y) + x

A divisor of three values or more is inverted, and the values are multiplied by its inverse.

along_x = span_x / length,  along_y = span_y / length,  along_z = span_z / length   →   inverse = 1 / length, …
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Sequence
from itertools import combinations
from typing import TypeAlias

import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.graph import PRODUCT, SUM, Graph, Node, Value
from derive.lowering.draft import Draft, Readers, Rewriting, changed, readers_of
from derive.lowering.hoisting import Constant

_ONE = sp.Integer(1)
WORTHWHILE = 3
"""The least number of quotients for which a divisor is inverted: a division takes as long as several
multiplications, but is rounded only once."""

Part = tuple[Node, bool]
"""A factor, or a divisor where the flag is set."""


class Factoring(Rewriting):
    """Takes the most common factor or divisor of the terms out of a sum, then repeats. A named value is one factor."""

    def __init__(self, graph: Graph, named: Collection[Node], is_constant: Callable[[Node], bool]) -> None:
        super().__init__(graph)
        self._named, self._is_constant = named, is_constant
        self._whole: set[Node] = set()
        """The nodes with a name, after the change."""

    def rewritten(self, node: Node, parts: tuple[Value, ...]) -> Value:
        """A sum with common factors in front."""
        is_open = node.head is SUM and not self._is_constant(node)
        value = self._factored(parts) if is_open else super().rewritten(node, parts)
        if node in self._named:
            self._whole.add(value.node)
        return value

    def _factored(self, terms: Sequence[Value]) -> Value:
        counts = Counter[Part]()
        for term in terms:
            counts.update(list(dict.fromkeys(self._parts(term.node))))
        best = max(counts, key=lambda part: (counts[part], part[1], -part[0].place), default=None)
        if best is None or counts[best] < 2:
            return self.graph.sum(terms)
        having = [t for t in terms if best in self._parts(t.node)]
        inner = self._factored([self._without(t, best) for t in having])
        common = Value(best[0], 1)
        first = self._times(inner, common, is_divisor=best[1])
        others = [t for t in terms if best not in self._parts(t.node)]
        return self._factored([first, *others]) if others else first

    def _without(self, term: Value, part: Part) -> Value:
        """A term without one of its factors or divisors."""
        factors, divisors = [f.node for f in term.node.parts], list(term.node.divisors)
        (divisors if part[1] else factors).remove(part[0])
        value = self.graph.product([Value(f, 1) for f in factors], [Value(d, 1) for d in divisors])
        return Value(value.node, value.sign * term.sign)

    def _times(self, inner: Value, common: Value, *, is_divisor: bool) -> Value:
        """A sum multiplied or divided by the common part of its terms, next to the factors that the sum itself has."""
        node = inner.node
        is_open = node.head is PRODUCT and node not in self._whole
        factors = [Value(f.node, 1) for f in node.parts] if is_open else [Value(node, 1)]
        divisors = [Value(d, 1) for d in node.divisors] if is_open else []
        (divisors if is_divisor else factors).append(common)
        value = self.graph.product(factors, divisors)
        return Value(value.node, value.sign * inner.sign)

    def _parts(self, node: Node) -> list[Part]:
        """The factors and the divisors of a term that is a product."""
        if node.head is not PRODUCT or node in self._whole:
            return []
        return [*((f.node, False) for f in node.parts), *((d, True) for d in node.divisors)]


class Dividing(Rewriting):
    """Multiplies by the inverse of a divisor that several values have."""

    def __init__(self, graph: Graph, nodes: Iterable[Node], is_constant: Callable[[Node], bool]) -> None:
        super().__init__(graph)
        quotients = [node for node in nodes if node.head is PRODUCT and not is_constant(node)]
        counts = Counter(d for node in quotients for d in set(node.divisors))
        self.inverted = {node for node, count in counts.items() if count >= WORTHWHILE and node.head != DEGREE}
        self._is_constant = is_constant

    def rewritten(self, node: Node, parts: tuple[Value, ...]) -> Value:
        """A product in which the inverses of such divisors are factors."""
        if node.head is not PRODUCT or self.inverted.isdisjoint(node.divisors) or self._is_constant(node):
            return super().rewritten(node, parts)
        one = self.graph.leaf(_ONE)
        factors, divisors = list(parts), list[Value]()
        for divisor in node.divisors:
            value = self(Value(divisor, 1))
            (factors if divisor in self.inverted else divisors).append(
                self.graph.product([one], [value]) if divisor in self.inverted else value
            )
        return self.graph.product(factors, divisors)


_Pair: TypeAlias = frozenset[Value]
"""Two terms, the first node with a plus."""


def opened(draft: Draft, graph: Graph, constant: Constant) -> Draft:
    """The draft with a sum that only one other sum reads merged into it, where terms of both then make a pair that is
    already computed: one addition less. No other sum is changed.

        first = x - a,   second = b + a,   third = x - second     →  third = first - b
    """
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


def collected(draft: Draft, graph: Graph, constant: Constant) -> Draft:
    """The draft in which the coefficients of one value in a sum are added: c * x + d * x  →  (c + d) * x. Only where
    that saves an operation: a product that something else reads is computed anyway.
    """
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
