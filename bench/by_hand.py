"""The wrist-partitioned arm written down by hand, for comparison: what straight-line Python and NumPy reach.

The closed form of ortho-parallel arms with a spherical wrist (Brandstötter, Angerer, Hofbaur 2014). Nothing is checked
but reach, and nothing is done for singular poses: with the wrist straight or on axis 1 the answers are wrong, or there
is an error.
"""

from __future__ import annotations

from collections.abc import Callable
from math import acos, atan2, cos, pi, sin, sqrt
from typing import Any, NamedTuple

import numpy as np

from bench.chain import Array

DEGREES = 180.0 / pi
CHUNK = 8192
Axes = tuple[float, float, float, float, float, float]


class Arm(NamedTuple):
    """Its dimensions, in any unit."""

    a1: float
    a2: float
    c1: float
    c2: float
    c3: float
    c4: float


def all_solutions(arm: Arm) -> Callable[[Any], list[Axes | None]]:
    """A function from a frame to its eight solutions, None where it does not reach."""
    a1, a2, c1, c2, c3, c4 = arm
    square, fold, twice = a2 * a2 + c3 * c3, atan2(a2, c3), 2.0 * c2 * sqrt(a2 * a2 + c3 * c3)

    def inverse(frame: Any) -> list[Axes | None]:
        (x, y, z), ((r11, r12, r13), (r21, r22, r23), (r31, r32, r33)) = frame
        x, y, z = x - c4 * r13, y - c4 * r23, z - c4 * r33 - c1
        distance, turn = sqrt(x * x + y * y), atan2(y, x)
        found: list[Axes | None] = []
        for ahead, first in ((distance - a1, turn), (-distance - a1, turn + pi)):
            reach = ahead * ahead + z * z
            folded, leaned = (reach - c2 * c2 - square) / twice, (reach + c2 * c2 - square) / (2.0 * sqrt(reach) * c2)
            if not -1.0 <= folded <= 1.0:
                found += [None, None, None, None]
                continue
            lean, direction, bend = acos(leaned), atan2(ahead, z), acos(folded)
            s1, k1 = sin(first), cos(first)
            side, height = r23 * k1 - r13 * s1, r13 * k1 + r23 * s1
            u1, u2 = r11 * k1 + r21 * s1, r12 * k1 + r22 * s1
            for second, third in ((direction - lean, bend - fold), (direction + lean, -bend - fold)):
                s, k = sin(second + third), cos(second + third)
                straight = r33 * k + height * s
                fourth = atan2(side, height * k - r33 * s) * DEGREES
                fifth = atan2(sqrt(1.0 - straight * straight) if straight * straight < 1.0 else 0.0, straight) * DEGREES
                sixth = atan2(u2 * s + r32 * k, -u1 * s - r31 * k) * DEGREES
                q1, q2, q3 = first * DEGREES, second * DEGREES, third * DEGREES
                found += [(q1, q2, q3, fourth, fifth, sixth), (q1, q2, q3, fourth + 180.0, -fifth, sixth - 180.0)]
        return found

    return inverse


def one_solution(arm: Arm) -> Callable[[Any, Any], Axes | None]:
    """A function from a frame and the signs of arm, elbow and wrist to a solution."""
    a1, a2, c1, c2, c3, c4 = arm
    square, fold, twice = a2 * a2 + c3 * c3, atan2(a2, c3), 2.0 * c2 * sqrt(a2 * a2 + c3 * c3)

    def inverse(frame: Any, signs: Any) -> Axes | None:
        (x, y, z), ((r11, r12, r13), (r21, r22, r23), (r31, r32, r33)) = frame
        side, elbow, wrist = signs
        x, y, z = x - c4 * r13, y - c4 * r23, z - c4 * r33 - c1
        ahead, first = side * sqrt(x * x + y * y) - a1, atan2(side * y, side * x)
        reach = ahead * ahead + z * z
        folded = (reach - c2 * c2 - square) / twice
        if not -1.0 <= folded <= 1.0:
            return None
        second = atan2(ahead, z) - elbow * acos((reach + c2 * c2 - square) / (2.0 * sqrt(reach) * c2))
        third = elbow * acos(folded) - fold
        s1, k1 = sin(first), cos(first)
        s, k = sin(second + third), cos(second + third)
        height = r13 * k1 + r23 * s1
        straight = r33 * k + height * s
        fourth = atan2(wrist * (r23 * k1 - r13 * s1), wrist * (height * k - r33 * s))
        fifth = atan2(wrist * (sqrt(1.0 - straight * straight) if straight * straight < 1.0 else 0.0), straight)
        sixth = atan2(wrist * ((r12 * k1 + r22 * s1) * s + r32 * k), -wrist * ((r11 * k1 + r21 * s1) * s + r31 * k))
        return first * DEGREES, second * DEGREES, third * DEGREES, fourth * DEGREES, fifth * DEGREES, sixth * DEGREES

    return inverse


def batch(arm: Arm) -> Callable[[tuple[Array, Array, Array]], Array]:
    """A function from positions (N, 3), rotations (N, 9) and signs (N, 3) to axes (N, 6), NaN where
    it does not reach.
    """
    a1, a2, c1, c2, c3, c4 = arm
    square, fold, twice = a2 * a2 + c3 * c3, atan2(a2, c3), 2.0 * c2 * sqrt(a2 * a2 + c3 * c3)

    def chunk(positions: Array, rotations: Array, signs: Array) -> Array:
        x, y, z = positions.T.copy()
        r11, r12, r13, r21, r22, r23, r31, r32, r33 = rotations.T.copy()
        side, elbow, wrist = signs.T.copy()
        x, y, z = x - c4 * r13, y - c4 * r23, z - c4 * r33 - c1
        ahead, first = side * np.sqrt(x * x + y * y) - a1, np.arctan2(side * y, side * x)
        reach = ahead * ahead + z * z
        second = np.arctan2(ahead, z) - elbow * np.arccos((reach + c2 * c2 - square) / (2.0 * np.sqrt(reach) * c2))
        third = elbow * np.arccos((reach - c2 * c2 - square) / twice) - fold
        s1, k1, s, k = np.sin(first), np.cos(first), np.sin(second + third), np.cos(second + third)
        height = r13 * k1 + r23 * s1
        straight = r33 * k + height * s
        fourth = np.arctan2(wrist * (r23 * k1 - r13 * s1), wrist * (height * k - r33 * s))
        fifth = np.arctan2(wrist * np.sqrt(np.maximum(1.0 - straight * straight, 0.0)), straight)
        sixth = np.arctan2(
            wrist * ((r12 * k1 + r22 * s1) * s + r32 * k), -wrist * ((r11 * k1 + r21 * s1) * s + r31 * k)
        )
        return np.array([first, second, third, fourth, fifth, sixth]).T * DEGREES

    def inverse(given: tuple[Array, Array, Array]) -> Array:
        axes = np.empty((len(given[0]), 6))
        with np.errstate(invalid="ignore"):
            for start in range(0, len(axes), CHUNK):
                rows = slice(start, start + CHUNK)
                axes[rows] = chunk(*(part[rows] for part in given))
        return axes

    return inverse
