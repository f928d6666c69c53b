"""The prime field of the exact check.

Every angle of a whole number of thousandths of a degree has a sine and a cosine in it, which follow from a root of
unity: the prime is 1 + 360000 m, near 2^61.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cache

PRIME = 2305843009213320001
_TURN = 360_000
"""A turn in thousandths of a degree, which divides PRIME - 1."""
_UNITY = 1693008195423970676
"""A number whose powers repeat after `_TURN`."""
_ODD = (PRIME - 1) // 64
"""PRIME - 1 is 64 times this odd number."""
_HALF = (PRIME + 1) // 2

Pair = tuple[int, int]
"""The cosine and the sine of an angle."""


class NoRoot(Exception):
    """A number has no square root in the field, or its sign was not found: other numbers have to be drawn."""


def inverse(number: int) -> int:
    """1/number; raises `NoRoot` for zero, which random numbers do not meet twice."""
    if number == 0:
        raise NoRoot
    return pow(number, -1, PRIME)


def element(number: Fraction) -> int:
    """A fraction as an element of the field."""
    return number.numerator * inverse(number.denominator % PRIME) % PRIME


def root(number: int) -> int:
    """A square root (Tonelli and Shanks); of a small square the root that is small and positive."""
    number %= PRIME
    if number == 0:
        return 0
    if pow(number, (PRIME - 1) // 2, PRIME) != 1:
        raise NoRoot
    found, rest = pow(number, (_ODD + 1) // 2, PRIME), pow(number, _ODD, PRIME)
    step, order = pow(_non_residue(), _ODD, PRIME), 6
    while rest != 1:
        least, square = 0, rest
        while square != 1:
            square, least = square * square % PRIME, least + 1
        factor = pow(step, 1 << (order - least - 1), PRIME)
        found, step, order = found * factor % PRIME, factor * factor % PRIME, least
        rest = rest * step % PRIME
    return min(found, PRIME - found)


@cache
def _non_residue() -> int:
    return next(n for n in range(2, 100) if pow(n, (PRIME - 1) // 2, PRIME) == PRIME - 1)


def of_angle(thousandths: int) -> Pair:
    """Cosine and sine of an angle in thousandths of a degree."""
    one = pow(_UNITY, thousandths % _TURN, PRIME)
    other, imaginary = inverse(one), pow(_UNITY, _TURN // 4, PRIME)
    return (one + other) * _HALF % PRIME, (one - other) * _HALF * inverse(imaginary) % PRIME


@cache
def root_of_whole(number: int) -> int:
    """The root of a positive integer. Those of 2, 3 and 5 fit the sines of fixed angles: 2 cos 45° is the root of 2."""
    found = 1
    known = {2: 2 * of_angle(45_000)[0], 3: 2 * of_angle(30_000)[0], 5: 4 * of_angle(36_000)[0] - 1}
    for factor, value in known.items():
        while number % factor == 0:
            if number % (factor * factor) == 0:
                found, number = found * factor, number // (factor * factor)
            else:
                found, number = found * value, number // factor
    return found * root(number) % PRIME


def turned(first: Pair, second: Pair) -> Pair:
    """The sum of two angles."""
    (c, s), (d, t) = first, second
    return (c * d - s * t) % PRIME, (c * t + s * d) % PRIME


def times(pair: Pair, count: int) -> Pair:
    """A multiple of an angle."""
    if count < 0:
        return times((pair[0], -pair[1] % PRIME), -count)
    found, power = (1, 0), pair
    while count:
        found, power, count = (turned(found, power) if count & 1 else found), turned(power, power), count >> 1
    return found


def on_circle(slope: int) -> Pair:
    """A point of c^2 + s^2 = 1: that with this tangent of half its angle."""
    scale = inverse(1 + slope * slope)
    return (1 - slope * slope) * scale % PRIME, 2 * slope * scale % PRIME
