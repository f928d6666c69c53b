"""Machines with a joint that is held: a rail under an arm, a turn within one."""

from functools import partial

from sympy import cos, sin

from derive.frames import Rx, Ry, Rz, Tx, Txyz, Tz
from derive.mechanism import Task, Turning, branch, distance, length, linear, rotary
from tests.machines.chain_machines import FROM_FLANGE
from tests.machines.textbook import textbook

X, Z = (linear(name, f"slide {name}") for name in ("X", "Z"))
A1, A2, A3, A4, A5, A6, E1 = (rotary(name, f"turn {name}") for name in ("A1", "A2", "A3", "A4", "A5", "A6", "E1"))
PIVOT_X = distance("pivot_x", "pivot, x", nominal=20)
HEIGHT = distance("height", "height of the shoulder", nominal=200.0)
L1, L2, L3, L4 = (length(f"link_{k}", f"link {k}", nominal=v) for k, v in enumerate((300.0, 400.0, 350.0, 120.0), 1))
L5 = length("link_5", "link 5", nominal=30.0)
TURNED, POSE = Task("xyz", Turning.ABOUT_Z), Task("xyz", Turning.FULL)
ELBOW = branch("elbow", sin(A2), right=+1, left=-1)

M_HEIGHT = length("height_m", "base to shoulder", nominal=0.36)
M_UPPER = length("link_u", "upper arm", nominal=0.42)
M_FORE = length("link_f", "forearm", nominal=0.4)
_machine = partial(
    textbook, (X, Z, A1, A2, A3, A4, A5, A6, E1, PIVOT_X, HEIGHT, L1, L2, L3, L4, L5, M_HEIGHT, M_UPPER, M_FORE)
)

HELD = {
    **FROM_FLANGE,
    "rail and arm with two links": _machine(
        "RailArm", Tx(X) * Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2), Task("xy"), (ELBOW,), held=(X,), offset_interface=True
    ),
    "SCARA on a rail": _machine(
        "ScaraRail", Tx(X) * Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2) * Tz(Z) * Rz(A4), TURNED, (ELBOW,), held=(X,)
    ),
    "arm on a track": _machine(
        "Track",
        Tx(X) * Rz(A1) * Tz(HEIGHT) * Ry(A2) * Tz(L2) * Ry(A3) * Tx(L3) * Rx(A4) * Ry(A5) * Rx(A6) * Tx(L4),
        POSE,
        (
            branch("shoulder", L2 * sin(A2) + L3 * cos(A2 + A3), front=+1, back=-1),
            branch("elbow", cos(A3), up=+1, down=-1),
            branch("wrist", sin(A5), positive=+1, negative=-1),
        ),
        held=(X,),
    ),
    "seven axes": _machine(
        "Seven",
        Rz(A1) * Tz(L1) * Ry(A2) * Rz(E1) * Tz(L2) * Ry(A3) * Rz(A4) * Tz(L3) * Ry(A5) * Rz(A6) * Tz(L4),
        POSE,
        (
            branch("elbow", sin(A3), positive=+1, negative=-1),
            branch(
                "shoulder", L2 * sin(A2) + L3 * (sin(A2) * cos(A3) + cos(A2) * cos(E1) * sin(A3)), front=+1, back=-1
            ),
            branch("wrist", sin(A5), positive=+1, negative=-1),
        ),
        held=(E1,),
    ),
    "arm in metres with a held turn of its upper arm": _machine(
        "HeldTurn", Rz(A1) * Tz(M_HEIGHT) * Ry(A2) * Rz(E1) * Tz(M_UPPER) * Ry(A3) * Tz(M_FORE), Task("xyz"), held=(E1,)
    ),
}

FIRST_HELD = {
    **FROM_FLANGE,
    "seven axes beside each other, the first held": _machine(
        "SevenBeside",
        Rz(E1) * Txyz(PIVOT_X, 0, L1) * Rx(A1) * Rz(A2) * Txyz(0, L5, L2) * Rx(A3) * Tz(L3) * Rz(A4) * Rx(A5) * Rz(A6),
        POSE,
        (
            branch("shoulder", cos(A2) * (L3 * sin(A3) - L5), front=+1, back=-1),
            branch("elbow", L2 * sin(A3) + L5 * cos(A3), positive=+1, negative=-1),
            branch("wrist", sin(A5), positive=+1, negative=-1),
        ),
        held=(E1,),
    ),
}
