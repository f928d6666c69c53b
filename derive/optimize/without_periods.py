"""Turnless: angles that may be a turn more or less, because all that reads them takes a sine, a cosine or the nearest turn.

    angle = atan2(y, x),  axis = nearest_period(shift + angle/DEGREE, reference),  s = sin(angle + other)
"""

from __future__ import annotations

import sympy as sp

from derive.ir.constants import (
    DEGREE,
)
from derive.ir.primitives import (
    NearestPeriod,
    Select,
)
from derive.ir.program import (
    Let,
    Program,
    Statement,
    reads,
)
from derive.ir.symbols import (
    is_condition,
    symbols_of,
)


def turnless(program: Program) -> frozenset[sp.Symbol]:
    """The names that are such angles, in radians."""
    found = {let.name for let in program.lets() if not is_condition(let.value)}
    wanted = {s for o in program.outputs for s in symbols_of(o.value)}
    while True:
        kept = found - wanted - {s for statement in program.body for s in _counted(statement, found)}
        if kept == found:
            return frozenset(kept)
        found = kept


def _counted(statement: Statement, angles: set[sp.Symbol]) -> set[sp.Symbol]:
    """What a statement reads in a way in which turns count."""
    if not isinstance(statement, Let):
        return reads(statement)
    value = statement.value
    if isinstance(value, NearestPeriod):
        direction, near = value.args
        return symbols_of(near) | _beside_angles(direction, DEGREE)
    if statement.name in angles:
        if isinstance(value, Select):
            return symbols_of(value.args[0]).union(*(_beside_angles(side) for side in value.args[1:]))
        return _beside_angles(value)
    return _beside_sines(value)


def _beside_angles(value: sp.Expr, unit: sp.Expr = sp.S.One) -> set[sp.Symbol]:
    """What a sum reads beside terms that are an angle or its negative, in a unit, and beside sines of such sums."""
    terms = sp.Add.make_args(sp.expand(value))
    return set[sp.Symbol]().union(*(_beside_sines(t) for t in terms if not (t * unit).is_Symbol and not (-t * unit).is_Symbol))


def _beside_sines(value: sp.Basic) -> set[sp.Symbol]:
    """What a value reads, of the arguments of its sines only what is no angle in them."""
    if isinstance(value, sp.sin | sp.cos):
        return _beside_angles(value.args[0])
    if not value.args:
        return symbols_of(value)
    return set[sp.Symbol]().union(*map(_beside_sines, value.args))
