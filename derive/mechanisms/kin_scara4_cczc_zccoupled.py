"""Kin_Scara4_CCZC_ZCcoupled: the SCARA of Type1 with either spelling of the coupling, and a flange that may look
down."""

from sympy import Eq, sin

from derive.frames import Rz, Tx, Tz, flip_x
from derive.mechanism import (
    TURN,
    Constraint,
    Mechanism,
    Task,
    Turning,
    Vendor,
    branch,
    flag,
    gear,
    helical,
    length,
    linear,
    pitch,
    rotary,
)
from derive.program import DEGREE

L1 = length("link_length_1", "Length of link 1, axis A1 to axis A2", nominal=325.0)
L2 = length("link_length_2", "Length of link 2, axis A2 to axis A4", nominal=225.0)
P = pitch("pitch_zc", "Travel of the quill per clockwise turn of A4, downward negative", nominal=20.0)
K = gear("gear_coupling", "Travel of the quill per degree of A4, up positive; instead of the pitch", nominal=0.0)
DOWN = flag("flange_down", "The flange looks down: turned half a turn about X", nominal=True)

A1 = rotary("A1", "Arm 1 about Z")
A2 = rotary("A2", "Arm 2 about Z")
A3 = linear("A3", "Quill along Z, up")
A4 = helical("A4", "Quill about Z", limit_range=(-720.0, 720.0), pitch=P / TURN - K / DEGREE)

MECHANISM = Mechanism(
    name="Kin_Scara4_CCZC_ZCcoupled",
    vendor=Vendor.SINSEGYE,
    family="scara",
    source="Sinsegye SF512x catalogue by name; equations as Kin_Scara4_ZCcoupled_Type1",
    summary="SCARA with four axes whose quill climbs when A4 turns; the flange may look down.",
    parameters=(L1, L2, P, K, DOWN),
    joints=(A1, A2, A3, A4),
    chain=Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2) * Tz(A3 - P * A4 / TURN + K * A4 / DEGREE) * Rz(A4) * flip_x(DOWN),
    task=Task("xyz", Turning.ABOUT_Z),
    branches=(branch("elbow", sin(A2), right=+1, left=-1),),
    constraints=(Constraint(Eq(P * K, 0), "the coupling is given once: pitch_zc or gear_coupling, not both"),),
    periods=("A4", "A1", "A2"),
    notes=(
        "The coupling may be given as travel per turn (pitch) or per degree (gear coupling), never both.",
        "With a pitch and no limits of its own, A4 is limited to -720 .. 720 degrees.",
    ),
)
