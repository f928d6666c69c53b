"""Kin_Scara3_Z: three arms and a linear axis; the flange's turn is commanded."""

from sympy import sin

from derive.frames import Rz, Tx, Tz
from derive.mechanism import Mechanism, Task, Turning, Vendor, branch, length, linear, rotary

L1 = length("arm_length_1", "Length of arm 1", nominal=300.0)
L2 = length("arm_length_2", "Length of arm 2", nominal=250.0)
L3 = length("arm_length_3", "Length of arm 3", nominal=80.0)

A1 = rotary("A1", "Arm 1 about Z")
A2 = rotary("A2", "Arm 2 about Z")
A3 = rotary("A3", "Arm 3 about Z")
Z = linear("Z", "Lift along Z")

MECHANISM = Mechanism(
    name="Kin_Scara3_Z",
    vendor=Vendor.CODESYS,
    family="scara",
    source="CODESYS SM3_Transformation, Kin_Scara3_Z",
    summary="SCARA with three arms and a linear axis; the flange's turn is commanded.",
    parameters=(L1, L2, L3),
    joints=(A1, A2, A3, Z),
    chain=Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2) * Rz(A3) * Tx(L3) * Tz(Z),
    task=Task("xyz", Turning.ABOUT_Z),
    branches=(branch("elbow", sin(A2), right=+1, left=-1),),
    offset_interface=False,
    notes=("As CODESYS's own block it is a complete kinematics and not a part to be coupled: no offset interface.",),
)
