"""Pairs of singular factors driven together, at every decade of distance: no pose is lost, and every answer is met."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache

import numpy as np
import pytest
import softkin
from softkin import Status

from derive.catalogue import catalogue
from derive.mechanism import Mechanism
from tests.mechanisms.closure import Array
from tests.mechanisms.corners import DISTANCES, Corner, can_be_at, corners, factor_program
from tests.mechanisms.loops import loop_machines_of
from tests.mechanisms.machines import Machine, bare_machine, machine, machines_of
from tests.mechanisms.robots import KR6_R900, PUMA_560, UR5

BOUND = 3e-11
"""Of what is missed: two free angles at their thresholds of 1e-11, either of them a chord of 2."""
PLACES = 3
"""Places of every combination of factors."""
KR6_D3 = {**KR6_R900, "d3": 40.0}
SPECIAL: dict[str, dict[str, Mapping[str, float]]] = {
    "Kin_Ac6_ThreeParallel": {
        "UR5": UR5,
        "no shift": {**UR5, "d4": 0.0},
        "equal links": {**UR5, "a3": UR5["a2"]},
        "equal links, no shift": {**UR5, "a3": UR5["a2"], "d4": 0.0},
    },
    "Kin_ArticulatedRobot_6DOF": {
        "KR6": KR6_R900,
        "KR6, shifted": KR6_D3,
        "PUMA": PUMA_560,
        "straight forearm": {**KR6_D3, "a3": 0.0},
        "equal links": {**KR6_D3, "a1": 0.0, "a3": 0.0, "a2": 420.0},
    },
    "Kin_Ac6_RZRYRYRXRYRZ_J6Offset": {
        "KR6": {**KR6_R900, "j6_offset_x": 0.0},
        "equal links": {**KR6_R900, "a1": 0.0, "a3": 0.0, "a2": 420.0, "j6_offset_x": 0.0},
    },
}
"""Dimensions that are sold, and those with which more vanishes at once."""
SPECIAL["Kin_Pos_RRR"] = {
    name: {k: v for k, v in given.items() if k != "d6"} for name, given in SPECIAL["Kin_ArticulatedRobot_6DOF"].items()
}
APART = {"Kin_P2X_Type1", "MC_KIN_TYPE_12_XY"}
"""Loops whose factors vanish together only where nothing controls the plate."""
PAIRED = tuple(m for _, m in catalogue() if not m.is_platform and not m.is_orientation and len(factor_program(m).outputs) > 1)


def robots(mechanism: Mechanism) -> Iterator[Machine]:
    """Machines of one mechanism."""
    if mechanism.rods:
        yield from loop_machines_of(mechanism)[1:3]
        return
    for name, given in SPECIAL.get(mechanism.name, {}).items():
        yield machine(mechanism, name, given)
    if mechanism.search is None:
        yield from machines_of(mechanism)[-1:]
        yield bare_machine(mechanism)


@cache
def places(mechanism: Mechanism) -> tuple[tuple[Machine, Corner], ...]:
    """Corners of two and of three factors."""
    rng = np.random.default_rng(5)
    return tuple((one, corner) for one in robots(mechanism) for of in (2, 3) for corner in corners(one, PLACES, rng, of=of))


def poses(one: Machine, corner: Corner) -> Array:
    """Axis values at every distance from a corner: one factor, all, one against the others, and any."""
    count, rng = len(corner.names), np.random.default_rng(7)
    ways = [*np.eye(count), np.ones(count), np.array([1.0, -1.0, 1.0])[:count]]
    axes = np.concatenate([corner.beside(d * way) for d in DISTANCES for way in (*ways, rng.uniform(-1.0, 1.0, count))])
    return axes[can_be_at(one, axes)]


@pytest.fixture(params=PAIRED, ids=lambda m: m.name)
def paired(request: pytest.FixtureRequest) -> Mechanism:
    """A mechanism with two factors or more."""
    chosen: Mechanism = request.param
    return chosen


def test_corners_are_found(paired: Mechanism) -> None:
    """Every factor takes part in one, but where the machine cannot be there."""
    names = {name for _, corner in places(paired) for name in corner.names}
    assert bool(names) == (paired.name not in APART)
    if paired.name in SPECIAL:
        assert names == {o.name for o in factor_program(paired).outputs}


def test_no_pose_is_lost(paired: Mechanism) -> None:
    rng = np.random.default_rng(8)
    for one, corner in places(paired):
        robot, axes = one.changed(check_limits=False), poses(one, corner)
        positions, rotations, own, _ = robot.forward_batch(axes)
        own[:, robot.BRANCHES :] = 0
        for references in (axes, 0.0 * axes, rng.uniform(-180.0, 180.0, axes.shape)):
            for configurations in (own, 0 * own):
                found, statuses = robot.inverse_batch(positions, rotations, configurations, references)
                lost = axes[statuses != Status.OK]
                assert len(lost) == 0, f"{one.label} {corner.names}: {len(lost)} of {len(axes)}, {lost[0].tolist()}"
                assert one.miss(found, positions, rotations).max() < BOUND
            every, statuses = robot.inverse_all_batch(positions, rotations, references)
            answered = statuses == Status.OK
            assert answered.any(axis=1).all()
            pose = np.nonzero(answered)[0]
            assert one.miss(every[answered], positions[pose], rotations[pose]).max() < BOUND


def test_one_pose_at_a_time(paired: Mechanism) -> None:
    for one, corner in places(paired):
        robot = one.changed(check_limits=False)
        axes = poses(one, corner)[::37]
        for row, reference in zip(axes.tolist(), (0.5 * axes).tolist(), strict=True):
            frame, own = robot.forward(row)
            position, rotation = np.array([frame.position]), np.array([frame.rotation])
            branches = own[: robot.BRANCHES]
            opened = (0,) * (len(own) - robot.BRANCHES)
            for near in (row, reference):
                for configuration in ((*branches, *opened), (0,) * len(own)):
                    found = np.array([robot.inverse(frame, configuration, near)])
                    assert one.miss(found, position, rotation)[0] < BOUND
                solved = [s.axes for s in robot.inverse_all(frame, near) if s.axes is not None]
                assert solved
                same = np.repeat(position, len(solved), axis=0), np.repeat(rotation, len(solved), axis=0)
                assert one.miss(np.array(solved), *same).max() < BOUND


def test_a_shoulder_and_an_elbow_at_once() -> None:
    """The shoulder's root is rounding, 5.4e-9 too long for the elbow that is stretched."""
    robot = softkin.ArticulatedRobot6DOF(**KR6_D3)
    axes = (110.0, 1.6345249003522546, 85.23635830927383, -70.0, -30.0, 100.0)
    frame, own = robot.forward(axes)
    for configuration in (own, None):
        again, _ = robot.forward(robot.inverse(frame, configuration, axes))
        assert np.abs(np.subtract(again.position, frame.position)).max() < 1e-12 * 1000.0
        assert np.abs(np.subtract(again.rotation, frame.rotation)).max() < 1e-12


@pytest.mark.parametrize("reference", [0.0, 33.0, -120.0, 179.0])
def test_the_first_axis_is_found_that_reaches(reference: float) -> None:
    """Nothing shifts the arm, and the wrist is on axis 1: A1 is free, but with most of its values the elbow is too short."""
    robot = softkin.Ac6ThreeParallel(**{**UR5, "d4": 0.0})
    rng = np.random.default_rng(9)
    refused_elsewhere = 0
    for _ in range(40):
        axes = rng.uniform(-170.0, 170.0, 6)
        axes[2] = 1e-3 * rng.uniform(-1.0, 1.0)
        fore = axes[1] + axes[2]
        forward = UR5["a2"] * np.cos(np.radians(axes[1])) + UR5["a3"] * np.cos(np.radians(fore))
        if abs(forward) > 0.9 * UR5["d5"]:
            axes[1] = 90.0 + rng.uniform(-4.0, 4.0)
            fore = axes[1] + axes[2]
            forward = UR5["a2"] * np.cos(np.radians(axes[1])) + UR5["a3"] * np.cos(np.radians(fore))
        axes[3] = np.degrees(np.arcsin(-forward / UR5["d5"])) - fore
        frame, _ = robot.forward(axes)
        found = robot.inverse(frame, None, (reference,) * 6)
        again, _ = robot.forward(found)
        assert np.abs(np.subtract(again.position, frame.position)).max() < BOUND * 1000.0
        assert np.abs(np.subtract(again.rotation, frame.rotation)).max() < BOUND
        refused_elsewhere += abs((found[0] - reference + 180.0) % 360.0 - 180.0) > 1.0
    assert refused_elsewhere > 10
