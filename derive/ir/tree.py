"""A program as a structured tree: statements in order, and choices of which one side alone is run.

if radius > tolerance:
    cos_q4 = x/radius
else:
    cos_q4 = cos(free)
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import sympy as sp

from derive.ir.program import Statement, binds


@dataclass(frozen=True)
class If:
    """A choice: what is run where the condition holds, and where it does not. Both bind the names."""

    condition: sp.Basic
    holds: tuple[Item, ...]
    fails: tuple[Item, ...]
    names: tuple[sp.Symbol, ...]
    """What both sides bind, and is read behind them."""


Item = Statement | If


def statements_in(items: Sequence[Item]) -> Iterator[Statement]:
    """The statements of a tree, those on the sides of choices too."""
    for item in items:
        if isinstance(item, If):
            yield from statements_in((*item.holds, *item.fails))
        else:
            yield item


def bound_in(items: Sequence[Item]) -> tuple[sp.Symbol, ...]:
    """The names that a tree binds, each once, in order."""
    return tuple(dict.fromkeys(name for s in statements_in(items) for name in binds(s)))
