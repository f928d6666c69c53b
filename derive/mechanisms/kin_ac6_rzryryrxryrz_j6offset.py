"""Kin_Ac6_RZRYRYRXRYRZ_J6Offset: an articulated arm whose last axis may stand beside the wrist centre."""

from sympy import Abs, cos, sin

from derive.frames import Rx, Ry, Rz, Tx, Txyz, Tz
from derive.mechanism import (
    Mechanism,
    Task,
    Turning,
    Vendor,
    branch,
    crossing,
    distance,
    length,
    optional_length,
    rotary,
    search,
)
from derive.program import Select

D1 = distance("d1", "Height of axis A2 above the base", nominal=615.0)
L1 = optional_length("a1", "Axis A1 to axis A2, forward", nominal=100.0)
L2 = length("a2", "Upper arm, axis A2 to axis A3", nominal=705.0)
L3 = distance("a3", "Axis A3 to the axis of the forearm, up", nominal=135.0)
D4 = length("d4", "Forearm, to the wrist centre", nominal=755.0)
LATERAL = distance("j6_offset_x", "Wrist centre to axis A6, along X", nominal=60.0)
D6 = distance("d6", "Wrist centre to the flange, along axis A6", nominal=85.0)
A1, A2, A3, A4, A5, A6 = (rotary(f"A{k}", f"Axis {k}", value=f"q{k}") for k in range(1, 7))

FORWARD = L1 + L2 * sin(A2) + L3 * sin(A2 + A3) + D4 * cos(A2 + A3)
"""How far in front of axis A1 the wrist centre is."""

MECHANISM = Mechanism(
    name="Kin_Ac6_RZRYRYRXRYRZ_J6Offset",
    vendor=Vendor.SINSEGYE,
    family="articulated",
    source="Sinsegye SF512x catalogue by name; details are Softkin's definition",
    summary="Articulated arm with six axes, with a spherical wrist or with axis A6 beside the wrist centre.",
    parameters=(D1, L1, L2, L3, D4, LATERAL, D6),
    joints=(A1, A2, A3, A4, A5, A6),
    chain=Rz(A1)
    * Txyz(L1, 0, D1)
    * Ry(A2)
    * Tz(L2)
    * Ry(A3)
    * Txyz(D4, 0, L3)
    * Rx(A4)
    * Ry(A5)
    * Tx(LATERAL)
    * Rz(A6)
    * Tz(D6),
    task=Task("xyz", Turning.FULL),
    branches=(
        branch("shoulder", FORWARD, front=+1, back=-1),
        branch("elbow", L3 * sin(A3) + D4 * cos(A3), up=+1, down=-1),
        branch("wrist", Select(Abs(LATERAL) > 0, sin(A4), cos(A5)), positive=+1, negative=-1),
        crossing("crossing", rising=+1, falling=-1),
    ),
    search=search(A6, where=LATERAL),
    offset_interface=False,
    notes=(
        "With a lateral offset of axis A6 no closed form is known. The answer is the solution next to the reference, "
        "if all axes together are less than 5.7 degrees away; else the inverse looks for every root along A6, and "
        "answers with the one that is nearest to the reference. With A6 known the arm is that with a spherical wrist, "
        "and what is left is the cosine between axis 4 and axis 5. The fourth byte tells whether it rises or falls "
        "with A6; without the offset it is always 1.",
        "The wrist byte is the sign of cos A5 for a spherical wrist, and the sign of sin A4 with a lateral offset.",
    ),
)
