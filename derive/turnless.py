"""Turnless: angles that may be a turn more or less, because all that reads them takes a sine, a cosine or the nearest turn.

    angle = atan2(y, x),  axis = nearest_period(shift + angle/DEGREE, reference),  s = sin(angle + other)
"""

from __future__ import annotations

import sympy as sp

from derive.program import DEGREE, Let, NearestPeriod, Program, Select, Statement, reads, symbols_of


def turnless(program: Program) -> frozenset[sp.Symbol]:
    """The names that are such angles, in radians."""
    found = {let.name for let in program.lets()}
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
        return symbols_of(near) | symbols_of(_without_angles(direction, DEGREE))
    if statement.name in angles:
        sides = value.args[1:] if isinstance(value, Select) else (value,)
        conditions = symbols_of(value.args[0]) if isinstance(value, Select) else set()
        return conditions.union(*(symbols_of(_without_angles(side, sp.Integer(1))) for side in sides))
    return symbols_of(_without_sines(value))


def _without_angles(value: sp.Expr, unit: sp.Expr) -> sp.Expr:
    """A sum without the terms that are an angle or its negative, in a unit, and without sines of angles."""
    kept = [t for t in sp.Add.make_args(sp.expand(value)) if not (t * unit).is_Symbol and not (-t * unit).is_Symbol]
    return _without_sines(sp.Add(*kept))


def _without_sines(value: sp.Expr) -> sp.Expr:
    """A value with what the arguments of its sines hold besides angles, instead of these sines."""
    return value.replace(lambda e: isinstance(e, sp.sin | sp.cos), lambda e: _without_angles(e.args[0], sp.Integer(1)))
