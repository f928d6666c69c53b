"""Serial chains of few axes: an arm without length in some poses, arms without a closed form, and held joints."""

from functools import partial

import sympy as sp
from sympy import pi

from derive.frames import Chain, Rx, Ry, Rz, Tx, Ty, Tz
from derive.mechanism import Task, Turning, distance, length, linear, rotary
from tests.machines.textbook import textbook

X, Y, Z = (linear(name, f"slide {name}") for name in "XYZ")
A1, A2, A3, A4, A5, A6, A7 = (rotary(f"A{k}", f"turn A{k}") for k in range(1, 8))
L5 = length("link_5", "link 5", nominal=30.0)
L1, L2, L3, L4 = (length(f"link_{k}", f"link {k}", nominal=v) for k, v in enumerate((50.0, 200.0, 300.0, 120.0), 1))
PLACE, DIRECTION, POSE = Task("xyz"), Task("xyz", Turning.DIRECTION), Task("xyz", Turning.FULL)
UPPER, TOOL = (distance(name, name, nominal=300.0) for name in ("first_link", "tool_link"))
SHORT = length("short_link", "short link", nominal=50.0)
"""The slide is sampled within the lengths of the machine, and distances are none: far below the long links."""
_chain = partial(textbook, (X, Y, Z, A1, A2, A3, A4, A5, A6, A7, L1, L2, L3, L4, L5, UPPER, TOOL, SHORT))


def _by_table(*rows: tuple[sp.Expr | float, float, sp.Expr | float, float]) -> Chain:
    """The chain of a table in the modified convention: twist and length before the turn, angle and shift of it."""
    chain = Chain(())
    for twist, length_before, turn, shift in rows:
        chain = chain * Rx(twist) * Tx(length_before) * Rz(turn) * Tz(shift)
    return chain


WITHOUT_ARM = {
    "finger on a rocker on a slide": _chain("Finger", Ty(Y) * Tz(L1) * Rx(A1) * Tx(L2) * Ry(A2) * Tz(L3), PLACE),
    "arm whose wrist may lie on its second axis": _chain(
        "Kneeling", Ry(A1) * Tz(L1) * Rz(A2) * Tz(L2) * Rx(-A3) * Ty(L3) * Rz(A4) * Rx(A5) * Rz(A6) * Tz(L4), POSE
    ),
    "finger beside a rocker on a slide": _chain(
        "Beside", Ty(Y) * Tz(L1) * Rx(A1) * Tx(L2) * Ry(A2) * Tz(L3) * Ty(L4), PLACE
    ),
    "finger that two rockers in a row turn": _chain(
        "TwoRockers", Rx(-A1) * Tz(L1) * Rx(A2) * Ry(-A3) * Tx(L2) * Tz(L4), PLACE
    ),
    "finger that folds onto the second of two parallel axes": _chain(
        "Folding", Rz(-A1) * Tx(L1) * Rz(A2) * Tx(L2) * Ry(A3) * Tx(L3) * Tz(L2), PLACE
    ),
    "slide that a head points, beside its axis": _chain(
        "Pointed", Ty(Y) * Rz(-A1) * Tx(L1) * Ry(A2) * Rz(A3) * Tx(L3) * Tz(Z), DIRECTION
    ),
}
"""Joints fold the arm of a later joint onto its axis: that joint is free there. In the last its size changes alone."""

LONG_LINKS = {
    "telescope between long links, with a wrist": _chain(
        "LongLinks", Rz(A1) * Tx(UPPER) * Ry(A2) * Tx(Y) * Tx(SHORT) * Rz(A4) * Ry(A5) * Rz(A6) * Tx(TOOL), POSE
    )
}
"""Determinants of two steps have one sign at all samples: with these dimensions signs alone tell no branch."""

BENT_WRISTS = {
    "arm with a wrist that is bent by 60 degrees": _chain(
        "BentWrist",
        Rz(A1) * Ry(A2) * Tz(L2) * Ry(A3) * Tx(L3) * Rx(A4) * Rz(pi / 3) * Rx(A5) * Rz(-pi / 3) * Rx(A6) * Tx(L4),
        POSE,
    ),
    "head whose second axis leans by 45 degrees": _chain(
        "LeaningHead", Ty(Y) * Tz(Z) * Tx(X) * Rz(A4) * Rx(pi / 4) * Rz(A5) * Rx(-pi / 4) * Tz(-L4), DIRECTION
    ),
}
"""At A5 = 0 the entry of the rotation that tells A5 is one, and the angle is in the digits that it has lost."""

FROM_FLANGE = {
    "seven axes by a table, the last held": _chain(
        "Panda",
        _by_table(
            (0, 0, A1, 0.333),
            (-pi / 2, 0, A2, 0),
            (pi / 2, 0, A3, 0.316),
            (pi / 2, 0.0825, A4, 0),
            (-pi / 2, -0.0825, A5, 0.384),
            (pi / 2, 0, A6, 0),
            (pi / 2, 0.088, A7, 0.107),
        ),
        POSE,
        held=(A7,),
    ),
    "seven axes with an elbow and a wrist beside them, the last held": _chain(
        "BesideHeld",
        Rz(A1) * Ry(A2) * Rz(A3) * Tz(L3) * Tx(L1) * Ry(A4) * Tz(L2) * Rz(A5) * Ry(A6) * Tx(L5) * Rz(A7) * Tz(L4),
        POSE,
        held=(A7,),
    ),
}
"""With the last joint known the shoulder, seen from the flange, gives the joints of the wrist."""

OF_DEGREE_FOUR = {
    "three axes with offsets everywhere": _chain(
        "Ortho",
        Tz(L2) * Rz(A1) * Tx(L1) * Rx(pi / 2) * Rz(A2) * Tz(L5) * Tx(L3) * Rx(pi / 2) * Rz(A3) * Tz(L1) * Tx(L4),
        PLACE,
    ),
    "three axes that lean by 60 degrees": _chain(
        "Leaning", Rz(A1) * Tx(L1) * Rx(pi / 3) * Rz(A2) * Tz(L5) * Tx(L3) * Rx(pi / 3) * Rz(A3) * Tx(L4), PLACE
    ),
}
"""With one joint known a pair gives the next; the residual is a quartic of the tangent of its half angle."""

WRIST_BEYOND_QUARTIC = {
    "arm whose elbow rolls, with a wrist": _chain(
        "RollingElbow", Ry(A1) * Tx(L1) * Rz(A2) * Ty(L2) * Rx(A3) * Tz(L3) * Rz(A4) * Rx(A5) * Rz(A6) * Tz(L4), POSE
    ),
    "arm whose elbow goes across, with a wrist": _chain(
        "AcrossWrist",
        Ry(A1) * Tz(L1) * Ty(L2) * Rx(A2) * Tz(L3) * Ty(L5) * Ry(A3) * Tz(L2) * Rx(A4) * Ry(A5) * Rx(A6) * Tz(L4),
        POSE,
    ),
}
"""The position alone is searched as above: its wrist takes any rotation, and does not say which trial is a solution."""

_BESIDE_EACH_OTHER = Rx(-A4) * Tz(L1) * Tx(L5) * Ry(A5) * Tx(L4) * Rz(-A6) * Tx(L4)
THREE_PARALLEL = {
    "arm with three parallel axes, the last two beside each other": _chain(
        "ThreeParallel", Rz(A1) * Tx(L1) * Rx(A2) * Tz(L2) * Rx(A3) * Tz(L3) * _BESIDE_EACH_OTHER, POSE
    )
}
"""With one joint known the rotation tells the sum of the parallel ones, before the position tells each."""

MEETING_AXES = {
    "arm that rolls and bends where its shoulder is": _chain(
        "Rolling", Rz(A1) * Tx(L1) * Ry(A2) * Rz(A3) * Tx(L4) * Tz(L3), PLACE
    ),
    "arm that rolls beside its elbow about an axis that leans": _chain(
        "LeaningRoll", Rz(A1) * Tx(L1) * Ry(pi / 5) * Rx(A2) * Tx(L2) * Ry(A3) * Tx(L3), PLACE
    ),
    "arm with an elbow that is held, whose shoulder is beside its base": _chain(
        "HeldElbow",
        Rz(A1) * Tx(L1) * Rx(A2) * Ry(A3) * Tx(L5) * Tz(L2) * Rx(A4) * Tz(L3) * Rz(A5) * Rx(A6) * Rz(A7) * Tz(L4),
        POSE,
        held=(A4,),
    ),
    "arm with an elbow that is held, whose flange is beside its wrist": _chain(
        "HeldBefore",
        Rz(A1) * Rx(A2) * Rz(A3) * Tz(L2) * Tx(L5) * Rx(A4) * Tz(L3) * Rz(A5) * Rx(A6) * Tx(L1) * Rz(A7) * Tz(L4),
        POSE,
        held=(A4,),
    ),
}
"""Behind the first unknown joint two axes meet: where they meet is as far from the wrist as links and elbow say."""

SHORT_ARMS = {
    "arm that rolls before its elbow": _chain("RollElbow", Ry(A1) * Rx(A2) * Tx(L2) * Ry(A3) * Tx(L3), PLACE),
    "arm that rolls before its elbow, beside its base": _chain(
        "RollBeside", Rz(A1) * Tx(L1) * Rx(A2) * Tx(L2) * Ry(A3) * Tx(L3), PLACE
    ),
}
"""The elbow, nearly straight, folds the arm that the roll turns: its length is the root of the law of cosines."""

TOOL_ON_AXIS = {
    "arm whose tool points across its last axis": _chain(
        "AcrossLast",
        Ry(A1) * Tx(L1) * Rx(A2) * Tz(L2) * Rx(-A3) * Ty(L3) * Rx(A4) * Ry(A5) * Tz(L4) * Ty(L5),
        DIRECTION,
    )
}
"""The last shift is along the last axis: where this axis meets the line of the tool, the last joint moves nothing."""

_ELBOW = 1.3849179
ANGLES_AS_NUMBERS = _chain(
    "AnglesByTable",
    _by_table(
        (0, 0, A1, 0.267),
        (-pi / 2, 0, A2 - _ELBOW, 0),
        (0, 0.28948866, A3 + _ELBOW, 0),
        (-pi / 2, 0.0775, A4, 0.3425),
        (pi / 2, 0, A5, 0),
        (-pi / 2, 0.076, A6, 0.097),
    ),
    POSE,
)
"""It is searched: the compiler names its branches by the joints and by angles of its own, in degrees."""

BY_TABLE = {"six axes by a table with angles as numbers": ANGLES_AS_NUMBERS}

CHAINS = {
    **WITHOUT_ARM, **FROM_FLANGE, **OF_DEGREE_FOUR, **WRIST_BEYOND_QUARTIC, **THREE_PARALLEL, **BY_TABLE,
    **BENT_WRISTS, **LONG_LINKS, **MEETING_AXES, **SHORT_ARMS, **TOOL_ON_AXIS,
}  # fmt: skip
