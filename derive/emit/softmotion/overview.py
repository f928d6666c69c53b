"""The overview of the blocks: what each is, its axes, and the tools that SoftMotion lets it carry."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from derive.description.mechanism import Turning
from derive.emit.softmotion.pictures import FOLDER as PICTURES
from derive.kinematics.kinematics import Freedom, Kinematics


def overview(kinematics: Sequence[Kinematics]) -> Iterator[dict[str, str]]:
    """One row for every block, in the order of families and names."""
    for one in sorted(kinematics, key=lambda k: (k.mechanism.family, k.mechanism.block_name)):
        mechanism = one.mechanism
        yield {
            "picture": f"{PICTURES}/{mechanism.block_name}",
            "path": f"{mechanism.family}/{mechanism.block_name}",
            "block": mechanism.block_name,
            "axes": " ".join(joint.name for joint in mechanism.joints) or "none",
            "tools": _tools(one),
            "summary": mechanism.summary,
        }


def _tools(kinematics: Kinematics) -> str:
    """Which offsets SMC_GroupSetTool takes: the flange's orientation must be known where the offset is removed."""
    if kinematics.mechanism.is_orientation:
        return "with a position block"
    if kinematics.mechanism.task.turning is Turning.DIRECTION:
        return "along the axis it turns about"
    if kinematics.projection is not None or kinematics.freedom is Freedom.ZERO:
        return "any"
    return "along the axis it turns about" if kinematics.freedom is Freedom.ONE else "none"
