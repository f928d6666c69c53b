"""The direction x, y or z along which every axis moves, and the fixed turns between the frames of the axes.

At joint values of zero a frame keeps the orientation of the one before it as long as the next axis is along one of its
coordinate axes: then the chain is written with shifts alone between the joints.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np

from derive.importing.arms.lines import ROUNDING, Arm
from derive.importing.arms.snapping import Snapped, angle_between, nearest_angle
from derive.importing.robot import Array, about

Turns = tuple[tuple[int, float], ...]
"""Fixed turns one after the other: coordinate axis and angle."""


@dataclass(frozen=True)
class Heading:
    """The frame in which an axis moves: turns that lead to it, its orientation at zero, the axis' letter and sign."""

    turns: Turns
    frame: Array
    letter: int
    sign: int


def headings(arm: Arm, names: Sequence[str], limit: float) -> tuple[tuple[Heading, ...], tuple[Snapped, ...]]:
    """The frame of every line, and the directions that were moved to lie along a coordinate axis."""
    frame, letter = np.eye(3), 2
    found: list[Heading] = []
    moved: list[Snapped] = []
    for line, name in zip(arm.lines, names, strict=True):
        turns, letter, sign = toward(frame.T @ line.direction, letter, limit)
        frame = frame @ product(turns)
        amount = float(np.linalg.norm(sign * frame[:, letter] - line.direction))
        if amount > ROUNDING:
            moved.append(Snapped(f"{name}: its direction", amount, True))
        found.append(Heading(turns, frame, letter, sign))
    return tuple(found), tuple(moved)


def toward(direction: Array, before: int, limit: float) -> tuple[Turns, int, int]:
    """The fewest turns after which a direction is along a coordinate axis: turns, letter, and sign.

    before: the letter of the joint before, whose value absorbs a turn about the same letter.
    """
    limit = max(limit, ROUNDING)
    letter = int(np.argmax(np.abs(direction)))
    if np.linalg.norm(np.delete(direction, letter)) <= limit:
        return (), letter, 1 if direction[letter] > 0.0 else -1
    flat = int(np.argmin(np.abs(direction)))
    if abs(direction[flat]) <= limit:
        return _in_plane(direction, flat, limit)
    first, second = (before + 1) % 3, (before + 2) % 3
    angle = _nearest_half_turn(float(np.arctan2(direction[second], direction[first])))
    angle = angle if abs(angle) <= np.pi / 4 else angle - np.copysign(np.pi / 2, angle)
    angle = _snapped(angle, limit)
    turned = about(np.eye(3)[before], angle).T @ direction
    flat = second if abs(turned[second]) < abs(turned[first]) else first
    turns, letter, sign = _in_plane(turned, flat, limit)
    return ((before, angle), *turns), letter, sign


def _in_plane(direction: Array, flat: int, limit: float) -> tuple[Turns, int, int]:
    """A direction that is perpendicular to a coordinate axis: one turn about that."""
    first, second = (flat + 1) % 3, (flat + 2) % 3
    along = float(np.arctan2(direction[second], direction[first]))
    choices: list[tuple[float, int, int, float]] = []
    for letter, start in ((first, 0.0), (second, np.pi / 2)):
        for sign in (1, -1):
            angle = _wrapped(along - start + (0.0 if sign > 0 else np.pi))
            choices.append((round(abs(angle), 6), -sign, -letter, _snapped(angle, limit)))
    _, sign, letter, angle = min(choices)
    return (((flat, angle),) if angle else ()), -letter, -sign


def orientation(rotation: Array, limit: float) -> tuple[Turns, float]:
    """The fewest turns about x, y and z that make a rotation, and the angle by which their product differs from it; a
    flange that looks down is turned about z, then by half a turn about x.
    """
    limit = max(limit, ROUNDING)
    if np.linalg.norm(rotation[:2, 2]) <= limit and rotation[2, 2] < 0.0:
        about_z = _snapped(_about(2, rotation @ about(np.eye(3)[0], np.pi).T), limit)
        down = (*(((2, about_z),) if about_z else ()), (0, float(np.pi)))
        return down, angle_between(product(down), rotation)
    choices: list[tuple[int, int, int, Turns]] = []
    for order in ((2, 1, 0), *permutations(range(3))):
        turns = _three_turns(rotation, order, limit)
        odd = sum(nearest_angle(a) != a for _, a in turns)
        choices.append((len(turns), odd, len(choices), turns))
    turns = min(choices)[3]
    return turns, angle_between(product(turns), rotation)


def _three_turns(rotation: Array, order: Sequence[int], limit: float) -> Turns:
    """The turns about three letters, one after the other; each is taken out before the next one is read."""
    a, b, c = order
    parity = 1.0 if (b - a) % 3 == 1 else -1.0
    across = float(np.hypot(rotation[b, c], rotation[c, c]))
    first = 0.0 if across <= limit else float(np.arctan2(-parity * rotation[b, c], rotation[c, c]))
    if across <= limit:
        second = float(np.copysign(np.pi / 2, parity * rotation[a, c]))
        first = _snapped(_about(a, rotation @ about(np.eye(3)[b], second).T), limit)
        third = 0.0
    else:
        first = _snapped(first, limit)
        rest = about(np.eye(3)[a], first).T @ rotation
        second = _snapped(float(np.arctan2(parity * rest[a, c], rest[c, c])), limit)
        third = _snapped(_about(c, about(np.eye(3)[b], second).T @ rest), limit)
    return tuple((k, angle) for k, angle in zip(order, (first, second, third), strict=True) if angle != 0.0)


def _about(axis: int, rotation: Array) -> float:
    """The angle of a rotation about a coordinate axis."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    return float(np.arctan2(rotation[j, i], rotation[i, i]))


def product(turns: Turns) -> Array:
    """The rotation matrix of turns one after the other."""
    rotation = np.eye(3)
    for axis, angle in turns:
        rotation = rotation @ about(np.eye(3)[axis], angle)
    return rotation


def _snapped(angle: float, limit: float) -> float:
    nearest = nearest_angle(angle)
    return _wrapped(nearest if abs(nearest - angle) <= limit else angle)


def _wrapped(angle: float) -> float:
    """The same angle in ]-pi .. pi]."""
    wrapped = float(np.remainder(angle, 2.0 * np.pi))
    return wrapped - 2.0 * np.pi if wrapped > np.pi * (1.0 + 1e-12) else wrapped


def _nearest_half_turn(angle: float) -> float:
    """The angle less a multiple of half a turn, at most a quarter in size."""
    return float(np.remainder(angle + np.pi / 2, np.pi) - np.pi / 2)
