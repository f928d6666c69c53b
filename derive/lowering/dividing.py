"""Dividing once: what divides three values or more is inverted, and they are multiplied by its inverse.

along_x = span_x / length,  along_y = span_y / length,  along_z = span_z / length   →   inverse = 1 / length, …
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable

import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.graph import PRODUCT, Graph, Node, Value
from derive.lowering.draft import Rewriting

_ONE = sp.Integer(1)
WORTHWHILE = 3
"""A division takes as long as several multiplications, but a quotient of two is one rounding."""


class Dividing(Rewriting):
    """Multiplies by the inverse of what divides several values."""

    def __init__(self, graph: Graph, nodes: Iterable[Node], is_constant: Callable[[Node], bool]) -> None:
        super().__init__(graph)
        quotients = [node for node in nodes if node.head is PRODUCT and not is_constant(node)]
        counts = Counter(d for node in quotients for d in set(node.divisors))
        self.inverted = {node for node, count in counts.items() if count >= WORTHWHILE and node.head != DEGREE}
        self._is_constant = is_constant

    def rewritten(self, node: Node, parts: tuple[Value, ...]) -> Value:
        """A product with such divisors as factors."""
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
