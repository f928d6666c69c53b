"""Values as a graph: each value is one node, whatever names it has in a program.

    (b - a) / d   and   (a - b) * c / d       one node for a - b, read with a minus sign by the first

Nodes are hash-consed: equal operations on equal parts are the same node. A minus sign is no node: it stands beside the
node that is read, and the sign in front of a sum or of a product is moved to its reader. So a value and its negative
are one node, and the cosine of an angle and of its negative are one node, too. The order of terms does not matter.
Nothing is expanded, and nothing is factored.

Names, notes and statements are not part of the graph: see `derive.lowering.draft` and `writing`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import sympy as sp

from derive.ir.primitives import Select, ToReal
from derive.ir.symbols import is_count, is_decided

SUM, PRODUCT = sp.Add, sp.Mul
Head = Any
"""A name or a positive number; or the operation on the parts: `SUM`, `PRODUCT`, a primitive, a comparison, AND, OR."""
_EVEN = (sp.cos, sp.Abs)
ODD = (sp.sin, ToReal)
"""The odd functions: f(-x) = -f(x)."""


@dataclass(frozen=True, eq=False, slots=True)
class Node:
    """A value: `place` is larger than those of its parts."""

    place: int
    head: Head
    parts: tuple[Value, ...] = ()
    """Terms, factors (whose signs are +1) or arguments."""
    divisors: tuple[Node, ...] = ()
    """The divisors of a product."""

    @property
    def is_leaf(self) -> bool:
        """Whether it is a name or a number."""
        return not self.parts and not self.divisors

    is_number: bool = False
    """Whether it is a number."""
    is_whole: bool = False
    """Whether it is an integer, by the types of its names. Stored, because a shared node is reached many times."""
    read: tuple[Node, ...] = ()
    """The nodes that it reads. Stored, because every pass asks for them."""


class Value(NamedTuple):
    """A node, and whether it is read with a minus sign."""

    node: Node
    sign: int

    def __neg__(self) -> Value:
        return Value(self.node, -self.sign)


@dataclass
class Graph:
    """All nodes that have been made, by operation and parts."""

    nodes: list[Node] = field(default_factory=list)
    _known: dict[object, Node] = field(default_factory=dict)

    def leaf(self, head: sp.Basic) -> Value:
        """A name, a truth value, or the absolute value of a number with its sign beside it."""
        if isinstance(head, sp.Number) and head.is_negative:
            return Value(self._node(-head, -head), -1)
        return Value(self._node(head, head), 1)

    def sum(self, terms: Iterable[Value]) -> Value:
        """The sum; equal terms are counted, opposite ones cancel, numbers are added."""
        number, counts = sp.S.Zero, dict[Node, int]()
        for node, sign in terms:
            if node.is_number:
                number += sign * node.head
            else:
                counts[node] = counts.get(node, 0) + sign
        kept = [self._times(count, node) for node, count in counts.items() if count]
        kept += [] if number.is_zero else [self.leaf(number)]
        if len(kept) < 2:
            return kept[0] if kept else self.leaf(number)
        sign = min(kept, key=lambda v: v.node.place).sign
        signed = tuple(Value(v.node, sign * v.sign) for v in kept)
        return Value(self._node((SUM, frozenset(signed)), SUM, signed), sign)

    def product(self, factors: Iterable[Value], divisors: Iterable[Value] = ()) -> Value:
        """The product of factors over the product of divisors; numbers are multiplied, and signs
        moved to the reader.
        """
        number, sign = sp.S.One, 1
        above, below = list[Node](), list[Node]()
        for value, side in (*((f, above) for f in factors), *((d, below) for d in divisors)):
            sign *= value.sign
            if value.node.is_number:
                number *= value.node.head if side is above else 1 / value.node.head
            else:
                side.append(value.node)
        if number.is_zero:
            return self.leaf(sp.S.Zero)
        if number is not sp.S.One:
            above.insert(0, self.leaf(number).node)
        if not below and len(above) < 2:
            return Value(above[0], sign) if above else self.leaf(sp.Integer(sign))
        key = PRODUCT, *(tuple(sorted(node.place for node in side)) for side in (above, below))
        return Value(self._node(key, PRODUCT, tuple(Value(f, 1) for f in above), tuple(below)), sign)

    def apply(self, head: type[sp.Basic], arguments: Sequence[Value]) -> Value:
        """A primitive, a comparison, AND or OR of its arguments; conditions whose truth is known are left out."""
        parts = tuple(arguments)
        if head is Select:
            return self._choice(*parts)
        if head in _EVEN or head in ODD:
            sign = parts[0].sign if head in ODD else 1
            return Value(self._called(head, (Value(parts[0].node, 1),)).node, sign)
        return self._called(head, parts)

    def _called(self, head: type[sp.Basic], parts: tuple[Value, ...]) -> Value:
        if all(p.node.is_number or is_decided(p.node.head) for p in parts):
            decided = head(*(p.sign * p.node.head if p.node.is_number else p.node.head for p in parts))
            if is_decided(decided) or isinstance(decided, sp.Rational | sp.Float):
                return self.leaf(decided)
        if issubclass(head, sp.And | sp.Or):
            return self._logic(head, parts)
        return Value(self._node((head, parts), head, parts), 1)

    def _logic(self, head: type[sp.Basic], parts: Sequence[Value]) -> Value:
        decides, idle = (sp.false, sp.true) if issubclass(head, sp.And) else (sp.true, sp.false)
        kept = tuple(dict.fromkeys(p for p in parts if p.node.head != idle))
        if any(p.node.head == decides for p in kept):
            return self.leaf(decides)
        if len(kept) < 2:
            return kept[0] if kept else self.leaf(idle)
        return Value(self._node((head, frozenset(kept)), head, kept), 1)

    def _choice(self, condition: Value, first: Value, second: Value) -> Value:
        if is_decided(condition.node.head):
            return first if condition.node.head == sp.true else second
        if first == second:
            return first
        sign = -1 if first.sign < 0 and (second.sign < 0 or second.node.head == 0) else 1
        parts = condition, Value(first.node, sign * first.sign), Value(second.node, sign * second.sign)
        if second.node.head == 0:
            parts = (*parts[:2], Value(second.node, 1))
        return Value(self._node((Select, parts), Select, parts), sign)

    def _times(self, count: int, node: Node) -> Value:
        return Value(node, count) if abs(count) == 1 else self.product([self.leaf(sp.Integer(count)), Value(node, 1)])

    def _node(self, key: object, head: Head, parts: tuple[Value, ...] = (), divisors: tuple[Node, ...] = ()) -> Node:
        known = self._known.get(key)
        if known is None:
            read = (*(part.node for part in parts), *divisors)
            known = self._known[key] = Node(
                len(self.nodes),
                head,
                parts,
                divisors,
                is_number=isinstance(head, sp.Number),
                is_whole=_is_whole(head, parts) if read else is_count(head),
                read=read,
            )
            self.nodes.append(known)
        return known


def reached(starts: Iterable[Node], is_end: Callable[[Node], bool] = lambda _: False) -> Iterator[Node]:
    """These nodes and all nodes that they read, each once; the search stops at nodes for which `is_end` holds."""
    seen: set[Node] = set()
    pending = list(starts)
    while pending:
        node = pending.pop()
        if node not in seen:
            seen.add(node)
            yield node
            pending += () if is_end(node) else node.read


def _is_whole(head: Head, parts: Iterable[Value]) -> bool:
    return head in (SUM, PRODUCT, sp.Abs, Select) and any(part.node.is_whole for part in parts)
