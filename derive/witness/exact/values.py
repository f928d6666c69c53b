"""Numbers of the field that remember what they are as angles: sums of fixed angles and of unknown ones.

A value is a number, and a form: multiples of atoms, with powers of DEGREE. The atom "" is one; every other atom is an
angle with a cosine and a sine. So cos(DEGREE*(axis - offset)) is known, and so is the angle as a number, which a pitch
reads. Numbers that are no such sums have no form.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from random import Random

from derive.witness.exact.field import PRIME, Pair, element, inverse, of_angle, on_circle, times, turned

Form = Mapping[tuple[str, int], Fraction]
"""(atom, power of DEGREE) → multiple"""
_ROUNDING = 1e-13
"""An angle in radians nearer than this to thousandths of a degree is a decimal number for these."""

_PARTS = 10**20
"""Other decimals are whole multiples of such a part of a radian or a degree: so their sums are the sums of angles."""


class NotAlgebraic(Exception):
    """A program is no formula of numbers and angles: this is not checked exactly. The message says why."""


class Fractional(Exception):
    """The multiple of a planted angle is no whole number: it has to be drawn as a multiple of another one."""

    def __init__(self, denominator: int) -> None:
        super().__init__(denominator)
        self.denominator = denominator


class NotPlanted(Exception):
    """The same of an angle that was found: this is not the planted solution."""


@dataclass(frozen=True)
class Value:
    """A number of the field, with its form as an angle; without one where it has none."""

    number: int
    form: Form | None = None

    def __add__(self, other: Value) -> Value:
        number = (self.number + other.number) % PRIME
        if self.form is None or other.form is None:
            return Value(number)
        form = dict(self.form)
        for key, multiple in other.form.items():
            form[key] = form.get(key, Fraction(0)) + multiple
        return Value(number, {key: m for key, m in form.items() if m})

    def __mul__(self, other: Value) -> Value:
        number = self.number * other.number % PRIME
        first, second = self.form, other.form
        if first is None or second is None:
            return Value(number)
        if not _is_plain(second):
            first, second = second, first
        if not _is_plain(second):
            return Value(number)
        form: dict[tuple[str, int], Fraction] = {}
        for (atom, power), multiple in first.items():
            for (_, further), factor in second.items():
                key = (atom, power + further)
                form[key] = form.get(key, Fraction(0)) + multiple * factor
        return Value(number, {key: m for key, m in form.items() if m})

    def __neg__(self) -> Value:
        return self * MINUS_ONE

    def inverted(self) -> Value:
        """One over the value."""
        number = inverse(self.number)
        if self.form is None or len(self.form) != 1 or not _is_plain(self.form):
            return Value(number)
        (((_, power), multiple),) = self.form.items()
        return Value(number, {("", -power): 1 / multiple})

    @property
    def rational(self) -> Fraction | None:
        """The fraction that the value is; None if it is not known to be one."""
        if self.form is None or any(key != ("", 0) for key in self.form):
            return None
        return self.form.get(("", 0), Fraction(0))


def _is_plain(form: Form) -> bool:
    return all(atom == "" for atom, _ in form)


@cache
def fraction(number: Fraction) -> Value:
    """A number that is known."""
    return Value(element(number), {("", 0): number} if number else {})


ONE, MINUS_ONE, ZERO = fraction(Fraction(1)), fraction(Fraction(-1)), fraction(Fraction(0))


class Angles:
    """The atoms of one trial, with their cosines and sines."""

    def __init__(self, seed: int) -> None:
        """seed: other fixed angles for which the field has no sine are drawn with it."""
        self._drawn = Random(seed)
        self.pairs: dict[str, Pair] = {}
        self._known: dict[Pair, Value] = {}
        self._found: set[str] = set()

    def planted(self, name: str, pair: Pair, number: int) -> Value:
        """A further angle that is drawn, in radians."""
        self.pairs[name] = pair
        return Value(number, {(name, 0): Fraction(1)})

    def found(self, pair: Pair) -> Value:
        """The angle with this cosine and sine, in radians: one that is known, or else a new one."""
        known = self._known.get(pair)
        if known is not None:
            return known
        name = f"angle {len(self._found)}"
        self._found.add(name)
        made = self.planted(name, pair, (pair[0] * 3 + pair[1] * 5 + 7) % PRIME)
        self.know(made)
        return made

    def know(self, angle: Value) -> None:
        """Take this value, in radians, for every angle with its cosine and sine, and its negative."""
        cosine, sine = self.pair(angle)
        self._known.setdefault((cosine, sine), angle)
        self._known.setdefault((cosine, -sine % PRIME), -angle)

    def known(self, pair: Pair) -> Value | None:
        """The value that was taken for angles with this cosine and sine."""
        return self._known.get(pair)

    def pair(self, angle: Value) -> Pair:
        """Cosine and sine of an angle in radians. Raises `NotAlgebraic` and `Fractional`."""
        if angle.form is None:
            raise NotAlgebraic("it turns by what is no sum of angles")
        found = (1, 0)
        for (atom, power), multiple in angle.form.items():
            if atom == "":
                found = turned(found, self._fixed(multiple, power))
                continue
            if power != 0:
                raise NotAlgebraic("it turns by what is no sum of angles")
            if multiple.denominator != 1:
                raise NotPlanted if atom in self._found else Fractional(multiple.denominator)
            found = turned(found, times(self.pairs[atom], multiple.numerator))
        return found

    def _fixed(self, multiple: Fraction, power: int) -> Pair:
        """Cosine and sine of a fixed angle: so many degrees, or radians."""
        if power not in (0, 1):
            raise NotAlgebraic("it turns by what is no sum of angles")
        thousandths = multiple * 1000
        if power == 0:
            near = round(math.degrees(float(multiple)) * 1000)
            if abs(float(multiple) - math.radians(near / 1000)) <= _ROUNDING * (1.0 + abs(float(multiple))):
                thousandths, power = Fraction(near), 1
        if power == 1 and thousandths.denominator == 1:
            return of_angle(thousandths.numerator)
        parts, name = multiple * _PARTS, f"part {power}"
        if parts.denominator != 1:
            parts, name = Fraction(1 if multiple > 0 else -1), f"fixed {abs(multiple)} {power}"
        if name not in self.pairs:
            self.pairs[name] = on_circle(self._drawn.randrange(2, PRIME))
        return times(self.pairs[name], parts.numerator)
