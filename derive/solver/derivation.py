"""What the driver gives: the statements that solve a problem, and the steps in which they were found."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from derive.equations.problem import Binding, Conditioning, Problem, StepDeterminant
from derive.ir.program import Statement
from derive.solver.parallel_axes import Sum


@dataclass(frozen=True)
class Step:
    """One step: the problem before it, the binding that a rule found, and this binding with its recorded names."""

    problem: Problem
    found: Binding
    recorded: Binding
    span: tuple[int, int] = (0, 0)
    """Where the statements of the step begin and end among those of the derivation that are `plain`."""
    names: tuple[tuple[sp.Symbol, sp.Symbol], ...] = ()
    """The names in `found` that have another name in `recorded`, each with the other name."""


@dataclass(frozen=True)
class Derivation:
    """The solution as statements, with the determinants of its two-root steps, and the conditioning of every step
    whose angle may be free.
    """

    statements: tuple[Statement, ...]
    determinants: tuple[StepDeterminant, ...]
    conditionings: tuple[Conditioning, ...]
    rules: tuple[str, ...]
    sums: tuple[Sum, ...] = ()
    residuals: tuple[sp.Expr, ...] = ()
    """With an equation too many: the expressions that vanish if the equations agree with each other."""
    wrist: tuple[sp.Symbol, ...] = ()
    """With an equation too many in the positions: the joints behind them, which take any rotation."""
    conditions: tuple[sp.Expr, ...] = ()
    """Values of parameters that must not vanish."""
    plain: tuple[Statement, ...] = ()
    """The statements of the steps alone: a mechanism may put others in front."""
    steps: tuple[Step, ...] = ()
    """The steps in their order, for a reader."""
