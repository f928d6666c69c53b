"""Loops that turn their platforms, for which the derivation was not tuned."""

from collections.abc import Sequence

import sympy as sp
from sympy import cos, sin

from derive.description.mechanism import (
    Branch,
    Joint,
    Mechanism,
    Rod,
    Task,
    Turning,
    Vendor,
    branch,
    distance,
    length,
    linear,
    on_plate,
    rod,
    rotary,
)
from derive.vectors import dot, minus, vector

Point = tuple[float, ...]

ROD = length("rod_length", "rods", nominal=300.0)
CRANK = length("crank_length", "cranks", nominal=120.0)
HOME_X, HOME_Z = distance("home_x", "home", nominal=10.0), distance("home_z", "home", nominal=-260.0)
TRIANGLE = ((-260.0, -150.0), (250.0, -170.0), (20.0, 300.0))
SMALL = ((-60.0, -35.0), (70.0, -30.0), (5.0, 80.0))


def _details(**description: object) -> Mechanism:
    details = {
        "name": "Kin_Invented", "vendor": Vendor.TEXTBOOK, "family": "test", "source": "none", "summary": "none",
        "offset_interface": False,
    }  # fmt: skip
    return Mechanism(**{**details, **description})  # type: ignore[arg-type]


def _along(number: int, rod_: Rod, direction: Sequence[object]) -> Branch:
    """Which side of the joint on the plate the slider is, along its rail."""
    span = minus(vector(*rod_.plate), vector(*rod_.base))
    return branch(f"slide_{number}", dot(span, vector(*direction)), ahead=+1, behind=-1)


def _sliders(
    places: Sequence[Point], directions: Sequence[Point]
) -> tuple[tuple[Joint, ...], list[tuple[sp.Expr, ...]]]:
    joints = tuple(linear(f"P{k}", "slide", nominal=0.0) for k, _ in enumerate(places, 1))
    ends = [
        tuple(a + d * joint for a, d in zip(place, direction, strict=True))
        for joint, place, direction in zip(joints, places, directions, strict=True)
    ]
    return joints, ends


def three_prr() -> Mechanism:
    """Three sliders on the sides of a triangle with rods of the same length."""
    directions = [(1.0, 0.0), (-0.6, 0.8), (-0.6, -0.8)]
    joints, ends = _sliders(TRIANGLE, directions)
    rods = tuple(rod(str(k), e, on_plate(*p), ROD) for k, (e, p) in enumerate(zip(ends, SMALL, strict=True), 1))
    return _details(
        parameters=(ROD, HOME_X),
        joints=joints,
        rods=rods,
        task=Task("xy", Turning.ABOUT_Z),
        branches=tuple(_along(k, r, d) for k, (r, d) in enumerate(zip(rods, directions, strict=True), 1)),
        home=(HOME_X, sp.Integer(0), sp.Integer(0)),
    )


def three_rpr() -> Mechanism:
    """Three legs of variable length: no branches; numbers where others have parameters."""
    joints = tuple(linear(f"P{k}", "leg", domain=(0.0, 1e9), nominal=220.0) for k in (1, 2, 3))
    rods = tuple(
        rod(str(k), tuple(map(sp.Float, b)), on_plate(*p), j)
        for k, (b, p, j) in enumerate(zip(TRIANGLE, SMALL, joints, strict=True), 1)
    )
    return _details(
        parameters=(HOME_X,),
        joints=joints,
        rods=rods,
        task=Task("xy", Turning.ABOUT_Z),
        positive=joints,
        home=(HOME_X, sp.Integer(0), sp.Rational(1, 5)),
    )


def two_cranks_and_a_leg() -> Mechanism:
    """Three legs of three kinds: a crank with a rod, a slider with a rod, a leg of variable length."""
    turn, slide, leg = (
        rotary("A1", "crank"),
        linear("P2", "slide"),
        linear("P3", "leg", domain=(0.0, 1e9), nominal=200.0),
    )
    knee = vector(-260 + CRANK * cos(turn), -150 + CRANK * sin(turn))
    first = rod("1", knee, on_plate(*SMALL[0]), ROD)
    second = rod("2", vector(slide, -200), on_plate(*SMALL[1]), ROD)
    third = rod("3", vector(20, 300), on_plate(*SMALL[2]), leg)
    along = minus(vector(*first.plate), knee)
    return _details(
        parameters=(ROD, CRANK, HOME_X),
        joints=(turn, slide, leg),
        rods=(first, second, third),
        task=Task("xy", Turning.ABOUT_Z),
        positive=(leg,),
        branches=(
            branch("elbow", cos(turn) * along[1] - sin(turn) * along[0], right=+1, left=-1),
            branch("slide", second.plate[0] - slide, ahead=+1, behind=-1),
        ),
        home=(HOME_X, sp.Integer(0), sp.Integer(0)),
    )


def four_rods() -> Mechanism:
    """Position and heading on four cranks, with joints of the platform at different heights."""
    bases = ((220.0, 40.0), (-30.0, 210.0), (-230.0, -20.0), (10.0, -200.0))
    plates = ((60.0, 50.0, 0.0), (-60.0, 40.0, 30.0), (-50.0, -60.0, 0.0), (55.0, -45.0, 20.0))
    joints = tuple(rotary(f"A{k}", "crank") for k in (1, 2, 3, 4))
    outward = [(1, 0), (0, 1), (-1, 0), (0, -1)]
    rods, branches = [], []
    for k, (b, p, j, d) in enumerate(zip(bases, plates, joints, outward, strict=True), 1):
        arm = vector(CRANK * cos(j) * d[0], CRANK * cos(j) * d[1], -CRANK * sin(j))
        knee = vector(b[0] + arm[0], b[1] + arm[1], arm[2])
        rods.append(rod(str(k), knee, on_plate(*p), ROD))
        span = minus(vector(*rods[-1].plate), knee)
        ahead = span[0] * d[0] + span[1] * d[1]
        branches.append(branch(f"knee_{k}", -cos(j) * span[2] - sin(j) * ahead, outward=+1, inward=-1))
    return _details(
        parameters=(ROD, CRANK, HOME_X, HOME_Z),
        joints=joints,
        rods=tuple(rods),
        task=Task("xyz", Turning.ABOUT_Z),
        branches=tuple(branches),
        home=(HOME_X, sp.Integer(0), HOME_Z, sp.Integer(0)),
    )


def six_rus() -> Mechanism:
    """Six cranks about horizontal axes carry a platform with its whole pose on rods."""
    joints = tuple(rotary(f"A{k}", "crank") for k in range(1, 7))
    base = [_on_circle(210.0, a) for a in (10, 110, 130, 230, 250, 350)]
    plate = [_on_circle(110.0, a) for a in (45, 75, 165, 195, 285, 315)]
    rods, branches = [], []
    for k, (b, p, j) in enumerate(zip(base, plate, joints, strict=True), 1):
        d = (sp.Rational(3, 5), sp.Rational(4, 5)) if k % 2 else (sp.Rational(-3, 5), sp.Rational(4, 5))
        arm = vector(CRANK * cos(j) * d[0], CRANK * cos(j) * d[1], CRANK * sin(j))
        knee = vector(b[0] + arm[0], b[1] + arm[1], arm[2])
        rods.append(rod(str(k), knee, on_plate(*p, 0), ROD))
        span = minus(vector(*rods[-1].plate), knee)
        ahead = span[0] * d[0] + span[1] * d[1]
        branches.append(branch(f"knee_{k}", cos(j) * span[2] - sin(j) * ahead, up=+1, down=-1))
    return _details(
        parameters=(ROD, CRANK, HOME_X, distance("home_z", "home", nominal=270.0)),
        joints=joints,
        rods=tuple(rods),
        task=Task("xyz", Turning.FULL),
        branches=tuple(branches),
        home=(HOME_X, sp.Integer(0), sp.Symbol("home_z", real=True), *[sp.Integer(0)] * 3),
    )


def _on_circle(radius: float, degrees: float) -> tuple[sp.Expr, sp.Expr]:
    angle = sp.pi * degrees / 180
    return sp.Float(radius * float(cos(angle)), 9), sp.Float(radius * float(sin(angle)), 9)


TURNING_INVENTIONS = {
    "three sliders with rods": (three_prr(), 5),
    "three legs of variable length": (three_rpr(), 1),
    "legs of three kinds": (two_cranks_and_a_leg(), 4),
    "four cranks, position and heading": (four_rods(), 12),
    "six cranks with rods": (six_rus(), 64),
}
"""With the largest number of solutions, in the assembly mode of home, that the witness finds at a pose."""
