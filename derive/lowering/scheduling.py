"""Scheduling: a value that only one side of a choice needs is computed on that side only.

    length = select(radius > tolerance, radius, 1)            if radius > tolerance:
    cos_q4 = select(radius > tolerance, x/length, cos(free))      cos_q4 = x/radius
    sin_q4 = select(radius > tolerance, y/length, sin(free))      sin_q4 = y/radius
                                                        →     else:
                                                                  cos_q4 = cos(free)
                                                                  sin_q4 = sin(free)

A language that evaluates only one side of a choice prints the result; the values are the same. A statement may move to
where it is needed, because a program is total.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from operator import is_

import sympy as sp

from derive.ir.passes import with_bound_reason, with_inputs
from derive.ir.primitives import Select
from derive.ir.program import Let, Output, Program, Require, Statement, rewritten
from derive.ir.symbols import names_in
from derive.ir.tree import If, Item, bound_behind, read_in
from derive.lowering.stretches import gathered


def together(program: Program) -> Program:
    """Move choices by the same condition, and the values that they need, to the first such choice.

    They move across refusals, because a program is total. A value that needs a statement of another kind stays.
    """
    stretches: list[list[Let]] = [[]]
    others: list[Statement] = []
    for statement in program.body:
        if isinstance(statement, Let):
            stretches[-1].append(statement)
        else:
            others.append(statement)
            stretches.append([])
    first: dict[sp.Basic, int] = {}
    for place, lets in enumerate(stretches):
        for let in tuple(lets):
            if isinstance(let.value, Select):
                _advance(let, place, first.setdefault(let.value.args[0], place), stretches, others)
    ends: list[list[Statement]] = [[other] for other in others]
    body = tuple(s for lets, end in zip(stretches, [*ends, []], strict=True) for s in (*lets, *end))
    return replace(program, body=body)


def _advance(let: Let, place: int, target: int, stretches: list[list[Let]], others: Sequence[Statement]) -> None:
    """Move a statement and all that it needs to the end of an earlier stretch, if everything can be computed there."""
    between = [s for lets in stretches[target + 1 : place + 1] for s in lets]
    needed = set(let.reads()) | {let.name}
    for other in reversed(between):
        needed |= other.reads() if other.name in needed else set()
    if not any(needed & set(s.bound()) for s in others[target:place]):
        moved = [s for s in between if s.name in needed]
        stretches[target] += moved
        for lets in stretches[target + 1 : place + 1]:
            lets[:] = [s for s in lets if s.name not in needed]


def refused_late(body: Iterable[Statement]) -> tuple[Statement, ...]:
    """Move the conditions behind the values, for arrays: all rows are computed in any case, and values that stand
    together can share a choice.

    The first conditions check the inputs and stay in front. No condition moves across an iteration, a search or a call:
    these skip refused rows.
    """
    found: list[Statement] = []
    waiting: list[Statement] = []
    for statement in body:
        if isinstance(statement, Require) and not all(isinstance(s, Require) for s in found):
            waiting.append(statement)
            continue
        if not statement.is_straight:
            found, waiting = [*found, *waiting], []
        found.append(statement)
    return (*found, *waiting)


def scheduled(body: Sequence[Item], wanted: Sequence[sp.Basic]) -> tuple[Item, ...]:
    """The statements of a program, in which choices that share a condition are gathered with the values that only they
    need.
    """
    return _sunk(_in_arms(body, wanted), {s for value in wanted for s in names_in(value)})


def with_reasons_on_sides(items: Sequence[Item], program: Program) -> tuple[Item, ...]:
    """The statements; a value that a choice binds on one side only is written out in the reasons that read it."""
    values = {let.name: let.value for let in program.lets()}
    bound: set[sp.Symbol] = set()
    found: list[Item] = []
    for item in items:
        found.append(item if isinstance(item, If) else with_bound_reason(item, bound, values))
        bound |= bound_behind(item)
    return tuple(found)


def _sunk(items: Sequence[Item], later: set[sp.Symbol]) -> tuple[Item, ...]:
    """A value that only second sides (the singular ones) of several choices read is bound on each of these sides."""
    found: list[Item] = []
    needed = set(later)
    for item in reversed(items):
        if isinstance(item, Let) and item.name not in needed and any(isinstance(i, If) for i in found):
            found = [_with(i, item) if isinstance(i, If) else i for i in found]
            continue
        needed |= _reads_always(item)
        found.insert(0, item)
    return tuple(found)


def _reads_always(item: Item) -> set[sp.Symbol]:
    """The names that a statement reads; those that a choice reads in its condition and on its first side."""
    return read_in(item.holds) | names_in(item.condition) if isinstance(item, If) else read_in((item,))


def _with(arms: If, let: Let) -> If:
    """The choice with a statement in front of its second side, if that reads it."""
    if let.name not in read_in(arms.fails):
        return arms
    return replace(arms, fails=(let, *arms.fails))


def _in_arms(body: Sequence[Item], wanted: Sequence[sp.Basic]) -> tuple[Item, ...]:
    later = frozenset(s for value in wanted for s in names_in(value))
    found: list[Item] = []
    stretch: list[Let] = []
    for statement in reversed(body):
        if isinstance(statement, Let):
            stretch.insert(0, statement)
            continue
        found[:0] = [statement, *gathered(stretch, later)]
        later = later.union(*(names_in(let.value) for let in stretch), read_in((statement,)))
        stretch = []
    return (*gathered(stretch, later), *found)


def decided(program: Program) -> Program:
    """The program for a language that returns where a condition does not hold: it is not tested again behind that.

    require(length > tolerance)
    divisor = select(length > tolerance, length, 1)      →  length is read where divisor was
    """
    known: dict[sp.Basic, sp.Basic] = {}
    about: set[sp.Symbol] = set()  # the names in the known conditions: an expression without any of them stays
    body: list[Statement] = []

    def read(expression: sp.Basic) -> sp.Basic:
        return expression if about.isdisjoint(names_in(expression)) else expression.xreplace(known)

    for statement in program.body:
        changed = rewritten(statement, read)
        if isinstance(changed, Let) and changed is not statement and changed.value.is_Symbol:
            known[changed.name] = changed.value
            about.add(changed.name)
            continue
        if isinstance(changed, Require):
            if changed.condition == sp.true:
                continue
            known |= dict.fromkeys(sp.And.make_args(changed.condition), sp.true)
            about |= names_in(changed.condition)
        body.append(changed)
    outputs = tuple(Output(o.name, read(o.value)) for o in program.outputs)
    if len(body) == len(program.body) and all(map(is_, body, program.body)) and outputs == program.outputs:
        return program
    return with_inputs(replace(program, body=tuple(body), outputs=outputs))
