"""Right angles of a chain, however they are written: `pi/2`, `90*DEGREE` and `1.5708` are one angle.

`1.5708` is a right angle written with four decimals; `1.57` is 0.0008 rad short of one, and stays as it is.
"""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from derive.description.amounts import in_radians, number_in
from derive.description.mechanism import Mechanism
from derive.geometry.frames import Chain, Factor, Motion
from derive.ir.constants import DEGREE

_RIGHT = sp.pi / 2
_ANY_DECIMALS = 1e-6
"""An angle as near to a multiple of 90° as this (radians) is that multiple, however many decimals it has."""
_DECIMALS = 4
"""A decimal with at least this many digits that equals a rounded multiple of 90° is that multiple."""
_NEARLY = 0.01
"""Any other angle as near to a multiple of 90° as this (radians) was perhaps meant to be that multiple."""


def with_right_angles(mechanism: Mechanism) -> Mechanism:
    """The mechanism with the exact multiples of 90° in its chain, however they are written: `90*DEGREE`, `1.5708`."""
    if mechanism.chain is None:
        return mechanism
    return replace(mechanism, chain=Chain(tuple(map(_with_right_angle, mechanism.chain.factors))))


def _with_right_angle(factor: Factor) -> Factor:
    number = number_in(factor.amount) if factor.motion is Motion.TURN else sp.Integer(0)
    exact = as_right_angles(number)
    if exact is None or exact == number:
        return factor
    return replace(factor, amount=sp.expand(factor.amount) - number + exact)


def almost_right_angles(mechanism: Mechanism) -> str:
    """The message about angles of a chain that are almost multiples of 90°; empty where there are none."""
    factors = mechanism.chain.factors if mechanism.chain is not None else ()
    turns = (number_in(f.amount) for f in factors if f.motion is Motion.TURN)
    return "; ".join(dict.fromkeys(told for n in turns if (told := almost_right(n)) is not None))


def as_right_angles(number: sp.Expr) -> sp.Expr | None:
    """The exact multiple of 90° that a number stands for; None where it stands for none."""
    exact = sp.nsimplify(number.subs(DEGREE, sp.pi / 180) / _RIGHT) if not number.has(sp.Float) else None
    if exact is not None and exact.is_Integer:
        return exact * _RIGHT
    value = in_radians(number)
    nearest = round(value / float(_RIGHT))
    off = abs(value - nearest * float(_RIGHT))
    if off <= _ANY_DECIMALS or _is_rounded(number, value, nearest):
        return nearest * _RIGHT
    return None


def _is_rounded(number: sp.Expr, value: float, nearest: int) -> bool:
    """Whether a decimal is a multiple of 90°, rounded to as many digits as the decimal has."""
    decimals = len(repr(value).partition(".")[2])
    return number.is_Float and decimals >= _DECIMALS and round(nearest * float(_RIGHT), decimals) == value


def almost_right(number: sp.Expr) -> str | None:
    """The message about an angle that is almost a multiple of 90°; None for any other angle."""
    value = in_radians(number)
    nearest = round(value / float(_RIGHT))
    off = abs(value) - abs(nearest) * float(_RIGHT)
    if nearest == 0 or abs(off) > _NEARLY or as_right_angles(number) is not None:
        return None
    side = "short of" if off < 0 else "more than"
    many = "a right angle" if abs(nearest) == 1 else f"{abs(nearest)} right angles"
    exact = sp.sstr(sp.sign(value) * abs(nearest) * _RIGHT)
    told = sp.sstr(number, full_prec=False)
    return f"{told} is {abs(off):.1g} rad {side} {many}; write {exact} or {90 * nearest}*DEGREE"
