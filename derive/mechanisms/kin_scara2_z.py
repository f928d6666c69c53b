"""Kin_Scara2_Z: two arms and a linear axis; the flange turns with the arms."""

from sympy import sin

from derive.frames import Rz, Tx, Tz
from derive.mechanism import Mechanism, Task, Vendor, branch, length, linear, rotary

L1 = length("arm_length_1", "Length of arm 1", nominal=300.0)
L2 = length("arm_length_2", "Length of arm 2", nominal=250.0)

A1 = rotary("A1", "Arm 1 about Z")
A2 = rotary("A2", "Arm 2 about Z")
Z = linear("Z", "Lift along Z")

MECHANISM = Mechanism(
    name="Kin_Scara2_Z",
    vendor=Vendor.CODESYS,
    family="scara",
    source="CODESYS SM3_Transformation, Kin_Scara2_Z",
    summary="SCARA with two arms and a linear axis; the flange turns with the arms.",
    parameters=(L1, L2),
    joints=(A1, A2, Z),
    chain=Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2) * Tz(Z),
    task=Task("xyz"),
    branches=(branch("elbow", sin(A2), right=+1, left=-1),),
)
