"""Checks of a derivation that parameters alone decide: they refuse a machine when it is set up, and no pose.

An arm that is made of parameters may have no length: then the angle that turns it is not determined. A step refuses
that in front of its roots, for every pose or for none. What the ranges of the parameters exclude is not tested at all.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import mpmath
import sympy as sp

from derive.description.mechanism import Constraint, Mechanism, Parameter
from derive.equations.closures.fixed_names import fixed_lets
from derive.ir.constants import DEGREE
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Require, Statement, rewritten
from derive.ir.reason import Why
from derive.ir.symbols import replaced

_FUNCTIONS = {"sin": mpmath.iv.sin, "cos": mpmath.iv.cos, "sqrt": lambda x: mpmath.iv.sqrt(_not_negative(x))}
_KNOWN = (sp.sin, sp.cos, sp.Abs)


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
        names = " and ".join(sorted(str(s) for s in length.free_symbols - {DEGREE}))
        told = f"{names} must not vanish: the arm that {self.joint.upper()} turns would have no length"
        return Constraint(sp.Gt(length, least), told)


def with_checks(mechanism: Mechanism, checks: Iterable[MachineCheck]) -> Mechanism:
    """The mechanism with the checks of its derivation."""
    lets = fixed_lets(mechanism)
    return with_constraints(mechanism, [check.constraint(lets) for check in dict.fromkeys(checks)])


def with_constraints(mechanism: Mechanism, further: Sequence[Constraint]) -> Mechanism:
    """The mechanism with further constraints, but for those that hold for all parameters in their ranges."""
    open_ones = tuple(c for c in further if not _always_holds(mechanism, c.condition))
    return replace(mechanism, constraints=(*mechanism.constraints, *open_ones)) if open_ones else mechanism


def apart(
    statements: Iterable[Statement], parameters: Iterable[sp.Symbol]
) -> tuple[tuple[Statement, ...], tuple[MachineCheck, ...]]:
    """The statements without the checks of arms that are made of parameters alone, and these. A choice that depends on
    such a check takes its first value.
    """
    own, known = set(parameters), dict[sp.Symbol, sp.Expr]()
    kept: list[Statement] = []
    checks: dict[sp.Basic, MachineCheck] = {}
    for s in statements:
        if isinstance(s, Let) and s.value.free_symbols and s.value.free_symbols <= own | known.keys():
            known[s.name] = s.value.xreplace(known)
        check = _check(s, known, own) if isinstance(s, Require) else None
        if check is None or not isinstance(s, Require):
            kept.append(rewritten(s, lambda e: replaced(e, dict(_decided(e, checks)))) if checks else s)
        else:
            checks[s.condition] = check
    return tuple(kept), tuple(checks.values())


def _decided(value: sp.Basic, holding: Mapping[sp.Basic, MachineCheck]) -> Iterator[tuple[sp.Expr, sp.Expr]]:
    """The choices in a value whose condition holds, with what they choose."""
    return ((choice, choice.args[1]) for choice in value.atoms(Select) if choice.args[0] in holding)


def _check(check: Require, known: dict[sp.Symbol, sp.Expr], own: set[sp.Symbol]) -> MachineCheck | None:
    condition = check.condition
    if not isinstance(condition, sp.StrictGreaterThan) or check.reason is None or check.reason.why is not Why.TOO_SHORT:
        return None
    length, least = (side.xreplace(known).replace(Root, sp.sqrt) for side in condition.args)
    is_fixed = length.free_symbols | least.free_symbols <= own
    return MachineCheck(check.reason.subject.name, length, least) if is_fixed else None


def _always_holds(mechanism: Mechanism, condition: sp.Basic) -> bool:
    """Whether the ranges of the parameters prove a strict inequality, by intervals."""
    if not isinstance(condition, sp.StrictGreaterThan):
        return False
    excess = condition.lhs - condition.rhs
    excess = excess.xreplace({number: sp.Rational(number) for number in excess.atoms(sp.Float)})
    ranges = {p.symbol: mpmath.iv.mpf(_range(p)) for p in mechanism.parameters} | {DEGREE: mpmath.iv.pi / 180}
    if not excess.free_symbols <= ranges.keys() or not all(isinstance(f, _KNOWN) for f in excess.atoms(sp.Function)):
        return False
    read = sorted(excess.free_symbols, key=str)
    function = sp.lambdify(read, excess, modules=[_FUNCTIONS | {"mpf": mpmath.iv.mpf}, "mpmath"])
    return bool(mpmath.iv.mpf(function(*(ranges[s] for s in read))).a > 0)


def _range(parameter: Parameter) -> list[float]:
    return [parameter.low, parameter.high] if parameter.fixed is None else [float(parameter.nominal)] * 2


def _not_negative(interval: mpmath.ctx_iv.ivmpf) -> mpmath.ctx_iv.ivmpf:
    """The part of an interval that is not negative."""
    return mpmath.iv.mpf([max(interval.a, 0), max(interval.b, 0)])
