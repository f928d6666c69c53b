"""Unrolling: all branches of a program in one straight line, by substitution of +1 and -1 for each sign in the graph.

    a = root(x)                             a = root(x)                   reads no sign
    s = a * sigma_elbow             →       s_right = a, s_left = -a      no node of its own
    b = s + y                               b_right = y + a, b_left = y - a
    require(b > 0, UNREACHABLE)             refusal_right = 0, or the number of the status; likewise refusal_left

Nodes are hash-consed: a value that two branches have in common is one node, and so are a value and its negative. A
condition that depends on no sign stays a condition: it refuses all branches alike. Programs are total, so that a
refused branch disturbs no other.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby

import sympy as sp

from derive.ir.graph import Graph, Node, Value, reached
from derive.ir.passes import renamed
from derive.ir.primitives import Select
from derive.ir.program import Output, Program, Require, Solve, Status
from derive.ir.symbols import REFUSAL, Choice, Names, Sign, choices, count, suffixed
from derive.ir.verify import BrokenProgram
from derive.lowering.draft import Draft, Effect, Named, Reader, Rewriting
from derive.lowering.writing import written

_ZERO = sp.Integer(0)


def is_straight(program: Program) -> bool:
    """Whether a program can be unrolled: one with an iteration cannot, which takes longer on some branches; nor can a
    program with a call, whose names belong to the shared program.
    """
    return all(s.is_straight for s in program.body)


def unroll(program: Program, signs: Sequence[Sign]) -> Program:
    """All branches at once. The outputs are those of every slot, with its `REFUSAL`; each name ends in the words of its
    slot.
    """
    reader = Reader()
    return written(unrolled(reader.draft(program), reader.graph, signs), {})


def unrolled(draft: Draft, graph: Graph, signs: Sequence[Sign]) -> Draft:
    """The draft of all branches: see `unroll`."""
    if not is_straight(draft.program):
        raise BrokenProgram("what iterates or is shared is not unrolled")
    return _Unrolling(draft, graph, tuple(signs)).draft()


class Substituted(Rewriting):
    """Replaces some names by other values."""

    def __init__(self, graph: Graph, values: Mapping[sp.Basic, Value]) -> None:
        super().__init__(graph)
        self.values = dict(values)

    def rewritten(self, node: Node, parts: tuple[Value, ...]) -> Value:
        """The value in place of a name, or the node made of its changed parts."""
        return self.values.get(node.head, Value(node, 1)) if node.is_leaf else super().rewritten(node, parts)


@dataclass(frozen=True)
class _Refusal:
    """The refusal so far: that of every slot, and the signs on which it depends. `status`: the only status that occurs,
    OK where several occur.
    """

    support: tuple[int, ...]
    values: Mapping[Choice, Value]
    status: Status | None


@dataclass
class _Unrolling:
    source: Draft
    graph: Graph
    signs: tuple[Sign, ...]
    names: dict[Node, Named] = field(default_factory=dict)
    items: list[Effect] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.slots = sorted(choices(len(self.signs)), reverse=True)  # keeps slots that share values together
        self.free = Names(s.name for s in self.source.program.inputs)
        self.at: dict[Choice, Substituted] = {}
        for slot in self.slots:
            known = {s.symbol: self.graph.leaf(sp.Integer(v)) for s, v in zip(self.signs, slot, strict=True)}
            self.at[slot] = Substituted(self.graph, known)
        self._supports: dict[Node, frozenset[int]] = {}
        self._of_names = {sign.symbol: frozenset({index}) for index, sign in enumerate(self.signs)}

    def draft(self) -> Draft:
        """The draft of all branches."""
        places = [place for place, s in enumerate(self.source.program.body) if s.bound() == () or isinstance(s, Solve)]
        found = [(place, i) for place, i in zip(places, self.source.items, strict=True) if isinstance(i, Effect)]
        for _, effect in (e for e in found if isinstance(e[1].statement, Solve)):
            self._solve(effect)
        values = {slot: tuple(map(self.at[slot], self.source.outputs)) for slot in self.slots}
        self._name_values()
        refusal = self._refusal([e for e in found if isinstance(e[1].statement, Require)])
        outputs: list[Output] = []
        wanted: list[Value] = []
        for slot in self.slots:
            words = [REFUSAL, *(o.name for o in self.source.program.outputs)]
            outputs += [Output(suffixed(word, self.signs, slot), _ZERO) for word in words]
            wanted += [refusal.values[slot], *values[slot]]
        program = replace(self.source.program, outputs=tuple(outputs))
        return Draft(program, list(self.items), tuple(wanted), self.names)

    # --- what depends on which signs

    def _support(self, values: Iterable[Value]) -> tuple[int, ...]:
        """The signs that values depend on, by index."""
        return tuple(sorted(frozenset[int]().union(*(self._support_of(v.node) for v in values))))

    def _support_of(self, node: Node) -> frozenset[int]:
        if node not in self._supports:
            for inner in sorted(reached([node], self._supports.__contains__), key=lambda n: n.place):
                own = self._of_names.get(inner.head, frozenset()) if inner.is_leaf else frozenset()
                self._supports[inner] = own.union(*(self._supports[source] for source in inner.read))
        return self._supports[node]

    def _slots_of(self, support: Sequence[int]) -> Iterator[tuple[int, Choice, Choice]]:
        """Each assignment of these signs, with the first slot that has it and the number of this slot."""
        seen: set[Choice] = set()
        for number, slot in enumerate(self.slots):
            choice = tuple(slot[i] for i in support)
            if choice not in seen:
                seen.add(choice)
                yield number, slot, choice

    def _called(self, name: sp.Symbol, support: Sequence[int], choice: Choice) -> sp.Symbol:
        return self.free.fresh(suffixed(name.name, [self.signs[i] for i in support], choice), name)

    # --- statements

    def _solve(self, effect: Effect) -> None:
        """Linear equations, once for every assignment of their signs, with names of their own for the solutions."""
        support = self._support(effect.values)
        for _, slot, choice in self._slots_of(support):
            names = {name: self._called(name, support, choice) for name in effect.statement.bound()}
            equations = renamed(effect.statement, names.__getitem__)
            self.items.append(replace(effect.changed(self.at[slot]), statement=equations))
            for other in self.slots:
                if tuple(other[i] for i in support) == choice:
                    self.at[other].values |= {name: self.graph.leaf(new) for name, new in names.items()}
        self._of_names |= dict.fromkeys(effect.statement.bound(), frozenset(support))

    def _name_values(self) -> None:
        """Name the values that have a name in the source; of a value and its negative, name the one without a minus."""
        for node, named in self.source.names.items():
            support = self._support([Value(node, named.sign)])
            variants: dict[Node, list[tuple[int, Choice, int]]] = {}
            for number, slot, choice in self._slots_of(support):
                value = self.at[slot](Value(node, named.sign))
                variants.setdefault(value.node, []).append((number, choice, value.sign))
            for variant, found in variants.items():
                if not variant.is_leaf and variant not in self.names:
                    _, choice, sign = next((f for f in found if f[2] > 0), found[0])
                    name = self._called(named.name, support, choice)
                    self.names[variant] = replace(
                        named, name=name, sign=sign, order=self._order(found[0][0], named.order)
                    )

    def _order(self, slot: int, place: int) -> int:
        """The order of a value, slot after slot: it stands among the statements of the first slot that needs it."""
        return slot * (len(self.source.program.body) + 1) + place

    # --- refusals

    def _refusal(self, effects: Sequence[tuple[int, Effect]]) -> _Refusal:
        """The refusal of every slot: the first condition that does not hold there."""
        refusal = _Refusal((), dict.fromkeys(self.slots, self.graph.leaf(_ZERO)), None)
        for status, group in groupby(effects, key=lambda e: _status(e[1])):
            if status is Status.OK:  # no answer for one slot: then for no slot, whatever the other conditions say
                self.items += [e.changed(self.at[slot]) for _, e in group for slot in self._different(e)]
                continue
            by_support: dict[tuple[int, ...], list[tuple[int, Effect]]] = {}
            for effect in group:
                by_support.setdefault(self._support(effect[1].values), []).append(effect)
            for support in sorted(by_support, key=lambda s: (len(s), s)):
                if not support and refusal.status in (None, status):
                    self.items += [e.changed(self.at[self.slots[0]]) for _, e in by_support[support]]  # all alike
                else:
                    refusal = self._refused(refusal, support, by_support[support])
        return refusal

    def _different(self, effect: Effect) -> list[Choice]:
        """A slot for every choice of the signs that an effect reads."""
        return [slot for _, slot, _ in self._slots_of(self._support(effect.values))]

    def _refused(self, before: _Refusal, support: tuple[int, ...], effects: Sequence[tuple[int, Effect]]) -> _Refusal:
        graph, status = self.graph, _status(effects[0][1])
        note = ", ".join(dict.fromkeys(n for n in (_note(e) for _, e in effects) if n))
        joint = tuple(sorted({*before.support, *support}))
        number = graph.leaf(sp.Integer(list(Status).index(status)))
        values: dict[Choice, Value] = {}
        for first, slot, choice in self._slots_of(joint):
            holds = graph.apply(sp.And, [self.at[slot](value) for _, e in effects for value in e.values])
            value = graph.apply(Select, (holds, graph.leaf(_ZERO), number))
            earlier = before.values[slot]
            if earlier.node.head != 0:
                is_earlier = graph.apply(sp.StrictGreaterThan, (earlier, graph.leaf(_ZERO)))
                value = graph.apply(Select, (is_earlier, earlier, value))
            if not value.node.is_leaf and value.node not in self.names:
                name = self._called(count(REFUSAL), joint, choice)
                self.names[value.node] = Named(name, value.sign, note, self._order(first, effects[0][0]))
            values |= {other: value for other in self.slots if tuple(other[i] for i in joint) == choice}
        return _Refusal(joint, values, status if before.status in (None, status) else Status.OK)


def _status(effect: Effect) -> Status:
    assert isinstance(effect.statement, Require)
    return effect.statement.otherwise


def _note(effect: Effect) -> str:
    assert isinstance(effect.statement, Require)
    return effect.statement.comment
