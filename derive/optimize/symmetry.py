"""Mirrored branches: a value that another one gives by a change of sign or by half a turn is not computed again.

    c_up = select(r > tolerance, -x/r, cos(free))     where r > tolerance, c_up is -c_down
    m_up = a * c_up + b * s_up                     →  m_up = select(r > tolerance, -m_down, a * c_up + b * s_up)
    axis_up = turn(atan2(m_up, n_up))              →  turned = select(r > tolerance, axis_down + 180, atan2(m_up, n_up))
                                                      axis_up = turn(turned)

A wrist that is turned over is another case. It serves a language that computes one side of a choice alone.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import sympy as sp

from derive.ir.constants import (
    DEGREE,
)
from derive.ir.primitives import (
    Atan2,
    NearestPeriod,
    Select,
)
from derive.ir.program import (
    Let,
    Output,
    Program,
    Statement,
    rewritten,
)
from derive.ir.symbols import (
    is_condition,
    real,
    symbols_of,
)
from derive.ir.verify import verify
from derive.optimize.without_periods import angles_modulo_turns


def with_mirrored_branches(program: Program) -> Program:
    """The program with values taken from those of mirrored branches."""
    finder = _Finder(angles_modulo_turns(program))
    body = tuple(found for s in program.body for found in finder.seen(s))
    outputs = tuple(Output(o.name, o.value.xreplace(finder.negatives)) for o in program.outputs)
    return verify(replace(program, body=body, outputs=outputs))


@dataclass
class _Finder:
    angles_modulo_turns: frozenset[sp.Symbol]
    """Angles that may be a turn more or less."""
    values: dict[sp.Expr, sp.Symbol] = field(default_factory=dict)
    """Who has a value."""
    angles: dict[tuple[sp.Expr, ...], sp.Symbol] = field(default_factory=dict)
    """Who has an angle, by its shift, the middle of its turn, and the coordinates of its direction."""
    sides: dict[tuple[sp.Basic, sp.Expr], tuple[sp.Symbol, sp.Expr]] = field(default_factory=dict)
    """Who has a value where a condition holds, and what else."""
    known: dict[sp.Basic, dict[sp.Basic, sp.Expr]] = field(default_factory=dict)
    """By condition: what a name is there, in terms of another one."""

    negatives: dict[sp.Basic, sp.Expr] = field(default_factory=dict)
    """Angles that are the negative of another one."""

    def seen(self, statement: Statement) -> tuple[Statement, ...]:
        """The statement, by its twin where it has one: everywhere, or on the first side of a choice."""
        statement = rewritten(statement, lambda e: e.xreplace(self.negatives))
        if not isinstance(statement, Let):
            return (statement,)
        mirrored = self._mirrored(statement.value) if statement.name in self.angles_modulo_turns else None
        if mirrored is not None:
            self.negatives[statement.name] = mirrored
            return ()
        twin = self._turned(statement.value)
        if twin is not None:
            return (replace(statement, value=twin),)
        for condition, known in self.known.items():
            if symbols_of(statement.value) & known.keys():
                found = self._chosen(statement, condition, known)
                if found:
                    return found
        self._remember(statement)
        return (statement,)

    def _chosen(self, let: Let, condition: sp.Basic, known: dict[sp.Basic, sp.Expr]) -> tuple[Statement, ...]:
        """The choice between the twin and the value, where there is a twin if the condition holds."""
        there = let.value.xreplace(known)
        if is_condition(there):
            return ()
        for sign, value in ((1, there), (-1, _negative(there))):
            if value in self.values:
                known[let.name] = sign * self.values[value]
                return (replace(let, value=Select(condition, known[let.name], let.value)),)
        turned = self._turned(there)
        if turned is None:
            return ()
        direction = real(f"direction_of_{let.name.name}")
        chosen = Let(direction, Select(condition, turned.args[0], let.value.args[0]))
        return chosen, replace(let, value=NearestPeriod(direction, let.value.args[1]))

    def _mirrored(self, value: sp.Expr) -> sp.Expr | None:
        """The angle of a mirrored direction, up to a turn."""
        other = self.values.get(Atan2(-value.args[0], value.args[1])) if isinstance(value, Atan2) else None
        return None if other is None else -other

    def _turned(self, value: sp.Expr) -> sp.Expr | None:
        """An angle by that of the mirrored or of the opposite direction."""
        angle = _angle(value)
        if angle is None:
            return None
        shift, near, sine, cosine = angle
        if (shift, near, -sine, cosine) in self.angles:
            return NearestPeriod(2 * shift - self.angles[shift, near, -sine, cosine], near)
        if (shift, near, -sine, -cosine) in self.angles:
            return NearestPeriod(self.angles[shift, near, -sine, -cosine] + 180, near)
        return None

    def _remember(self, let: Let) -> None:
        self.values.setdefault(let.value, let.name)
        angle = _angle(let.value)
        if angle is not None:
            self.angles.setdefault(angle, let.name)
        if isinstance(let.value, Select):
            condition, first, second = let.value.args
            if first.is_Symbol:
                self.known.setdefault(condition, {})[let.name] = first
            twin = self.sides.get((condition, -first))
            if twin is not None and twin[1] == second:
                self.known.setdefault(condition, {})[let.name] = -twin[0]
            self.sides.setdefault((condition, first), (let.name, second))


def _negative(value: sp.Expr) -> sp.Expr:
    """The negative, of a choice side by side."""
    return Select(value.args[0], *map(_negative, value.args[1:])) if isinstance(value, Select) else -value


def _angle(value: sp.Expr) -> tuple[sp.Expr, sp.Expr, sp.Expr, sp.Expr] | None:
    """Shift, middle of the turn, sine and cosine of `NearestPeriod(shift + Atan2(sine, cosine)/DEGREE, near)`."""
    if not isinstance(value, NearestPeriod):
        return None
    direction, near = value.args
    found = [term for term in sp.Add.make_args(direction) if isinstance(term * DEGREE, Atan2)]
    if len(found) != 1:
        return None
    sine, cosine = (found[0] * DEGREE).args
    return direction - found[0], near, sine, cosine
