"""Pairs of singular factors close to zero, at every decade of distance: no pose is lost, and every answer is right."""

import numpy as np
import pytest
import softkin
from softkin import Status

from derive.description.mechanism import Mechanism
from tests.catalogue.cornered import APART, CANDIDATES, KR6_D3, PAIRED, SPECIAL, places, poses
from tests.catalogue.corners import factor_program
from tests.catalogue.references import held_at
from tests.catalogue.robots import UR5
from tests.catalogue.shares import share

pytestmark = pytest.mark.slow

UR5_IN_METRES = {"d1": 0.089159, "a2": -0.425, "a3": -0.39225, "d4": 0.10915, "d5": 0.09465, "d6": 0.0823}
BOUND = 1e-11
"""Of what is missed: two free angles at their thresholds of 2e-12, either of them a chord of 2, and rounding."""


@pytest.fixture(params=PAIRED, ids=lambda m: m.name)
def paired(request: pytest.FixtureRequest) -> Mechanism:
    """A mechanism with two factors or more."""
    chosen: Mechanism = request.param
    return chosen


@pytest.mark.parametrize("candidate", CANDIDATES, ids=lambda m: m.name)
def test_every_mechanism_with_pairs_is_here(candidate: Mechanism) -> None:
    assert (candidate in PAIRED) == (len(factor_program(candidate).outputs) > 1)


def test_corners_are_found(paired: Mechanism) -> None:
    """Every factor takes part in one, but where the machine cannot be there."""
    names = {name for _, corner in places(paired) for name in corner.names}
    assert bool(names) == (paired.name not in APART)
    if paired.name in SPECIAL:
        assert names == {o.name for o in factor_program(paired).outputs}


def test_no_pose_is_lost(paired: Mechanism) -> None:
    rng = np.random.default_rng(8)
    for one in {one: None for one, _ in places(paired)}:
        everywhere = np.concatenate([poses(one, corner) for own, corner in places(paired) if own is one])
        axes = everywhere[share(len(everywhere))]
        robot = one.changed(check_limits=False)
        positions, rotations, own, _ = robot.forward_batch(axes)
        own[:, robot.BRANCHES :] = 0
        any_references = axes * (np.arange(len(axes)) % 3 == 0)[:, None]  # the pose, zero, and anywhere
        any_references[2::3] = rng.uniform(-180.0, 180.0, axes[2::3].shape)
        references = held_at(robot, axes, any_references)
        for configurations in (own, 0 * own):
            found, statuses = robot.inverse_batch(positions, rotations, configurations, references)
            lost = axes[statuses != Status.OK]
            assert len(lost) == 0, f"{one.label}: {len(lost)} of {len(axes)}, {lost[0].tolist()}"
            assert one.miss(found, positions, rotations).max() < BOUND
        every, statuses = robot.inverse_all_batch(positions, rotations, references)
        answered = statuses == Status.OK
        assert answered.any(axis=1).all()
        pose = np.nonzero(answered)[0]
        assert one.miss(every[answered], positions[pose], rotations[pose]).max() < BOUND


def test_one_pose_at_a_time(paired: Mechanism) -> None:
    """Where two singularities coincide single calls reach every pose, from its own reference and from another one."""
    for one, corner in places(paired):
        robot = one.changed(check_limits=False)
        axes = poses(one, corner)[::61]
        for row, reference in zip(axes.tolist(), (0.5 * axes).tolist(), strict=True):
            frame, own = robot.forward(row)
            position, rotation = np.array([frame.position]), np.array([frame.rotation])
            branches = own[: robot.BRANCHES]
            opened = (0,) * (len(own) - robot.BRANCHES)
            for near in (row, held_at(robot, row, reference)):
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


@pytest.mark.parametrize(
    "axes",
    [
        (-116.09886093434964, -95.13322290635698, 0.0, -34.28513162476884, 5.729577951313962e-10, -110.67049431370661),
        (95.82707261452202, 95.13117670236709, 0.005729577951308232, -145.7288344062594, 5.729577951308238e-10)
        + (-136.40429986496184,),
    ],
)
def test_three_at_once_at_the_threshold_of_a_free_angle(axes: tuple[float, ...]) -> None:
    """sin A5 is the threshold to all digits, and A6 free for one step and known for the next: a UR5 in metres."""
    robot = softkin.Ac6ThreeParallel(**UR5_IN_METRES)
    frame, own = robot.forward(axes)
    for configuration in (own, None):
        for reference in (axes, (0.0,) * 6):
            again, _ = robot.forward(robot.inverse(frame, configuration, reference))
            assert np.abs(np.subtract(again.position, frame.position)).max() < BOUND
            assert np.abs(np.subtract(again.rotation, frame.rotation)).max() < BOUND


@pytest.mark.parametrize("beyond", [1e-7, 1e-6, 1e-4])
def test_what_is_beyond_rounding_is_refused(beyond: float) -> None:
    """Both singularities at once, and the wrist moved outwards along the stretched arm."""
    robot = softkin.ArticulatedRobot6DOF(**KR6_D3)
    axes = (110.0, 1.6345249003522546, 85.23635830927383, -70.0, -30.0, 100.0)
    (position, rotation), _ = robot.forward(axes)
    shoulder = np.array([0.0, 0.0, KR6_D3["d1"]])
    wrist = np.array(position) - KR6_D3["d6"] * np.array(rotation)[:, 2]
    arm = wrist - shoulder
    moved = np.array(position) + beyond * 1000.0 * np.array([0.0, 0.0, arm[2]]) / abs(arm[2])
    for slot in robot.inverse_all((moved, rotation), axes):
        assert slot.status is Status.UNREACHABLE


def test_where_every_first_axis_gives_the_same_wrist_it_stays() -> None:
    """Two links and nothing else, the wrist on axis 1: what the later angle asks of A1 vanishes."""
    robot = softkin.Ac6ThreeParallel(a2=-0.425, a3=-0.39225)
    axes = (
        -64.96055854774626, 90.0, -8.103500366233181e-25, -151.87194789911305, 179.99999999999997, 68.04331838698822,
    )  # fmt: skip
    reference = (
        -156.53950058712866, -24.24029420008918, 89.1797330998652, -165.0526600834, -69.0371358284223,
        61.031977805744,
    )  # fmt: skip
    frame, _ = robot.forward(axes)
    for slot in robot.inverse_all(frame, reference):
        assert slot.axes is not None
        again, _ = robot.forward(slot.axes)
        assert np.abs(np.subtract(again.rotation, frame.rotation)).max() < BOUND
        assert np.abs(np.subtract(again.position, frame.position)).max() < BOUND


@pytest.mark.parametrize("reference", [0.0, 33.0, -120.0, 179.0])
def test_the_first_axis_is_found_that_reaches(reference: float) -> None:
    """Nothing shifts the arm, and the wrist is on axis 1: A1 is free, but with most of its values the elbow is too
    short.
    """
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
