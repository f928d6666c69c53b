"""Kin_Scara3_CCZ: two arms and a quill; the flange turns with the arms."""

from sympy import sin

from derive.frames import Rz, Tx, Tz
from derive.mechanism import Mechanism, Task, Vendor, branch, length, linear, rotary

L1 = length("link_length_1", "Length of link 1, axis A1 to axis A2", nominal=325.0)
L2 = length("link_length_2", "Length of link 2, axis A2 to the quill", nominal=225.0)

A1 = rotary("A1", "Arm 1 about Z")
A2 = rotary("A2", "Arm 2 about Z")
A3 = linear("A3", "Quill along Z, up")

MECHANISM = Mechanism(
    name="Kin_Scara3_CCZ",
    vendor=Vendor.SINSEGYE,
    family="scara",
    source="Sinsegye SF512x catalogue by name; zero pose as Kin_Scara4_ZCcoupled_Type1",
    summary="SCARA with three axes; the flange turns with the arms.",
    parameters=(L1, L2),
    joints=(A1, A2, A3),
    chain=Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2) * Tz(A3),
    task=Task("xyz"),
    branches=(branch("elbow", sin(A2), right=+1, left=-1),),
)
