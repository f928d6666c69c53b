"""Mechanisms for which the derivation was not tuned."""

import sympy as sp
from sympy import cos, sin

from derive.description.mechanism import (
    TURN,
    Mechanism,
    Parameter,
    Task,
    Turning,
    Vendor,
    X,
    Y,
    Z,
    branch,
    coupling,
    helical,
    length,
    linear,
    optional_length,
    pitch,
    rotary,
    sign,
)
from derive.geometry.frames import Chain, Rz, Tx, Txyz, Ty, Tz, flip_x
from tests.machines.textbook import read_by

L1 = length("link_1", "first link", nominal=300.0)
L2 = length("link_2", "second link", nominal=200.0)
L3 = optional_length("link_3", "third link", nominal=70.0)
PITCH = pitch("pitch_screw", "travel per turn", nominal=12.0)
DIRECTION = sign("direction_a1", "sense of the first motor", nominal=-1)
K12 = coupling("coupling_12", "turn of joint 2 per turn of motor 1", nominal=-0.5)

A1, A2, A3, A4 = (rotary(f"A{k}", f"turn {k}") for k in (1, 2, 3, 4))
P1, P2, P3 = (linear(f"P{k}", f"slide {k}") for k in (1, 2, 3))
STOCK = (A1, A2, A3, A4, P1, P2, P3, L1, L2, L3, PITCH, DIRECTION, K12)
FOLLOWED = Turning.ABOUT_Z
ELBOW = branch("elbow", sin(A2), right=+1, left=-1)


def described(**description: object) -> Mechanism:
    """A description: the joints and the parameters of a chain that are not stated are those that it reads."""
    details = {"name": "Kin_Invented", "vendor": Vendor.TEXTBOOK, "family": "test", "source": "none", "summary": "none"}
    chain = description.get("chain")
    read = read_by(chain, STOCK) if isinstance(chain, Chain) else {}
    return Mechanism(**{**details, **read, **description})  # type: ignore[arg-type]


def planar_arm(**changes: object) -> Mechanism:
    """The arm with two links in a plane, changed."""
    stated = {
        "parameters": (L1, L2),
        "joints": (A1, A2),
        "chain": Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2),
        "task": Task("xy"),
        "branches": (ELBOW,),
        "offset_interface": False,
    }
    return described(**{**stated, **changes})


def links(*turns: object, last: Parameter = L3) -> Chain:
    """Turns about z with the three links behind them."""
    first, second, third = turns
    return Rz(first) * Tx(L1) * Rz(second) * Tx(L2) * Rz(third) * Tx(last)


SHOULDER = L1 * cos(A2) + L2 * cos(A2 + A3)
RADIUS = P1 + L1

INVENTIONS = {
    "a lift between the joints": described(
        chain=Rz(A1) * Tz(P1) * Tx(L1) * Rz(A2) * Tx(L2) * Rz(A3) * Tx(L3),
        task=Task("xyz", FOLLOWED),
        branches=(ELBOW,),
        periods=("A3", "A1", "A2"),
    ),
    "all turns clockwise": described(
        chain=links(-A1, -A2, -A3), task=Task("xy", FOLLOWED), branches=(branch("elbow", -sin(A2), right=+1, left=-1),)
    ),
    "a base that stands aside, looking elsewhere": described(
        joints=(A1, A2, P1, A3),
        chain=Txyz(100, -50, 20) * Rz(sp.pi / 6) * Tz(P1) * links(A1, A2, A3) * flip_x(1),
        task=Task("xyz", FOLLOWED),
        branches=(ELBOW,),
    ),
    "an arm on its side, crooked": described(
        chain=Rz(A1) * Ty(L1) * Rz(A2) * Tx(L2) * Ty(L3) * Tz(P1),
        task=Task("xyz"),
        branches=(branch("elbow", L3 * sin(A2) - L2 * cos(A2), right=+1, left=-1),),
    ),
    "an arm on an oblique rail": described(
        chain=Rz(sp.pi / 6) * Tx(P1) * Rz(A1) * Tx(L1) * Rz(A2) * Tx(L3),
        task=Task("xy", FOLLOWED),
        branches=(branch("side", cos(A1), front=+1, back=-1),),
    ),
    "a telescope with a wrist": described(
        chain=Rz(A1) * Tx(P1) * Rz(A2) * Tx(L1),
        task=Task("xy", FOLLOWED),
        branches=(branch("reach", P1, front=+1, back=-1),),
        offset_interface=False,
    ),
    "a telescope on a column": described(
        parameters=(L1,),
        joints=(A1, P2, P1),
        closure=(X - RADIUS * cos(A1), Y - RADIUS * sin(A1), Z - P2 + 5),
        task=Task("xyz"),
        positive=(RADIUS,),
    ),
    "skewed belts": described(chain=Tx((2 * P1 - P2) / 3) * Ty((P1 + P2) / 2) * Tz(P3 - P1 / 4), task=Task("xyz")),
    "belts geared by parameters": described(
        parameters=(L1, L2), joints=(P1, P2), closure=(X - L1 * P1 + L2 * P2, Y - L2 * P1 - L1 * P2), task=Task("xy")
    ),
    "an oblique slide": described(chain=Tx(P1) * Rz(sp.pi / 3) * Tx(P2), task=Task("xy")),
    "clock angles": described(
        parameters=(L1, L2),
        joints=(A1, A2),
        closure=(X - L1 * sin(A1) - L2 * sin(A2), Y - L1 * cos(A1) - L2 * cos(A2)),
        task=Task("xy"),
        branches=(branch("elbow", sin(A2 - A1), right=+1, left=-1),),
    ),
    "all motors in the base": described(
        chain=links(A1, A2 - A1, A3 - A2),
        task=Task("xy", FOLLOWED),
        branches=(branch("elbow", sin(A2 - A1), right=+1, left=-1),),
    ),
    "a motor of either sense": described(
        chain=Rz(DIRECTION * A1) * Tx(L1) * Rz(A2) * Tx(L2) * Rz(A3), task=Task("xy", FOLLOWED), branches=(ELBOW,)
    ),
    "a palletiser": described(
        parameters=(L1, L2),
        joints=(A1, A2, A3),
        closure=(X - cos(A1) * SHOULDER, Y - sin(A1) * SHOULDER, Z - L1 * sin(A2) - L2 * sin(A2 + A3)),
        task=Task("xyz"),
        branches=(branch("shoulder", SHOULDER, front=+1, back=-1), branch("elbow", sin(A3), down=+1, up=-1)),
    ),
    "a boom that tips over": described(
        parameters=(L1,),
        joints=(A1, A2, linear("P1", "boom", domain=(0.0, 1e9), nominal=100.0)),
        closure=(X - P1 * cos(A2) * cos(A1), Y - P1 * cos(A2) * sin(A1), Z - L1 - P1 * sin(A2)),
        task=Task("xyz"),
        positive=(P1,),
        branches=(branch("side", cos(A2), front=+1, back=-1),),
    ),
    "a screw that lifts as the arm turns": described(
        joints=(A1, helical("A2", "carries the lift", limit_range=(-720.0, 720.0), pitch=PITCH), P1, A4),
        chain=Tz(P1 + PITCH * A2 / TURN) * Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2) * Rz(A4),
        task=Task("xyz", FOLLOWED),
        branches=(ELBOW,),
        periods=("A1", "A2", "A4"),
    ),
    "a coupled elbow": described(
        parameters=(L1, L2, K12),
        joints=(A1, rotary("A2", "driven through the shoulder", coupling=K12 * A1.motor)),
        chain=Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2),
        task=Task("xy"),
        branches=(ELBOW,),
    ),
}
