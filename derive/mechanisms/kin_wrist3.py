"""Kin_Wrist3: a wrist with three axes that meet in a point."""

from sympy import sin

from derive.frames import Ry, Rz, Txyz
from derive.mechanism import Mechanism, Task, Turning, Vendor, branch, distance, rotary

TX = distance("tool_offset_x", "Wrist centre to the flange, along its X", nominal=10.0)
TY = distance("tool_offset_y", "Wrist centre to the flange, along its Y", nominal=-6.0)
TZ = distance("tool_offset_z", "Wrist centre to the flange, along its Z", nominal=75.0)
A = rotary("A", "Turn about Z")
B = rotary("B", "Turn about the turned -Y")
C = rotary("C", "Turn about the turned Z")

MECHANISM = Mechanism(
    name="Kin_Wrist3",
    vendor=Vendor.CODESYS,
    family="orientation",
    source="CODESYS SM3_Transformation",
    summary="Orientation kinematics with three axes that meet in the wrist centre.",
    parameters=(TX, TY, TZ),
    joints=(A, B, C),
    chain=Rz(A) * Ry(-B) * Rz(C) * Txyz(TX, TY, TZ),
    task=Task("", Turning.FULL),
    branches=(branch("hand", sin(B), down=+1, up=-1, margin="a_parallel_c"),),
)
