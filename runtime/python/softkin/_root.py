"""All roots of a search along one joint, on plain numbers: the next one ahead, again and again around the circle."""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import Any

from softkin._constants import AHEAD, ELSEWHERE

Values = tuple[Any, ...]


def every_root(find: Callable[[Values], Any], given: Values, start: int, onward: int, joints: int) -> list[Values]:
    """The joints (radians, the user's unit) at all roots that fit, the nearest to the start first.

    find: the program that finds a root: whether there is one, how far it is from the start, and the joints; some tell
    also whether other joints stand there, too, and these. joints: their number.
    given: its arguments; start, onward: the places among them of the start, and of the flag that asks for the next root
    """
    reference = given[start]
    found: list[Values] = []
    for begin in (reference + ELSEWHERE, reference + ELSEWHERE + 1.0):  # a root may stand at the first, too
        if found:
            break
        left, at = 2.0 * pi - AHEAD, begin
        while True:
            values = list(given)
            values[start], values[onward] = at, True
            there, away, *results = find(tuple(values))
            left -= away if found else 0.0
            if not there or left <= 0.0:
                break
            at += away
            found.append((at, tuple(results[:joints])))
            if any(results[joints : joints + 1]):
                found.append((at, tuple(results[joints + 1 :])))
    found.sort(key=lambda one: abs((one[0] - reference - AHEAD + pi) % (2.0 * pi) - pi))
    return [one for _, one in found]
