"""The equations of the commanded rotation for the rotations of a chain that are still unknown: L^-1 R S^-1 = M.

They are written again whenever an angle becomes known: the known rotations at both ends are moved to the side of the
commanded one, one after the other, each entry under a name: `r13_from_a12` is r13 in the frame behind A1 and A2,
`r13_before_a6` is r13 of the frame in front of A6.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.algebra.angle_sums import name_of, terms_of
from derive.algebra.normal_form import is_compound, polynomial, reduce_units
from derive.equations.problem import Equation, Problem
from derive.geometry.frames import Chain, Factor
from derive.geometry.pose import pose_of
from derive.ir.program import (
    Let,
)
from derive.ir.symbols import (
    names_in,
    real,
)

_MOST_UNKNOWN = 2
"""No subproblem takes an equation with more unknown angles than this."""


def rotations(problem: Problem) -> tuple[Equation, ...]:
    """The entries of L^-1 R S^-1 = M that depend on unknown angles."""
    return tuple(e for e in _entries(problem) if problem.unknowns_of(e.expression))


def conditions(problem: Problem) -> tuple[Equation, ...]:
    """The entries of L^-1 R S^-1 = M without unknown angles: conditions on the known ones."""
    return tuple(e for e in _entries(problem) if not problem.unknowns_of(e.expression) and e.expression != 0)


def _entries(problem: Problem) -> tuple[Equation, ...]:
    if not problem.turns or not any(_unknown(problem, t) for t in problem.turns):
        return ()
    turns = list(problem.turns)
    lets: list[Let] = []
    entries = sp.Matrix(3, 3, list(problem.rotation))
    front, back = _Side("from", "base"), _Side("before", "flange")
    while not _unknown(problem, turns[0]):
        turn = turns.pop(0)
        front = front.behind(_word(problem, turn), turn)
        entries = _named(problem, _matrix(problem, turn, lets).T * entries, front.suffix, lets)
    while len(problem.columns) == 3 and not _unknown(problem, turns[-1]):
        turn = turns.pop()
        back = back.behind(_word(problem, turn), turn)
        entries = _named(problem, entries * _matrix(problem, turn, lets).T, front.suffix + back.suffix, lets)
    return _entry_equations(problem, turns, entries, tuple(lets))


@dataclass(frozen=True)
class _Side:
    """The known rotations at one end of the chain, which names of entries end in."""

    word: str
    end: str
    joints: tuple[str, ...] = ()
    """Base first."""
    fixed: int = 0
    """The number of oblique fixed rotations since the last joint: one by right angles only permutes the entries."""

    def behind(self, joints: tuple[str, ...], turn: Factor) -> _Side:
        """The side with one more rotation."""
        if joints:
            return replace(
                self, joints=(*self.joints, *joints) if self.word == "from" else (*joints, *self.joints), fixed=0
            )
        is_oblique = any(entry not in (-1, 0, 1) for entry in turn.matrix())
        return replace(self, fixed=self.fixed + is_oblique)

    @property
    def suffix(self) -> str:
        """The end of the names of entries: `_from_a12`, `_from_a12_turned`, `_before_flange`."""
        turned = ("", "_turned", *(f"_turned_{n}" for n in range(2, self.fixed + 1)))
        if self.joints:
            return f"_{self.word}_{name_of(tuple((real(name), 1) for name in self.joints))}{turned[self.fixed]}"
        return f"_{self.word}_{self.end}{turned[self.fixed - 1]}" if self.fixed else ""


def _entry_equations(
    problem: Problem, turns: Sequence[Factor], entries: sp.Matrix, lets: tuple[Let, ...]
) -> tuple[Equation, ...]:
    middle = pose_of(Chain(tuple(turns))).rotation
    found = []
    for i in range(3):
        for j in problem.columns:
            if len({a for a in problem.angles if a in names_in(middle[i, j])}) > _MOST_UNKNOWN:
                continue
            if any(a in names_in(middle[i, j]) for a in problem.pending):
                continue
            form = polynomial(middle[i, j], problem.units, problem.signs)
            expression = reduce_units(form - entries[i, j], problem.units, problem.signs)
            found.append(Equation(f"r{i + 1}{j + 1}", expression, _needed(lets, expression), is_length=False))
    return tuple(found)


def _needed(lets: Sequence[Let], expression: sp.Expr) -> tuple[Let, ...]:
    """The statements that bind the names in an expression, directly or by other names, in order."""
    wanted = set(expression.free_symbols)
    kept: list[Let] = []
    for let in reversed(lets):
        if let.name in wanted:
            kept.append(let)
            wanted |= let.value.free_symbols
    return tuple(reversed(kept))


def _unknown(problem: Problem, turn: Factor) -> bool:
    return bool(turn.amount.free_symbols & {*problem.angles, *problem.pending})


def _word(problem: Problem, turn: Factor) -> tuple[str, ...]:
    """The names of the joints of a rotation."""
    return tuple(a.name for a in problem.units if a in turn.amount.free_symbols)


def _matrix(problem: Problem, turn: Factor, lets: list[Let]) -> sp.Matrix:
    """The matrix of a known rotation; the cosine and sine of a sum of angles by their names."""
    matrix = sp.Matrix(turn.matrix()[:3, :3])
    table: dict[sp.Expr, sp.Expr] = {}
    for function in sorted(matrix.atoms(sp.sin, sp.cos), key=sp.default_sort_key):
        table[function] = polynomial(function, problem.units, problem.signs)
        terms = terms_of(function.args[0], problem.units)
        if terms is not None and len(terms) > 1:
            name = real(f"{'sin' if isinstance(function, sp.sin) else 'cos'}_{name_of(terms)}")
            lets.append(Let(name, table[function]))
            table[function] = name
    return matrix.xreplace(table)


def _named(problem: Problem, entries: sp.Matrix, word: str, lets: list[Let]) -> sp.Matrix:
    """The entries by names of their own, where they are more than a name."""
    named = sp.zeros(3, 3)
    for i in range(3):
        for j in range(3):
            value = entries[i, j]
            if is_compound(value):
                lets.append(Let(real(f"r{i + 1}{j + 1}{word}"), value))
                value = lets[-1].name
            named[i, j] = value
    return named
