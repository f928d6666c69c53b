"""Softkin_TableTable_AC: five axes, a table that turns about C on a trunnion that tilts about A."""

from sympy import sin

from derive.frames import Rx, Rz, Tx, Ty, Tz
from derive.mechanism import Mechanism, Task, Turning, Vendor, branch, distance, linear, rotary

PIVOT_Y = distance("pivot_y", "Axis A to axis C, along Y, at A = 0", nominal=40.0)
PIVOT_Z = distance("pivot_z", "Axis A to the surface of the table, along Z, at A = 0", nominal=-60.0)
LENGTH = distance("tool_length", "Gauge line of the spindle to the tip of the tool", nominal=120.0)

X = linear("X", "Slide along X: the spindle against the trunnion")
Y = linear("Y", "Slide along Y")
Z = linear("Z", "Slide along Z, up; zero with the gauge line at the height of axis A")
A = rotary("A", "Trunnion about X: positive turns the table from Y to Z")
C = rotary("C", "Table about its own Z: positive turns the workpiece from X to Y")
MECHANISM = Mechanism(
    name="Softkin_TableTable_AC",
    vendor=Vendor.TEXTBOOK,
    family="five_axis",
    source="five-axis milling machines, both rotary axes in the table; axes as ISO 841 names them",
    summary="Five-axis machine with a tilting rotary table: the frame is that of the workpiece on the table.",
    parameters=(PIVOT_Y, PIVOT_Z, LENGTH),
    joints=(X, Y, Z, A, C),
    chain=Rz(-C) * Tz(-PIVOT_Z) * Ty(-PIVOT_Y) * Rx(-A) * Tx(X) * Ty(Y) * Tz(Z) * Tz(-LENGTH),
    task=Task("xyz", Turning.DIRECTION),
    branches=(branch("tilt", sin(A), positive=+1, negative=-1, margin="tool_along_c"),),
    offset_interface=False,
    notes=(
        "Positions are in the frame of the workpiece: its origin is where axis C leaves the table, and it turns with "
        "the table. The direction is that of the tool, from its tip to the spindle.",
    ),
)
