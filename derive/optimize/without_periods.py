"""Angles and axes that may be a turn more or less, because of their types.

    angle = atan2(y, x),  axis = nearest_period(shift + angle/DEGREE, reference),  s = sin(angle + other)

`angle` may be a turn more: it is an Angle, and nothing takes its value by `wrap`. An axis that may be on any turn is
shift + angle/DEGREE, unless a statement reads it as a real number, as a pitch or a gear does.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import sympy as sp

from derive.ir.passes import normalise
from derive.ir.primitives import NearestPeriod, Wrap
from derive.ir.program import Let, Output, Program, Require, Statement, Status, rewritten
from derive.ir.symbols import replaced, symbols_of
from derive.ir.types import IllTypedError, Type, angles_in, angles_of, check_statement


def angles_modulo_turns(program: Program) -> frozenset[sp.Symbol]:
    """The names of angles whose whole turns nothing reads."""
    values = [*(e for s in program.body for e in s.children()), *(o.value for o in program.outputs)]
    wrapped = {s for value in values for node in value.atoms(Wrap) for s in symbols_of(node)}
    answered = {s for output in program.outputs for s in symbols_of(output.value)}
    return frozenset(n for n, kind in angles_in(program.body).items() if kind is Type.ANGLE) - wrapped - answered


def specialised(program: Program, values: Mapping[sp.Symbol, sp.Expr]) -> Program:
    """The program with values for some inputs: choices that these decide disappear."""
    body = [rewritten(s, lambda e: replaced(e, values)) for s in program.body]
    return normalise(program.name, body, [Output(o.name, replaced(o.value, values)) for o in program.outputs])


def without_chosen_turns(program: Program) -> Program:
    """The program for inputs that are known to be good: they are not checked, and an axis that is only an angle may be
    on any turn.
    """
    counted = turns_that_count(program)
    body = [_in_any_turn(s, counted) for s in _of_good_input(program)]
    return normalise(program.name, body, program.outputs)


def turns_that_count(program: Program) -> frozenset[sp.Symbol]:
    """The axes whose turn is chosen because another value depends on it: a pitch or a gear moves with them."""
    counted: frozenset[sp.Symbol] = frozenset()
    while (more := _read_as_numbers(_of_good_input(program), counted)) is not None:
        counted |= more
    return counted


def _of_good_input(program: Program) -> list[Statement]:
    return [s for s in program.body if not (isinstance(s, Require) and s.otherwise is Status.BAD_INPUT)]


def _in_any_turn(statement: Statement, counted: frozenset[sp.Symbol]) -> Statement:
    """The statement without the choice of a turn, unless the turn counts."""
    if not isinstance(statement, Let) or not isinstance(statement.value, NearestPeriod) or statement.name in counted:
        return statement
    return replace(statement, value=statement.value.args[0], turn_of="")


def _read_as_numbers(body: list[Statement], counted: frozenset[sp.Symbol]) -> set[sp.Symbol] | None:
    """The axes that the first ill-typed statement needs as numbers, if all but the counted ones are on any turn."""
    known: dict[sp.Symbol, Type] = {}
    chosen = {s.name for s in body if isinstance(s, Let) and isinstance(s.value, NearestPeriod)}
    for statement in (_in_any_turn(s, counted) for s in body):
        try:
            check_statement(statement, known)
            known |= angles_of(statement, known)
        except IllTypedError:
            found = (_behind(body, statement.reads()) & chosen) - counted
            if not found:
                raise
            return found
    return None


def _behind(body: list[Statement], names: set[sp.Symbol]) -> set[sp.Symbol]:
    """The names, and the names in their values, except where a value is the choice of a turn."""
    values = {s.name: s.value for s in body if isinstance(s, Let) and not isinstance(s.value, NearestPeriod)}
    found, pending = set[sp.Symbol](), set(names)
    while pending:
        name = pending.pop()
        found.add(name)
        pending |= symbols_of(values[name]) - found if name in values else set()
    return found
