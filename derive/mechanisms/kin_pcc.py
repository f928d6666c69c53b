"""Kin_PCC: two arms driven from one point; A2 is the absolute angle of the forearm."""

from sympy import cos, sin

from derive.mechanism import Mechanism, Task, Vendor, X, Y, branch, length, limited, rod, rotary
from derive.vectors import vector

L1 = length("link_length_1", "Length of the inner arm", nominal=300.0)
L2 = length("link_length_2", "Length of the outer arm", nominal=250.0)

A1 = rotary("A1", "Inner arm about Z")
A2 = rotary("A2", "Outer arm about Z, its absolute angle")

KNEE = vector(L1 * cos(A1), L1 * sin(A1))
TIP = vector(KNEE[0] + L2 * cos(A2), KNEE[1] + L2 * sin(A2))

MECHANISM = Mechanism(
    name="Kin_PCC",
    vendor=Vendor.SINSEGYE,
    family="planar",
    source="Sinsegye SF512x catalogue by name; shafts as Beckhoff 2D Type 3 (S_CC)",
    summary="Planar arm whose two links are both driven from the base; the flange keeps its orientation.",
    parameters=(L1, L2),
    joints=(A1, A2),
    closure=(X - TIP[0], Y - TIP[1]),
    bars=(rod("inner", (0, 0), KNEE, L1), rod("outer", KNEE, TIP, L2)),
    task=Task("xy"),
    branches=(branch("elbow", sin(A2 - A1), right=+1, left=-1),),
    limited=(limited("elbow", A2 - A1, "the outer arm relative to the inner arm", angle=True),),
    notes=("Angles are right-handed about +Z.",),
)
