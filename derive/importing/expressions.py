"""Amounts of a chain as Python text: axes, named lengths, and multiples of pi."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from derive.geometry.frames import Motion
from derive.importing.arms.pieces import LARGEST_DENOMINATOR, Piece, exact
from derive.importing.arms.snapping import STEP, nearest_angle
from derive.importing.naming import parameter_meaning, parameter_name

_DIGITS = 14
"""The decimal digits, relative to the machine's size, with which a length is written: further ones are rounding."""
_DEGREES = 11
"""The decimals of an angle in degrees: the form writes 13 of radians."""


@dataclass(frozen=True)
class Dimension:
    """A parameter of the description: a length that is more than zero, or an angle in degrees."""

    name: str
    meaning: str
    value: float
    is_angle: bool

    @property
    def variable(self) -> str:
        """Its name in the file."""
        return self.name.upper()


def clean(value: float, size: float) -> float:
    """A length without the digits that rounding has left."""
    digits = _DIGITS - 1 - int(np.floor(np.log10(size))) if size > 0.0 else _DIGITS
    return round(value, digits)


def dimension_of(piece: Piece, places: Sequence[str], size: float) -> Dimension | None:
    """The parameter that the constant of a piece becomes; None for no constant, and for multiples of 15 degrees."""
    if piece.constant == 0.0 or is_plain(piece):
        return None
    name = parameter_name(piece, places)
    if piece.motion is Motion.SHIFT:
        meaning = parameter_meaning(piece, places, piece.constant < 0.0)
        return Dimension(name, meaning, abs(clean(piece.constant, size)), False)
    degrees = round(float(np.degrees(piece.constant)), _DEGREES)
    return Dimension(name, parameter_meaning(piece, places, False), degrees, True)


def is_half_turn(piece: Piece) -> bool:
    """Whether a piece is half a fixed turn about x."""
    return piece.motion is Motion.TURN and piece.letter == 0 and not piece.drives and abs(piece.constant) == np.pi


def is_plain(piece: Piece) -> bool:
    """Whether the constant of a piece is written as a multiple of pi."""
    return piece.motion is Motion.TURN and abs(piece.constant - nearest_angle(piece.constant)) < 1e-15


def factor_text(piece: Piece, axes: Sequence[str], dimension: Dimension | None, flips: bool = False) -> str:
    """The piece as the file writes it: `Ry(A3 - A2 + pi/2)`. flips: half a turn about x is a flange that looks down."""
    if flips and is_half_turn(piece):
        return "flip_x(1)"
    name = f"{'R' if piece.motion is Motion.TURN else 'T'}{'xyz'[piece.letter]}"
    return f"{name}({amount_text(piece, axes, dimension)})"


def amount_text(piece: Piece, axes: Sequence[str], dimension: Dimension | None) -> str:
    """The amount of a piece: axes with their multipliers, positive ones first, then the constant."""
    up = any(multiplier > 0.0 for _, multiplier in piece.drives)
    ordered = sorted(piece.drives, key=lambda d: (d[1] < 0.0, -d[0] if up else d[0]))
    terms = [(multiplier < 0.0, _multiple(axes[axis], abs(multiplier))) for axis, multiplier in ordered]
    if dimension is not None and dimension.is_angle:
        terms.append((False, f"radians({dimension.variable})"))
    elif dimension is not None:
        terms.append((piece.constant < 0.0, dimension.variable))
    elif piece.constant != 0.0:
        terms.append((piece.constant < 0.0, pi_text(abs(piece.constant))))
    text = "".join(f" {'-' if is_negative else '+'} {term}" for is_negative, term in terms)
    return f"-{text[3:]}" if text.startswith(" - ") else text[3:]


def pi_text(angle: float) -> str:
    """A multiple of 15 degrees, in pi."""
    share = Fraction(round(angle / STEP), 12)
    top = "pi" if share.numerator == 1 else f"{share.numerator}*pi"
    return top if share.denominator == 1 else f"{top}/{share.denominator}"


def _multiple(name: str, multiplier: float) -> str:
    """An axis times a number: a fraction, or the decimals of a slide in an oblique frame."""
    share = exact(multiplier)
    if share == 1:
        return name
    if share.q > LARGEST_DENOMINATOR:
        return f"{multiplier!r}*{name}"
    if share.p == 1:
        return f"{name}/{share.q}"
    return f"{share.p}*{name}" if share.q == 1 else f"{share.p}*{name}/{share.q}"
