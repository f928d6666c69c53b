"""Spatial arms for which the derivation was not tuned: built, and checked against the closure by the witness."""

from collections.abc import Callable

import pytest
from sympy import cos, pi, sin

from derive.description.mechanism import Mechanism, Task, Turning, branch, distance, length, linear, rotary
from derive.geometry.frames import Rx, Ry, Rz, Tx, Txyz, Ty, Tz, denavit_hartenberg
from derive.kinematics.build import build
from derive.witness import witness
from tests.unit.kinematics.inventions import described

pytestmark = pytest.mark.slow

L1 = length("link_1", "first link", nominal=300.0)
L2 = length("link_2", "second link", nominal=250.0)
ASIDE = distance("aside", "beside", nominal=40.0)
TIP = distance("tip", "behind the wrist", nominal=80.0)
RISE = distance("rise", "a step", nominal=120.0)
A1, A2, A3, A4, A5, A6 = (rotary(f"A{k}", f"turn {k}") for k in range(1, 7))
P1, P2, P3 = (linear(f"P{k}", f"slide {k}") for k in range(1, 4))
FULL = Task("xyz", Turning.FULL)
WRIST = branch("wrist", sin(A5), first=+1, second=-1)
ZYZ = Rz(A4) * Ry(A5) * Rz(A6)


def arm(**stated: object) -> Mechanism:
    common = {"parameters": (L1, L2, ASIDE, TIP, RISE), "task": FULL, "offset_interface": False}
    return described(**{**common, **stated})


def telescope() -> Mechanism:
    """A Stanford arm: a telescope that is turned about two axes."""
    chain = Tz(RISE) * Rz(A1) * Ry(A2) * Ty(ASIDE) * Tz(P1) * ZYZ * Tz(TIP)
    shoulder = branch("shoulder", sin(A2), right=+1, left=-1)
    return arm(joints=(A1, A2, P1, A4, A5, A6), chain=chain, branches=(shoulder, WRIST), positive=(P1.symbol,))


def puma() -> Mechanism:
    """A PUMA 560 by its table."""
    table = denavit_hartenberg(
        (A1, 0, 0, -pi / 2),
        (A2, 0, L1, 0),
        (A3, ASIDE, RISE, pi / 2),
        (A4, L2, 0, -pi / 2),
        (A5, 0, 0, pi / 2),
        (A6, TIP, 0, 0),
    )
    forward = L1 * cos(A2) + RISE * cos(A2 + A3) + L2 * sin(A2 + A3)
    elbow = branch("elbow", L2 * cos(A3) - RISE * sin(A3), up=+1, down=-1)
    return arm(
        joints=(A1, A2, A3, A4, A5, A6),
        chain=table,
        branches=(branch("shoulder", forward, right=+1, left=-1), elbow, WRIST),
    )


def scara_with_a_wrist() -> Mechanism:
    """A SCARA whose quill carries three axes that meet."""
    chain = Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2) * Tz(P1) * ZYZ * Tz(TIP)
    return arm(
        joints=(A1, A2, P1, A4, A5, A6), chain=chain, branches=(branch("elbow", sin(A2), right=+1, left=-1), WRIST)
    )


def gantry_with_a_wrist() -> Mechanism:
    """Three slides and three axes, the tip beside the last."""
    chain = Tx(P1) * Ty(P2) * Tz(P3) * ZYZ * Txyz(ASIDE, 0, TIP)
    return arm(joints=(P1, P2, P3, A4, A5, A6), chain=chain, branches=(WRIST,))


def cylindrical() -> Mechanism:
    """A column that turns, lifts and reaches out: no second way to reach."""
    chain = Rz(A1) * Tz(P1) * Tx(P2) * Rx(A4) * Ry(A5) * Rx(A6) * Tx(TIP)
    return arm(joints=(A1, P1, P2, A4, A5, A6), chain=chain, branches=(WRIST,), positive=(P2.symbol,))


def three_parallel() -> Mechanism:
    """Three parallel axes in other directions than a collaborative arm has them."""
    chain = (
        Rz(A1) * Ty(ASIDE) * Ry(A2) * Tx(L1) * Ry(A3) * Tx(L2) * Ry(A4) * Tz(RISE) * Rz(A5) * Ty(TIP) * Ry(A6) * Ty(TIP)
    )
    forward = L1 * cos(A2) + L2 * cos(A2 + A3) + RISE * sin(A2 + A3 + A4)
    branches = (branch("shoulder", forward, right=+1, left=-1), branch("elbow", sin(A3), up=+1, down=-1), WRIST)
    return arm(joints=(A1, A2, A3, A4, A5, A6), chain=chain, branches=branches)


def milling_head() -> Mechanism:
    """Five axes of a milling machine: a head that turns and tilts, whose tool's direction is followed."""
    chain = Tx(P1) * Ty(P2) * Tz(P3) * Rz(A4) * Tx(ASIDE) * Rx(A5) * Tz(TIP)
    return arm(joints=(P1, P2, P3, A4, A5), chain=chain, branches=(WRIST,), task=Task("xyz", Turning.DIRECTION))


def crooked() -> Mechanism:
    """An arm on an oblique base, with a crooked forearm and an oblique flange: twice turned by what is fixed at either
    end.
    """
    base, flange = Ry(pi / 4) * Rx(pi / 6), Ry(pi / 6) * Rz(pi / 5) * Tx(ASIDE)
    front = Rz(A1) * Tz(RISE) * Ry(A2) * Tx(L1) * Ry(A3) * Tx(L2) * Rz(pi / 7)
    branches = (
        branch("shoulder", L1 * cos(A2) + L2 * cos(A2 + A3), right=+1, left=-1),
        branch("elbow", sin(A3), up=+1, down=-1),
        WRIST,
    )
    chain = base * front * Rx(A4) * Ry(A5) * Rx(A6) * Tx(TIP) * flange
    return arm(joints=(A1, A2, A3, A4, A5, A6), chain=chain, branches=branches)


def round_shoulder() -> Mechanism:
    """The first three axes meet, the last do not: an arm as it is seen from its flange."""
    chain = Tz(RISE) * Rz(A1) * Ry(A2) * Rz(A3) * Tz(L1) * Ry(A4) * Tz(L2) * Ry(A5) * Tx(ASIDE) * Rz(A6) * Tz(TIP)
    branches = (
        branch("shoulder", sin(A2), right=+1, left=-1),
        branch("elbow", sin(A4), up=+1, down=-1),
        branch("flange", L1 * sin(A4 + A5) + L2 * sin(A5) - ASIDE, front=+1, back=-1),
    )
    return arm(joints=(A1, A2, A3, A4, A5, A6), chain=chain, branches=branches)


def hand_of_three() -> Mechanism:
    """Three parallel axes behind a shoulder, and one more: a collaborative arm as it is seen from its flange."""
    chain = Rz(A1) * Ry(A2) * Tz(RISE) * Rx(A3) * Tz(L1) * Rx(A4) * Tz(L2) * Rx(A5) * Tx(ASIDE) * Rz(A6) * Tz(TIP)
    branches = (
        branch("flange", RISE * sin(A3 + A4 + A5) + L1 * sin(A4 + A5) + L2 * sin(A5), front=+1, back=-1),
        branch("shoulder", cos(A2), right=+1, left=-1),
        branch("elbow", sin(A4), up=+1, down=-1),
    )
    return arm(joints=(A1, A2, A3, A4, A5, A6), chain=chain, branches=branches)


def yawing_elbow() -> Mechanism:
    """A shoulder that leans and an elbow that yaws: the distance alone leaves the elbow, the sum of three squares."""
    chain = Rz(A1) * Tz(RISE) * Ry(A2) * Tx(L1) * Rz(A3) * Tx(L2) * Rx(A4) * Ry(A5) * Rx(A6) * Tx(TIP)
    branches = (branch("shoulder", cos(A2), right=+1, left=-1), branch("elbow", sin(A3), up=+1, down=-1), WRIST)
    return arm(joints=(A1, A2, A3, A4, A5, A6), chain=chain, branches=branches)


def tilting_quill() -> Mechanism:
    """A SCARA whose quill carries a tilt beside it: the point is named twice on the way to the elbow."""
    chain = Tz(P1) * Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2) * Rz(A4) * Tx(ASIDE) * Ry(A5) * Tx(RISE) * Rx(A6) * Tx(TIP)
    branches = (branch("elbow", sin(A2), right=+1, left=-1), branch("tilt", cos(A5), first=+1, second=-1))
    return arm(joints=(P1, A1, A2, A4, A5, A6), chain=chain, branches=branches)


def leaning_boom() -> Mechanism:
    """A boom that leans on a column: its reach is a share of its length, and as positive."""
    chain = Rz(A1) * Tz(P1) * Ry(pi / 6) * Tx(P2) * ZYZ * Tz(TIP)
    return arm(joints=(A1, P1, P2, A4, A5, A6), chain=chain, branches=(WRIST,), positive=(P2.symbol,))


def skew_slides() -> Mechanism:
    """Slides that are not square to each other, by angles whose sines are no surds."""
    chain = Rz(pi / 6) * Tx(P1) * Rz(pi / 7) * Ty(P2) * Rx(pi / 5) * Tz(P3) * ZYZ * Tz(TIP)
    return arm(joints=(P1, P2, P3, A4, A5, A6), chain=chain, branches=(WRIST,))


def position_alone() -> Mechanism:
    """Three turns that carry something else: with the point off the flange as well."""
    chain = Rz(A1) * Tx(ASIDE) * Tz(RISE) * Rx(A2) * Ty(L1) * Rx(A3) * Ty(L2)
    branches = (
        branch("shoulder", L1 * cos(A2) + L2 * cos(A2 + A3), right=+1, left=-1),
        branch("elbow", sin(A3), up=+1, down=-1),
    )
    return arm(joints=(A1, A2, A3), chain=chain, branches=branches, task=Task("xyz"), offset_interface=True)


ARMS: dict[Callable[[], Mechanism], int] = {
    telescope: 4, puma: 8, scara_with_a_wrist: 4, gantry_with_a_wrist: 2, cylindrical: 2, three_parallel: 8,
    milling_head: 2, crooked: 8, round_shoulder: 8, hand_of_three: 8, yawing_elbow: 8, tilting_quill: 4,
    leaning_boom: 2, skew_slides: 2, position_alone: 4,
}  # fmt: skip
"""Every arm, and how many solutions a pose has."""


@pytest.mark.parametrize("make", ARMS, ids=lambda f: f.__name__)
def test_an_arm_in_space(make: Callable[[], Mechanism]) -> None:
    mechanism = make()
    evidence = witness(build(mechanism), mechanism)
    assert evidence.inverted is not None
    assert evidence.inverted.solutions == ARMS[make]
    assert max(evidence.closure_residual, evidence.inverted.round_trip, evidence.inverted.jacobian) <= 1e-10
