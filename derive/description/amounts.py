"""The amounts of a chain: their numbers, and a message, quoting the factor, for what no turn or shift can have."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from derive.description.mechanism import Mechanism, Role
from derive.geometry.frames import LETTERS, Factor, Motion
from derive.ir.constants import DEGREE

_LENGTHS = (Role.LENGTH, Role.SIGNED_LENGTH, Role.DISTANCE)


def number_in(amount: sp.Expr) -> sp.Expr:
    """The sum of the terms of an amount that are numbers; an angle may be in degrees."""
    return sp.Add(*[t for t in sp.Add.make_args(sp.expand(amount)) if not t.free_symbols - {DEGREE}])


def in_radians(number: sp.Expr) -> float:
    """The value of a number in which `DEGREE` may stand."""
    return float(number.subs(DEGREE, sp.pi / 180))


def written(factor: Factor) -> str:
    """A factor as a description writes it: `Rz(a1 + pi/4)`."""
    return f"{LETTERS[factor.motion]}{'xyz'[factor.axis]}({sp.sstr(factor.amount, full_prec=False)})"


def wrong_amounts(mechanism: Mechanism) -> Iterator[str]:
    """The faults in the amounts of a chain."""
    for factor in mechanism.chain.factors if mechanism.chain is not None else ():
        if not isinstance(factor.amount, sp.Expr):
            yield f"{written(factor)} of the chain is given what is true or false: it needs an angle or a length"
        elif factor.amount.has(sp.nan, sp.oo, -sp.oo, sp.zoo, sp.I):
            yield f"{written(factor)} of the chain holds what is no number"
        elif (strange := _strange(mechanism, factor.amount)) is not None:
            yield f"{written(factor)} of the chain holds {strange}: it is made of +, -, *, powers, sines and cosines"
        elif factor.motion is Motion.TURN:
            yield from _wrong_turn(mechanism, factor)


def _strange(mechanism: Mechanism, amount: sp.Expr) -> sp.Basic | None:
    """A part of an amount that no equation can have: a root of a joint, or a function other than sine and cosine."""
    joints = {j.symbol for j in mechanism.joints}
    for part in sp.preorder_traversal(amount):
        if isinstance(part, sp.Pow) and part.free_symbols & joints and not part.exp.is_nonnegative:
            return part
        if isinstance(part, sp.Pow) and part.free_symbols & joints and not part.exp.is_Integer:
            return part
        if isinstance(part, sp.Function) and not isinstance(part, sp.sin | sp.cos):
            return part
    return None


def _wrong_turn(mechanism: Mechanism, factor: Factor) -> Iterator[str]:
    number, place = number_in(factor.amount), written(factor)
    told = sp.sstr(number, full_prec=False)
    if not number.has(sp.pi, DEGREE) and abs(in_radians(number)) > 2 * float(sp.pi):
        yield f"{place} of the chain turns by {told} radians, more than a full turn: write {told}*DEGREE"
    for parameter in mechanism.parameters:
        if parameter.symbol not in factor.amount.free_symbols:
            continue
        rate = sp.diff(factor.amount, parameter.symbol)
        if parameter.role is Role.ANGLE and not rate.has(DEGREE, sp.pi):
            yield f"{place} of the chain has the angle {parameter.name} in degrees: write radians({parameter.name})"
        if parameter.role in _LENGTHS and rate.is_number:
            yield f"{place} of the chain turns by the length {parameter.name}: a turn needs an angle"
    for joint in (j for j in mechanism.joints if j.is_angle):
        if sp.diff(factor.amount, joint.symbol).has(DEGREE):
            yield f"{place} of the chain converts {joint.name}, which is in radians already: leave out radians()"
