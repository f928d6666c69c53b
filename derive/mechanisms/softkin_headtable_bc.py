"""Softkin_HeadTable_BC: five axes, a head that tilts about B over a table that turns about C."""

from sympy import sin

from derive.frames import Ry, Rz, Tx, Ty, Tz
from derive.mechanism import Mechanism, Task, Turning, Vendor, branch, distance, linear, rotary

SIDE = distance("head_offset", "Axis B to the axis of the spindle, along X, at B = 0", nominal=35.0)
PIVOT = distance("pivot_length", "Axis B to the tip of the tool, along the spindle", nominal=240.0)

X = linear("X", "Slide along X: the head against the table")
Y = linear("Y", "Slide along Y")
Z = linear("Z", "Slide along Z, up; zero with axis B at the surface of the table")
B = rotary("B", "Head about Y: positive turns it from Z to X")
C = rotary("C", "Table about Z: positive turns the workpiece from X to Y")
MECHANISM = Mechanism(
    name="Softkin_HeadTable_BC",
    vendor=Vendor.TEXTBOOK,
    family="five_axis",
    source="five-axis milling machines, one rotary axis in the head and one in the table; axes as ISO 841 names them",
    summary="Five-axis machine with a tilting head over a rotary table: the frame is that of the workpiece.",
    parameters=(SIDE, PIVOT),
    joints=(X, Y, Z, B, C),
    chain=Rz(-C) * Tx(X) * Ty(Y) * Tz(Z) * Ry(B) * Tx(SIDE) * Tz(-PIVOT),
    task=Task("xyz", Turning.DIRECTION),
    branches=(branch("tilt", sin(B), positive=+1, negative=-1, margin="tool_along_c"),),
    offset_interface=False,
    notes=(
        "Positions are in the frame of the workpiece: its origin is where axis C leaves the table, and it turns with "
        "the table. The direction is that of the tool, from its tip to the spindle.",
    ),
)
