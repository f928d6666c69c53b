"""The reasons for refusing a value that is not between its limits."""

from __future__ import annotations

from collections.abc import Mapping

from softkin._configuration import turn_inside
from softkin._constants import ABOVE, BELOW, OTHER_TURN
from softkin._types import Diagnosis, Status

__all__ = ["beyond", "beyond_turn", "turn_inside"]


def beyond(
    subject: str, value: float, lowest: float, highest: float, unit: str, turns: Mapping[str, int] | None = None
) -> Diagnosis:
    """The reason for refusing a value below `lowest` or above `highest`.

    turns: for each axis the number of another turn that is inside its limits, 0 if there is none. The first such
    turn gives the reason.
    """
    is_below = not value >= lowest
    missing = lowest - value if is_below else value - highest
    for name, turn in (turns or {}).items():
        if turn:
            axis = "" if name == subject else f" of {name}"
            return Diagnosis(
                Status.UNREACHABLE, f"{OTHER_TURN.format(subject=subject, axis=axis)} [{unit}]", missing, turn
            )
    reason = (BELOW if is_below else ABOVE).format(subject)
    return Diagnosis(Status.UNREACHABLE, f"{reason} [{unit}]", missing)


def beyond_turn(axis: str, value: float, lowest: float, highest: float) -> Diagnosis:
    """The reason for refusing an axis that turns more than once (degrees)."""
    return beyond(axis, value, lowest, highest, "deg", {axis: turn_inside(value, lowest, highest)})
