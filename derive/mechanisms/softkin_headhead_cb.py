"""Softkin_HeadHead_CB: five axes, a fork that turns about C carries a head that tilts about B."""

from sympy import sin

from derive.frames import Ry, Rz, Tx, Ty, Tz
from derive.mechanism import Mechanism, Task, Turning, Vendor, branch, distance, linear, rotary

FORK = distance("fork_offset", "Axis C to axis B, along X, at C = 0", nominal=25.0)
SIDE = distance("head_offset", "Axis B to the axis of the spindle, along X, at B = 0", nominal=-15.0)
PIVOT = distance("pivot_length", "Axis B to the tip of the tool, along the spindle", nominal=260.0)

X = linear("X", "Slide along X")
Y = linear("Y", "Slide along Y")
Z = linear("Z", "Slide along Z, up")
C = rotary("C", "Fork about Z: positive turns it from X to Y")
B = rotary("B", "Head about the turned Y: positive turns it from Z to X")
MECHANISM = Mechanism(
    name="Softkin_HeadHead_CB",
    vendor=Vendor.TEXTBOOK,
    family="five_axis",
    source="five-axis milling machines, both rotary axes in the head; axes as ISO 841 names them",
    summary="Five-axis machine with a fork head: both rotary axes turn the tool, with the offsets between them.",
    parameters=(FORK, SIDE, PIVOT),
    joints=(X, Y, Z, C, B),
    chain=Tx(X) * Ty(Y) * Tz(Z) * Rz(C) * Tx(FORK) * Ry(B) * Tx(SIDE) * Tz(-PIVOT),
    task=Task("xyz", Turning.DIRECTION),
    branches=(branch("tilt", sin(B), positive=+1, negative=-1, margin="tool_along_c"),),
    offset_interface=False,
    notes=("The direction is that of the tool, from its tip to the spindle.",),
)
