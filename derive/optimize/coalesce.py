"""Reused names: in a straight line for all branches, a name that no later statement reads is used again by the next
branch.

    cos_q1_front = …; axis_a1_front = f(cos_q1_front)         cos_q1 = …; axis_a1_front = f(cos_q1)
    cos_q1_back = …;  axis_a1_back = f(cos_q1_back)      →    cos_q1 = …; axis_a1_back = f(cos_q1)

The result reads like one branch after the other, and holds fewer numbers at a time: a language reuses the memory of
numbers that are overwritten.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import sympy as sp

from derive.ir.passes import renamed
from derive.ir.program import rewritten
from derive.ir.symbols import Sign, called, replaced, symbols_of, without_words
from derive.ir.tree import If, Item, bindings_in, read_in


def coalesced(
    items: Sequence[Item], wanted: Sequence[sp.Basic], signs: Sequence[Sign]
) -> tuple[tuple[Item, ...], Mapping[sp.Symbol, sp.Symbol]]:
    """The statements with shorter names, and the new name of every name that is wanted after them."""
    lives = _lives(items, wanted)
    fixed = {s.name for s in read_in(items)} - {name.name for name in lives}
    by_stem: dict[str, list[sp.Symbol]] = {}
    for name in lives:
        by_stem.setdefault(without_words(name.name, signs)[0], []).append(name)
    names: dict[sp.Symbol, sp.Symbol] = {}
    for variants in by_stem.values():
        names |= _shortest(variants, signs, lives, fixed | {name.name for name in names.values()})
    return tuple(_renamed(item, names) for item in items), names


def _lives(items: Sequence[Item], wanted: Sequence[sp.Basic]) -> dict[sp.Symbol, tuple[int, int]]:
    """For every bound name: the places of the first and of the last statement that contains it."""
    last = {s: place for place, item in enumerate(items) for s in read_in((item,))}
    last |= {s: len(items) for value in wanted for s in symbols_of(value)}
    first = {name: place for place, item in reversed(list(enumerate(items))) for name in bindings_in((item,))}
    return {
        name: (place, max(place, last.get(name, place))) for name, place in sorted(first.items(), key=lambda e: e[1])
    }


def _shortest(
    variants: Sequence[sp.Symbol], signs: Sequence[Sign], lives: Mapping[sp.Symbol, tuple[int, int]], taken: set[str]
) -> dict[sp.Symbol, sp.Symbol]:
    """The variants of a name with as few words as distinguish those that are needed at the same time; the first words
    are dropped first.
    """
    own = set(variants)
    others = taken | {name.name for name in lives if name not in own}
    for kept in range(len(signs) + 1):
        names = {v: _with_last_words(v, signs, kept) for v in variants}
        apart = all(
            lives[a][1] < lives[b][0] or lives[b][1] < lives[a][0]
            for a, b in combinations(variants, 2) if names[a] == names[b]
        )  # fmt: skip
        if apart and not {n.name for n in names.values()} & others:
            return names
    return {v: v for v in variants}


def _with_last_words(name: sp.Symbol, signs: Sequence[Sign], kept: int) -> sp.Symbol:
    stem, found = without_words(name.name, signs)
    return called("_".join([stem, *found[max(0, len(found) - kept) :]]), name)


def _renamed(item: Item, names: Mapping[sp.Symbol, sp.Symbol]) -> Item:
    if isinstance(item, If):
        sides = {side: tuple(_renamed(i, names) for i in getattr(item, side)) for side in ("holds", "fails")}
        called = tuple(names.get(n, n) for n in item.names)
        return replace(item, condition=replaced(item.condition, names), names=called, **sides)
    changed = rewritten(item, lambda e: replaced(e, names))
    return renamed(changed, lambda n: names.get(n, n))
