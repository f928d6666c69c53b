"""Names for the angles that stand in a chain as numbers.

Every angle is a sum of few named ones, and of right angles: 60° and -60° have one name, and so have 45° and 135°.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, product

import sympy as sp

from derive.description.amounts import in_radians
from derive.ir.constants import DEGREE
from derive.ir.symbols import real

_RIGHT = sp.pi / 2
_SAME = 1e-9
"""Angles that differ by less than this (radians) are equal."""
_THOUSANDTHS = 1000
"""An angle that is a whole number of thousandths of a degree is named by its degrees."""
_MULTIPLES = (-2, -1, 0, 1, 2)


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


def of_degrees(degrees: sp.Expr) -> NamedAngle:
    """An angle under the name that its degrees give it."""
    return NamedAngle(real(f"angle_{_digits(degrees)}_deg"), degrees)


def _of(number: sp.Expr) -> NamedAngle:
    """The angle that is left of a number without its right angles: 45° of 135°; a decimal in radians stays whole."""
    degrees = abs(in_radians(number)) * 180 / float(sp.pi)
    rounded = sp.Rational(round(degrees * _THOUSANDTHS), _THOUSANDTHS)
    if abs(degrees - float(rounded)) * float(sp.pi) / 180 < _SAME:
        return of_degrees(rounded % 90)
    size = sp.Float(abs(in_radians(number)))
    return NamedAngle(real(f"angle_{_digits(size)}_rad"), size / DEGREE)


def _digits(number: sp.Expr) -> str:
    """A number as it stands in a name: 22_5 for 22.5."""
    text = repr(float(number)).removesuffix(".0")
    return text.replace(".", "_").replace("-", "minus").replace("+", "")
