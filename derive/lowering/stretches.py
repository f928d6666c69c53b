"""Stretches: bindings without a refusal between them. In a stretch, choices with the same condition are gathered, with
the values that only one of their sides needs."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cache

import sympy as sp
from sympy.logic.boolalg import Boolean

from derive.ir.primitives import Select
from derive.ir.program import Let
from derive.ir.symbols import is_condition, names_in, replaced
from derive.ir.tree import If, Item, follows

_BOTH = (sp.true, sp.false)


@cache
def _conditions(expression: sp.Basic) -> frozenset[sp.Basic]:
    """The conditions in an expression, and their parts."""
    return frozenset(node for node in sp.preorder_traversal(expression) if isinstance(node, Boolean))


def gathered(lets: Sequence[Let], later: frozenset[sp.Symbol]) -> list[Item]:
    """The items of a stretch, with its choices gathered; `later` are the names that are read after the stretch."""
    conditions = dict.fromkeys(let.value.args[0] for let in lets if isinstance(let.value, Select))
    if not conditions:
        return list(lets)
    stretch = _Stretch(lets, later)
    worthwhile = [c for c in (_Choice(condition, stretch) for condition in conditions) if c.is_worthwhile]
    if not worthwhile:
        return list(lets)
    outermost = [c for c in worthwhile if not any(c.places < other.places for other in worthwhile)]
    first = min(outermost, key=lambda c: min(c.members))
    return first.items({place for c in outermost for place in c.places} - first.places)


class _Stretch:
    """Statements without refusals between them, and the readers of each."""

    def __init__(self, lets: Sequence[Let], later: frozenset[sp.Symbol]) -> None:
        self.lets, self.later = tuple(lets), later
        self.place = {let.name: place for place, let in enumerate(lets)}
        self.sources = [sorted(self.place[s] for s in names_in(let.value) if s in self.place) for let in lets]
        self.readers: list[list[int]] = [[] for _ in lets]
        self.deciding: dict[sp.Basic, list[int]] = {}
        for place, let in enumerate(lets):
            for source in self.sources[place]:
                self.readers[source].append(place)
            for condition in _conditions(let.value):
                self.deciding.setdefault(condition, []).append(place)

    def upstream(self, places: Iterable[int]) -> set[int]:
        """These statements and all statements that they need."""
        return _closure(places, self.sources)

    def downstream(self, places: Iterable[int]) -> set[int]:
        """These statements and all statements that need them."""
        return _closure(places, self.readers)


def _closure(places: Iterable[int], neighbours: Sequence[Sequence[int]]) -> set[int]:
    found = set(places)
    pending = list(found)
    while pending:
        for place in neighbours[pending.pop()]:
            if place not in found:
                found.add(place)
                pending.append(place)
    return found


class _Choice:
    """The choices with one condition, and the statements that only one of their sides needs."""

    def __init__(self, condition: sp.Basic, stretch: _Stretch) -> None:
        self.condition, self.stretch = condition, stretch
        self.sides = [self._assumed(truth) for truth in _BOTH]
        members = {place for place in {*self.sides[0], *self.sides[1]} if self._is_decided(place)}
        while True:
            self.members, self.inside = members, self._inside(members)
            misplaced = self._misplaced()
            if misplaced is None:
                return
            members = members - {misplaced}

    @property
    def is_worthwhile(self) -> bool:
        """Whether at least two choices, or a choice and another statement, are gathered."""
        return len(self.members) > 1 or len(self.members) + len(self.inside) > 2

    @property
    def places(self) -> set[int]:
        """The places of all these statements."""
        return self.members | set(self.inside)

    def value(self, place: int, side: int) -> sp.Expr:
        """The value that a statement binds on a side."""
        return self.sides[side].get(place, self.stretch.lets[place].value)

    def _assumed(self, truth: sp.Basic) -> dict[int, sp.Expr]:
        """The values that change where the condition is known; a value that becomes a number is known to later ones."""
        stretch = self.stretch
        known: dict[sp.Basic, sp.Basic] = {self.condition: truth}
        known |= {other: truth for other in stretch.deciding if follows(other, self.condition, truth)}
        pending, changed = {p for condition in known for p in stretch.deciding.get(condition, ())}, dict[int, sp.Expr]()
        while pending:
            place = min(pending)
            pending.remove(place)
            changed[place] = stretch.lets[place].value.xreplace(known)
            if changed[place].is_Number:
                known[stretch.lets[place].name] = changed[place]
                pending |= set(stretch.readers[place])
        return changed

    def _is_decided(self, place: int) -> bool:
        """Whether the condition decides the choice on at least one side."""
        value = self.stretch.lets[place].value
        if not isinstance(value, Select) or self.condition in value.args[0].args:
            return False  # a part of a condition decides little, and may be needed on one side alone
        sides = (self.value(place, side) for side in (0, 1))
        return any(not isinstance(v, Select) or v.args[0] != value.args[0] for v in sides)

    def _reads(self, place: int, side: int) -> frozenset[sp.Symbol]:
        return names_in(self.value(place, side))

    def _inside(self, members: set[int]) -> dict[int, int]:
        """The other statements that only one side reads: side 0 where the condition holds, 1 where it does not."""
        stretch, inside = self.stretch, dict[int, int]()
        outside = stretch.later | names_in(self.condition)
        for place in sorted(stretch.upstream(members) - members, reverse=True):
            name = stretch.lets[place].name
            if name in outside or any(r not in members and r not in inside for r in stretch.readers[place]):
                continue
            used = {
                side
                for reader in stretch.readers[place]
                for side in ((inside[reader],) if reader in inside else (0, 1))
                if name in self._reads(reader, side)
            }
            if len(used) == 1:
                inside[place] = used.pop()
        return inside

    def _misplaced(self) -> int | None:
        """A member that needs a statement outside which in turn needs a member: the two members cannot be gathered."""
        inside = self.places
        behind = self.stretch.downstream(self.members) - inside
        torn = [place for place in sorted(inside) if behind & set(self.stretch.sources[place])]
        if not torn:
            return None
        return max(self.stretch.downstream(torn[:1]) & self.members)

    def items(self, elsewhere: set[int]) -> list[Item]:
        """The stretch with this choice in it; the other choices are gathered in turn. elsewhere: the places that other
        choices gather.
        """
        lets, later = self.stretch.lets, self.stretch.later
        inside = self.places
        needed_outside = {s for place, let in enumerate(lets) if place not in inside for s in names_in(let.value)}
        results = tuple(
            lets[place].name for place in sorted(self.members) if lets[place].name in later | needed_outside
        )
        arms = If(self.condition, self._arm(0, results), self._arm(1, results), results)
        first = self.stretch.upstream(inside | self._deciders()) - inside
        behind = self.stretch.downstream(inside | (elsewhere - first))
        first |= set(range(min(self.members))) - behind  # a statement that came first stays first
        after = [let for place, let in enumerate(lets) if place not in inside and place not in first]
        read_after = later.union(*(names_in(let.value) for let in after))
        read_inside = names_in(self.condition).union(*(names_in(lets[place].value) for place in inside))
        before = [lets[place] for place in sorted(first)]
        return [*gathered(before, read_after | read_inside), arms, *gathered(after, later)]

    def _deciders(self) -> set[int]:
        """The statements that the condition reads."""
        return {self.stretch.place[s] for s in names_in(self.condition) if s in self.stretch.place}

    def _arm(self, side: int, results: tuple[sp.Symbol, ...]) -> tuple[Item, ...]:
        lets = [
            replace(let, value=self.value(place, side))
            for place, let in enumerate(self.stretch.lets)
            if place in self.members or self.inside.get(place) == side
        ]
        return tuple(gathered(_simplified(lets, set(results)), frozenset(results)))


def _simplified(lets: Sequence[Let], results: set[sp.Symbol]) -> list[Let]:
    """The bindings without aliases and unused ones; if the negative of a value is computed already, it is used."""
    aliases: dict[sp.Basic, sp.Basic] = {}
    known: dict[sp.Basic, sp.Symbol] = {}
    kept: list[Let] = []
    for let in lets:
        value = replaced(let.value, aliases)
        if value in known:
            value = known[value]
        elif not is_condition(value) and -value in known:
            value = -known[-value]
        if let.name not in results and (
            value.is_Symbol or value.is_Number or (not is_condition(value) and (-value).is_Symbol)
        ):
            aliases[let.name] = value
            continue
        if not value.is_Symbol and not value.is_Number:
            known.setdefault(value, let.name)
        kept.append(replace(let, value=value))
    needed = _ancestors(kept, results)
    return _without_copies([let for let in kept if let.name in needed], results)


def _without_copies(lets: Sequence[Let], results: set[sp.Symbol]) -> list[Let]:
    """The bindings without copies: a value of which a result is a copy gets the name of the result."""
    own = {let.name for let in lets} - results
    names: dict[sp.Basic, sp.Symbol] = {}
    for let in lets:
        if let.value in own and let.value not in names:
            names[let.value] = let.name
    notes = {let.name: let.note for let in lets if names.get(let.value) == let.name}
    found: list[Let] = []
    for let in lets:
        if names.get(let.value) != let.name:
            name = names.get(let.name, let.name)
            value, note = replaced(let.value, names), let.note or notes.get(name, "")
            found.append(replace(let, name=name, value=value, note=note))
    return found


def _ancestors(lets: Sequence[Let], wanted: set[sp.Symbol]) -> set[sp.Symbol]:
    """The names of the statements that the wanted names need."""
    needed = set(wanted)
    for let in reversed(lets):
        if let.name in needed:
            needed |= names_in(let.value)
    return needed & {let.name for let in lets}
