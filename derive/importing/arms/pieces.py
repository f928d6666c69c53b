"""The chain of an arm in the one form of a machine (`form.chain`): turns and shifts along x, y and z, one after the
other; what is nearly zero there, or nearly a simple angle, is that.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import sympy as sp

from derive.description.amounts import in_radians, number_in
from derive.description.joints import Kind
from derive.form import lines as form
from derive.form.chain import as_turn, normal_factors
from derive.geometry.frames import Factor, Motion
from derive.importing.arms.lines import ROUNDING, Arm, Line, forward, place_names
from derive.importing.arms.snapping import SNAP, Snapped, nearest_angle
from derive.importing.robot import Array, about

LARGEST_DENOMINATOR = 1000
"""A multiplier with a larger one is written in decimals."""
_ROUNDS = 3
"""What is put to zero makes lines meet, and these give a chain with fewer numbers: as often at most."""
_BELOW = "differences below 1e-9, which no description has"
_ANGLE = 1e-12
"""An angle (radians) that is nearer to a multiple of 15 degrees is that: the form writes 13 decimals."""


@dataclass(frozen=True)
class Piece:
    """A turn about, or a shift along, x, y or z: by multiples of axis values plus a constant (radians or lengths)."""

    motion: Motion
    letter: int
    drives: tuple[tuple[int, float], ...]
    constant: float
    place: int
    """The number of turns of axes in front of it."""

    def matrix(self, values: Sequence[float]) -> Array:
        """The homogeneous 4 x 4 matrix at axis values."""
        amount = self.constant + sum(values[k] * multiplier for k, multiplier in self.drives)
        matrix = np.eye(4)
        if self.motion is Motion.SHIFT:
            matrix[self.letter, 3] = amount
        else:
            matrix[:3, :3] = about(np.eye(3)[self.letter], amount)
        return matrix


@dataclass(frozen=True)
class Simple:
    """An arm in its one form, and the changes that this took."""

    pieces: tuple[Piece, ...]
    moved: tuple[Snapped, ...]

    def forward(self, values: Sequence[float]) -> Array:
        """The pose of the tip (4 x 4) at axis values (radians and lengths)."""
        frame = np.eye(4)
        for piece in self.pieces:
            frame = frame @ piece.matrix(values)
        return frame


def simple(arm: Arm, axes: Sequence[str], limit: float, *, about_z: bool) -> Simple:
    """The chain in its one form. limit: a share of the size (lengths), and of one radian (angles).

    axes: the names of the axes. about_z: whether the task commands a turn about z.
    """
    symbols = [sp.Symbol(name, real=True) for name in axes]
    own = _in_form(arm, symbols)
    before: Callable[[Sequence[float]], Array] = partial(forward, arm)
    pieces: tuple[Piece, ...] = ()
    moved: list[Snapped] = []
    for _ in range(_ROUNDS):
        read = tuple(_pieces(normal_factors(own, about_z=about_z), symbols))
        moved += _listed(_rounded(before, read, len(axes)), arm)
        pieces, found = _snapped(read, axes, arm, limit)
        moved += _listed(found, arm)
        if len(pieces) == len(read):
            break
        own, before = form.arm_of([_factor(piece, symbols) for piece in pieces]), Simple(pieces, ()).forward
    return Simple(pieces, tuple(moved))


def _rounded(
    before: Callable[[Sequence[float]], Array], pieces: tuple[Piece, ...], count: int
) -> tuple[Snapped, Snapped]:
    """What the form has taken as equal (`form.lines.SAME`), by the poses of the tip. before: those without it."""
    rng = np.random.default_rng(3)
    rows = [np.zeros(count), *rng.uniform(-2.0, 2.0, (5, count))]
    differences = [Simple(pieces, ()).forward(row) - before(row) for row in rows]
    angle = max(float(np.linalg.norm(d[:3, :3])) for d in differences)
    length = max(float(np.linalg.norm(d[:3, 3])) for d in differences)
    return Snapped(f"{_BELOW}: the tip moves", length, False), Snapped(f"{_BELOW}: the tip turns", angle, True)


def _listed(moved: Sequence[Snapped], arm: Arm) -> list[Snapped]:
    """The changes that are more than the rounding of our own calculation."""
    return [one for one in moved if one.amount > 10 * (ROUNDING if one.is_angle else arm.rounding)]


def _snapped(
    pieces: Sequence[Piece], axes: Sequence[str], arm: Arm, limit: float
) -> tuple[tuple[Piece, ...], list[Snapped]]:
    """The pieces with simple angles, and without what is nearly zero; and the changes."""
    places, limits = turns(pieces, axes), _limits(arm, limit)
    kept: list[Piece] = []
    moved: list[Snapped] = []
    for piece in pieces:
        is_turn = piece.motion is Motion.TURN
        near = nearest_angle(piece.constant) if is_turn else 0.0
        amount = abs(piece.constant - near)
        narrow, wide = limits[min(piece.place, len(limits) - 1)]
        if amount <= (max(narrow, _ANGLE) if is_turn else max(wide * arm.size, arm.rounding)):
            is_tip = piece.place == len(places)
            what = ("orientation" if is_tip else "direction") if is_turn else "position"
            moved.append(Snapped(f"{'tip' if is_tip else places[piece.place]}: its {what}", amount, is_turn))
            piece = replace(piece, constant=near)
        if piece.drives or piece.constant != 0.0:
            kept.append(piece)
    return tuple(kept), moved


def _limits(arm: Arm, stated: float) -> list[tuple[float, float]]:
    """The limits for angles and, as shares of the size, for lengths: in front of every turn, and behind the last."""
    found = [(0.0, 0.0)]
    for place, line in enumerate([*arm.lines, None]):
        angle, length = found[-1]
        found[-1] = max(angle, arm.limit(place, min(stated, SNAP))), max(length, arm.limit(place, stated))
        found += [(0.0, 0.0)] if line is not None and line.kind is Kind.ROTARY else []
    return found


def turns(pieces: Sequence[Piece], axes: Sequence[str]) -> list[str]:
    """The names of the turns that axes drive, which number the places of pieces."""
    return place_names([p.drives for p in pieces if p.motion is Motion.TURN and p.drives], axes)


def _in_form(arm: Arm, symbols: Sequence[sp.Symbol]) -> form.Arm:
    """The lines that turn, and what shifts them: slides along their directions."""
    lengths = (sp.Integer(1), *symbols)
    shifted = np.zeros((3, len(lengths)))
    lines: list[form.Line] = []
    for line in arm.lines:
        if line.kind is Kind.LINEAR:
            for axis, multiplier in line.drives:
                shifted[:, 1 + axis] += line.direction * multiplier
        else:
            form.add_line(lines, form.Line(_turn(line, symbols), line.direction, _at(line.point, shifted)), lengths)
    return form.Arm(lengths, tuple(lines), arm.tip[:3, :3], _at(arm.tip[:3, 3], shifted))


def _at(point: Array, shifted: Array) -> Array:
    return np.column_stack([point, shifted[:, 1:]])


def _turn(line: Line, symbols: Sequence[sp.Symbol]) -> sp.Expr:
    return sp.Add(*[exact(multiplier) * symbols[axis] for axis, multiplier in line.drives])


def exact(multiplier: float) -> sp.Rational:
    """The fraction that a multiplier stands for, or its decimals."""
    share = sp.Rational(multiplier).limit_denominator(LARGEST_DENOMINATOR)
    return share if abs(float(share) - multiplier) <= 1e-15 * abs(multiplier) else sp.Rational(repr(multiplier))


def _pieces(factors: Sequence[Factor], symbols: Sequence[sp.Symbol]) -> Iterator[Piece]:
    place = 0
    for factor in map(as_turn, factors):
        drives = tuple((k, float(m)) for k, s in enumerate(symbols) if (m := factor.amount.coeff(s)) != 0)
        yield Piece(factor.motion, factor.axis, drives, in_radians(number_in(factor.amount)), place)
        place += factor.motion is Motion.TURN and bool(drives)


def _factor(piece: Piece, symbols: Sequence[sp.Symbol]) -> Factor:
    amount = sp.Add(*[exact(multiplier) * symbols[axis] for axis, multiplier in piece.drives])
    return Factor(piece.motion, piece.letter, amount + (sp.Rational(repr(piece.constant))))
