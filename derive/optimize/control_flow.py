"""Arms: what only one side of a choice needs is computed there only.

    length = select(radius > tolerance, radius, 1)            if radius > tolerance:
    cos_q4 = select(radius > tolerance, x/length, cos(free))      cos_q4 = x/radius
    sin_q4 = select(radius > tolerance, y/length, sin(free))      sin_q4 = y/radius
                                                        →     else:
                                                                  cos_q4 = cos(free)
                                                                  sin_q4 = sin(free)

A language that evaluates one side of a choice alone prints the result; the values are the same. A program is total, so that
a statement may move to where it is needed.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache

import sympy as sp
from sympy.logic.boolalg import Boolean

from derive.ir.passes import told_in
from derive.ir.primitives import (
    Select,
)
from derive.ir.program import (
    Let,
    Program,
    Statement,
    binds,
    expressions,
    reads,
)
from derive.ir.symbols import (
    is_condition,
    names_in,
)

_BOTH = (sp.true, sp.false)


@cache
def _conditions(expression: sp.Basic) -> frozenset[sp.Basic]:
    """The conditions in an expression, and their parts."""
    return frozenset(node for node in sp.preorder_traversal(expression) if isinstance(node, Boolean))


@dataclass(frozen=True)
class Arms:
    """A choice: what is bound where the condition holds, and where it does not. Both bind all that is read later."""

    condition: sp.Basic
    holds: tuple[Item, ...]
    fails: tuple[Item, ...]
    names: tuple[sp.Symbol, ...]


Item = Statement | Arms


def in_arms(body: Sequence[Item], wanted: Sequence[sp.Basic]) -> tuple[Item, ...]:
    """The statements of a program, choices that share a condition gathered with what they alone need."""
    return _sunk(_in_arms(body, wanted), {s for value in wanted for s in names_in(value)})


def told_on_sides(items: Sequence[Item], program: Program) -> tuple[Item, ...]:
    """The statements, with what reasons read and a choice keeps to one of its sides written out in them."""
    values = {let.name: let.value for let in program.lets()}
    bound: set[sp.Symbol] = set()
    found: list[Item] = []
    for item in items:
        found.append(item if isinstance(item, Arms) else told_in(item, bound, values))
        bound |= _bound_behind(item)
    return tuple(found)


def _bound_behind(item: Item) -> set[sp.Symbol]:
    """What is bound behind a statement; behind a choice, what both sides bind."""
    if not isinstance(item, Arms):
        return set(binds(item))
    holds, fails = ({name for inner in side for name in _bound_behind(inner)} for side in (item.holds, item.fails))
    return holds & fails


def spared(items: Sequence[Item], wanted: Sequence[sp.Basic]) -> tuple[Item, ...]:
    """Without what is bound on a first side for the second sides of later choices that the same condition decides.

    It serves a language that runs one side alone: a choice then binds its names on the other side only.
    """
    later = {s for value in wanted for s in names_in(value)}
    found: list[Item] = []
    for place, item in enumerate(items):
        if isinstance(item, Arms):
            needed = later.union(*(_reads_where(other, item.condition) for other in items[place + 1 :]))
            read = needed.union(*(_reads_somewhere(inner) for inner in item.holds))
            kept = tuple(i for i in item.holds if not isinstance(i, Let) or i.name in read)
            item = replace(item, holds=kept or item.holds)  # a side has a statement
        found.append(item)
    return tuple(found)


def _reads_where(item: Item, condition: sp.Basic) -> set[sp.Symbol]:
    """What a statement reads where a condition holds."""
    if isinstance(item, Arms) and (item.condition == condition or _follows(item.condition, condition, sp.true)):
        return set(names_in(item.condition)).union(*map(_reads_somewhere, item.holds))
    return _reads_somewhere(item)


def _sunk(items: Sequence[Item], later: set[sp.Symbol]) -> tuple[Item, ...]:
    """What is read on the second sides of several choices only, the singular ones, is bound on each of them."""
    found: list[Item] = []
    needed = set(later)
    for item in reversed(items):
        if isinstance(item, Let) and item.name not in needed and any(isinstance(i, Arms) for i in found):
            found = [_with(i, item) if isinstance(i, Arms) else i for i in found]
            continue
        needed |= _reads_always(item)
        found.insert(0, item)
    return tuple(found)


def _reads_always(item: Item) -> set[sp.Symbol]:
    """What a statement reads, or a choice to decide and on its first side."""
    if isinstance(item, Arms):
        return set(names_in(item.condition)).union(*map(_reads_somewhere, item.holds))
    return {s for value in expressions(item) for s in names_in(value)} | set(reads(item))


def _with(arms: Arms, let: Let) -> Arms:
    """The choice with a statement in front of its second side, if that reads it."""
    if not any(let.name in _reads_somewhere(item) for item in arms.fails):
        return arms
    return replace(arms, fails=(let, *arms.fails))


def _reads_somewhere(item: Item) -> set[sp.Symbol]:
    if isinstance(item, Arms):
        return _reads_always(item).union(*(_reads_somewhere(inner) for inner in (*item.holds, *item.fails)))
    return _reads_always(item)


def _in_arms(body: Sequence[Item], wanted: Sequence[sp.Basic]) -> tuple[Item, ...]:
    later = frozenset(s for value in wanted for s in names_in(value))
    found: list[Item] = []
    stretch: list[Let] = []
    for statement in reversed(body):
        if isinstance(statement, Let):
            stretch.insert(0, statement)
            continue
        found[:0] = [statement, *_gathered(stretch, later)]
        later = later.union(*(names_in(let.value) for let in stretch), _reads_somewhere(statement))
        stretch = []
    return (*_gathered(stretch, later), *found)


def _gathered(lets: Sequence[Let], later: frozenset[sp.Symbol]) -> list[Item]:
    """A stretch without conditions: `later` is what is read behind it. First the first choice that is in no other."""
    stretch = _Stretch(lets, later)
    conditions = dict.fromkeys(let.value.args[0] for let in lets if isinstance(let.value, Select))
    worthwhile = [c for c in (_Choice(condition, stretch) for condition in conditions) if c.is_worthwhile]
    if not worthwhile:
        return list(lets)
    outermost = [c for c in worthwhile if not any(c.gathered < other.gathered for other in worthwhile)]
    return min(outermost, key=lambda c: min(c.members)).items()


class _Stretch:
    """Statements without conditions between them, and who reads what."""

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
        """What these statements need, with them."""
        return _closure(places, self.sources)

    def downstream(self, places: Iterable[int]) -> set[int]:
        """What needs these statements, with them."""
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
    """The statements that one condition decides, and those that one of its sides alone needs."""

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
        """Whether more than one choice, or more than a choice, is gathered."""
        return len(self.members) > 1 or len(self.members) + len(self.inside) > 2

    @property
    def gathered(self) -> set[int]:
        """All of them."""
        return self.members | set(self.inside)

    def value(self, place: int, side: int) -> sp.Expr:
        """What a statement binds on a side."""
        return self.sides[side].get(place, self.stretch.lets[place].value)

    def _assumed(self, truth: sp.Basic) -> dict[int, sp.Expr]:
        """The values that change where the condition is known; a number that this gives is known, too."""
        stretch = self.stretch
        known: dict[sp.Basic, sp.Basic] = {self.condition: truth}
        known |= {other: truth for other in stretch.deciding if _follows(other, self.condition, truth)}
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
            return False  # a part of a condition decides little, and what it decides may be needed on one side alone
        sides = (self.value(place, side) for side in (0, 1))
        return any(not isinstance(v, Select) or v.args[0] != value.args[0] for v in sides)

    def _reads(self, place: int, side: int) -> frozenset[sp.Symbol]:
        return names_in(self.value(place, side))

    def _inside(self, members: set[int]) -> dict[int, int]:
        """The other statements that one side alone reads: 0 where the condition holds, 1 where it does not."""
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
        """A member that needs something outside which needs a member: the two cannot be gathered."""
        gathered = self.gathered
        behind = self.stretch.downstream(self.members) - gathered
        torn = [place for place in sorted(gathered) if behind & set(self.stretch.sources[place])]
        if not torn:
            return None
        return max(self.stretch.downstream(torn[:1]) & self.members)

    def items(self) -> list[Item]:
        """The stretch with the choice in it, and what is left gathered in turn."""
        lets, later = self.stretch.lets, self.stretch.later
        gathered = self.gathered
        needed_outside = {s for place, let in enumerate(lets) if place not in gathered for s in names_in(let.value)}
        results = tuple(lets[place].name for place in sorted(self.members) if lets[place].name in later | needed_outside)
        arms = Arms(self.condition, self._arm(0, results), self._arm(1, results), results)
        first = self.stretch.upstream(gathered | self._deciders()) - gathered
        first |= set(range(min(self.members))) - gathered - self.stretch.downstream(gathered)  # what was first stays first
        after = [let for place, let in enumerate(lets) if place not in gathered and place not in first]
        read_after = later.union(*(names_in(let.value) for let in after))
        read_inside = names_in(self.condition).union(*(names_in(lets[place].value) for place in gathered))
        before = [lets[place] for place in sorted(first)]
        return [*_gathered(before, read_after | read_inside), arms, *_gathered(after, later)]

    def _deciders(self) -> set[int]:
        """The statements that the condition reads."""
        return {self.stretch.place[s] for s in names_in(self.condition) if s in self.stretch.place}

    def _arm(self, side: int, results: tuple[sp.Symbol, ...]) -> tuple[Item, ...]:
        lets = [
            replace(let, value=self.value(place, side))
            for place, let in enumerate(self.stretch.lets)
            if place in self.members or self.inside.get(place) == side
        ]
        return tuple(_gathered(_simplified(lets, set(results)), frozenset(results)))


def _follows(other: sp.Basic, condition: sp.Basic, truth: sp.Basic) -> bool:
    """Whether another condition has the same truth: what is above a number is above smaller ones, and so on."""
    if not (isinstance(other, sp.StrictGreaterThan) and isinstance(condition, sp.StrictGreaterThan)):
        return False
    if other.lhs != condition.lhs or not (other.rhs.is_number and condition.rhs.is_number):
        return False
    return bool(other.rhs <= condition.rhs if truth == sp.true else other.rhs >= condition.rhs)


def _simplified(lets: Sequence[Let], results: set[sp.Symbol]) -> list[Let]:
    """Without names for names, and without what nothing reads; a negative is taken from what has been computed."""
    aliases: dict[sp.Basic, sp.Basic] = {}
    known: dict[sp.Basic, sp.Symbol] = {}
    kept: list[Let] = []
    for let in lets:
        value = let.value.xreplace(aliases)
        if value in known:
            value = known[value]
        elif not is_condition(value) and -value in known:
            value = -known[-value]
        if let.name not in results and (value.is_Symbol or value.is_Number or (not is_condition(value) and (-value).is_Symbol)):
            aliases[let.name] = value
            continue
        if not value.is_Symbol and not value.is_Number:
            known.setdefault(value, let.name)
        kept.append(replace(let, value=value))
    needed = _ancestors(kept, results)
    return [let for let in kept if let.name in needed]


def _ancestors(lets: Sequence[Let], wanted: set[sp.Symbol]) -> set[sp.Symbol]:
    """The names of the statements that the wanted names need."""
    needed = set(wanted)
    for let in reversed(lets):
        if let.name in needed:
            needed |= names_in(let.value)
    return needed & {let.name for let in lets}
