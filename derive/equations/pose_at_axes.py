"""The pose of a mechanism at its axis values, as statements."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from derive.equations.problem import Slope
from derive.ir.program import Statement


@dataclass(frozen=True)
class Forward:
    """The pose as statements: joints, the cosines and sines it needs, position; and the rotation's entries."""

    statements: tuple[Statement, ...]
    position: tuple[sp.Expr, ...]
    rotation: tuple[sp.Expr, ...]
    slope: Slope | None = None
    """Of the step that has two solutions: its sign is the assembly mode."""


