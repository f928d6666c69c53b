"""The letter x, y or z along which every line of an arm lies, and the fixed turns between their frames.

At zero a frame keeps the orientation of the one before as long as the next line is along one of its coordinate axes:
right angles between frames are then gone, and what is left of them is the orientation of the tip. Another line takes
the smallest turn that brings a coordinate axis to it; a turn about the line before comes first, which the motion at
that line takes in.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import permutations

import numpy as np
import sympy as sp

from derive.form.lines import SAME, Array, about, by_kind

Turns = tuple[tuple[int, float], ...]
"""Fixed turns one after the other: coordinate axis and angle."""


def along_link(link: Array, lengths: Sequence[sp.Expr], letter: int) -> Turns:
    """The turn about a line after which a link across it is along a coordinate axis; none for a link that is a sum of
    lengths along both.

    link: 3 x lengths. A link in numbers is oblique if its length has fewer digits than its coordinates.
    """
    across, kinds = by_kind(link[[(letter + 1) % 3, (letter + 2) % 3]], lengths)
    sizes = np.hypot(*across)
    is_there = sizes > SAME * max(1.0, sizes.max(initial=0.0))
    ways = (across[:, is_there] / sizes[is_there]).T
    if len(ways) == 0 or any(abs(v @ (ways[0][1], -ways[0][0])) > SAME for v in ways):
        return ()
    if len(ways) == 1 and kinds[int(np.argmax(is_there))] == 1:
        numbers = across[:, is_there][:, 0]
        if _digits(float(np.hypot(*numbers))) >= max(map(_digits, numbers)):
            return ()
    angle = _wrapped(float(np.arctan2(ways[0][1], ways[0][0])), np.pi / 2)
    turned = min((angle, angle - np.copysign(np.pi / 2, angle)), key=lambda a: min(_digits(a), _digits(np.degrees(a))))
    return ((letter, turned),) if abs(angle) > SAME else ()


def _digits(number: float) -> int:
    """The digits of a number without those that are rounding."""
    return len(f"{number:.9e}".partition("e")[0].replace(".", "").strip("-0"))


def toward(direction: Array, before: int | None) -> tuple[Turns, int, int]:
    """The fewest turns after which a direction is along a coordinate axis: turns, letter, and sign.

    before: the letter of the line before.
    """
    before = 2 if before is None else before
    letter = int(np.argmax(np.abs(direction)))
    if np.linalg.norm(np.delete(direction, letter)) <= SAME:
        return (), letter, 1 if direction[letter] > 0.0 else -1
    flat = int(np.argmin(np.abs(direction)))
    if abs(direction[flat]) <= SAME:
        return _in_plane(direction, flat)
    first, second = (before + 1) % 3, (before + 2) % 3
    angle = _wrapped(float(np.arctan2(direction[second], direction[first])), np.pi / 2)
    turned = about(before, angle).T @ direction
    flat = second if abs(turned[second]) < abs(turned[first]) else first
    turns, letter, sign = _in_plane(turned, flat)
    return ((before, angle), *turns), letter, sign


def _in_plane(direction: Array, flat: int) -> tuple[Turns, int, int]:
    """A direction that is perpendicular to a coordinate axis: one turn about that."""
    first, second = (flat + 1) % 3, (flat + 2) % 3
    along = float(np.arctan2(direction[second], direction[first]))
    choices: list[tuple[float, int, int, float]] = []
    for letter, start in ((first, 0.0), (second, np.pi / 2)):
        for sign in (1, -1):
            angle = _wrapped(along - start + (0.0 if sign > 0 else np.pi), 2.0 * np.pi)
            choices.append((round(abs(angle), 6), -sign, -letter, angle))
    _, sign, letter, angle = min(choices)
    return ((flat, angle),), -letter, -sign


def orientation(rotation: Array, *, looks_down: bool, same: float = SAME) -> Turns:
    """The fewest turns about x, y and z that make a rotation.

    looks_down: whether z reversed is written as a turn about z, if any, then half a turn about x or y. same: a third
    turn is not told from the first one if the second differs by less from a right angle (radians).
    """
    if looks_down and np.linalg.norm(rotation[:2, 2]) <= same and rotation[2, 2] < 0.0:
        downs = [(*_turns(rotation @ about(k, np.pi), (2, 1, 0), same), (k, float(np.pi))) for k in range(2)]
        return min(downs, key=len)
    choices: list[tuple[int, int, int, Turns]] = []
    for order in ((2, 1, 0), *permutations(range(3))):
        turns = _turns(rotation, order, same)
        odd = sum(abs(_wrapped(angle, np.pi / 2)) > SAME for _, angle in turns)
        choices.append((odd, len(turns), len(choices), turns))
    return min(choices)[3]


def _turns(rotation: Array, order: Sequence[int], same: float) -> Turns:
    """The turns about three letters, one after the other; each is taken out before the next one is read."""
    a, b, c = order
    parity = 1.0 if (b - a) % 3 == 1 else -1.0
    if float(np.hypot(rotation[b, c], rotation[c, c])) <= same:
        second = float(np.copysign(np.pi / 2, parity * rotation[a, c]))
        angles = (_about(a, rotation @ about(b, second).T), second, 0.0)
    else:
        first = _exact(float(np.arctan2(-parity * rotation[b, c], rotation[c, c])))
        rest = about(a, first).T @ rotation
        second = _exact(float(np.arctan2(parity * rest[a, c], rest[c, c])))
        angles = (first, second, _about(c, about(b, second).T @ rest))
    return tuple((k, angle) for k, angle in zip(order, angles, strict=True) if abs(angle) > SAME)


def _about(axis: int, rotation: Array) -> float:
    """The angle of a rotation about a coordinate axis."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    return _exact(float(np.arctan2(rotation[j, i], rotation[i, i])))


def product(turns: Turns) -> Array:
    """The rotation matrix of turns one after the other."""
    rotation = np.eye(3)
    for axis, angle in turns:
        rotation = rotation @ about(axis, angle)
    return rotation


def _exact(angle: float) -> float:
    """The angle; near a multiple of a right angle, that."""
    near = round(angle / (np.pi / 2)) * (np.pi / 2)
    return _wrapped(near if abs(near - angle) <= SAME else angle, 2.0 * np.pi)


def _wrapped(angle: float, period: float) -> float:
    """The same angle less multiples of a period, in ]-period/2 .. period/2]."""
    wrapped = float(np.remainder(angle, period))
    return wrapped - period if wrapped > period / 2 + SAME else wrapped
