"""Kin_Scara4_ZCcoupled_Type1: a SCARA whose quill climbs when A4 turns."""

from sympy import sin

from derive.frames import Rz, Tx, Tz
from derive.mechanism import TURN, Mechanism, Task, Turning, Vendor, branch, helical, length, linear, pitch, rotary

L1 = length("link_length_1", "Length of link 1, axis A1 to axis A2", high=800.0, nominal=325.0)
L2 = length("link_length_2", "Length of link 2, axis A2 to axis A4", high=800.0, nominal=225.0)
P = pitch(
    "pitch_zc", "Travel of the quill per clockwise turn of A4, downward negative", low=-200.0, high=200.0, nominal=20.0
)

A1 = rotary("A1", "Arm 1 about Z", offset_range=(-360.0, 360.0), limit_range=(-360.0, 360.0))
A2 = rotary("A2", "Arm 2 about Z", offset_range=(-360.0, 360.0), limit_range=(-360.0, 360.0))
A3 = linear("A3", "Quill along Z, up", offset_range=(-400.0, 400.0), limit_range=(-400.0, 400.0))
A4 = helical("A4", "Quill about Z", offset_range=(-720.0, 720.0), limit_range=(-720.0, 720.0), pitch=P)

MECHANISM = Mechanism(
    name="Kin_Scara4_ZCcoupled_Type1",
    title="Kin_Scara4_ZCcoupled",
    vendor=Vendor.SINSEGYE,
    family="scara",
    source="Sinsegye SF512x_Kinematics manual",
    summary="SCARA with four axes whose quill climbs when A4 turns.",
    parameters=(L1, L2, P),
    joints=(A1, A2, A3, A4),
    chain=Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2) * Tz(A3 - P * A4 / TURN) * Rz(A4),
    task=Task("xyz", Turning.ABOUT_Z),
    branches=(branch("elbow", sin(A2), right=+1, left=-1),),
    periods=("A4", "A1", "A2"),
)
