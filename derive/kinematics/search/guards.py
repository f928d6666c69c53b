"""The places where a trial is out of reach: the conditions of its two-root steps.

Where a guard vanishes the two roots of its step join, and the trial goes on with the other root: on the other side.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from derive.equations.problem import StepDeterminant
from derive.ir.constants import BOUNDARY
from derive.ir.primitives import Select
from derive.ir.program import Require, Statement
from derive.solver.derivation import Derivation


@dataclass(frozen=True)
class Guard:
    """A two-root step of a trial, and the condition under which it has roots."""

    step: sp.Symbol
    condition: sp.Basic

    @property
    def room(self) -> sp.Expr:
        """The amount by which the condition holds."""
        return room_of(self.condition)


def guards_of(derivation: Derivation) -> tuple[Guard, ...] | None:
    """The guards of a trial; None where it has a condition that no search can follow: each has a two-root step."""
    found: list[Guard] = []
    for s in derivation.statements:
        if not isinstance(s, Require):
            continue
        step = _step_of(s, derivation.determinants)
        if step is None or not _is_followed(s.condition) or step in [g.step for g in found]:
            return None
        found.append(Guard(step, s.condition))
    return tuple(found)


def without_wrist(derivation: Derivation) -> tuple[Statement, ...]:
    """The statements without the conditions of a wrist: it has no part in whether a trial is a root."""
    steps = [step for step in derivation.determinants if step.step in derivation.wrist]
    return tuple(s for s in derivation.statements if not isinstance(s, Require) or _step_of(s, steps) is None)


def _step_of(check: Require, steps: Sequence[StepDeterminant]) -> sp.Symbol | None:
    """The unknown of the step that a check belongs to."""
    name = "" if check.reason is None else check.reason.subject.name
    return next((s.step for s in steps if s.step.name == name), None)


def _is_followed(condition: sp.Basic) -> bool:
    return isinstance(condition, sp.Ge) or (isinstance(condition, sp.Le) and isinstance(condition.args[0], sp.Abs))


def conditions_of(statements: Sequence[Statement]) -> list[sp.Basic]:
    """The conditions of the guards, in their order."""
    return [s.condition for s in statements if isinstance(s, Require)]


def room_of(condition: sp.Basic) -> sp.Expr:
    """The amount by which a condition holds, without a unit: 1 - c^2 for a cosine c whose size is at most 1; for a
    radicand, its amount above the bound, divided by the scale of which the bound is `BOUNDARY`.
    """
    if isinstance(condition, sp.Le):
        (cosine_value,) = condition.lhs.args
        return 1 + BOUNDARY - cosine_value**2
    radicand, bound = condition.args
    return radicand / (-bound / BOUNDARY).as_coeff_Mul()[1] + BOUNDARY


def least(values: Sequence[sp.Expr]) -> sp.Expr:
    """The least of some values."""
    found = values[0]
    for value in values[1:]:
        found = Select(sp.Le(found, value), found, value)
    return found
