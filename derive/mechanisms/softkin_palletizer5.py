"""Softkin_Palletizer5: a palletizer whose level flange turns a tool about Z, and tilts it."""

from sympy import cos, sin

from derive.frames import Ry, Rz, Tx, Tz
from derive.mechanism import (
    Mechanism,
    Task,
    Turning,
    Vendor,
    branch,
    distance,
    length,
    limited,
    optional_length,
    rotary,
)

HEIGHT = distance("base_height", "Height of axis A2 above the base", nominal=320.0)
BESIDE = optional_length("shoulder_offset", "Axis A1 to axis A2, forward", nominal=80.0)
L1 = length("link_length_1", "Rear arm, axis A2 to the elbow", nominal=300.0)
L2 = length("link_length_2", "Forearm, elbow to the level wrist", nominal=350.0)
WRIST = distance("wrist_offset_x", "Wrist to axis A4, forward", nominal=60.0)
DROP = distance("wrist_offset_z", "Wrist to axis A5, along Z, downward negative", nominal=-90.0)
TOOL = distance("tool_length", "Axis A5 to the tip, along the tool, downward negative", nominal=-120.0)

A1 = rotary("A1", "Column about Z")
A2 = rotary("A2", "Rear arm: zero upright, positive forward")
A3 = rotary("A3", "Forearm, against the base: zero level, positive downward")
A4 = rotary("A4", "Flange about Z")
A5 = rotary("A5", "Tilt of the tool about Y of the flange")

MECHANISM = Mechanism(
    name="Softkin_Palletizer5",
    vendor=Vendor.TEXTBOOK,
    family="articulated",
    source="palletizing robots with a fifth axis, which tilts the tool behind a level flange",
    summary="Palletizer with five axes: its level flange turns a tool about Z, and tilts it.",
    parameters=(HEIGHT, BESIDE, L1, L2, WRIST, DROP, TOOL),
    joints=(A1, A2, A3, A4, A5),
    chain=Rz(A1)
    * Tz(HEIGHT)
    * Tx(BESIDE)
    * Ry(A2)
    * Tz(L1)
    * Ry(A3 - A2)
    * Tx(L2)
    * Ry(-A3)
    * Tx(WRIST)
    * Tz(DROP)
    * Rz(A4)
    * Ry(A5)
    * Tz(TOOL),
    task=Task("xyz", Turning.DIRECTION),
    branches=(
        branch("tilt", sin(A5), positive=+1, negative=-1, margin="tool_along_a4"),
        branch("shoulder", BESIDE + L1 * sin(A2) + L2 * cos(A3) + WRIST, front=+1, back=-1, margin="axis_a4_on_a1"),
        branch("elbow", cos(A3 - A2), up=+1, down=-1),
    ),
    limited=(limited("elbow", A3 - A2, "the forearm relative to the rear arm", angle=True),),
    notes=("A3 is the angle of the forearm against the base: where A2 alone moves, the forearm keeps its direction.",),
)
