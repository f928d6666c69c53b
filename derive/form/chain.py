"""The one form of a chain: however its frames are chosen, the same machine has the same chain.

The chain is read as lines of its zero pose, and written from these again: turns about, and shifts along, x, y and z.
Right angles between the frames are gone; another angle is left between two lines. A shift stands behind the turns
about its own direction, but in front of the first turns of the chain. Angles, lengths, their names and signs are those
of the description.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import sympy as sp

from derive.description.mechanism import Mechanism, Turning
from derive.form.headings import Turns, along_link, orientation, product, toward
from derive.form.lines import SAME, Arm, Array, arm_of, points
from derive.geometry.frames import Chain, Factor, Motion

_DECIMALS = 13
"""The decimals of an oblique angle in radians: further ones are rounding."""


def with_normal_chain(mechanism: Mechanism) -> Mechanism:
    """The mechanism with its chain in the one form; the chain as it is described is the one to draw."""
    if mechanism.chain is None:
        return mechanism
    factors = [as_turn(f) for f in mechanism.chain.factors]
    end = next((k for k, f in enumerate(factors) if f.motion is Motion.FLIP), len(factors))
    if any(f.motion is not Motion.FLIP for f in factors[end:]):
        return mechanism  # a flip before another factor is refused if flips are read
    form = normal_factors(arm_of(factors[:end]), about_z=mechanism.task.turning is Turning.ABOUT_Z)
    return replace(mechanism, chain=Chain((*form, *factors[end:])), drawn=mechanism.chain)


def as_turn(factor: Factor) -> Factor:
    """A flip that no parameter decides as half a turn, or none."""
    if factor.motion is not Motion.FLIP or factor.amount.free_symbols:
        return factor
    return replace(factor, motion=Motion.TURN, amount=factor.amount * sp.pi)


def normal_factors(arm: Arm, *, about_z: bool) -> tuple[Factor, ...]:
    """The factors of the chain of an arm.

    about_z: whether half a turn about x, of a tip that looks down, is a flip behind the joints.
    """
    frame, here = np.eye(3), np.zeros_like(arm.position)
    before: int | None = None
    found: list[Factor] = []
    for line, target in zip(arm.lines, points(arm.lines, here), strict=True):
        turns, letter, sign = toward(frame.T @ line.direction, before)
        if letter == before and not turns:
            turns = along_link(frame.T @ (target - here), arm.lengths, letter)
        found += _way(arm, frame, turns, target - here, before)
        found.append(Factor(Motion.TURN, letter, sp.expand(sign * line.amount)))
        here, frame, before = target, frame @ product(turns), letter
    about_z = about_z or all(f.axis == 2 for f in found if f.motion is Motion.TURN)
    turns = orientation(frame.T @ arm.rotation, looks_down=about_z)
    tip = _way(arm, frame, turns, arm.position - here, before)
    return tuple(_merged([*found, *(_with_flip(tip) if about_z else tip)]))


def _way(arm: Arm, frame: Array, turns: Turns, between: Array, before: int | None) -> list[Factor]:
    """The shifts and turns to the next line: the shifts where they are fewest. Of several such places it is the one
    behind a turn about the line before, which is then a part of the turn there; else the first one.

    before: the letter of the line before.
    """
    own = 1 if turns and turns[0][0] == before else 0
    ways = []
    for count in dict.fromkeys((own, len(turns), 0)):
        shifts = _shifts(arm, (frame @ product(turns[:count])).T @ between)
        ways.append([*_turns(turns[:count]), *shifts, *_turns(turns[count:])])
    return min(ways, key=len)


def _shifts(arm: Arm, vector: Array) -> list[Factor]:
    amounts = enumerate(map(arm.amount, vector))
    return [Factor(Motion.SHIFT, axis, amount) for axis, amount in amounts if amount != 0]


def _turns(turns: Sequence[tuple[int, float]]) -> list[Factor]:
    return [Factor(Motion.TURN, axis, _angle(angle)) for axis, angle in turns]


def _angle(angle: float) -> sp.Expr:
    quarters = round(angle / (np.pi / 2))
    return quarters * sp.pi / 2 if abs(angle - quarters * np.pi / 2) < SAME else sp.Float(round(angle, _DECIMALS))


def _merged(factors: Sequence[Factor]) -> list[Factor]:
    """The factors with a fixed turn in the turn before it, if both are about the same letter."""
    found: list[Factor] = []
    for factor in factors:
        last = found[-1] if found else None
        if last and last.motion is factor.motion is Motion.TURN and last.axis == factor.axis:
            found[-1] = replace(last, amount=last.amount + factor.amount)
        else:
            found.append(factor)
    return found


def _with_flip(factors: Sequence[Factor]) -> list[Factor]:
    """The factors with half a turn about x or y, where it is the last of them, as a flip."""
    last = factors[-1] if factors else None
    if last is None or last.motion is not Motion.TURN or last.axis == 2 or abs(last.amount) != sp.pi:
        return list(factors)
    return [*factors[:-1], replace(last, motion=Motion.FLIP, amount=sp.Integer(1))]
