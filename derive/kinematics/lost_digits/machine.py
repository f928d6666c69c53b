"""What the steps on the closure of a machine need to know of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import sympy as sp

from derive.description.mechanism import Joint, Mechanism, Turning
from derive.equations.chain_splits import is_spatial
from derive.ir.program import Statement
from derive.ir.symbols import Flag
from derive.kinematics.branches.assignment import Assignment
from derive.kinematics.differential import jacobian_rows
from derive.kinematics.inverse import Inverse

_ROTATED = (Turning.NONE, Turning.ABOUT_Z, Turning.DIRECTION, Turning.FULL)
"""The commanded rotations whose error is known."""


@dataclass(frozen=True)
class Commanded:
    """What an axis tells of the value that it has."""

    shift: sp.Expr
    """What is added to the axis value that it has."""
    gain: sp.Expr
    """What the sum is divided by."""

    def value(self, has: sp.Expr) -> sp.Expr:
        """What it tells."""
        return (has + self.shift) / self.gain


@dataclass(frozen=True)
class Machine:
    """What the steps need: the solved inverse, and its derivation and the pose at given axis values."""

    mechanism: Mechanism
    inverse: Inverse
    assignments: tuple[Assignment, ...]
    at_axes: tuple[Statement, ...]
    is_point: bool = False
    """Whether a point off the flange is commanded."""
    entries: tuple[Sequence[Statement], Sequence[sp.Expr]] | None = None
    """The statements and the entries of the Jacobian; None: they follow from the mechanism."""
    commanded: Mapping[Joint, Commanded] = field(default_factory=dict)
    """What the axes tell of the values that the steps find, where this differs."""
    deviates: Flag | None = None
    """The flag of a machine with deviations: the steps meet every pose of it."""

    @property
    def turning(self) -> Turning:
        """The commanded part of the rotation."""
        return Turning.NONE if self.is_point else self.mechanism.task.turning

    @property
    def rows(self) -> tuple[str, ...]:
        """The rows of the Jacobian that the closure has."""
        return tuple(self.mechanism.task.position) if self.is_point else jacobian_rows(self.mechanism)

    @property
    def has_steps(self) -> bool:
        """Whether there are steps on its closure: it must be that of a chain."""
        chain = self.mechanism.chain
        is_known = chain is not None and (is_spatial(chain) or not self.is_point)
        return is_known and self.turning in _ROTATED
