"""Opposites: what is bound with a minus, or read with one, is bound as its opposite where that leaves fewer minus signs.

    y = -a * u - b * v,  x = -a * w - b * t          minus_y = a * u + b * v,  minus_x = a * w + b * t
    axis = shift + atan2(y, x)/DEGREE           →    axis = (shift + 180) + atan2(minus_y, minus_x)/DEGREE

    s = -root(square),  arm = -length * s       →    minus_s = root(square),  arm = length * minus_s

Where both coordinates of a direction have a minus in front, the angle of the opposite one is half a turn away; its turn is
chosen afterwards.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import sympy as sp

from derive.ir.constants import (
    DEGREE,
)
from derive.ir.names import Names
from derive.ir.passes import assemble, is_read_once
from derive.ir.primitives import (
    Atan2,
)
from derive.ir.program import (
    Let,
    Output,
    Program,
    Statement,
    expressions,
    rewritten,
)
from derive.optimize.constant_parts import without_sign
from derive.optimize.directions import direction_of
from derive.optimize.without_periods import turnless


def without_minus(program: Program) -> Program:
    """The program with such directions turned by half a turn, where nothing else reads them."""
    values = {let.name: let.value for let in program.lets()}
    taken = Names.of(program)
    changed: dict[sp.Basic, sp.Basic] = {}
    opposites: dict[sp.Symbol, sp.Symbol] = {}
    for pair in [pair for let in program.lets() for pair in [direction_of(let)] if pair is not None]:
        is_negative = all(s in values and values[s].could_extract_minus_sign() for s in pair)
        if is_negative and all(is_read_once(program, s) for s in pair):
            opposites |= {s: taken.fresh(f"minus_{s.name}") for s in pair}
            changed[Atan2(*pair) / DEGREE] = Atan2(*(opposites[s] for s in pair)) / DEGREE + 180
    body = [
        replace(s, name=opposites[s.name], value=-s.value)
        if isinstance(s, Let) and s.name in opposites
        else rewritten(s, lambda e: e.xreplace(changed))
        for s in program.body
    ]
    return assemble(program.name, body, [Output(o.name, o.value.xreplace(changed)) for o in program.outputs])


def with_fewer_signs(program: Program) -> Program:
    """The program with opposites of sums, products and angles wherever that takes minus signs away."""
    taken, turns_are_free = Names.of(program), turnless(program)
    body, outputs = list(program.body), list(program.outputs)
    opposites: set[sp.Symbol] = set()
    """What is an opposite already: SymPy orders terms by name, so that one may seem to save signs both ways."""
    place = 0
    while place < len(body):
        let = body[place]
        place += 1
        opposite = _opposite(let, turns_are_free) if isinstance(let, Let) and let.name not in opposites else None
        if not isinstance(let, Let) or opposite is None:
            continue
        reads_opposite = {let.name: -let.name}
        read_in = [e for s in body for e in expressions(s)] + [o.value for o in outputs]
        saved = sum(_signs_in(e) - _signs_in(e.xreplace(reads_opposite)) for e in read_in if let.name in e.free_symbols)
        if saved + _signs_in(let.value) <= _signs_in(opposite):
            continue
        name = taken.fresh(_opposite_name(let.name.name))
        opposites.add(name)
        turns_are_free |= {name} if let.name in turns_are_free else set()
        body[place - 1] = replace(let, name=name, value=opposite)
        body = [_with(s, {let.name: -name}) for s in body]
        outputs = [Output(o.name, o.value.xreplace({let.name: -name})) for o in outputs]
        place = 0
    return assemble(program.name, body, outputs)


def _with(statement: Statement, names: Mapping[sp.Basic, sp.Expr]) -> Statement:
    return rewritten(statement, lambda e: e.xreplace(dict(names)))


def _opposite(let: Let, turns_are_free: frozenset[sp.Symbol]) -> sp.Expr | None:
    """The opposite of a sum, of a product, or of an angle whose turn nobody counts."""
    if isinstance(let.value, sp.Add | sp.Mul):
        return -let.value
    if isinstance(let.value, Atan2) and let.name in turns_are_free:
        sine, cosine = let.value.args
        return Atan2(-sine, cosine)
    return None


def _opposite_name(name: str) -> str:
    return name.removeprefix("minus_") if name.startswith("minus_") else f"minus_{name}"


def _signs_in(value: sp.Basic) -> int:
    """How many minus signs that subtract nothing a value is written with."""
    if value.is_Add:
        terms = [without_sign(term) for term in value.args]
        is_all_negative = all(term != signed for term, signed in zip(terms, value.args, strict=True))
        return int(is_all_negative) + sum(map(_signs_in, terms))
    if value.is_Mul and value.args[0] == -1:
        return 1 + _signs_in(-value)
    return sum(map(_signs_in, value.args))
