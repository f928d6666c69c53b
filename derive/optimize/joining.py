"""Joining: a choice that an earlier choice decides, brought into that one.

    if radius > tolerance:               if radius > tolerance:
        x4 = x/radius                        x4 = x/radius
        other_x4 = -x4                       angle = atan2(y, x4)
    else:                                    other_angle = pi + angle
        x4 = cos(free)                   else:
        other_x4 = cos(free)         →       x4 = cos(free)
    angle = atan2(y, x4)                     other_x4 = cos(free)
    if radius > tolerance:                   angle = atan2(y, x4)
        other_angle = pi + angle             other_angle = atan2(y, other_x4)
    else:
        other_angle = atan2(y, other_x4)

A language that runs one side alone then computes nothing that the other side alone needs, and what is read behind a
choice is bound on both of its sides.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

import sympy as sp

from derive.ir.program import Let
from derive.ir.symbols import names_in
from derive.ir.tree import If, Item, bound_behind, bound_in, follows, given_to, read_in


def joined(items: Sequence[Item], wanted: Sequence[sp.Basic]) -> tuple[Item, ...]:
    """The statements with choices joined, where the first side of the earlier one binds a name for the second side of
    the later one alone. wanted: the values that are read at the end.
    """
    later = {s for value in wanted for s in names_in(value)}
    found, rest = list[Item](), list(items)
    while rest:
        item = rest.pop(0)
        if isinstance(item, If) and (own := _unneeded(item, rest, later)):
            last = max(own.values())
            if all(isinstance(s, Let | If) for s in rest[: last + 1]):
                rest[: last + 1] = _join(item, rest[: last + 1], own, given_to(rest[last + 1 :]) | later)
                continue
        found.append(item)
    return tuple(found)


def _unneeded(choice: If, rest: Sequence[Item], later: set[sp.Symbol]) -> dict[sp.Symbol, int]:
    """The names that the first side binds for second sides of later choices alone, each with the place of the last of
    these choices.
    """
    own = [let.name for let in choice.holds if isinstance(let, Let) and let.name not in read_in(choice.holds)]
    places = {name: _last_second_side(name, choice.condition, rest, later) for name in own}
    return {name: place for name, place in places.items() if place is not None}


def _last_second_side(name: sp.Symbol, condition: sp.Basic, rest: Sequence[Item], later: set[sp.Symbol]) -> int | None:
    """The place of the last choice whose second side reads a name; None if anything else reads it, or nothing does.

    A name may be bound once more, for another branch: then it is another value.
    """
    place, is_same = None, True
    for k, item in enumerate(rest):
        if isinstance(item, If) and is_same and _is_decided(item.condition, condition):
            if name in names_in(item.condition) | given_to(item.holds):
                return None
            place = k if name in given_to(item.fails) else place
        elif name in given_to((item,)):
            return None
        if name in bound_behind(item):
            return place
        is_same = is_same and names_in(condition).isdisjoint(bound_in((item,)))
    return None if name in later else place


def _is_decided(condition: sp.Basic, by: sp.Basic, truth: sp.Basic = sp.true) -> bool:
    """Whether a condition has the truth that another one has."""
    return condition == by or follows(condition, by, truth)


def _join(choice: If, between: Sequence[Item], unneeded: Collection[sp.Symbol], later: set[sp.Symbol]) -> list[Item]:
    """What stands before the joined choice, and that choice. later: what is read behind it."""
    before, moved = list[Item](), list[Item]()
    for item in between:
        (before if isinstance(item, Let) and _may_pass(item, (choice, *moved)) else moved).append(item)
    kept = (s for s in choice.holds if not (isinstance(s, Let) and s.name in unneeded))
    holds = (*kept, *_on_a_side(choice.condition, sp.true, moved))
    fails = (*choice.fails, *_on_a_side(choice.condition, sp.false, moved))
    read = {name for side in (holds, fails) for name in bound_in(side)} & later
    return [*before, If(choice.condition, holds, fails, tuple(n for n in bound_in(holds) if n in read))]


def _may_pass(let: Let, items: Sequence[Item]) -> bool:
    """Whether a statement may stand before others: neither reads or binds what the other binds."""
    bound = set(bound_in(items))
    return let.name not in bound | read_in(items) and bound.isdisjoint(names_in(let.value))


def _on_a_side(condition: sp.Basic, truth: sp.Basic, items: Sequence[Item]) -> Iterator[Item]:
    """The statements where a condition has this truth; of a choice that it decides, one side."""
    is_same = True
    for item in items:
        if isinstance(item, If) and is_same and _is_decided(item.condition, condition, truth):
            yield from item.holds if truth == sp.true else item.fails
        else:
            yield item
        is_same = is_same and names_in(condition).isdisjoint(bound_in((item,)))
