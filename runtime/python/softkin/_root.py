"""All roots of a search along one joint, on plain numbers: the next one ahead, again and again around the circle."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import pi
from typing import Any

from softkin._constants import AHEAD, ELSEWHERE

Values = tuple[Any, ...]
SEARCHES, LONGEST, NEAR = 48, 0.5, 3e-5
"""The searches of a way around the circle, at most; the longest step (radians) where every joint value is a root; roots
that are nearer to each other nearly join.
"""


def every_root(find: Callable[[Values], Any], given: Values, start: int, onward: int, joints: int) -> list[Values]:
    """The joints (radians, the user's unit) at all roots that fit, the nearest to the start first. Where the arm moves
    while its tool rests, every joint value is a root: a stretch of them has one, and the nearest to the start is added.

    find: the program that finds a root: whether there is one, how far it is from the start, and the joints; some tell
    also whether other joints stand there, too, and these. joints: their number.
    given: its arguments; start, onward: the places among them of the start, and of the flag that asks for the next root
    """
    reference = given[start]
    found: list[tuple[float, Values]] = []
    moves = False

    def search(at: float, is_onward: bool) -> Any:
        values = list(given)
        values[start], values[onward] = at, is_onward
        return find(tuple(values))

    def keep(away: float, results: Sequence[Any]) -> None:
        found.append((away, tuple(results[:joints])))
        if any(results[joints : joints + 1]):
            found.append((away, tuple(results[joints + 1 :])))

    for begin in (reference + ELSEWHERE, reference + ELSEWHERE + 1.0):  # a root may stand at the first, too
        left, at, skip, is_near = 2.0 * pi - AHEAD, begin, 0.0, False
        for _ in range(0 if found else SEARCHES):
            there, away, *results = search(at, True)
            left -= away if found else 0.0
            if not there or left <= 0.0:
                break
            at += away
            is_near, was_near = bool(found) and away < NEAR, is_near
            if found and away < 1.1 * AHEAD:  # roots without end: nothing new is near
                skip = min(max(4.0 * skip, AHEAD), LONGEST)
                at, left = at + skip, left - skip
            else:
                if is_near and was_near:  # between two roots that nearly join the pose is as good as met
                    found.pop()
                skip = 0.0
                keep(abs((at - reference - AHEAD + pi) % (2.0 * pi) - pi), results)
            moves = moves or skip == LONGEST
    if moves:
        there, away, *results = search(reference, False)
        if there:
            keep(away, results)
    found.sort(key=lambda one: one[0])
    return [one for _, one in found]
