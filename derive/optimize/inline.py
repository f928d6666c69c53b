"""Inlining: a short value that is read once is written where it is read.

    y = a * s                                     angle = atan2(a * s, b + a * c) - atan2(u, v)
    x = b + a * c
    angle_of_x = atan2(y, x)                 →
    angle_of_v = atan2(u, v)
    angle = angle_of_x - angle_of_v

It serves a language in which a name costs time. Only one side of a choice is executed, so a value that each side reads
once is written on both. Products are not regrouped; terms of a sum may be added in another order. A value with a note
keeps its name, and so does a choice.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace

import sympy as sp

from derive.ir.passes import with_inputs
from derive.ir.primitives import NearestPeriod, Root, Select, ToReal
from derive.ir.program import Let, Program, rewritten
from derive.ir.symbols import replaced
from derive.ir.tree import If, Item, bindings_in, expressions_in
from derive.ir.verify import verify

LONGEST = 5
"""A value that reads more names than this keeps its own."""


class Grouped(sp.Function):
    """A value in place of a name: it is computed as a unit."""

    nargs = 1
    is_real = True


def squares_where_read(program: Program) -> Program:
    """The program with the names of squares replaced by products: this costs no more, and shows that a root of them is
    a root of squares.
    """
    own = {let.name: let.value for let in program.lets() if isinstance(let.value, sp.Pow) and let.value.base.is_Symbol}
    squares = {name: value for name, value in own.items() if value.exp == 2}
    body = [
        rewritten(s, lambda e: replaced(e, squares))
        for s in program.body
        if not (isinstance(s, Let) and s.name in squares)
    ]
    outputs = tuple(replace(o, value=replaced(o.value, squares)) for o in program.outputs)
    return with_inputs(replace(program, body=tuple(body), outputs=outputs))


def without_conversions(program: Program) -> Program:
    """The program without conversions of whole numbers: where they multiply, Python converts them by itself."""
    own = {
        let.name: let.value for let in program.lets() if isinstance(let.value, ToReal) and let.value.args[0].is_Symbol
    }
    others = (s for s in program.body if not (isinstance(s, Let) and s.name in own))
    body = [rewritten(s, lambda e: replaced(e, own)) for s in others]
    outputs = tuple(replace(o, value=replaced(o.value, own)) for o in program.outputs)
    return verify(replace(program, body=tuple(body), outputs=outputs)) if own else program


def inlined(items: Sequence[Item], wanted: Sequence[sp.Basic]) -> tuple[tuple[Item, ...], Mapping[sp.Basic, sp.Basic]]:
    """The statements without such names, and the values in place of these names in `wanted`."""
    on_a_path, everywhere, bound = _read(items), Counter[sp.Basic](), Counter(bindings_in(items))
    for value in wanted:
        on_a_path += _written(value)
    for value in (*wanted, *expressions_in(items)):
        everywhere += _written(value)
    once = {n for n in bound if bound[n] == 1 and on_a_path[n] == 1 and everywhere[n] <= 2}
    values: dict[sp.Basic, sp.Basic] = {}
    return _shortened(items, once, values), values


def _shortened(items: Sequence[Item], once: set[sp.Symbol], values: dict[sp.Basic, sp.Basic]) -> tuple[Item, ...]:
    kept: list[Item] = []
    for item in items:
        if isinstance(item, If):
            condition = replaced(item.condition, values)
            holds, fails = (_shortened(side, once - set(item.names), values) for side in (item.holds, item.fails))
            kept.append(replace(item, condition=condition, holds=holds, fails=fails))
            continue
        changed = rewritten(item, lambda e: replaced(e, values))
        if isinstance(changed, Let) and changed.name in once and not changed.comment and _is_short(changed.value):
            values[changed.name] = Grouped(changed.value)
        else:
            kept.append(changed)
    return tuple(kept)


def _is_short(value: sp.Expr) -> bool:
    return not value.has(Select, NearestPeriod, Root) and sum(_written(value).values()) <= LONGEST


def _read(items: Sequence[Item]) -> Counter[sp.Basic]:
    """The number of times that each name is written, on the path through a program on which it is written most."""
    found = Counter[sp.Basic]()
    for item in items:
        if isinstance(item, If):
            found += _written(item.condition) + _written(item.condition) + (_read(item.holds) | _read(item.fails))
        else:
            for value in item.children():
                found += _written(value)
    return found


def _written(value: sp.Basic) -> Counter[sp.Basic]:
    """The number of times that each name is written in a value: a power is a product; conditions, roots and turns may
    write an argument twice.
    """
    if value.is_Symbol:
        return Counter({value: 1})
    found = Counter[sp.Basic]()
    for part in value.args:
        found += _written(part)
    times = abs(int(value.exp)) if isinstance(value, sp.Pow) else 2 if _asks_twice(value) else 1
    return Counter({name: times * count for name, count in found.items()})


def _asks_twice(value: sp.Basic) -> bool:
    return isinstance(value, Root | NearestPeriod) or not isinstance(value, sp.Expr)
