"""The settings that a drive passes for an axis, and the values computed from them: the instance variables that
AxisSettings writes."""

from __future__ import annotations

from dataclasses import dataclass, replace

from derive.description.joints import Joint
from derive.emit.st.expression import literal
from derive.emit.st.names import stored_name
from derive.ir.constants import GEARED_TURN, UNLIMITED

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
    turns: str = ""
    """The turns of the joint per turn of the axis; empty without a gear."""
    one_turn: str = literal(float(GEARED_TURN))
    """The widest range, in degrees of the joint, that holds one value for every direction."""
    unlimited: str = literal(float(UNLIMITED / 2))
    """More than any limit."""


def settings_of(joint: Joint) -> Settings:
    """The names of the instance variables of an axis."""
    key = joint.key
    given = (stored_name(f"drive_{word}_{key}") for word in ("limited", "lower", "upper"))
    ends = (stored_name(f"{word}_{key}") for word in ("lowest", "highest"))
    turns = (stored_name(f"{word}_{key}") if joint.multi_turn else "" for word in ("single", "mid"))
    own = (stored_name(f"{word}_{key}") for word in ("unlimited", "lower", "upper"))
    gear = turns_of(joint) if joint.is_geared and joint.multi_turn else ""
    return replace(Settings(*given, *ends, *turns, *own), turns=gear)


def turns_of(joint: Joint) -> str:
    """The turns of a joint with a gear per turn of its axis: a number, or the instance variable that holds it."""
    return literal(float(joint.turns)) if joint.turns.is_number else stored_name(str(joint.turns))
