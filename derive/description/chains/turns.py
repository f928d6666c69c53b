"""Angles that stand in a chain as numbers: right angles are recognised, and all others get names.

`1.5708` is a right angle written with four decimals; `1.57` is 0.0008 rad short of one, and stays as it is. Every
other angle is a sum of few named ones, and of right angles: 60° and -60° have one name, and so have 45° and 135°.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, product

import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.symbols import real

_RIGHT = sp.pi / 2
_ANY_DECIMALS = 1e-6
"""An angle as near to a multiple of 90° as this (radians) is that multiple, however many decimals it has."""
_DECIMALS = 4
"""A decimal with at least this many digits that equals a rounded multiple of 90° is that multiple."""
_NEARLY = 0.01
"""Any other angle as near to a multiple of 90° as this (radians) was perhaps meant to be that multiple."""
_SAME = 1e-9
"""Angles that differ by less than this (radians) are equal."""
_THOUSANDTHS = 1000
"""An angle that is a whole number of thousandths of a degree is named by its degrees."""
_MULTIPLES = (-2, -1, 0, 1, 2)


def in_radians(number: sp.Expr) -> float:
    """The value of a number in which `DEGREE` may stand."""
    return float(number.subs(DEGREE, sp.pi / 180))


def as_right_angles(number: sp.Expr) -> sp.Expr | None:
    """The exact multiple of 90° that a number stands for; None where it stands for none."""
    exact = sp.nsimplify(number.subs(DEGREE, sp.pi / 180) / _RIGHT) if not number.has(sp.Float) else None
    if exact is not None and exact.is_Integer:
        return number
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


@dataclass(frozen=True)
class NamedAngle:
    """The name of an angle, and its value in degrees."""

    symbol: sp.Symbol
    degrees: sp.Expr


class NamedAngles:
    """The named angles of a chain, and every other angle written as a sum of them."""

    def __init__(self, numbers: Sequence[sp.Expr]) -> None:
        """numbers: those that are no multiple of 90°, in radians; in degrees with `DEGREE`."""
        self.named: list[NamedAngle] = []
        self._written: dict[sp.Expr, sp.Expr] = {}
        for number in sorted(dict.fromkeys(numbers), key=lambda n: abs(in_radians(n))):
            found = next(self._sums(in_radians(number)), None)
            if found is None:
                self.named.append(_of(number))
                found = next(self._sums(in_radians(number)))
            self._written[number] = found

    def written(self, number: sp.Expr) -> sp.Expr:
        """A number as a sum of named angles and right angles."""
        return self._written[number]

    def _sums(self, value: float) -> Iterator[sp.Expr]:
        """The sums of right angles and of few named angles that have a value, the simplest first."""
        known = [in_radians(angle.degrees * DEGREE) for angle in self.named]
        right = float(_RIGHT)
        for count in (1, 2):
            for chosen in combinations(range(len(known)), count):
                for factors in sorted(product(_MULTIPLES, repeat=count), key=lambda f: [abs(x) for x in f]):
                    rest = value - sum(f * known[k] for f, k in zip(factors, chosen, strict=True))
                    nearest = round(rest / right)
                    if 0 not in factors and abs(rest - nearest * right) < _SAME:
                        parts = [f * self.named[k].symbol * DEGREE for f, k in zip(factors, chosen, strict=True)]
                        yield sp.Add(nearest * _RIGHT, *parts)


def _of(number: sp.Expr) -> NamedAngle:
    """The angle that is left of a number without its right angles: 45° of 135°; a decimal in radians stays whole."""
    degrees = abs(in_radians(number)) * 180 / float(sp.pi)
    told = sp.Rational(round(degrees * _THOUSANDTHS), _THOUSANDTHS)
    if abs(degrees - float(told)) * float(sp.pi) / 180 < _SAME:
        left = told % 90
        return NamedAngle(real(f"angle_{_digits(left)}_deg"), left)
    size = abs(in_radians(number))
    if number.is_Float:
        return NamedAngle(real(f"angle_{_digits(sp.Float(size))}_rad"), sp.Float(size) / DEGREE)
    exact = sp.nsimplify(sp.Abs(number.subs(DEGREE, sp.pi / 180)) * 180 / sp.pi)
    return NamedAngle(real(f"angle_{_digits(told)}_deg"), exact)


def _digits(number: sp.Expr) -> str:
    """A number as it stands in a name: 22_5 for 22.5."""
    text = repr(float(number)).removesuffix(".0")
    return text.replace(".", "_").replace("-", "minus").replace("+", "")
