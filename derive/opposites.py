"""Opposites: where both coordinates of a direction have a minus in front, the angle of the opposite one is half a turn away.

    y = -a * u - b * v,  x = -a * w - b * t          minus_y = a * u + b * v,  minus_x = a * w + b * t
    axis = shift + atan2(y, x)/DEGREE           →    axis = (shift + 180) + atan2(minus_y, minus_x)/DEGREE

Its turn is chosen afterwards.
"""

from __future__ import annotations

import sympy as sp

from derive.passes import assemble, is_read_once
from derive.program import DEGREE, Atan2, Let, NearestPeriod, Output, Program, real, rewritten


def without_minus(program: Program) -> Program:
    """The program with such directions turned by half a turn, where nothing else reads them."""
    values = {let.name: let.value for let in program.lets()}
    taken = {name.name for name in (*program.bound(), *program.inputs)}
    changed: dict[sp.Basic, sp.Basic] = {}
    opposites: dict[sp.Symbol, sp.Symbol] = {}
    for angle in _axis_angles(program):
        names = [real(f"minus_{s.name}") for s in angle.args]
        is_negative = all(s in values and values[s].could_extract_minus_sign() for s in angle.args)
        if is_negative and not {n.name for n in names} & taken and all(is_read_once(program, s) for s in angle.args):
            opposites |= dict(zip(angle.args, names, strict=True))
            changed[angle / DEGREE] = Atan2(*names) / DEGREE + 180
    body = [
        Let(opposites[s.name], -s.value, s.note)
        if isinstance(s, Let) and s.name in opposites
        else rewritten(s, lambda e: e.xreplace(changed))
        for s in program.body
    ]
    return assemble(program.name, body, [Output(o.name, o.value.xreplace(changed)) for o in program.outputs])


def _axis_angles(program: Program) -> list[Atan2]:
    """The angles of directions under names that axes with a turn of their own are taken of."""
    turns = [let.value.args[0] for let in program.lets() if isinstance(let.value, NearestPeriod)]
    found = [t * DEGREE for value in turns for t in sp.Add.make_args(value) if isinstance(t * DEGREE, Atan2)]
    return [angle for angle in dict.fromkeys(found) if all(a.is_Symbol for a in angle.args)]
