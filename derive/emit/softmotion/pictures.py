"""The pictures in the descriptions of function blocks, as PNG and as SVG: every machine, and its choices."""

from __future__ import annotations

from derive.description.mechanism import Turning
from derive.drawing.drawing import drawing_of
from derive.emit.softmotion.inputs import inputs
from derive.kinematics.kinematics import Freedom, Kinematics

FOLDER = "pictures"
CHOICES = "_Configuration"
"""The end of the name of the second picture, of the choices."""


def pictures_of(kinematics: Kinematics) -> dict[str, bytes]:
    """The drawings of a mechanism, first the machine: path below the folder of the language → bytes."""
    from derive.emit.picture.canvas import pictures
    from derive.emit.picture.page import pages

    block = kinematics.mechanism.block_name
    parameters = kinematics.mechanism.parameters
    given = inputs(kinematics).names
    names = {p.name: given[p.name] if p.fixed is None else f"{p.nominal:g}" for p in parameters}
    found: dict[str, bytes] = {}
    for drawn, end in zip(pages(drawing_of(kinematics), block, names), ("", CHOICES), strict=False):
        made = pictures(drawn.marks, drawn.width, drawn.height)
        found |= {f"{FOLDER}/{block}{end}.png": made.png, f"{FOLDER}/{block}{end}.svg": made.svg}
    return found


def row_of(kinematics: Kinematics) -> dict[str, str]:
    """The row of one block."""
    mechanism = kinematics.mechanism
    return {
        "family": mechanism.family,
        "picture": "" if kinematics.undrawn else f"{FOLDER}/{mechanism.block_name}",
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
    if kinematics.mechanism.task.turning is Turning.DIRECTION:
        return "along the axis it turns about"
    if kinematics.projection is not None or kinematics.freedom is Freedom.ZERO:
        return "any"
    return "along the axis it turns about" if kinematics.freedom is Freedom.ONE else "none"
