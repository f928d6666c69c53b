"""Long statements: a sum that takes many lines to write is a sum of shorter ones.

    v = t1 + t2 + ... + t90    →    p1 = t1 + ... + t30;  p2 = t31 + ... + t60;  v = p1 + p2 + t61 + ... + t90

The graph only groups the terms here; `writing` gives a name to each part of a value that is too long to be written out.
"""

from __future__ import annotations

from collections.abc import Mapping

from derive.ir.graph import SUM, Graph, Node, Value
from derive.lowering.draft import Draft, Named, Readers, Rewriting, changed, readers_of

LONGEST = 300
"""The most letters that a statement writes out, more or less: languages spell names differently."""
SHORT = 40
"""A part of at most so many letters gets no name for its length: the name would take as many."""
_OPERATOR = 2
_NEW_NAME = 20 + _OPERATOR
"""The letters of a name that is not yet made."""


def cut(draft: Draft, graph: Graph, constants: Mapping[Node, Named]) -> Draft:
    """The draft in which no sum has more terms than a statement can write out."""
    return changed(draft, _Cutting(graph, draft, constants, readers_of(draft)))


class _Cutting(Rewriting):
    """Groups neighbouring terms of sums."""

    def __init__(self, graph: Graph, draft: Draft, constants: Mapping[Node, Named], readers: Readers) -> None:
        super().__init__(graph)
        self._names, self._constants, self._readers = {**draft.names, **constants}, constants, readers
        self._lengths: dict[Node, int] = {}
        """What is written out for a node by itself, at most `LONGEST`."""

    def known(self, node: Node) -> Value | None:
        """A constant as it is: the setup computes it."""
        return Value(node, 1) if node in self._constants else None

    def rewritten(self, node: Node, parts: tuple[Value, ...]) -> Value:
        """The sum of groups of terms, none of which is too long."""
        terms = [self._length(part.node) for part in node.parts]
        whole = sum(terms) + sum(self._length(divisor) for divisor in node.divisors)
        self._lengths[node] = min(whole, LONGEST)
        if node.head is not SUM or whole <= LONGEST or len(parts) < 3:
            return super().rewritten(node, parts)
        groups, length = [[parts[0]]], terms[0]
        for part, more in zip(parts[1:], terms[1:], strict=True):
            length += more
            if length > LONGEST:
                groups.append([])
                length = more
            groups[-1].append(part)
        return self.graph.sum(map(self.graph.sum, groups))

    def _length(self, node: Node) -> int:
        if len(self._readers.get(node, ())) > 1:
            return letters(node, self._names) or _NEW_NAME
        return letters(node, self._names) or self._lengths[node]


def letters(node: Node, names: Mapping[Node, Named]) -> int:
    """The letters that a name or a number takes, with an operator; 0 for what is neither."""
    if node in names:
        return len(names[node].name.name) + _OPERATOR
    return len(str(node.head)) + _OPERATOR if node.is_leaf else 0
