"""The program for poses where nothing is singular: it takes the first side of each choice by a comparison, and refuses
where that is wrong.

    length = select(radius > 1e-11, radius, 1)                 require(radius > 1e-11)
    cos_c = select(radius > 1e-11, x/length, cos(free))    →   cos_c = x/radius

The first side of a choice by a comparison of numbers is the regular one. A choice by a flag of the machine stays, and
so does the choice of a status: a refused branch is not singular. If the result refuses, the whole program decides.
So it serves where many poses are computed by the same instructions, and a few of them once more.
"""

from __future__ import annotations

from collections.abc import Collection

import sympy as sp

from derive.ir.constants import EDGE
from derive.ir.passes import normalise, without_reasons
from derive.ir.primitives import Atan2, NearestPeriod, Root, Select, ToReal
from derive.ir.program import Let, Program, Require, Statement, Status
from derive.ir.symbols import is_count, names_in

_HALF_A_TURN = 180 + 2 * EDGE
"""The largest distance, in degrees, of an axis value on its chosen period from the centre."""
_PLAIN = (Root, Atan2, Select, ToReal, NearestPeriod, sp.Abs)


def regular(program: Program, constants: Collection[str]) -> Program | None:
    """The program for regular poses; None if it has more than arithmetic, roots and angles. constants: the names of
    constants of the machine.
    """
    if not all(isinstance(s, Let | Require) for s in program.body):
        return None
    own = frozenset(constants)
    wanted = {s for o in program.outputs for s in names_in(o.value)}
    wanted |= {s for r in program.requires() for s in names_in(r.condition)}
    lets = {let.name: let for let in program.lets()}
    found = _needed(lets, wanted, own)
    body: list[Statement] = []
    for statement in without_reasons(program).body:
        body += found.get(statement.name, ()) if isinstance(statement, Let) else (statement,)
    done = normalise(program.name, body, program.outputs)
    return done if all(map(_is_plain, done.lets())) else None


def _needed(
    lets: dict[sp.Symbol, Let], wanted: set[sp.Symbol], constants: frozenset[str]
) -> dict[sp.Symbol, tuple[Statement, ...]]:
    """The statements in place of each needed one, where only first sides are computed."""
    found: dict[sp.Symbol, tuple[Statement, ...]] = {}
    pending = [lets[name] for name in wanted & lets.keys()]
    while pending:
        let = pending.pop()
        if let.name in found:
            continue
        value, conditions = (let.value, ()) if is_count(let.name) else _first_sides(let.value, constants)
        found[let.name] = (
            *(Require(condition, Status.OK) for condition in conditions),
            Let(let.name, value, let.note, let.turn_of),
            *_on_its_turn(let.name, value),
        )
        read = names_in(value).union(*map(names_in, conditions))
        pending += [lets[name] for name in read & lets.keys()]
    return found


def _on_its_turn(name: sp.Symbol, value: sp.Basic) -> tuple[Require, ...]:
    """The condition that a value is no NaN, and lies on its chosen period."""
    if not isinstance(value, NearestPeriod):
        return ()
    return (Require(sp.Le(sp.Abs(name - value.args[1]), _HALF_A_TURN), Status.OK),)


def _is_plain(let: Let) -> bool:
    """Whether a value consists of arithmetic, roots and angles alone."""
    calls = let.value.atoms(sp.Function)
    return all(isinstance(call, _PLAIN) for call in calls) and not let.value.atoms(NearestPeriod) - {let.value}


def _first_sides(value: sp.Basic, constants: frozenset[str]) -> tuple[sp.Basic, tuple[sp.Basic, ...]]:
    """A value in which choices are replaced by their first sides, and the conditions under which that is right."""
    conditions: list[sp.Basic] = []
    while choices := [c for c in value.atoms(Select) if not _is_of_machine(c.args[0], constants)]:
        outermost = max(choices, key=lambda c: (sp.count_ops(c), str(c)))
        conditions.append(outermost.args[0])
        value = value.xreplace({outermost: outermost.args[1]})
    return value, tuple(conditions)


def _is_of_machine(condition: sp.Basic, constants: frozenset[str]) -> bool:
    return all(name.name in constants for name in names_in(condition))
