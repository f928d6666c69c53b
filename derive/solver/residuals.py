"""The residual of a trial: with one joint known there is one equation too many, which holds at a root alone."""

from __future__ import annotations

import sympy as sp

from derive.equations.problem import Binding, Problem
from derive.equations.rotations import conditions
from derive.solver.derivation_record import DerivationRecord


def unknowns_in(problem: Problem) -> set[sp.Symbol]:
    """The unknowns in the equations."""
    return {u for e in problem.equations for u in problem.unknowns_of(e.expression)}


def left_alone(problem: Problem, record: DerivationRecord) -> list[sp.Expr]:
    """The residuals of the equations of a trial that hold none of its unknowns."""
    alone = [e for e in problem.equations if not problem.unknowns_of(e.expression)]
    bindings = [Binding(e.label, (), e.lets, residual=e.expression / problem.scale_of(e)) for e in alone]
    return [left for b in bindings if (left := record.commit(b).residual) is not None]


def left_of_rotation(problem: Problem, record: DerivationRecord) -> list[sp.Expr]:
    """The expressions that vanish where the commanded rotation agrees with the positions."""
    bindings = (Binding("rotation", (), c.lets, residual=c.expression) for c in conditions(problem))
    found = [record.commit(binding).residual for binding in bindings]
    return [residual for residual in found if residual is not None]


def left_of_positions(problem: Problem, record: DerivationRecord) -> list[sp.Expr]:
    """The residual of the positions where they have one equation too many; if it is zero, the others are zero."""
    return [residual / problem.scale**2 for residual in record.residuals[:1]]
