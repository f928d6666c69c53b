"""The equations of the commanded rotation for the rotations of a chain that are still unknown: L^-1 R S^-1 = M.

They are written again whenever an angle becomes known: the known rotations at both ends are moved to the side of the
commanded one, one after the other, and each entry gets a name: `r13_from_a12` is r13 in the frame behind A1 and A2,
`r13_before_a6` is r13 of the frame in front of A6.
"""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from derive.algebra.normal_form import polynomial, reduce_units
from derive.equations.known_turns import between_known, is_unknown, needed
from derive.equations.pitch.equations import followed_entries
from derive.equations.problem import Column, Equation, Problem
from derive.geometry.frames import Chain, Factor
from derive.geometry.pose import pose_of
from derive.ir.program import Let
from derive.ir.symbols import names_in

_MOST_UNKNOWN = 2
"""No subproblem takes an equation with more unknown angles than this."""


def rotations(problem: Problem) -> tuple[Equation, ...]:
    """The entries of L^-1 R S^-1 = M that depend on unknown angles; for a pitch, its own equations."""
    if problem.followed:
        return followed_entries(problem) if problem.turns else ()
    return tuple(e for e in _entries(problem) if problem.unknowns_of(e.expression))


def conditions(problem: Problem) -> tuple[Equation, ...]:
    """The entries of L^-1 R S^-1 = M without unknown angles: conditions on the known ones."""
    return tuple(e for e in _entries(problem) if not problem.unknowns_of(e.expression) and e.expression != 0)


def _entries(problem: Problem) -> tuple[Equation, ...]:
    if not problem.turns or not any(is_unknown(problem, t) for t in problem.turns):
        return ()
    turns, entries, lets = between_known(problem, moves_last=len(problem.columns) == 3)
    return _entry_equations(problem, turns, entries, tuple(lets))


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
            label, column = f"r{i + 1}{j + 1}", _column(entries[:, j], i, lets)
            found.append(Equation(label, expression, needed(lets, expression), is_length=False, column=column))
    return tuple(found)


def _column(entries: sp.Matrix, row: int, lets: tuple[Let, ...]) -> Column | None:
    """The column of an entry, with its other two entries; None if the entry has no name."""
    entry = entries[row] if entries[row].is_Symbol else -entries[row]
    others = sp.Add(*[entries[k] ** 2 for k in range(3) if k != row])
    return Column(entry, others, needed(lets, entry + others)) if entry.is_Symbol else None
