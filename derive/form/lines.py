"""A chain as lines of its zero pose: every turn moves the rest of the machine about its own line.

Let M_k be the motions of the turns about their lines, in the frame of the base and at angles of zero, and T the pose of
the tip there. The pose of the chain is M_1 M_2 ... M_n T: no frame of the description is left in it. An angle that a
parameter states is a turn, too. Slides and lengths shift the lines behind them: the points of lines are sums of
both, each along its own direction.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.description.amounts import in_radians, number_in, without_decimals
from derive.form.numbers import is_right
from derive.geometry.frames import Factor, Motion

Array = NDArray[np.float64]
SAME = 1e-9
"""Directions that differ by less than this are equal, and so are angles, and shares of lengths."""
_NEARLY = 1e-12
"""A share that differs less than this from a simple fraction is that fraction."""
_SIMPLE = 1000
_LOST = 2e-13
"""In oblique frames a sum of numbers below this share of all of them is rounding: less than what the witness sees."""
_DIGITS, _STATED = 14, 12
"""The decimal digits of a sum in oblique frames, relative to its terms: further ones are rounding. And those that a
person states, at most.
"""


@dataclass(frozen=True)
class Line:
    """A turn about a line by an angle (radians) in which no number stands."""

    amount: sp.Expr
    direction: Array
    point: Array
    """3 x lengths of the arm: its coordinates as shares of these lengths."""


@dataclass(frozen=True)
class Arm:
    """The lines of a chain, base first, and the pose of its tip at zero."""

    lengths: tuple[sp.Expr, ...]
    """What coordinates are sums of: slides, parameters, products of these, numbers that are more than zero."""
    lines: tuple[Line, ...]
    rotation: Array
    position: Array
    """3 x lengths."""
    lost: float = 0.0
    """A sum of numbers that is smaller than this is zero."""

    def amount(self, shares: Array) -> sp.Expr:
        """The sum of shares of the lengths: exact, if each is taken whole and stated, not computed."""
        total = sp.Integer(0)
        for kind in _kinds(self.lengths):
            own = [(s, a / kind) for s, a in zip(shares, self.lengths, strict=True) if _kind(a) == kind]
            terms = [s * float(a) for s, a in own]
            if kind == 1 and len(own) > 1 and abs(sum(terms)) < self.lost:
                continue
            value = sp.Add(*[round(s) * a for s, a in own])
            if any(abs(s - round(s)) > _NEARLY for s, _ in own) or (len(own) > 1 and _is_computed(value)):
                value = _without_rounding(float(np.sum(terms)), float(np.abs(terms).sum()))
            total += value * kind
        return sp.expand(total)


def _kind(length: sp.Expr) -> sp.Expr:
    """The length without the number in front of it; 1 for a number."""
    return length.as_coeff_Mul()[1]


def _kinds(lengths: Sequence[sp.Expr]) -> list[sp.Expr]:
    return list(dict.fromkeys(map(_kind, lengths)))


def by_kind(shares: Array, lengths: Sequence[sp.Expr]) -> tuple[Array, list[sp.Expr]]:
    """Shares (entries x lengths) of the kinds of lengths, and these: what multiplies a slide, a parameter or 1."""
    kinds = _kinds(lengths)
    sizes = [[float(a / kind) if _kind(a) == kind else 0.0 for kind in kinds] for a in lengths]
    return shares @ np.array(sizes).reshape(len(lengths), len(kinds)), kinds


def _is_computed(number: sp.Expr) -> bool:
    """Whether a sum has more decimals than anybody states: what its terms have left of each other is rounding."""
    return bool(number.is_Rational and number.q > 10**_STATED)


def _without_rounding(value: float, size: float) -> sp.Expr:
    near = sp.Rational(value).limit_denominator(_SIMPLE)
    if abs(value - float(near)) < _NEARLY * size:
        return near
    return sp.Rational(str(round(value, _DIGITS - int(np.floor(np.log10(size))))))


def arm_of(factors: Sequence[Factor]) -> Arm:
    """The lines of a chain without flips. Turns about one line that follow each other are one, by their sum."""
    shifts = [_parts(f.amount) if f.motion is Motion.SHIFT else {} for f in factors]
    lengths = tuple(dict.fromkeys(length for parts in shifts for length in parts))
    rotation, position = np.eye(3), np.zeros((3, len(lengths)))
    lines: list[Line] = []
    for factor, parts in zip(factors, shifts, strict=True):
        direction = rotation[:, factor.axis].copy()
        for length, share in parts.items():
            position[:, lengths.index(length)] += direction * share
        if factor.motion is Motion.TURN:
            number = number_in(factor.amount)
            add_line(lines, Line(sp.expand(factor.amount) - number, direction, position.copy()), lengths)
            rotation = rotation @ about(factor.axis, in_radians(number))
    is_oblique = any(f.motion is Motion.TURN and not is_right(number_in(f.amount)) for f in factors)
    size = sum(float(length) for length in lengths if length.is_number)
    return Arm(lengths, tuple(lines), rotation, position, _LOST * size * is_oblique)


def _parts(amount: sp.Expr) -> dict[sp.Expr, float]:
    """A length as a sum of others: their shares. A term with a rational number in front is a length of its own."""
    found: dict[sp.Expr, float] = {}
    for term in sp.Add.make_args(sp.expand(without_decimals(amount))):
        factors = sp.Mul.make_args(term)
        odd = [f for f in factors if f.is_number and not f.is_Rational and f.as_base_exp()[0] != sp.pi]  # cos(0.3)
        length = sp.Mul(*[f for f in factors if f not in odd])
        sign = -1.0 if length.could_extract_minus_sign() else 1.0
        length *= int(sign)
        found[length] = found.get(length, 0.0) + sign * float(sp.Mul(*odd))
    return {length: share for length, share in found.items() if length != 0}


def add_line(lines: list[Line], line: Line, lengths: Sequence[sp.Expr]) -> None:
    """Add a turn, or its angle to the last turn if both are about one line; no turn stands for a sum of zero.

    A turn by -a is one by a about the opposite direction.
    """
    if lines and _is_same(lines[-1], line, lengths):
        last = lines.pop()
        sign = 1 if last.direction @ line.direction > 0 else -1
        line = replace(last, amount=sp.expand(last.amount + sign * line.amount))
    if line.amount.could_extract_minus_sign():
        line = replace(line, amount=sp.expand(-line.amount), direction=-line.direction)
    if line.amount != 0:
        lines.append(line)


def _is_same(one: Line, other: Line, lengths: Sequence[sp.Expr]) -> bool:
    """Whether two lines are one, in either sense; numbers among their lengths are added up."""
    across, _ = by_kind(np.cross(one.direction, (other.point - one.point).T).T, lengths)
    size = max(1.0, float(np.abs(by_kind(np.abs(other.point), lengths)[0]).max(initial=0.0)))
    turned = np.cross(one.direction, other.direction)
    return bool(np.all(np.abs(turned) < SAME) and np.all(np.abs(across) < SAME * size))


def about(axis: int, angle: float) -> Array:
    """The matrix of a turn about x, y or z (0, 1, 2); exact at right angles."""
    quarters = angle / (np.pi / 2)
    if abs(quarters - round(quarters)) < _NEARLY:
        cosine, sine = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[round(quarters) % 4]
    else:
        cosine, sine = float(np.cos(angle)), float(np.sin(angle))
    matrix = np.eye(3)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix[i, i] = matrix[j, j] = cosine
    matrix[j, i], matrix[i, j] = sine, -sine
    return matrix


_PARALLEL = 0.05
"""Lines at a smaller angle (radians) count as parallel here: the feet are far away."""


def points(lines: Sequence[Line], origin: Array) -> list[Array]:
    """The point of every turn on its own line, which the shifts lead to: the foot of the common perpendicular with the
    line before (Denavit and Hartenberg), on a parallel line the point nearest to the one before. The way along a line
    stands in front of its turn. origin: that of the base, for lines that are all parallel.
    """
    found: list[Array] = []
    feet = [_foot(second, first) for first, second in pairwise(lines)]
    before = next((foot for pair in pairwise(lines) if (foot := _foot(*pair)) is not None), origin)
    for line, foot in zip(lines, [None, *feet], strict=False):
        before = _nearest(line, before) if foot is None else foot
        found.append(before)
    return found


def _foot(line: Line, other: Line) -> Array | None:
    """The point of a line nearest to another; None if they are (nearly) parallel."""
    cosine = float(line.direction @ other.direction)
    determinant = 1.0 - cosine**2
    if determinant < _PARALLEL**2:
        return None
    along = (line.direction - cosine * other.direction) @ (other.point - line.point) / determinant
    return np.asarray(line.point + np.outer(line.direction, along))


def _nearest(line: Line, point: Array) -> Array:
    """The point of a line that is nearest to a point."""
    return np.asarray(line.point + np.outer(line.direction, line.direction @ (point - line.point)))
