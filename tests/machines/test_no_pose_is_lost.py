"""Where singularities meet no pose is lost and every answer meets its pose, in both languages.

There an elbow that is nearly straight folds the arm that another joint turns; a root has half of its digits. A wrist is
told by few entries of the rotation, which near one have lost the digits of its angles. An angle that the pose leaves
free moves to where the later joints have solutions, however far the reference is.
"""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from softkin import Frame, Status

from tests.catalogue.closure import Closure
from tests.machines.both import inverse_in_both
from tests.machines.chain_machines import WRIST_BEYOND_QUARTIC
from tests.machines.collection import COSTLY, MACHINES
from tests.machines.free_machines import FREED
from tests.machines.grid import corners, every_pose_is_met, grid
from tests.machines.made import Array, Made, made
from tests.machines.parallel_machines import METRES, PARALLEL
from tests.machines.spoken import answered

EVERY_TWENTIETH = 20
STRETCHED = ("seven axes", "arm in metres with a held turn of its upper arm")
SMALL = (0.0, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3)
ALONE = {
    "arm whose first axes are parallel, with a polar radius as long as a link": (
        180.0, -90.0, -90.0, 89.99999999256325, -90.0, 6.370457883843592e-06,
    ),
    "arm with three parallel axes, in one plane": (
        89.99982319804025, -180.0000686302135, -4.524475368456007e-05,
        5.311361262737903e-06, 179.99985037604125, 180.00007583435203,
    ),
}  # fmt: skip
"""Joints (degrees). The first: the wrist is 1.3e-10 off an axis, and an arm of length zero has no direction.

The second: the wrist is next to axis 1, axis 6 nearly parallel to axis 4, and the elbow stretched; there the first
order leads half of the way to the only solution.
"""


def solved(machine: Made) -> Array:
    """Which joints are not held: 1, the others 0."""
    return np.array([float(j not in machine.mechanism.held_joints) for j in machine.mechanism.joints])


@pytest.mark.slow(*COSTLY, *PARALLEL)
@pytest.mark.parametrize("name", [*MACHINES, *PARALLEL])
def test_next_to_right_angles(name: str) -> None:
    """As a batch every pose is met, of a search, which takes long, each fifth; one by one, in all solutions, so is each
    twentieth.
    """
    machine, within = made(name), 1e-10 if name in PARALLEL else 1e-9
    axes = corners(machine)[:: 5 if machine.is_searched else 1]
    every_pose_is_met(machine, axes, axes, within)
    for row in axes[::EVERY_TWENTIETH]:
        position, rotation = machine.closure.poses(row[None])
        frame = Frame(tuple(position[0]), tuple(map(tuple, rotation[0])))
        answers = [s.axes for s in machine.robot.inverse_all(frame, row) if s.axes is not None]
        assert answers
        poses = np.repeat(position, len(answers), axis=0), np.repeat(rotation, len(answers), axis=0)
        assert machine.error(np.array(answers), *poses).max() <= within


@pytest.mark.slow
@pytest.mark.parametrize("name", ALONE)
def test_where_three_singularities_meet(name: str) -> None:
    machine = made(name)
    axes = np.array([ALONE[name]]) + machine.closure.offsets
    every_pose_is_met(machine, axes, axes, 1e-10)


IN_PLANE = (
    (90.0, -180.0, -180.0, 1e-12, 179.999999, 90.0), (-98.7119860657112, 180.0, 0.0, 180.0, -179.99999999999, 1e-5),
    (90.0, 180.0, 0.0, -180.0, 1e-3, 0.0), (89.9999999999, 1e-8, -1e-9, -180.0, 180.0001, 0.0),
    (90.000000001, -179.999999999, 0.0, 180.0, -1e-11, -90.0), (90.0, 0.0, -180.0, 179.9999999999, 0.01, 0.0),
    (89.999999999999, 0.0, 180.00001, 180.0, 180.0, 180.0), (-1e-11, 180.0, 180.0, 180.0, -180.0, 180.0001),
)  # fmt: skip
STRAIGHT = (
    (90.0, -89.9999, 1e-5, 1e-11, 179.999999999999, -37.984772097317), (-90.001, 180.0, 0.0, 0.0, 1e-5, -89.9),
    (90.0000000001, -89.99999999999, 1e-6, -1e-9, -180.0, 180.0), (180.0, -0.1, 0.1, 0.0, 0.0, 180.0),
    (0.0, -180.0, 0.0, 0.0, -179.999999999999, 90.000000000001), (90.0, -90.0, 0.0, 1e-12, 180.0, 180.0),
)  # fmt: skip
AT_ZERO = {"its own links": ({}, IN_PLANE), "equal links": ({p.name: 0.3 for p in METRES}, STRAIGHT)}
"""Joints (degrees), asked from zero. The first: the wrist is on axis 1, or axis 6 along axis 4, and the pose is met
next to one value of a free axis alone, where another one is free, too. The second: with equal links the whole arm is
straight, and steps change its reach by so little that a pivot was taken for zero.
"""


@pytest.mark.slow
@pytest.mark.parametrize("links", AT_ZERO)
def test_three_parallel_axes_in_one_plane_from_zero(links: str) -> None:
    machine = made("arm with three parallel axes, in one plane")
    given, joints = AT_ZERO[links]
    robot = type(machine.robot)(**{**machine.robot.parameters, **given})
    machine = replace(machine, robot=robot, closure=Closure(machine.mechanism, robot.parameters))
    axes = np.array(joints) + machine.closure.offsets
    positions, rotations, configurations, _ = robot.forward_batch(axes)
    found, statuses = robot.inverse_batch(positions, rotations, configurations, machine.closure.offsets)
    assert (statuses == Status.OK).all()
    assert machine.error(found, *machine.closure.poses(axes)).max() <= 1e-11


@pytest.mark.parametrize("name", ["slide that a head points, beside its axis"])
def test_no_slide_goes_further_than_an_input_may(name: str) -> None:
    """A tool that is nearly along the slide meets its pose at a second root, which may be 1e11 away."""
    machine = made(name)
    joints = np.array([(0.3, -90.000000001, 89.99999999999, -179.999999999999, -0.4),
                       (-0.2, 90.0000000001, -90.000000001, 89.999999999999, -0.3),
                       (-0.4, 89.999999999, -89.9999999999, -179.99999, -0.5)])  # fmt: skip
    axes = machine.axes(joints)
    positions, rotations, configurations, _ = machine.robot.forward_batch(axes)
    near = machine.closure.offsets + np.where(machine.closure.angles, (0.0, 170.0, 153.0, 483.0, 0.0), 0.0)
    for reference in (machine.closure.offsets, near):
        row = np.repeat(reference[None], len(axes), axis=0)
        found, statuses = machine.robot.inverse_batch(positions, rotations, configurations, row)
        assert (statuses == Status.OK).all() and np.abs(found).max() <= 1e9


def nearly_stretched(machine: Made) -> Array:
    """Axes whose second and third joints are nearly zero, or half a turn; the arm beside and in line."""
    shoulder, side = (*SMALL, 180.0), (0.0, 37.0, 90.0, -90.0)
    rows = [(20.0, a2, e1, a3, 50.0, 40.0, -10.0) for a2, e1, a3 in product(shoulder, side, SMALL)]
    return machine.axes(np.array(rows)[:, : len(machine.mechanism.joints)])


@pytest.mark.parametrize("name", STRETCHED)
@pytest.mark.parametrize("away", (0.0, 140.0))
def test_an_arm_held_at_an_angle_nearly_stretched_above_its_first_axis(name: str, away: float) -> None:
    """The distance from the first axis is as small as what the elbow, which has half of its digits, leaves open."""
    machine = made(name)
    axes = nearly_stretched(machine)
    every_pose_is_met(machine, axes, axes + away * solved(machine), 1e-10)


def test_the_block_meets_the_pose_of_an_arm_nearly_stretched() -> None:
    machine = made(STRETCHED[1])
    axes = nearly_stretched(machine)[::2]
    positions, rotations = machine.closure.poses(axes)
    assert machine.error(answered(None, machine, machine.robot, axes, axes), positions, rotations).max() <= 1e-10


@pytest.mark.parametrize("bend", [0.0, 1e-9, 1e-7, 1e-6, 1e-5, 1e-3])
def test_an_arm_nearly_stretched_keeps_its_rotation(bend: float) -> None:
    """Two folds at once: A1 may be free, and the rotation is met all the same, the position to a root of rounding."""
    machine = made(STRETCHED[0])
    places = {joint.name: place for place, joint in enumerate(machine.mechanism.joints)}
    joints = np.random.default_rng(3).uniform(-120.0, 120.0, (300, len(places)))
    joints[:, places["A3"]] = bend
    joints[:, places["A2"]] = np.tile([0.0, 180.0, 1e-9, 1e-7, 180.0 - 1e-6, 1e-4], 50)
    joints[:, places["E1"]] = np.tile([90.0, -90.0, 0.0, 37.0, 90.0], 60)
    axes = machine.axes(joints)
    positions, rotations = machine.closure.poses(axes)
    references = axes + solved(machine) * 80.0 * np.sign(joints)
    slots, statuses = machine.robot.inverse_all_batch(positions, rotations, references)
    assert (statuses == Status.OK).any(axis=1).all()
    for slot in range(slots.shape[1]):
        rows = statuses[:, slot] == Status.OK
        found = machine.closure.joints(slots[rows, slot])
        residual = np.abs(machine.closure.equations(found, positions[rows], rotations[rows]))
        assert residual[:, 3:].max(initial=0.0) <= 1e-12
        assert residual[:, :3].max(initial=0.0) <= 3e-8 * machine.reach


@pytest.mark.slow
@pytest.mark.parametrize("name", WRIST_BEYOND_QUARTIC)
@pytest.mark.parametrize("turn", [0.0, 180.0])
def test_a_straight_wrist_stands_still(name: str, turn: float) -> None:
    """Of an arm whose position is searched: A4 and A6 keep their reference, in both languages."""
    machine, rng = made(name), np.random.default_rng(3)
    joints = rng.uniform(-170.0, 170.0, (60, 6))
    joints[:, 4] = turn
    axes = machine.axes(joints)
    regular = np.linalg.svd(np.array([machine.robot.jacobian(row) for row in axes.tolist()])[:, :3, :3])[1].min(axis=1)
    axes = axes[regular > 0.05 * machine.reach]
    assert len(axes) > 30
    positions, rotations, configurations, _ = machine.robot.forward_batch(axes)
    back, statuses = machine.robot.inverse_batch(positions, rotations, configurations, axes)
    assert (statuses == Status.OK).all() and np.abs(back - axes).max() <= 1e-6
    assert np.abs(answered(None, machine, machine.robot, axes, axes) - axes).max() <= 1e-6


def far_from(machine: Made, axes: Array) -> Array:
    rng = np.random.default_rng(9)
    sizes = np.where(machine.closure.angles, 170.0, 0.5 * machine.reach)
    return np.asarray(axes + rng.uniform(-1.0, 1.0, axes.shape) * sizes)


@pytest.mark.slow
@pytest.mark.parametrize("name", FREED)
def test_from_a_far_reference_where_an_angle_is_free(name: str) -> None:
    """Nor where the free angle is near its threshold: half of its digits are then in the pose."""
    machine = made(name)
    assert machine.built.evidence is not None and machine.built.evidence.inverted is not None
    assert machine.built.evidence.inverted.solutions == 4
    axes = grid(machine)
    tiny = np.where(machine.closure.angles, 10.0 ** np.random.default_rng(1).uniform(-13.0, -3.0, axes.shape), 0.0)
    axes = np.concatenate([axes, axes[:300] + tiny[:300]])
    every_pose_is_met(machine, axes, far_from(machine, axes), 1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("name", FREED)
def test_the_block_moves_a_free_angle_to_the_same_place(name: str) -> None:
    machine = made(name)
    controller, robot = machine.controller(), machine.robot
    axes = grid(machine)[:300:4]
    references = far_from(machine, grid(machine))[:300:4]
    singular = 0
    for row, near in zip(axes.tolist(), references.tolist(), strict=True):
        frame, configuration = robot.forward(row)
        singular += 3 in configuration
        inverse_in_both(controller, robot, frame, near, 1e-7 * max(1.0, machine.reach))
    assert singular > 20
