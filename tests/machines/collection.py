"""Machines that are in no catalogue, by the rule that each needs."""

from collections.abc import Mapping
from functools import partial

from sympy import Integer, cos, pi, sin

from derive.frames import Rx, Ry, Rz, Tx, Ty, Tz, denavit_hartenberg
from derive.mechanism import (
    Branch,
    Joint,
    Mechanism,
    Task,
    Turning,
    angle,
    branch,
    distance,
    length,
    linear,
    radians,
    rotary,
)
from tests.machines.angle_machines import NUMBERS
from tests.machines.chain_machines import CHAINS
from tests.machines.held_machines import FIRST_HELD, HELD
from tests.machines.searched_machines import POINTING, POINTS, SEARCHED
from tests.machines.subset_machines import SWEPT
from tests.machines.task_machines import TASK_MACHINES, UNNAMED
from tests.machines.textbook import textbook

X, Y, Z, R = (linear(name, f"slide {name}") for name in ("X", "Y", "Z", "R"))
A, B, C, A1, A2, A3, A4, A5, A6, E1 = (rotary(n, f"turn {n}") for n in "A B C A1 A2 A3 A4 A5 A6 E1".split())
PIVOT_X, PIVOT_Y, PIVOT_Z = (
    distance(f"pivot_{c}", f"pivot, {c}", nominal=v) for c, v in zip("xyz", (20, 30, 80), strict=True)
)
BESIDE = distance("beside", "how far the boom is beside its axis", nominal=50.0)
HEIGHT = distance("height", "height of the shoulder", nominal=200.0)
L1, L2, L3, L4 = (length(f"link_{k}", f"link {k}", nominal=v) for k, v in enumerate((300.0, 400.0, 350.0, 120.0), 1))
L5 = length("link_5", "link 5", nominal=30.0)
LEAN = angle("lean", "lean of one axis against another", nominal=50.0)
INCLINED = radians(LEAN)
SLIDES = Tx(X) * Ty(Y) * Tz(Z)
STOCK = (
    X, Y, Z, R, A, B, C, A1, A2, A3, A4, A5, PIVOT_X, PIVOT_Y, PIVOT_Z, BESIDE, HEIGHT, L1, L2, L3, L4, L5, LEAN,
)  # fmt: skip
_machine = partial(textbook, STOCK)

DIRECTION, TURNED = Task("xyz", Turning.DIRECTION), Task("xyz", Turning.ABOUT_Z)
POSE, PLACE, FLAT = Task("xyz", Turning.FULL), Task("xyz"), Task("xy", Turning.ABOUT_Z)
LEFT = branch("slide", Y, left=+1, right=-1)
ELBOW = branch("elbow", sin(A2), right=+1, left=-1)


def _tilt(joint: Joint) -> tuple[Branch, ...]:
    return (branch("tilt", sin(joint), positive=+1, negative=-1),)


THREE_LENGTHS = {
    "trunnion": _machine(
        "Trunnion", Rz(-C) * Ty(-PIVOT_Y) * Tz(-PIVOT_Z) * Rx(-A) * SLIDES, DIRECTION, _tilt(A), joints=(X, Y, Z, A, C)
    ),
    "table with B and C": _machine(
        "TableBc", Rz(C) * Tx(PIVOT_X) * Tz(PIVOT_Z) * Ry(B) * SLIDES, DIRECTION, _tilt(B), joints=(X, Y, Z, B, C)
    ),
    "table with an oblique axis": _machine(
        "Nutating",
        Rz(C) * Tz(PIVOT_Z) * Rx(INCLINED) * Rz(B) * Rx(-INCLINED) * SLIDES,
        DIRECTION,
        _tilt(B),
        joints=(X, Y, Z, B, C),
    ),
    "inclined head over a table on a trunnion": _machine(
        "InclinedOverTrunnion",
        Rz(-C) * Rx(-A) * SLIDES * Rx(INCLINED) * Rz(A4) * Rx(-INCLINED) * Tz(-L4),
        POSE,
        joints=(X, Y, Z, A, A4, C),
    ),
    "oblique slides on a table": _machine(
        "Oblique",
        Rz(C) * Tx(X) * Rz(pi / 5) * Ty(Y) * Rx(pi / 7) * Tz(Z) * Rx(-pi / 7) * Rz(-pi / 5),
        TURNED,
        joints=(X, Y, Z, C),
    ),
}

SQUARES_WITH_LENGTHS = {
    "telescope beside its column": _machine(
        "BoomTurn", Rz(A1) * Ty(BESIDE) * Tx(R) * Rz(A2) * Tx(L4), FLAT, positive=(R,)
    ),
    "telescope that may turn inside out": _machine(
        "BoomBoth", Rz(A1) * Ty(BESIDE) * Tx(R) * Rz(A2) * Tx(L4), FLAT, (branch("boom", R, ahead=+1, behind=-1),)
    ),
    "telescope above its shoulder": _machine(
        "BoomUp",
        Tz(HEIGHT) * Rz(A1) * Ry(A2) * Tz(BESIDE) * Tx(R),
        PLACE,
        (branch("shoulder", R * cos(A2) + BESIDE * sin(A2), front=+1, back=-1),),
        positive=(R,),
    ),
}

PARAMETERS_DECIDE = {
    "skewed rail": _machine(
        "Skewed", Tx(X) * Rz(INCLINED) * Ty(Y) * Rz(-INCLINED) * Tz(Z), PLACE, offset_interface=True
    ),
    "rails in a wedge": _machine(
        "Wedge", Ry(INCLINED) * Tx(X) * Ry(-2 * INCLINED) * Tx(Z) * Ry(INCLINED) * Ty(Y), PLACE, joints=(X, Y, Z)
    ),
}

ONE_ROOT = {
    "arm whose elbow bends one way": _machine(
        "OneElbow",
        Tz(HEIGHT) * Rz(A1) * Ry(A2) * Tz(L2) * Ry(A3) * Tx(L3),
        PLACE,
        (branch("shoulder", L2 * sin(A2) + L3 * cos(A2 + A3), front=+1, back=-1),),
        positive=(cos(A3),),
    ),
    "SCARA that bends to the left alone": _machine(
        "OneScara", Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2) * Tz(Z) * Rz(A4), TURNED, positive=(-sin(A2),)
    ),
}

_SWING = (branch("side", sin(A2), right=+1, left=-1), branch("lean", cos(A2), up=+1, down=-1))

CONSTANT_RADIUS = {
    "jib that swings on a hoist": _machine("Jib", Tz(Z) * Rz(A1) * Ry(A2) * Tz(L1), PLACE, _SWING, joints=(A1, A2, Z)),
    "jib with a number for its length": _machine(
        "JibNumber", Tz(Z) * Rz(A1) * Ry(A2) * Tz(Integer(300)), PLACE, _SWING, joints=(A1, A2, Z)
    ),
}

OTHERS = {
    "palletizer with both motors at the base": _machine(
        "BaseMotors",
        Tz(HEIGHT) * Rz(A1) * Tx(PIVOT_X) * Ry(A2) * Tz(L2) * Ry(A3 - A2) * Tx(L3) * Ry(-A3) * Tx(L4) * Rz(A4),
        TURNED,
        (
            branch("shoulder", PIVOT_X + L2 * sin(A2) + L3 * cos(A3) + L4, front=+1, back=-1),
            branch("elbow", cos(A2 - A3), up=+1, down=-1),
        ),
        offset_interface=True,
    ),
    "numbers for lengths": _machine(
        "Numbers", Rz(A1) * Tx(Integer(250)) * Rz(A2) * Tx(Integer(200)) * Tz(Z) * Rz(A4), TURNED, (ELBOW,)
    ),
    "flange that turns against two axes": _machine(
        "Level",
        Rz(A1) * Tx(PIVOT_X) * Ry(A2) * Tz(L2) * Ry(A3) * Tx(L3) * Ry(-A2 - A3) * Tx(L4) * Rz(A4),
        TURNED,
        (
            branch("shoulder", PIVOT_X + L2 * sin(A2) + L3 * cos(A2 + A3) + L4, front=+1, back=-1),
            branch("elbow", cos(A3), up=+1, down=-1),
        ),
    ),
}

_ARM_AND_TELESCOPE = (Rz(A1) * Tx(L1) * Rz(A2) * Tx(R), FLAT, (branch("arm", cos(A2), ahead=+1, behind=-1),))
ALONG_A_DIRECTION = {
    "telescope in front of an arm": _machine("ArmTelescope", *_ARM_AND_TELESCOPE, positive=(R,)),
    "telescope in front of an arm that may turn inside out": _machine("ArmTelescopeBoth", *_ARM_AND_TELESCOPE),
    "telescope that a tilting arm points": _machine(
        "PointingTelescope",
        Tz(HEIGHT) * Rz(A1) * Ty(Y) * Ry(A2) * Tz(L2) * Ry(A3) * Tz(R),
        DIRECTION,
        (branch("tilt", sin(A2 + A3), positive=+1, negative=-1), branch("arm", cos(A3), ahead=+1, behind=-1)),
    ),
}

HALF_TURNS = {
    "SCARA below a ceiling": _machine(
        "CeilingScara",
        Tz(HEIGHT) * Rx(pi) * Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2) * Tz(Z) * Rz(A4) * Tx(L3),
        TURNED,
        (ELBOW,),
    ),
    "SCARA by its table": _machine(
        "TableOfScara",
        denavit_hartenberg((A1, HEIGHT, L1, 0), (A2, 0, L2, pi), (0, Z, 0, 0), (A4, L4, 0, 0)),
        TURNED,
        (ELBOW,),
    ),
}

ACROSS = {
    "ram that a head may lay flat": _machine(
        "RamHead",
        Tx(X) * Ty(Y) * Rz(C) * Tx(PIVOT_X) * Rx(A) * Ty(PIVOT_Y) * Tz(-R) * Tz(-L4),
        DIRECTION,
        _tilt(A),
        joints=(X, Y, A, R, C),
    ),
    "slide that turns on a slide": _machine("TurningSlide", Ty(Y) * Rz(C) * Tx(X) * Ty(BESIDE), FLAT),
}

DISTANCES_ALONE = {
    "slide on a rocker": _machine(
        "RockerSlide",
        Rx(A1) * Ry(A2) * Tx(PIVOT_X) * Tz(BESIDE) * Ty(Y),
        PLACE,
        (branch("rocker", BESIDE * cos(A2) - PIVOT_X * sin(A2), ahead=+1, behind=-1), LEFT),
    ),
    "slide on a swivel": _machine("SwivelSlide", Rz(A1) * Tx(PIVOT_X) * Ty(Y), Task("xy"), (LEFT,)),
}

SEEN_FROM_A_KNOWN_FRAME = {
    "arm beside the rail that it turns about": _machine(
        "ShoulderRail",
        Tx(X) * Rx(A1) * Ty(L1) * Rz(A2) * Tz(BESIDE) * Tx(L2),
        PLACE,
        (branch("shoulder", L1 + L2 * sin(A2), front=+1, back=-1), branch("elbow", cos(A2), ahead=+1, behind=-1)),
    ),
    "telescope on a rocker that points the tool": _machine(
        "RockerTelescope",
        Rz(A1) * Ry(-A2) * Ty(Y) * Tz(L1) * Tx(R) * Ry(A5),
        DIRECTION,
        (branch("tilt", sin(A5 - A2), positive=+1, negative=-1), branch("telescope", R, ahead=+1, behind=-1)),
    ),
    "telescope with a level head beside it": _machine(
        "LevelTelescope",
        Rz(A1) * Tx(PIVOT_X) * Ry(-A2) * Tx(L1 + R) * Ry(A2) * Ty(BESIDE) * Tz(-L4) * Rz(A4),
        TURNED,
        (
            branch("shoulder", PIVOT_X + (L1 + R) * cos(A2), front=+1, back=-1),
            branch("telescope", L1 + R, ahead=+1, behind=-1),
        ),
    ),
    "level head beside an arm, on a quill": _machine(
        "LevelQuill",
        Rz(A1) * Ry(-A2) * Tx(L1) * Tz(PIVOT_X) * Ry(A2) * Ty(BESIDE) * Tz(Z) * Rz(A4),
        TURNED,
        (
            branch("shoulder", L1 * cos(A2) - PIVOT_X * sin(A2), front=+1, back=-1),
            branch("arm", L1 * sin(A2) + PIVOT_X * cos(A2), up=+1, down=-1),
        ),
    ),
}

TURNS_ABOUT_Y = {
    "boom on a carriage": _machine(
        "CarriageBoom",
        Tx(X) * Ty(Y) * Tz(HEIGHT) * Rz(INCLINED) * Ry(-A1) * Tx(L1) * Ry(pi / 2),
        PLACE,
        (branch("boom", cos(A1), forward=+1, backward=-1),),
    )
}

MACHINES: Mapping[str, Mechanism] = {
    **SEEN_FROM_A_KNOWN_FRAME, **TURNS_ABOUT_Y, **DISTANCES_ALONE, **ACROSS, **HALF_TURNS, **ALONG_A_DIRECTION,
    **CONSTANT_RADIUS, **THREE_LENGTHS, **SQUARES_WITH_LENGTHS, **PARAMETERS_DECIDE, **HELD, **FIRST_HELD, **ONE_ROOT,
    **OTHERS, **SEARCHED, **CHAINS, **NUMBERS, **TASK_MACHINES, **SWEPT,
}  # fmt: skip
SOLUTIONS: Mapping[str, int] = {
    **{name: 2 ** len(m.branches) for name, m in MACHINES.items()},
    **dict.fromkeys(POINTING, 8),
    "three turns between two slides, with an inclined tool": 6,
    **dict.fromkeys((*CHAINS, *POINTS, "arm in metres with a held turn of its upper arm"), 4),
    **{name: count for count, names in UNNAMED.items() for name in names},
}
"""The most solutions: two a branch that is stated, else as a search from many starts finds them."""
COSTLY = (
    "a tool beside", "an inclined tool",
    "an elbow that is held", "arm in metres", "arm of a URDF file", "arm with a wrist that is bent",
    "arm with three parallel axes", "across its last axis", "by a table with angles", "by a table, the last held",
    "head points, beside its axis", "may lie on its second axis", "seven axes beside each other",
    "three axes that miss", "three axes with offsets", "tilting arm points", "with a wrist",
    "inclined head over", "tilts its tool", "with an elbow and a wrist", "wrist goes sideways",
)  # fmt: skip
"""Words of those that take seconds to be derived: `make sweep` asks them."""
