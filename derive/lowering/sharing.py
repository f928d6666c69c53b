"""Sharing: two terms that several sums have in common are added once; two factors that several products have in common
are multiplied once.

    first = x + y - a,       second = x + y + b        →  x_plus_y = x + y, once
    first = a * b / c,       second = b * d / c        →  b_by_c = b / c, once

A product that is a term of several sums is one node, and needs no rule.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from derive.ir.graph import PRODUCT, SUM, Graph, Node, Value
from derive.lowering.draft import Rewriting


@dataclass(frozen=True)
class Pair:
    """Two terms, the second with its sign relative to the first; or two factors, the second possibly a divisor."""

    first: Part
    second: Part
    sign: int
    place: int


Part = Node | Pair
Entry = tuple[Part, int]
"""A term with its sign; or a factor with +1, or a divisor with -1."""


class Sharing(Rewriting):
    """Rewrites sums and products by the pairs that they have in common, the most common first."""

    def __init__(self, graph: Graph, nodes: Iterable[Node], is_constant: Callable[[Node], bool]) -> None:
        super().__init__(graph)
        wanted = sorted((n for n in set(nodes) if not is_constant(n)), key=lambda n: n.place)
        self._rows: dict[Node, list[Entry]] = {}
        for head in (SUM, PRODUCT):
            self._rows |= _paired({n: _entries(n) for n in wanted if n.head is head}, is_sum=head is SUM)

    def rewritten(self, node: Node, parts: tuple[Value, ...]) -> Value:
        """The sum or product of its entries."""
        row = self._rows.get(node)
        return super().rewritten(node, parts) if row is None else self._joined(row, node.head is SUM)

    def _joined(self, row: Sequence[Entry], is_sum: bool) -> Value:
        values = [(self._value(part, is_sum), sign) for part, sign in row]
        if is_sum:
            return self.graph.sum(Value(v.node, v.sign * sign) for v, sign in values)
        return self.graph.product([v for v, side in values if side > 0], [v for v, side in values if side < 0])

    def _value(self, part: Part, is_sum: bool) -> Value:
        if isinstance(part, Node):
            return self(Value(part, 1))
        return self._joined([(part.first, 1), (part.second, part.sign)], is_sum)


def _entries(node: Node) -> list[Entry]:
    return [*((p.node, p.sign) for p in node.parts), *((d, -1) for d in node.divisors)]


def _paired(rows: dict[Node, list[Entry]], *, is_sum: bool) -> dict[Node, list[Entry]]:
    """The rows with pairs instead of entries, as long as two rows have a pair in common."""
    place = max((n.place for n in rows), default=0)
    while True:
        readers: dict[tuple[Part, Part, int], list[Node]] = {}
        for node, row in rows.items():
            for key, _ in dict.fromkeys(_pairs(row, is_sum)):
                readers.setdefault(key, []).append(node)
        common = sorted(
            ((key, nodes) for key, nodes in readers.items() if len(nodes) > 1),
            key=lambda item: (-len(item[1]), _place(item[0][0]), _place(item[0][1])),
        )
        if not common:
            return rows
        touched: set[Node] = set()
        for key, nodes in common:
            if touched.isdisjoint(nodes):
                touched.update(nodes)
                place += 1
                whole = next((n for n in nodes if len(rows[n]) == 2), None)
                for node in nodes:
                    if node is not whole:
                        rows[node] = _replaced(rows[node], key, whole or Pair(*key, place), is_sum, rows)


def _place(part: Part) -> int:
    return part.place


def _pairs(row: Sequence[Entry], is_sum: bool) -> Iterator[tuple[tuple[Part, Part, int], int]]:
    """The pairs of entries of a row, each with the sign that it has there."""
    for one, other in combinations(row, 2):
        if any(isinstance(p, Node) and p.is_number for p, _ in (one, other)):
            continue
        (first, sign), (second, other_sign) = sorted((one, other), key=lambda e: e[0].place)
        if not is_sum and sign < 0 < other_sign:
            (first, sign), (second, other_sign) = (second, other_sign), (first, sign)
        yield (first, second, sign * other_sign), sign


def _replaced(
    row: Sequence[Entry], key: tuple[Part, Part, int], part: Part, is_sum: bool, rows: dict[Node, list[Entry]]
) -> list[Entry]:
    """The row with a part instead of a pair of entries."""
    sign = next(s for k, s in _pairs(row, is_sum) if k == key)
    kept = list(row)
    kept.remove((key[0], sign))
    kept.remove((key[1], sign * key[2]))
    if isinstance(part, Node):  # a row that is this pair alone: the row may be the negative of the pair
        own = next(s for k, s in _pairs(rows[part], is_sum) if k == key)
        sign *= own
    return [(part, sign), *kept]
