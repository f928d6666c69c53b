"""The candidates for margins: the determinants of the steps and their conditioning, each over its scale."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from derive.description.mechanism import Mechanism
from derive.equations.problem import Conditioning
from derive.ir.constants import COINCIDENT
from derive.ir.primitives import Select
from derive.ir.program import Let
from derive.ir.symbols import SCALE, real
from derive.kinematics.branches.assignment import Assignment
from derive.kinematics.parameters import has_length


@dataclass(frozen=True)
class Factor:
    """A candidate for a margin: the determinant or the conditioning of a step over its scale, at axis values."""

    name: str
    value: sp.Expr
    is_length: bool = False
    """Whether it is in the user's unit of length, because the machine has no length to divide it by."""
    is_signed: bool = True

    @property
    def lets(self) -> tuple[Let, ...]:
        """The margin; for a length, 1 where it determines the axis and 0 where it does not."""
        margin = real(f"margin_{self.name}")
        if not self.is_length:
            return (Let(margin, self.value),)
        length = real(f"length_{self.name}")
        other = Select(sp.Lt(length, -COINCIDENT), sp.Integer(-1), sp.Integer(0)) if self.is_signed else sp.Integer(0)
        value = Select(sp.Gt(length, COINCIDENT), sp.Integer(1), other)
        return Let(length, self.value), Let(margin, value, "0 where no equation determines the axis, else 1 or -1")


def factor_of(mechanism: Mechanism, found: Assignment | Conditioning) -> Factor:
    """The determinant of a branch, or the conditioning of a step, over its scale."""
    has_unit = not has_length(mechanism)
    if isinstance(found, Assignment):
        return Factor(found.branch.margin, found.margin(mechanism), has_unit and found.determinant.scale.has(SCALE))
    return Factor(found.name, found.value / found.scale, has_unit and found.scale.has(SCALE), is_signed=False)
