"""The pose of a mechanism at its axis values, as statements."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from derive.equations.problem import Slope
from derive.ir.program import Statement


@dataclass(frozen=True)
class Forward:
    """The pose as statements: joint values, cosines and sines, position; and the entries of the rotation."""

    statements: tuple[Statement, ...]
    position: tuple[sp.Expr, ...]
    rotation: tuple[sp.Expr, ...]
    slope: Slope | None = None
    """The slope of the step with two solutions: its sign is the assembly mode."""
