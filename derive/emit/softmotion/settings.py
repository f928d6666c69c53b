"""The settings that a drive passes for an axis, and the values computed from them: the instance variables that
AxisSettings writes."""

from __future__ import annotations

from dataclasses import dataclass

from derive.description.joints import Joint
from derive.emit.st.names import stored_name

SETTINGS = "ISMKinematicAxisSettings"
"""The interface by which SoftMotion passes the limits of a drive."""


@dataclass(frozen=True)
class Settings:
    """The names of the instance variables of one axis."""

    limited: str
    lower: str
    upper: str
    """As SoftMotion passes them: whether there are limits (FALSE before the first call), and both limits."""
    lowest: str
    highest: str
    """The range that the limits of block and drive together allow."""
    single: str
    middle: str
    """Whether the range holds one value for every direction, and its middle; empty for an axis without turns."""
    own_unlimited: str
    own_lower: str
    own_upper: str
    """The limits of the block."""


def settings_of(joint: Joint) -> Settings:
    """The names of the instance variables of an axis."""
    key = joint.key
    given = (stored_name(f"drive_{word}_{key}") for word in ("limited", "lower", "upper"))
    ends = (stored_name(f"{word}_{key}") for word in ("lowest", "highest"))
    turns = (stored_name(f"{word}_{key}") if joint.multi_turn else "" for word in ("single", "mid"))
    own = (stored_name(f"{word}_{key}") for word in ("unlimited", "lower", "upper"))
    return Settings(*given, *ends, *turns, *own)
