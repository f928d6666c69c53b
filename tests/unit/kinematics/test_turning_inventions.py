"""Invented loops that turn their platforms: derived, measured by the witness, and executed in both languages."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import sympy as sp
from sympy import cos, sin

from derive.description.mechanism import (
    Branch,
    Joint,
    Mechanism,
    Rod,
    Task,
    Turning,
    branch,
    distance,
    length,
    linear,
    on_plate,
    rod,
    rotary,
)
from derive.description.validate import validate
from derive.ir.program import Status
from derive.kinematics.kinematics import Kinematics
from derive.report.self_test import self_test
from derive.vectors import dot, minus, vector
from derive.witness import witness
from tests.unit.kinematics.inventions import described as invented
from tests.unit.kinematics.machine import Values, machine

pytestmark = pytest.mark.slow

Point = tuple[float, ...]

ROD = length("rod_length", "rods", nominal=300.0)
CRANK = length("crank_length", "cranks", nominal=120.0)
HOME_X, HOME_Z = distance("home_x", "home", nominal=10.0), distance("home_z", "home", nominal=-260.0)
TRIANGLE = ((-260.0, -150.0), (250.0, -170.0), (20.0, 300.0))
SMALL = ((-60.0, -35.0), (70.0, -30.0), (5.0, 80.0))


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
    return invented(
        offset_interface=False,
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
    return invented(
        offset_interface=False,
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
    return invented(
        offset_interface=False,
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
    return invented(
        offset_interface=False,
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
    return invented(
        offset_interface=False,
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


NAMES = tuple(TURNING_INVENTIONS)
EVERY = pytest.mark.parametrize("name", NAMES, ids=str)
COUNT = 60


def described(name: str) -> Mechanism:
    """With a name of its own, so that several are one package."""
    return replace(TURNING_INVENTIONS[name][0], name=f"Kin_Invented_{NAMES.index(name)}")


@cache
def built(name: str) -> Kinematics:
    kinematics = machine(validate(described(name))).kinematics
    evidence = witness(kinematics, described(name))
    return replace(kinematics, evidence=evidence, self_test=self_test(kinematics))


def poses_of(name: str) -> Values:
    mechanism, rng = described(name), np.random.default_rng(6)
    given = {p.symbol: p.nominal for p in mechanism.parameters}
    home = [float(v.subs(given)) for v in mechanism.home]
    width = len(mechanism.task.position)
    away = rng.uniform(-1.0, 1.0, (COUNT, len(home))) * ([25.0] * width + [0.2] * (len(home) - width))
    pose: Values = {c: np.zeros(COUNT) for c in "xyz"}
    pose |= {c: home[k] + away[:, k] for k, c in enumerate(mechanism.task.position)}
    rotation = np.tile(np.eye(3), (COUNT, 1, 1))
    for axis, angle in zip((2,) if len(home) == width + 1 else (0, 1, 2), (home + away)[:, width:].T, strict=True):
        first, second = (axis + 1) % 3, (axis + 2) % 3
        turn = np.tile(np.eye(3), (COUNT, 1, 1))
        turn[:, first, first] = turn[:, second, second] = np.cos(angle)
        turn[:, second, first], turn[:, first, second] = np.sin(angle), -np.sin(angle)
        rotation = turn @ rotation
    return pose | {f"r{i + 1}{j + 1}": rotation[:, i, j] for i in range(3) for j in range(3)}


@EVERY
def test_the_witness_finds_no_other_solution(name: str) -> None:
    evidence = built(name).evidence
    assert evidence is not None and evidence.inverted is not None
    assert evidence.poses == 144 and evidence.inverted.solutions == TURNING_INVENTIONS[name][1]


@EVERY
def test_there_and_back(name: str) -> None:
    """Around home, in the branches of home: every pose that the inverse accepts is found from home."""
    own, pose = machine(validate(described(name))), poses_of(name)
    zero = {j.axis.name: np.zeros(COUNT) for j in own.kinematics.mechanism.joints}
    axes, status = own.inverse(pose, own.slots[0], zero)
    good = status == Status.OK
    assert good.mean() > 0.8
    again = own.forward({n: v[good] for n, v in axes.items()})
    for value in pose:
        assert np.abs(again[value] - pose[value][good]).max() < 1e-9
    assert all((again[f"branch_{b.name}"] > 0).all() for b in own.kinematics.branches)
