"""The meaning of each coordinate of a LinuxCNC pose (X Y Z A B C U V W) on a machine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import sympy as sp

from derive.description.mechanism import Joint, Kind, Turning
from derive.ir.program import Let, Require
from derive.ir.symbols import symbols_of
from derive.kinematics.kinematics import Kinematics

LETTERS = "XYZABCUVW"
"""The members of a pose, in their order."""
_ROTARY, _FURTHER = "ABC", "UVW"
_TURN = "turn z"


class Orientation(Enum):
    """The meaning of A, B and C for the orientation."""

    NONE = "none"
    """Nothing: the machine follows no commanded rotation."""
    COUNTED = "counted"
    """C is the angle about Z of the x axis of the flange. It counts turns: a sum of axis values and a constant."""
    NEAREST = "nearest"
    """C is the angle about Z; its turn is the one nearest to the pose before."""
    AXES = "axes"
    """Letters are the values of the rotary axes themselves, as five-axis programs have them."""
    ANGLES = "angles"
    """R = Rz(C) Ry(B) Rx(A)."""


@dataclass(frozen=True)
class Words:
    """The meanings of the letters of a machine."""

    orientation: Orientation
    of_joints: tuple[str, ...]
    """The letter of each joint while joints and letters are the same (identity)."""
    position: tuple[str, ...]
    """The letters of commanded positions."""
    own: tuple[str, ...]
    """For each joint the letter that is its value in the pose, or ""."""
    carrier: int
    """The joint whose full turns C counts; -1 where none can."""

    @property
    def letters(self) -> tuple[str, ...]:
        """All letters that the pose of the machine has."""
        turns = {Orientation.COUNTED: "C", Orientation.NEAREST: "C", Orientation.ANGLES: _ROTARY}
        found = {*self.position, *self.own, *turns.get(self.orientation, "")} - {""}
        return tuple(letter for letter in LETTERS if letter in found)


def words_of(kin: Kinematics) -> Words | None:
    """The letters of a machine; None if it has no joints, or more than a pose has letters."""
    joints = kin.mechanism.joints
    if not 0 < len(joints) <= len(LETTERS):
        return None
    position = tuple(letter.upper() for letter in kin.mechanism.task.position)
    turning = _turning_axes(kin)
    orientation = _orientation(kin, turning)
    own = [""] * len(joints)
    if orientation is Orientation.AXES:
        for joint, letter in _rotary_letters(turning).items():
            own[joints.index(joint)] = letter
    for joint, letter in zip(kin.mechanism.held_joints, _FURTHER, strict=False):
        own[joints.index(joint)] = letter
    carrier = _carrier(kin) if orientation is Orientation.COUNTED else -1
    words = Words(orientation, (), position, tuple(own), carrier)
    return Words(orientation, _identity(words), position, tuple(own), carrier)


def _orientation(kin: Kinematics, turning: Sequence[Joint]) -> Orientation:
    kind = kin.mechanism.task.turning
    if kind is Turning.NONE:
        return Orientation.NONE
    if kind is Turning.ABOUT_Z and flange_of(kin) is not None:
        return Orientation.COUNTED if _turns_are_constant(kin) else Orientation.NEAREST
    if kind is Turning.DIRECTION and len(turning) == 2 and _others_are_straight(kin, turning):
        return Orientation.AXES
    return Orientation.ANGLES


def flange_of(kin: Kinematics) -> sp.Expr | None:
    """1 where the z axis of the flange has the direction of the machine's, -1 where it is opposite, or the constant of
    the machine with this sign; None if the two are not parallel.
    """
    entries = {o.name: o.value for o in kin.forward.outputs}
    is_along = all(entries[name] == 0 for name in ("r13", "r23", "r31", "r32"))
    found = sp.sympify(entries["r33"])
    constants = {o.name for o in kin.setup.outputs}
    return found if is_along and all(s.name in constants for s in symbols_of(found)) else None


def _turning_axes(kin: Kinematics) -> list[Joint]:
    """The joints that the orientation depends on."""
    if not all(isinstance(s, Let | Require) for s in kin.orientation.body):
        return list(kin.mechanism.joints)
    values = {let.name: let.value for let in kin.orientation.lets()}
    wanted = {s for o in kin.orientation.outputs for s in symbols_of(o.value)}
    seen: set[object] = set()
    while wanted - seen:
        symbol = min(wanted - seen, key=str)
        seen.add(symbol)
        wanted |= symbols_of(values[symbol]) if symbol in values else set()
    return [j for j in kin.mechanism.joints if j.axis in seen]


def _others_are_straight(kin: Kinematics, turning: Sequence[Joint]) -> bool:
    """Whether a linear joint stands for each commanded position, so that these follow from them in a straight line."""
    others = [j for j in kin.mechanism.joints if j not in turning]
    is_chain = kin.mechanism.chain is not None
    straight = all(j.kind is Kind.LINEAR for j in others) and not kin.mechanism.held_joints
    return is_chain and straight and len(others) == len(kin.mechanism.task.position)


def _rotary_letters(turning: Sequence[Joint]) -> dict[Joint, str]:
    """A, B and C for joints with these names; joints with other names take the remaining letters, in their order."""
    found = {joint: joint.name for joint in turning if joint.name in _ROTARY and len(joint.name) == 1}
    free = iter(letter for letter in _ROTARY if letter not in found.values())
    return {joint: found.get(joint) or next(free) for joint in turning}


def _turns_are_constant(kin: Kinematics) -> bool:
    """Whether the turn about z is a sum of axis values with constant factors."""
    constants = {o.name for o in kin.setup.outputs}
    return all(s.name in constants for entry in turn_row(kin) for s in symbols_of(entry))


def turn_row(kin: Kinematics) -> list[sp.Expr]:
    """The row of the Jacobian of the turn about z, per radian."""
    row, width = kin.rows.index(_TURN), len(kin.mechanism.joints)
    return [o.value for o in kin.jacobian.outputs[row * width : (row + 1) * width]]


def _carrier(kin: Kinematics) -> int:
    """The last joint that turns freely and turns the tool about z."""
    turned = [
        i for i, (joint, entry) in enumerate(zip(kin.mechanism.joints, turn_row(kin), strict=True))
        if entry != 0 and joint in kin.period_joints and joint not in kin.mechanism.held_joints
    ]  # fmt: skip
    return turned[-1] if turned else -1


def _identity(words: Words) -> tuple[str, ...]:
    """The letter of each joint in identity mode: its own, else the letters of the pose in their order, then any."""
    free = [letter for letter in (*words.letters, *LETTERS) if letter not in words.own]
    rest = iter(dict.fromkeys(free))
    return tuple(own or next(rest) for own in words.own)
