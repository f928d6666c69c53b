"""Kin_Wrist2: a wrist with two axes that follows the direction of the tool."""

from sympy import sin

from derive.frames import Ry, Rz, Txyz, Tz
from derive.mechanism import Mechanism, Task, Turning, Vendor, branch, distance, rotary, sign

LENGTH = distance("tool_length", "Axis B to the tool's tip, along the tool", nominal=90.0)
OX = distance("roll_axis_offset_x", "Axis A to axis B, along the turned X", nominal=12.0)
OY = distance("roll_axis_offset_y", "Axis A to axis B, along the turned Y", nominal=-7.0)
OZ = distance("roll_axis_offset_z", "Flange to axis B, along Z", nominal=-40.0)
SIDE = sign("tool_side", "+1: the tool points along +Z (library 4.16 and later), -1: along -Z (library 4.12)")
A = rotary("A", "Yaw about Z")
B = rotary("B", "Roll about the turned Y, which moves the tool to +X")

MECHANISM = Mechanism(
    name="Kin_Wrist2",
    vendor=Vendor.CODESYS,
    family="orientation",
    source="CODESYS SM3_Transformation",
    summary="Orientation kinematics with two axes: the tool's direction is followed, the turn about it is passive.",
    parameters=(LENGTH, OX, OY, OZ, SIDE),
    joints=(A, B),
    chain=Rz(A) * Txyz(OX, OY, OZ) * Ry(SIDE * B) * Tz(SIDE * LENGTH),
    task=Task("", Turning.DIRECTION),
    branches=(branch("roll", sin(B), positive=+1, negative=-1, margin="tool_along_a"),),
)
