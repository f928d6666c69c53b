"""The starts in a part of the circle, from each of which a joint value is sought that leaves no residual on a branch.

They are its middle; its ends and further points where it is wide; and the points where a length that turns an angle is
shortest, and beside them, where the angle has turned by a sixth: next to them it turns fast. They are numbered from 1:
first the points, then three for each length.
"""

from __future__ import annotations

import sympy as sp

from derive.ir.primitives import Select

POINTS, BESIDE = 9, 3
"""The number of points; the starts of a length: where it is shortest, then a little behind and before it."""
_FRACTIONS = ("0.5", "0", "1", "0.25", "0.75", "0.125", "0.375", "0.625", "0.875")
"""Where the points stand in a part."""
_WIDTHS = (("1e-9", 1), ("1e-3", 3), ("1e-1", 5))
"""A part up to this width has only so many points."""
_NARROW = sp.Float("1e-6")
"""In a part up to this width no length is looked for."""
_ZERO, _ONE = sp.Integer(0), sp.Integer(1)


def is_point(width: sp.Expr) -> sp.Expr:
    """Whether a part is as narrow as rounding: it has one trial, in its middle."""
    return sp.Le(width, sp.Float(_WIDTHS[0][0]))


def is_narrow(width: sp.Expr) -> sp.Expr:
    """Whether no length is looked for in a part."""
    return sp.Le(width, _NARROW)


def next_number(lengths: int, number: sp.Expr, width: sp.Expr) -> sp.Expr:
    """The number of the next start in a part, 0 where there is none."""
    last = POINTS + BESIDE * lengths
    behind: sp.Expr = Select(sp.Gt(width, _NARROW), sp.Integer(POINTS + 1), _ZERO) if lengths else _ZERO
    at_lengths = Select(sp.Le(number, POINTS), behind, Select(sp.Lt(number, last), number + 1, _ZERO))
    return Select(sp.Lt(number, _points_of(width)), number + 1, at_lengths)


def is_new_length(lengths: int, number: sp.Expr) -> sp.Expr:
    """Whether a start is the first of a length."""
    return sp.Or(*[sp.Eq(number, POINTS + 1 + BESIDE * k) for k in range(lengths)])


def of_length(lengths: int, number: sp.Expr, values: list[sp.Symbol]) -> sp.Expr:
    """The value of the length to which a start belongs."""
    found: sp.Expr = values[0]
    for k in range(1, lengths):
        found = Select(sp.Gt(number, POINTS + BESIDE * k), values[k], found)
    return found


def place_of(
    lengths: int, number: sp.Expr, ends: tuple[sp.Expr, sp.Expr], shortest: sp.Expr, aside: sp.Expr
) -> sp.Expr:
    """Where a start is. shortest, aside: where its length is shortest, and how far from there its angle turns by a
    sixth.
    """
    low, high = ends
    fraction: sp.Expr = sp.Float(_FRACTIONS[0])
    for k, share in enumerate(_FRACTIONS[1:], 2):
        fraction = Select(sp.Eq(number, k), sp.Float(share), fraction)
    point = low + fraction * (high - low)
    if not lengths:
        return point
    behind, before = ([sp.Eq(number, POINTS + n + BESIDE * k) for k in range(lengths)] for n in (2, 3))
    turned = Select(sp.Or(*behind), shortest + aside, Select(sp.Or(*before), shortest - aside, shortest))
    return Select(sp.Gt(number, POINTS), inside(turned, ends), point)


def inside(place: sp.Expr, ends: tuple[sp.Expr, sp.Expr]) -> sp.Expr:
    """The place, kept between the ends."""
    low, high = ends
    return Select(sp.Lt(place, low), low, Select(sp.Gt(place, high), high, place))


def _points_of(width: sp.Expr) -> sp.Expr:
    """The number of points in a part."""
    number: sp.Expr = sp.Integer(POINTS)
    for most, points in reversed(_WIDTHS):
        number = Select(sp.Le(width, sp.Float(most)), sp.Integer(points), number)
    return number
