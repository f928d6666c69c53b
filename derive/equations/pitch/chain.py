"""Which turns of a chain follow the commanded rotation, where the task is the pitch, or pitch and roll."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from derive.description.mechanism import DescriptionError, Mechanism
from derive.geometry.frames import Chain, Factor, Motion
from derive.geometry.pose import pose_of
from derive.ir.symbols import ROTATION_ENTRIES

_ROTATION = sp.Matrix(3, 3, list(ROTATION_ENTRIES))


@dataclass(frozen=True)
class Followed:
    """The turns of a chain that follow the commanded rotation, and those around them."""

    before: tuple[Factor, ...]
    pitch: Factor
    behind: tuple[Factor, ...]
    """The fixed rotations behind the pitch, up to the roll."""
    roll: Factor | None = None
    flange: tuple[Factor, ...] = ()
    """The fixed rotations behind the roll."""

    @property
    def direction(self) -> sp.Matrix:
        """The direction that the pitch moves, seen in the frame behind it."""
        axis = 2 if self.roll is None else self.roll.axis
        return matrix_of_turns(self.behind)[:, axis]

    @property
    def commanded(self) -> sp.Matrix:
        """The commanded direction that corresponds to `direction`, in the frame of the base."""
        axis = sp.Matrix([0, 0, 1]) if self.roll is None else matrix_of_turns(self.flange).T[:, self.roll.axis]
        return _ROTATION * axis


def followed_of(mechanism: Mechanism) -> Followed:
    """The turns of the chain of a mechanism whose task is the pitch. Raises `DescriptionError` if it has none."""
    what = mechanism.task.turning.value
    if mechanism.chain is None:
        raise DescriptionError(f"a task with {what} needs a chain: its last turns follow the commanded rotation")
    if not mechanism.task.position:
        raise DescriptionError(f"a task with {what} commands a position too: as in Task('xyz', Turning.PITCH)")
    turns = pose_of(mechanism.chain).turns
    joints = {j.symbol for j in mechanism.solved_joints}
    moving = [k for k, t in enumerate(turns) if t.amount.free_symbols & joints]
    if len(moving) < mechanism.followed_turns:
        raise DescriptionError(f"the task commands {what}, and the chain has no {what} at its end: no joint turns so")
    first, last = moving[-mechanism.followed_turns], moving[-1]
    if mechanism.followed_turns == 1:
        found = Followed(turns[:first], turns[first], turns[first + 1 :])
    else:
        found = Followed(turns[:first], turns[first], turns[first + 1 : last], turns[last], turns[last + 1 :])
    if found.direction[found.pitch.axis] != 0:
        direction = "the z axis of the flange" if found.roll is None else "the axis of the last turn"
        raise DescriptionError(
            f"the task commands {what}, but {direction} is not square to the axis of the turn before it: turn the "
            "flange by fixed rotations at the end of the chain so that its z axis is the direction of the tool"
        )
    return found


def followed_factors(mechanism: Mechanism) -> tuple[int, ...]:
    """Where in the chain the followed turns are, one factor of each, base first."""
    assert mechanism.chain is not None
    joints = {j.symbol for j in mechanism.solved_joints}
    turns: list[tuple[int, sp.Expr, int]] = []
    for k, factor in enumerate(mechanism.chain.factors):
        if factor.motion is Motion.SHIFT:
            continue
        amount, merges = factor.amount, bool(turns) and factor.motion is Motion.TURN and turns[-1][0] == factor.axis
        if merges:
            amount = sp.expand(turns.pop()[1] + amount)
        turns += [(factor.axis, amount, k)] if amount != 0 else []
    moving = [k for _, amount, k in turns if amount.free_symbols & joints]
    return tuple(moving[-mechanism.followed_turns :])


def matrix_of_turns(turns: Sequence[Factor]) -> sp.Matrix:
    """The product of rotations."""
    return sp.Matrix(pose_of(Chain(tuple(turns))).rotation)
