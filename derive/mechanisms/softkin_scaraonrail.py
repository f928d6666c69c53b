"""Softkin_ScaraOnRail: a SCARA with four axes on a rail, which stays where the reference has it."""

from sympy import sin

from derive.frames import Rz, Tx, Tz
from derive.mechanism import Mechanism, Task, Turning, Vendor, branch, length, linear, rotary

L1 = length("link_length_1", "Length of link 1, axis A1 to axis A2", nominal=325.0)
L2 = length("link_length_2", "Length of link 2, axis A2 to axis A4", nominal=225.0)

E1 = linear("E1", "Rail along X: carries the arm")
A1 = rotary("A1", "Arm 1 about Z")
A2 = rotary("A2", "Arm 2 about Z")
A3 = linear("A3", "Quill along Z, up")
A4 = rotary("A4", "Quill about Z")

MECHANISM = Mechanism(
    name="Softkin_ScaraOnRail",
    vendor=Vendor.TEXTBOOK,
    family="scara",
    source="SCARA robots on a linear axis, which serves several places or follows a belt",
    summary="SCARA with four axes on a rail: the rail stays where the reference has it.",
    parameters=(L1, L2),
    joints=(E1, A1, A2, A3, A4),
    chain=Tx(E1) * Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2) * Tz(A3) * Rz(A4),
    task=Task("xyz", Turning.ABOUT_Z),
    branches=(branch("elbow", sin(A2), right=+1, left=-1),),
    held=(E1,),
)
