"""Arms without a closed form: the compiler finds the joint that is searched."""

from sympy import cos, sin

from derive.frames import Chain, Rx, Ry, Rz, Tx, Ty, Tz
from derive.mechanism import (
    Branch,
    Mechanism,
    Parameter,
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
from tests.machines.textbook import textbook

A1, A2, A3, A4, A5, A6 = (rotary(f"A{k}", f"turn A{k}") for k in range(1, 7))
UPPER, FORE = length("link_a", "upper arm", nominal=540.0), length("link_b", "forearm", nominal=540.0)
SIDE = distance("sideways", "axis A4 to axis A5, sideways", nominal=150.0)
FLANGE = length("link_c", "wrist to flange", nominal=160.0)
BASE = distance("shoulder_y", "axis A1 to the arm, sideways", nominal=0.03)
M_UPPER, M_FORE = length("link_a", "upper arm", nominal=0.41), length("link_b", "forearm", nominal=0.31)
M_ELBOW = distance("between", "elbow of the wrist", nominal=0.085)
M_FLANGE = length("link_c", "wrist to flange", nominal=0.2)
LEAN = angle("lean", "lean of the axes of the wrist against each other", nominal=60.0, low=40.0, high=80.0)


def _arm(name: str, chain: Chain, parameters: tuple[Parameter, ...], branches: tuple[Branch, ...] = ()) -> Mechanism:
    """An arm whose wrist axes miss each other."""
    return textbook((A1, A2, A3, A4, A5, A6, *parameters), name, chain, Task("xyz", Turning.FULL), branches)


_BESIDE = tuple(distance(f"beside_{k}", f"shift {k} beside the axes", nominal=50.0) for k in range(1, 5))
REACH = length("reach_a", "last axis to the point", nominal=200.0)


def _point(name: str, chain: Chain) -> Mechanism:
    """An arm with three axes that miss each other."""
    return textbook((A1, A2, A3, *_BESIDE, REACH), name, chain, Task("xyz"))


_B1, _B2, _B3, _B4 = _BESIDE
POINTS = {
    "three axes that miss each other, the elbow across": _point(
        "PointAcross", Ry(A1) * Tz(_B1) * Ty(_B2) * Rx(A2) * Tz(_B3) * Ty(_B4) * Ry(A3) * Tz(REACH)
    ),
    "three axes that miss each other, each across the next": _point(
        "PointCrossed", Rx(A1) * Ty(_B1) * Tz(_B2) * Rz(A2) * Tx(_B3) * Ty(_B4) * Rx(A3) * Ty(REACH)
    ),
}
"""Arms that turn a point: with a shift of zero a branch may meet the next one where two solutions of it meet."""

_FLANGE = Tz(-FLANGE)
_TRACK, _QUILL = linear("E1", "track"), linear("E2", "quill")
_LEANING = Tz(_QUILL) * Tx(_B4) * Ry(radians(LEAN))


def _pointing(name: str, chain: Chain) -> Mechanism:
    """An arm with five axes whose direction is commanded, with the line of the tool beside the last axis."""
    shoulder = Rz(A1) * Tx(_B1) * Ry(A2) * Tz(UPPER) * Ry(A3) * Tx(FORE)
    stock = (A1, A2, A3, A4, A5, *_BESIDE, UPPER, FORE, FLANGE, LEAN)
    return textbook(stock, name, shoulder * chain * _FLANGE, Task("xyz", Turning.DIRECTION))


POINTING = {
    "five axes with a tool beside the last one, three of them parallel": _pointing(
        "PointingParallel", Ry(A4) * Tx(_B2) * Rx(A5) * Ty(_B3)
    ),
    "five axes with a tool beside the last one": _pointing("Pointing", Rx(A4) * Ry(A5) * Tx(_B2)),
    "three turns between two slides, with an inclined tool": textbook(
        (_TRACK, _QUILL, A1, A2, A3, *_BESIDE, FLANGE, LEAN),
        "PointingSlides",
        Tx(_TRACK) * Rz(A1) * Ty(_B1) * Ry(A2) * Tx(_B2) * Rx(A3) * Ty(_B3) * _LEANING * _FLANGE,
        Task("xyz", Turning.DIRECTION),
    ),
}
"""With the turn of the tool about its line as a sixth joint these are arms that are searched."""

_BENT = Rz(radians(LEAN)) * Rx(A5) * Tx(M_ELBOW) * Rz(-radians(LEAN))
SEARCHED = {
    "arm whose wrist goes sideways": _arm(
        "Sideways",
        Rz(A1) * Ry(A2) * Tz(UPPER) * Ry(A3) * Tx(FORE) * Rx(A4) * Ty(SIDE) * Ry(A5) * Rx(A6) * Tx(FLANGE),
        (UPPER, FORE, SIDE, FLANGE),
    ),
    "arm in metres with a bent wrist and a shoulder beside its axis": _arm(
        "Bent",
        Rz(A1) * Ty(BASE) * Ry(A2) * Tz(M_UPPER) * Ry(A3) * Tx(M_FORE) * Rx(A4) * _BENT * Rx(A6) * Tx(M_FLANGE),
        (BASE, M_UPPER, M_FORE, M_ELBOW, M_FLANGE, LEAN),
        (
            branch("shoulder", M_UPPER * sin(A2) + M_FORE * cos(A2 + A3), front=+1, back=-1),
            branch("wrist", sin(A5), positive=+1, negative=-1),
            branch("elbow", cos(A3), up=+1, down=-1),
        ),
    ),
    **POINTS,
    **POINTING,
}
"""One without any branch stated, one with a branch that no step decides; arms that turn a point, or point a tool."""
