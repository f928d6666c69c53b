"""Where a mechanism is singular, read off its description: branch indicators and positive quantities that vanish."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import sympy as sp

from tests.mechanisms.closure import Array
from tests.mechanisms.machines import Machine


@dataclass(frozen=True)
class Locus:
    """A joint combination `argument` that makes a quantity vanish at `target` (radians or length)."""

    machine: Machine
    argument: sp.Expr
    target: float
    branch: int | None
    """The branch whose two solutions meet here; None where a positive quantity ends."""

    @property
    def is_length(self) -> bool:
        """Whether the quantity is a length that ends, and no angle."""
        return any(j.symbol == self.argument and not j.is_angle for j in self.machine.mechanism.joints)

    @property
    def inward(self) -> float:
        """The direction of a shift from the locus that the machine can make: both, for a branch."""
        return -1.0 if self.branch is None and self.target > 0 else 1.0

    def moved(self, axes: Array, shift: float | Array) -> Array:
        """The axis values with the argument at its target plus a shift (radians, or per reach), one for all or a row."""
        symbols = [j.symbol for j in self.machine.mechanism.joints]
        last = max(i for i, s in enumerate(symbols) if s in self.argument.free_symbols)
        joints = self.machine.closure.joints(axes)
        wanted = self.target + shift * (self.machine.reach if self.is_length else 1.0)
        factors = [float(self.argument.coeff(s)) for s in symbols]
        joints[:, last] += (wanted - joints @ factors) / factors[last]
        return self.machine.closure.axes(joints)


def loci(machine: Machine) -> list[Locus]:
    """Every place where some quantity of the description vanishes."""
    found = []
    quantities: list[tuple[int | None, sp.Expr]] = [(i, b.indicator) for i, b in enumerate(machine.mechanism.branches)]
    quantities += [(None, p) for p in machine.mechanism.positive]
    for branch, quantity in quantities:
        _, bare = sp.sympify(quantity).as_coeff_Mul()
        if isinstance(bare, sp.sin):
            found += [Locus(machine, bare.args[0], target, branch) for target in (0.0, np.pi)]
        else:
            assert bare.is_Symbol, f"teach the tests where {quantity} vanishes"
            found.append(Locus(machine, bare, 0.0, branch))
    return found
