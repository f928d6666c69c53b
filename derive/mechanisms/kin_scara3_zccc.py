"""Kin_Scara3_ZCCC: a column that lifts three turning links."""

from sympy import sin

from derive.frames import Rz, Tx, Tz
from derive.mechanism import Mechanism, Task, Turning, Vendor, branch, length, linear, optional_length, rotary

L1 = length("link_length_1", "Length of link 1, axis A2 to axis A3", nominal=325.0)
L2 = length("link_length_2", "Length of link 2, axis A3 to axis A4", nominal=225.0)
L3 = optional_length("link_length_3", "Length of link 3, axis A4 to the flange", nominal=60.0)

A1 = linear("A1", "Column along Z, up")
A2 = rotary("A2", "Arm 1 about Z")
A3 = rotary("A3", "Arm 2 about Z")
A4 = rotary("A4", "Flange about Z")

MECHANISM = Mechanism(
    name="Kin_Scara3_ZCCC",
    vendor=Vendor.SINSEGYE,
    family="scara",
    source="Sinsegye SF512x catalogue by name; details are Softkin's definition",
    summary="SCARA with four axes whose column lifts the whole arm.",
    parameters=(L1, L2, L3),
    joints=(A1, A2, A3, A4),
    chain=Tz(A1) * Rz(A2) * Tx(L1) * Rz(A3) * Tx(L2) * Rz(A4) * Tx(L3),
    task=Task("xyz", Turning.ABOUT_Z),
    branches=(branch("elbow", sin(A3), right=+1, left=-1),),
    aliases=("Kin_Scara4_ZCCC",),
    notes=(
        "The name counts the three rotary joints; Kin_Scara4_ZCCC is the same block.",
        "With a third link, the elbow of the offset interface is that of the line from axis A3 to the point, also "
        "where the offset is zero.",
    ),
)
