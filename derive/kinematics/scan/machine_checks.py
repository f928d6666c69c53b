"""Checks of a trial that parameters alone decide: they refuse a machine when it is set up, and no trial.

An arm whose length is a distance may be zero: then the angle that turns it is not determined. A step refuses that in
front of its roots. No search along a joint can follow this check, and none has to: it holds at every trial or at none.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import sympy as sp

from derive.description.mechanism import Constraint
from derive.ir.primitives import Root
from derive.ir.program import Let, Require, Statement
from derive.ir.reason import Why


@dataclass(frozen=True)
class MachineCheck:
    """A length of the machine that may not vanish, and what it is compared with."""

    joint: str
    length: sp.Expr
    least: sp.Expr

    def constraint(self, fixed: Iterable[Let]) -> Constraint:
        """The check as the set-up of a machine makes it. fixed: what names made of parameters stand for."""
        written = {let.name: let.value for let in fixed}
        length, least = self.length.xreplace(written), self.least.xreplace(written)
        names = " and ".join(sorted(str(s) for s in length.free_symbols))
        told = f"{names} must not vanish: the arm that {self.joint.upper()} turns would have no length"
        return Constraint(sp.Gt(length, least), told)


def apart(
    statements: Iterable[Statement], parameters: Iterable[sp.Symbol]
) -> tuple[tuple[Statement, ...], tuple[MachineCheck, ...]]:
    """The statements without the checks of arms that are made of parameters alone, and these."""
    own, known = set(parameters), dict[sp.Symbol, sp.Expr]()
    kept: list[Statement] = []
    checks: list[MachineCheck] = []
    for s in statements:
        if isinstance(s, Let) and s.value.free_symbols and s.value.free_symbols <= own | known.keys():
            known[s.name] = s.value.xreplace(known)
        check = _check(s, known, own) if isinstance(s, Require) else None
        if check is None:
            kept.append(s)
        else:
            checks.append(check)
    return tuple(kept), tuple(checks)


def _check(check: Require, known: dict[sp.Symbol, sp.Expr], own: set[sp.Symbol]) -> MachineCheck | None:
    condition = check.condition
    if not isinstance(condition, sp.StrictGreaterThan) or check.reason is None or check.reason.why is not Why.TOO_SHORT:
        return None
    length, least = (side.xreplace(known).replace(Root, sp.sqrt) for side in condition.args)
    is_fixed = length.free_symbols | least.free_symbols <= own
    return MachineCheck(check.reason.subject.name, length, least) if is_fixed else None
