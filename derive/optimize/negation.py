"""Opposites: a direction whose coordinates both have a minus sign is the opposite of one that has none.

    y = -a * u - b * v,  x = -a * w - b * t          minus_y = a * u + b * v,  minus_x = a * w + b * t
    axis = shift + atan2(y, x)/DEGREE           →    axis = (shift + 180) + atan2(minus_y, minus_x)/DEGREE

Where both coordinates of a direction have a minus in front, the angle of the opposite one is half a turn away; its turn
is chosen afterwards.
"""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from derive.ir.constants import (
    DEGREE,
)
from derive.ir.names import Names
from derive.ir.passes import is_read_once, normalise
from derive.ir.primitives import (
    Atan2,
)
from derive.ir.program import (
    Let,
    Output,
    Program,
    rewritten,
)
from derive.optimize.directions import direction_of


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
    return normalise(program.name, body, [Output(o.name, o.value.xreplace(changed)) for o in program.outputs])
