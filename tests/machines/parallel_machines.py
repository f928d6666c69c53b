"""Arms with six axes, three of them parallel: with links that happen to be of one length, and with the three last."""

from collections.abc import Mapping

from derive.description.mechanism import Mechanism
from derive.frames import Rx, Ry, Rz, Tx, Ty, Tz
from derive.mechanism import Task, Turning, length, rotary
from tests.machines.textbook import textbook

A1, A2, A3, A4, A5, A6 = JOINTS = tuple(rotary(f"A{k}", f"turn A{k}") for k in range(1, 7))
L1, L2, L3, L4, L5, L6 = EQUAL = tuple(length(f"link_{k}", f"link {k}", nominal=250.0) for k in range(1, 7))
SHORT, LONG, WRIST, TOOL = METRES = tuple(
    length(f"link_{k}", f"link {k}, in metres", nominal=v) for k, v in enumerate((0.2125, 0.5525, 0.85, 0.425), 1)
)
POSE = Task("xyz", Turning.FULL)
LAST = "arm whose three parallel axes come last"
D1, D2, D3, D4, D5, D6 = FURTHER = tuple(
    length(f"link_{k}", f"link {k}, three parallel axes last", nominal=v)
    for k, v in enumerate((310.0, 140.0, 120.0, 380.0, 350.0, 90.0), 1)
)

PARALLEL: Mapping[str, Mechanism] = {
    "arm whose first axes are parallel, with a height that tells a joint of the wrist": textbook(
        (*JOINTS, *EQUAL),
        "ParallelHeight",
        Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2) * Tz(L2) * Rz(-A3) * Ry(A4) * Tx(L4) * Rx(A5) * Tx(L5) * Rz(A6),
        POSE,
    ),
    "arm whose first axes are parallel, with a polar radius of an entry and a height": textbook(
        (*JOINTS, *EQUAL),
        "ParallelRadius",
        Ry(A1) * Tx(L1) * Ry(A2) * Tx(L2) * Ry(A3) * Tx(L3) * Rz(A4) * Tz(L4) * Ry(A5) * Tz(L5) * Rx(A6),
        POSE,
    ),
    "arm whose first axes are parallel, with a polar radius as long as a link": textbook(
        (*JOINTS, *EQUAL),
        "ParallelLength",
        Rx(A1) * Tz(L1) * Tx(L1) * Rx(A2) * Ty(L2) * Tx(L2) * Rx(A3) * Ry(A4) * Rx(A5) * Tz(L5) * Ry(A6) * Tx(L6),
        POSE,
    ),
    "arm with three parallel axes, in one plane": textbook(
        (*JOINTS, *METRES),
        "ParallelPlane",
        Rz(A1) * Ry(A2) * Tz(LONG) * Ry(A3) * Tz(SHORT) * Ry(A4) * Tz(WRIST) * Rx(A5) * Ry(A6) * Ty(TOOL),
        POSE,
    ),
    LAST: textbook(
        (*JOINTS, *FURTHER),
        "ParallelLast",
        Rz(A1) * Tz(D1) * Rx(A2) * Tx(D2) * Rz(A3) * Tz(D3) * Rx(A4) * Tz(D4) * Rx(A5) * Tz(D5) * Rx(A6) * Tz(D6),
        POSE,
    ),
}
