"""The pose of a chain, with consecutive parallel rotations merged, so that `cos(a1 + a2)` stays one cosine; and its
screws."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import sympy as sp

from derive.geometry.frames import Chain, Factor, Motion


@dataclass(frozen=True)
class Screw:
    """The screw by which one factor moves the end of a chain: its direction, and a point on it, in the frame of the
    base.
    """

    motion: Motion
    amount: sp.Expr
    direction: sp.ImmutableMatrix
    origin: sp.ImmutableMatrix


@dataclass(frozen=True)
class Pose:
    """Position and rotation of the end of a chain, its merged rotations, and the screw of every factor."""

    position: sp.ImmutableMatrix
    rotation: sp.ImmutableMatrix
    turns: tuple[Factor, ...]
    screws: tuple[Screw, ...]


@cache
def pose_of(chain: Chain) -> Pose:
    """The pose of a chain, composed from its base. Cached: every part of a derivation asks for it."""
    turns: list[Factor] = []
    position = sp.zeros(3, 1)
    screws: list[Screw] = []
    for factor in chain.factors:
        rotation = _rotation(turns)
        direction = sp.ImmutableMatrix(rotation[:, factor.axis])
        screws.append(Screw(factor.motion, factor.amount, direction, sp.ImmutableMatrix(position)))
        if factor.motion is Motion.SHIFT:
            position += direction * factor.amount
        else:
            turns = _merged(turns, factor)
    rotation = sp.ImmutableMatrix(_rotation(turns))
    return Pose(sp.ImmutableMatrix(position), rotation, tuple(turns), tuple(screws))


def _merged(turns: list[Factor], factor: Factor) -> list[Factor]:
    if turns and turns[-1].motion is factor.motion is Motion.TURN and turns[-1].axis == factor.axis:
        amount = sp.expand(turns[-1].amount + factor.amount)
        return turns[:-1] + ([Factor(Motion.TURN, factor.axis, amount)] if amount != 0 else [])
    return [*turns, factor]


def _rotation(turns: list[Factor]) -> sp.Matrix:
    return _product(tuple(turns)).copy()


@cache
def _product(turns: tuple[Factor, ...]) -> sp.Matrix:
    product = sp.eye(3)
    for turn in turns:
        product = product * turn.matrix()[:3, :3]
    return product
