"""The overview of the blocks: the name of each, its axes, and the tools that SoftMotion accepts for it."""

from __future__ import annotations

from derive.description.mechanism import Turning
from derive.emit.softmotion.pictures import FOLDER as PICTURES
from derive.kinematics.kinematics import Freedom, Kinematics


def row_of(kinematics: Kinematics) -> dict[str, str]:
    """The row of one block."""
    mechanism = kinematics.mechanism
    return {
        "family": mechanism.family,
        "picture": "" if kinematics.undrawn else f"{PICTURES}/{mechanism.block_name}",
        "path": f"{mechanism.family}/{mechanism.block_name}",
        "block": mechanism.block_name,
        "axes": " ".join(joint.name for joint in mechanism.joints) or "none",
        "tools": _tools(kinematics),
        "summary": mechanism.summary,
    }


def _tools(kinematics: Kinematics) -> str:
    """The offsets that SMC_GroupSetTool accepts: to subtract one, SoftMotion must know the flange's orientation."""
    if kinematics.mechanism.is_orientation:
        return "with a position block"
    if kinematics.mechanism.task.turning is Turning.DIRECTION or kinematics.mechanism.followed_turns:
        return "along the axis it turns about"
    if kinematics.projection is not None or kinematics.freedom is Freedom.ZERO:
        return "any"
    return "along the axis it turns about" if kinematics.freedom is Freedom.ONE else "none"
