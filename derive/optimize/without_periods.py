"""Angles and axes that may be a turn more or less, because of their types.

    angle = atan2(y, x),  axis = nearest_period(shift + angle/DEGREE, reference),  s = sin(angle + other)

`angle` may be a turn more: it is an Angle, and nothing takes its value by `wrap`. Where an axis may be in any turn, it
is shift + angle/DEGREE, unless a statement reads it as a real number: as what a pitch or a gear moves along.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import sympy as sp

from derive.ir.passes import normalise
from derive.ir.primitives import (
    NearestPeriod,
    Wrap,
)
from derive.ir.program import (
    Let,
    Output,
    Program,
    Require,
    Statement,
    Status,
    expressions,
    reads,
    rewritten,
)
from derive.ir.symbols import (
    replaced,
    symbols_of,
)
from derive.ir.typed import check_statement
from derive.ir.types import IllTypedError, Type, angles_in, angles_of


def angles_modulo_turns(program: Program) -> frozenset[sp.Symbol]:
    """The names of angles whose turn nobody asks for."""
    values = [*(e for s in program.body for e in expressions(s)), *(o.value for o in program.outputs)]
    wrapped = {s for value in values for node in value.atoms(Wrap) for s in symbols_of(node)}
    answered = {s for output in program.outputs for s in symbols_of(output.value)}
    return frozenset(n for n, kind in angles_in(program.body).items() if kind is Type.ANGLE) - wrapped - answered


def specialised(program: Program, values: Mapping[sp.Symbol, sp.Expr]) -> Program:
    """The program with some inputs given: choices that this decides disappear."""
    body = [rewritten(s, lambda e: replaced(e, values)) for s in program.body]
    return normalise(program.name, body, [Output(o.name, replaced(o.value, values)) for o in program.outputs])


def without_chosen_turns(program: Program) -> Program:
    """The program for inputs that are known to be good: no look at them, and any turn of an axis
    that is only an angle.
    """
    counted = turns_that_count(program)
    body = [_in_any_turn(s, counted) for s in _of_good_input(program)]
    return normalise(program.name, body, program.outputs)


def turns_that_count(program: Program) -> frozenset[sp.Symbol]:
    """The axes that are chosen on a turn because another value depends on which: a pitch or a gear moves with them."""
    counted: frozenset[sp.Symbol] = frozenset()
    while (more := _read_as_numbers(_of_good_input(program), counted)) is not None:
        counted |= more
    return counted


def _of_good_input(program: Program) -> list[Statement]:
    return [s for s in program.body if not (isinstance(s, Require) and s.otherwise is Status.BAD_INPUT)]


def _in_any_turn(statement: Statement, counted: frozenset[sp.Symbol]) -> Statement:
    """The statement without the choice of a turn, unless that counts."""
    if not isinstance(statement, Let) or not isinstance(statement.value, NearestPeriod) or statement.name in counted:
        return statement
    return replace(statement, value=statement.value.args[0], turn_of="")


def _read_as_numbers(body: list[Statement], counted: frozenset[sp.Symbol]) -> set[sp.Symbol] | None:
    """The axes of the first statement that needs numbers where all others but the counted ones are in any turn."""
    known: dict[sp.Symbol, Type] = {}
    chosen = {s.name for s in body if isinstance(s, Let) and isinstance(s.value, NearestPeriod)}
    for statement in (_in_any_turn(s, counted) for s in body):
        try:
            check_statement(statement, known)
            known |= angles_of(statement, known)
        except IllTypedError:
            found = (_behind(body, reads(statement)) & chosen) - counted
            if not found:
                raise
            return found
    return None


def _behind(body: list[Statement], names: set[sp.Symbol]) -> set[sp.Symbol]:
    """The names, and what is behind those that are bound to more than a choice of a turn."""
    values = {s.name: s.value for s in body if isinstance(s, Let) and not isinstance(s.value, NearestPeriod)}
    found, pending = set[sp.Symbol](), set(names)
    while pending:
        name = pending.pop()
        found.add(name)
        pending |= symbols_of(values[name]) - found if name in values else set()
    return found
