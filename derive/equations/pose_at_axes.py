"""The pose of a mechanism at its axis values, as statements."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from derive.equations.problem import StepDeterminant
from derive.ir.program import Statement


@dataclass(frozen=True)
class Forward:
    """The pose as statements: joint values, cosines and sines, position; and the entries of the rotation."""

    statements: tuple[Statement, ...]
    position: tuple[sp.Expr, ...]
    rotation: tuple[sp.Expr, ...]
    determinant: StepDeterminant | None = None
    """The determinant of the step with two solutions: its sign is the assembly mode."""
