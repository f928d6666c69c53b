"""The pictures in the descriptions of function blocks: one PNG and one SVG for every mechanism."""

from __future__ import annotations

from derive.drawing.drawing import drawing_of
from derive.emit.softmotion.inputs import inputs
from derive.kinematics.kinematics import Kinematics

FOLDER = "pictures"


def pictures_of(kinematics: Kinematics) -> dict[str, bytes]:
    """The drawing of a mechanism: path below the folder of the language → bytes."""
    from derive.emit.picture.canvas import pictures
    from derive.emit.picture.page import page

    block = kinematics.mechanism.block_name
    parameters = kinematics.mechanism.parameters
    given = inputs(kinematics).names
    names = {p.name: given[p.name] if p.fixed is None else f"{p.nominal:g}" for p in parameters}
    drawn = page(drawing_of(kinematics), block, names)
    made = pictures(drawn.marks, drawn.height)
    return {f"{FOLDER}/{block}.png": made.png, f"{FOLDER}/{block}.svg": made.svg}
