"""Configuration bytes: the branches that they leave open, and the bytes of a pose."""

from __future__ import annotations

from functools import cache
from itertools import product
from math import floor
from typing import NamedTuple, TypeAlias

from softkin._constants import COINCIDENT, EDGE, LARGEST
from softkin._scalar import nearest_period
from softkin._types import Configuration, KinematicsError, Reals, Signs, Status

AUTOMATIC, FIRST, SECOND, COINCIDE = 0, 1, 2, 3
"""The values of a branch byte. `COINCIDE` is written where the branches meet, and read as automatic."""

FIRST_TURN, SECOND_TURN = -180.0 - EDGE, 180.0 - EDGE
"""The lower ends of the turns with the numbers 1 and 2 (degrees): earlier, so that rounding crosses no edge."""
UNREACHABLE = int(Status.UNREACHABLE)
"""The number that stands in a slot where an axis is beyond its limits."""


class Criterion(NamedTuple):
    """Axes whose squared distance from the reference decides an automatic choice."""

    axes: tuple[int, ...]
    """The indices of the axes, which are all in degrees, or all in the user's length unit."""
    tie: float
    """Squared distances that differ by at most this count as equal: then the lower slot is taken."""


Slot: TypeAlias = tuple[Configuration, Signs]
"""The branch bytes of a slot, and the signs for which they stand."""


@cache
def slots(branch_bytes: Configuration) -> tuple[Slot, ...]:
    """The slots that branch bytes leave open, as bytes and as signs; the first byte varies fastest."""
    for byte in branch_bytes:
        if byte not in (AUTOMATIC, FIRST, SECOND, COINCIDE):
            raise KinematicsError(Status.BAD_INPUT, f"a branch byte must be 0, 1, 2 or 3, not {byte}")
    choices = [(byte,) if byte in (FIRST, SECOND) else (FIRST, SECOND) for byte in reversed(branch_bytes)]
    found = [tuple(reversed(slot)) for slot in product(*choices)]
    return tuple((slot, tuple(1 if byte == FIRST else -1 for byte in slot)) for slot in found)


def branch_byte(margin: float) -> int:
    """The byte of a branch by its signed margin."""
    if abs(margin) <= COINCIDENT:
        return COINCIDE
    return FIRST if margin > 0.0 else SECOND


def period(axis: float) -> int:
    """The number of the turn of an axis value (degrees): 1 is [-180, 180), -1 is [-540, -180), and so on."""
    turn = floor((axis + 180.0 + EDGE) / 360.0)
    number = turn + 1 if turn >= 0 else turn
    return number if -127 <= number <= 127 else 0


def turn_inside(axis: float, lowest: float, highest: float) -> int:
    """The number of the turn on which an axis that is beyond its limits (degrees) would be inside.

    Of several the one nearest to the limit that it exceeds; 0 if there is none, or none that a byte can name.
    """
    turns = floor((highest - axis) / 360.0) if axis > highest else -floor((axis - lowest) / 360.0)
    number = period(min(max(axis + 360.0 * turns, -360.0 * 127), 360.0 * 126))
    inside = nearest_period(axis, 360.0 * number - 360.0 if number > 0 else 360.0 * number)
    return number if lowest <= inside <= highest else 0


def squared_distance(axes: Reals, reference: Reals, counted: tuple[int, ...]) -> float:
    """The squared distance of axes from the reference, over the counted axes.

    It is 0 for a reference that is no number of reasonable size: then the first branch is taken.
    """
    total = 0.0
    if not all(abs(reference[i]) <= LARGEST for i in counted):
        return total
    for i in counted:
        difference = axes[i] - reference[i]
        total += difference * difference
    return total
