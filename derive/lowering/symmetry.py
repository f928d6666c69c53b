"""Symmetry: a value that follows from another one by a change of sign or by half a turn is not computed again.

    c_up = select(r > tolerance, -x/r, cos(free))     where r > tolerance, c_up is -c_down
    m_up = a * c_up + b * s_up                     →  m_up = select(r > tolerance, -m_down, a * c_up + b * s_up)
    axis_up = shift + atan2(m_up, n_up)/DEGREE     →  axis_up = select(r > tolerance, axis_down + 180, shift + …)

    angle_up = atan2(-s, c)                        →  angle_up = -angle_down    where angle_down = atan2(s, c)

The condition of a choice is assumed to hold; then each node is compared with those before it. A direction is first
mirrored into one quadrant, so that mirrored and opposite directions have the same angle but for a sign and half a turn.
The rule serves a language that computes only one side of a choice.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.graph import PRODUCT, SUM, Graph, Node, Value, reached
from derive.ir.primitives import Atan2, NearestPeriod, Select, Wrap
from derive.lowering.draft import Rewriting
from derive.lowering.writing import is_condition

_HALF = 180
_NONE = sp.Integer(0)
"""No shift: compared by identity, for nearly nothing is shifted."""


class Mirrored(Rewriting):
    """Moves the minus sign of a sine in front of the angle, unless something takes the value of the angle."""

    def __init__(self, graph: Graph, nodes: Iterable[Node]) -> None:
        super().__init__(graph)
        self._counted = set(reached(node for node in nodes if node.head is Wrap))

    def rewritten(self, node: Node, parts: tuple[Value, ...]) -> Value:
        """An angle with a sine that has no minus sign."""
        if node.head is not Atan2 or node in self._counted or parts[0].sign > 0:
            return super().rewritten(node, parts)
        return -self.graph.apply(Atan2, (-parts[0], parts[1]))


class Symmetry(Rewriting):
    """Replaces named values, and angles whose turn is chosen, by those of mirrored branches: everywhere, or on the
    first side of a choice.
    """

    def __init__(self, graph: Graph, starts: Sequence[Node], named: Iterable[Node]) -> None:
        """starts: what the statements and the outputs of a draft read, in order; named: the nodes that have a name."""
        super().__init__(graph)
        counted = set(reached(node for node in reached(starts) if node.head is Wrap))
        always = _always_needed(starts)
        turned = {node.parts[0].node for node in always if node.head is NearestPeriod}
        first = _first_readers(starts)
        wanted = (node for node in always & {*named, *turned} if not is_condition(node))
        candidates = sorted(wanted, key=lambda node: (first[node], node.place))
        conditions = {node.parts[0].node for node in always if node.head is Select}
        always_so, deciding = Assumed(graph, None, counted), _deciding(candidates)
        assumed = (Assumed(graph, c, counted, (always_so, deciding)) for c in sorted(conditions, key=lambda n: n.place))
        found = [_equals(candidates, where) for where in assumed]
        found.sort(key=len)  # of several conditions, the one that gives most values
        everywhere = _equals(candidates, always_so)
        self._equals = {node: equal for part in (*found, everywhere) for node, equal in part.items()}

    def rewritten(self, node: Node, parts: tuple[Value, ...]) -> Value:
        """The choice between the value that another node gives, and the node itself."""
        own = super().rewritten(node, parts)
        equal = self._equals.get(node)
        if equal is None:
            return own
        other = self(equal.other)
        if equal.shift != 0:
            other = self.graph.sum([other, _number(self.graph, equal.shift)])
        if equal.condition is None:
            return other
        return self.graph.apply(Select, (self(Value(equal.condition, 1)), other, own))


@dataclass(frozen=True)
class _Equal:
    """Where a condition holds, or everywhere, a node equals another one but for a sign and perhaps half a turn."""

    condition: Node | None
    other: Value
    shift: sp.Expr


class Assumed(Rewriting):
    """Values under the assumption of a condition; an angle is a value plus a shift, which is a number of half turns."""

    def __init__(
        self,
        graph: Graph,
        condition: Node | None,
        counted: Iterable[Node],
        elsewhere: tuple[Assumed, Mapping[Node, frozenset[Node]]] | None = None,
    ) -> None:
        """counted: the nodes that take the value of an angle, which may not be a turn more or less; elsewhere: the
        values where nothing is assumed, and for each node the conditions of the choices in it.
        """
        super().__init__(graph)
        self.condition, self._counted, self._elsewhere = condition, frozenset(counted), elsewhere
        self._shifts: dict[Node, sp.Expr] = {}

    def known(self, node: Node) -> Value | None:
        """The value without the assumption, of a node that the condition does not affect."""
        if self._elsewhere is None or self.condition in self._elsewhere[1][node]:
            return None
        value, shift = self._elsewhere[0](Value(node, 1)), self._elsewhere[0].shift(Value(node, 1))
        if shift is not _NONE:
            self._shifts[node] = shift
        return value

    def shift(self, value: Value) -> sp.Expr:
        """The shift that has to be added to the assumed value."""
        found = self._shifts.get(value.node)
        return _NONE if found is None else value.sign * found

    def rewritten(self, node: Node, parts: tuple[Value, ...]) -> Value:
        """The value without its shift."""
        value, shift = self._apart(node, parts)
        if shift is not _NONE and shift != 0:
            self._shifts[node] = shift
        return value

    def _apart(self, node: Node, parts: tuple[Value, ...]) -> tuple[Value, sp.Expr]:
        shifts = [self.shift(part) for part in node.parts]
        is_shifted = any(shift is not _NONE for shift in shifts)
        if node.head is Select and node.parts[0].node is self.condition:
            return parts[1], shifts[1]
        if node.head is Select and not is_shifted:
            sign = next((side.sign for side in parts[1:] if side.node.head != 0), 1)
            sides = (side if side.node.head == 0 else Value(side.node, sign * side.sign) for side in parts[1:])
            value = self.graph.apply(Select, (parts[0], *sides))
            return Value(value.node, sign * value.sign), _NONE
        if node.head is Atan2 and node not in self._counted:
            sine, cosine = parts
            value = self.graph.apply(Atan2, (Value(sine.node, 1), Value(cosine.node, 1)))
            away = _HALF * DEGREE if cosine.sign < 0 else _NONE
            return Value(value.node, value.sign * sine.sign * cosine.sign), away
        if not is_shifted:
            return super().rewritten(node, parts), _NONE
        if node.head is SUM:
            return super().rewritten(node, parts), sp.Add(*shifts)
        if node.head is PRODUCT and all(n.is_number or n.head == DEGREE or n in self._shifts for n in node.read):
            factors = [s if s != 0 else p.sign * p.node.head for s, p in zip(shifts, node.parts, strict=True)]
            if sum(s != 0 for s in shifts) == 1:
                away = sp.Mul(*factors) / sp.Mul(*(d.head for d in node.divisors))
                return super().rewritten(node, parts), away
        whole = [
            p if s == 0 else self.graph.sum([p, _number(self.graph, s)]) for p, s in zip(parts, shifts, strict=True)
        ]
        return super().rewritten(node, tuple(whole)), _NONE


def _deciding(starts: Iterable[Node]) -> dict[Node, frozenset[Node]]:
    """For every node that is read: the conditions of the choices in it."""
    found: dict[Node, frozenset[Node]] = {}
    for node in sorted(reached(starts), key=lambda n: n.place):
        own = (node.parts[0].node,) if node.head is Select else ()
        found[node] = frozenset(own).union(*(found[n] for n in node.read))
    return found


def _equals(candidates: Iterable[Node], assumed: Assumed) -> dict[Node, _Equal]:
    """The nodes that follow from an earlier node under an assumption."""
    found: dict[Node, _Equal] = {}
    first: dict[Node, tuple[Node, int, sp.Expr]] = {}
    condition = assumed.condition
    for node in candidates:
        value, shift = assumed(Value(node, 1)), assumed.shift(Value(node, 1))
        if value.node.is_leaf:
            continue
        other, sign, away = first.setdefault(value.node, (node, value.sign, shift))
        is_decided = node.head is Select and node.parts[0].node is condition
        if other is not node and not is_decided and (condition is None or value.node is not node):
            sign *= value.sign
            found[node] = _Equal(condition, Value(other, sign), _modulo_turns(shift - sign * away))
    return found


def _first_readers(starts: Iterable[Node]) -> dict[Node, int]:
    """For every node that is read: the place of the first start that needs it.

    The nodes that a node reads have no later place. So a node may follow from another with an earlier place, or from
    one with the same place that was made before it.
    """
    found: dict[Node, int] = {}
    for place, start in enumerate(starts):
        for node in list(reached([start], found.__contains__)):
            found.setdefault(node, place)
    return found


def _always_needed(starts: Iterable[Node]) -> set[Node]:
    """The nodes that are read outside of choices: a node that only one side of a choice reads gives no other node."""
    found: set[Node] = set()
    pending = list(starts)
    while pending:
        node = pending.pop()
        if node not in found:
            found.add(node)
            pending += (node.parts[0].node,) if node.head is Select else node.read
    return found


def _number(graph: Graph, shift: sp.Expr) -> Value:
    """Half turns as a value, in degrees or in radians."""
    degrees, is_radian = (shift / DEGREE, True) if shift.has(DEGREE) else (shift, False)
    value = graph.leaf(degrees)
    return graph.product([value, graph.leaf(DEGREE)]) if is_radian else value


def _modulo_turns(shift: sp.Expr) -> sp.Expr:
    unit = DEGREE if shift.has(DEGREE) else sp.Integer(1)
    return sp.Mod(shift / unit, 2 * _HALF) * unit
