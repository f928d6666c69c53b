"""The amounts of Diagnose, against geometry without an inverse. Other tests compare both languages."""

import re

import numpy as np
import pytest
import softkin
import sympy as sp
from softkin import Diagnosis, KinematicsError, Status

from derive.description.mechanism import Mechanism, Rod, X, Y, Z
from derive.ir.constants import DEGREE
from tests.catalogue.references import held_at
from tests.mechanisms import catalogue, has_struts
from tests.text.samples import NO_TURN

LEGS = tuple(
    m
    for _, m in catalogue()
    if m.rods and not m.home and not has_struts(m)
    if all(sum(r.equation.has(j.symbol) for j in m.joints) == 1 for r in m.rods)
)
"""Loops whose every rod hangs on one joint: what is missing of the rod is missing whatever the other legs do."""
ARMS = {
    "Kin_Scara2_Z": "arm_length_2",
    "Kin_Scara3_CCZ": "link_length_2",
    "Kin_Scara4_ZCcoupled_Type1": "link_length_2",
    "Kin_SCCC": "link_length_2",
    "Kin_PCC": "link_length_2",
    "Kin_Pos_RRR": "a2",
    "Kin_ArticulatedRobot_6DOF": "a2",
    "Kin_Ac6_ThreeParallel": "a2",
    "Kin_Ac6_RZRYRYRXRYRZ_J6Offset": "a2",
}
"""Arms with an elbow, and the length of a link before or behind it."""


def nominal(mechanism: Mechanism, **changes: float) -> softkin.Mechanism:
    return softkin.catalogue()[mechanism.name](**{p.name: p.nominal for p in mechanism.parameters} | changes)


def said(robot: softkin.Mechanism, position: tuple[float, ...], rotation: object = NO_TURN) -> Diagnosis:
    """What is said of a position on the default branches, which the inverse refuses for the same reason."""
    near = held_at(robot, [0.0] * len(robot.AXES))
    found = robot.diagnose((position, rotation), None, near)
    try:
        robot.inverse((position, rotation), None, near)
    except KinematicsError as error:
        assert error.status == found.status
    else:
        assert found.status is Status.OK
    return found


@pytest.mark.long
@pytest.mark.parametrize("mechanism", LEGS, ids=lambda m: m.name)
def test_a_rod_would_have_to_be_so_much_longer_or_shorter(mechanism: Mechanism) -> None:
    robot = nominal(mechanism)
    rng = np.random.default_rng(3)
    size = sum(abs(p.nominal) for p in mechanism.parameters if p.unit == "u")
    legs = set()
    for _ in range(80):
        position = (
            rng.uniform(0.1, 1.0)
            * rng.uniform(-size, size, 3)
            * ["xyz"[k] in mechanism.task.position for k in range(3)]
        )
        found = said(robot, tuple(position.tolist()))
        if "reach" in found.reason:
            rod = _rod_of(mechanism, found.reason)
            legs.add(rod.name)
            assert found.missing == pytest.approx(_short(mechanism, rod, position), rel=1e-6, abs=1e-6 * size)
            assert found.missing > 0.0
    assert len(legs) >= 2


def _rod_of(mechanism: Mechanism, reason: str) -> Rod:
    """`A2: out of reach [u]`, `rod 2 cannot reach [u]`: the rod on that joint, or of that name."""
    assert reason.endswith(" [u]"), reason
    axis = re.match(r"(\w+): out of reach", reason)
    if axis is None:
        return next(r for r in mechanism.rods if reason.startswith(f"rod {r.name} "))
    (symbol,) = (j.symbol for j in mechanism.joints if j.name == axis[1])
    return next(r for r in mechanism.rods if r.equation.has(symbol))


def _short(mechanism: Mechanism, rod: Rod, position: np.ndarray) -> float:
    """How near the distance of the rod's ends comes to its length, whatever its joint does."""
    (joint,) = (j for j in mechanism.joints if rod.equation.has(j.symbol))
    given = {p.symbol: p.nominal for p in mechanism.parameters} | {DEGREE: np.pi / 180.0}
    given |= dict(zip((X.symbol, Y.symbol, Z.symbol), position.tolist(), strict=True))
    length = float(rod.length.subs(given))
    square = sp.lambdify(joint.symbol, (rod.equation + rod.length**2).subs(given))
    low, high = (-np.pi, np.pi) if joint.is_angle else (-1e5, 1e5)
    for _ in range(4):  # a grid around the best of a grid
        values = np.linspace(low, high, 2001)
        apart = np.abs(np.sqrt(np.broadcast_to(square(values), values.shape)) - length)
        best = values[np.argmin(apart)]
        low, high = best - (high - low) / 1000.0, best + (high - low) / 1000.0
    return float(apart.min())


@pytest.mark.parametrize("name", ARMS)
def test_an_arm_would_have_to_be_so_much_longer(name: str) -> None:
    """With a link that is so much longer the pose is on the boundary of the workspace."""
    mechanism = next(m for _, m in catalogue() if m.name == name)
    spherical = {"j6_offset_x": 0.0} if mechanism.search else {}
    robot, link = nominal(mechanism, **spherical), ARMS[name]
    (position, rotation), _ = robot.forward(tuple(20.0 if j.is_angle else 10.0 for j in mechanism.joints))
    places = (tuple((np.array(position) * [out, out, 1.0]).tolist()) for out in (1.4, 1.7, 2.5))
    far, found = next((p, f) for p in places if (f := said(robot, p, rotation)).status is not Status.OK)
    assert found.reason.endswith(": out of reach [u]") and found.missing > 0.0
    for share, reached in ((1.001, True), (0.999, False)):
        length = robot.parameters[link]
        longer = nominal(mechanism, **spherical, **{link: length + np.sign(length) * share * found.missing})
        assert (said(longer, far, rotation).status is Status.OK) == reached, name


@pytest.mark.parametrize("name", ["Kin_Tripod_Linear", "Kin_Tripod_Rotary"])
def test_a_ball_joint_that_swings_too_far(name: str) -> None:
    """Rod 1 moves in the plane of x and z: its swing is the angle whose sine is y over its length."""
    mechanism = next(m for _, m in catalogue() if m.name == name)
    robot = nominal(mechanism, max_angle_ball_joint=3.0)
    rod = robot.parameters["arm_length" if name == "Kin_Tripod_Linear" else "arm_length_2"]
    (position, _), configuration = robot.forward(tuple(j.nominal for j in mechanism.joints))
    aside = (position[0], rod * np.sin(np.radians(4.25)), position[2])
    found = robot.diagnose((aside, NO_TURN), configuration)
    assert found.reason == "ball joint of rod 1: beyond its largest angle [deg]"
    assert found.missing == pytest.approx(1.25, rel=1e-6)


def test_the_joint_along_which_is_searched() -> None:
    """A root search without a root names the joint that was searched."""
    robot = nominal(next(m for _, m in catalogue() if m.search is not None), j6_offset_x=40.0)
    found = said(robot, (3000.0, 0.0, 500.0))
    assert found == (Status.UNREACHABLE, "A6: the search along it finds no root of this branch", 0.0, 0, 0.0)
