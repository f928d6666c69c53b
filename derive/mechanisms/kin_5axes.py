"""Kin_5Axes: a gantry with three slides that carries a wrist with two axes."""

from sympy import sin

from derive.frames import Ry, Rz, Tx, Ty, Tz
from derive.mechanism import Mechanism, Task, Turning, Vendor, branch, distance, linear, rotary, sign

LENGTH = distance("tool_length", "Where the axes A and B meet to the tool's tip, along the tool", nominal=90.0)
SIDE = sign("tool_side", "+1: the tool points along +Z (library 4.16 and later), -1: along -Z (library 4.12)")
X = linear("X", "Slide along X")
Y = linear("Y", "Slide along Y")
Z = linear("Z", "Slide along Z")
A = rotary("A", "Azimuth: turn about Z")
B = rotary("B", "Inclination: turn about the turned Y, which moves the tool to +X")

MECHANISM = Mechanism(
    name="Kin_5Axes",
    vendor=Vendor.CODESYS,
    family="articulated",
    source="CODESYS SM3_Transformation",
    summary=(
        "Gantry with three slides and a wrist with two axes: the tool's direction is followed, its twist is passive."
    ),
    parameters=(LENGTH, SIDE),
    joints=(X, Y, Z, A, B),
    chain=Tx(X) * Ty(Y) * Tz(Z) * Rz(A) * Ry(SIDE * B) * Tz(SIDE * LENGTH),
    task=Task("xyz", Turning.DIRECTION),
    branches=(branch("roll", sin(B), positive=+1, negative=-1, margin="tool_along_a"),),
    offset_interface=False,
)
