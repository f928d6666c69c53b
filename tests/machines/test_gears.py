"""Axes with gears, belts and differentials: their turns are those of the joints that they move."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status
from sympy import Rational

from derive.form.gears import in_other_joints, with_gears
from derive.frames import Rz, Tx, Tz
from derive.kinematics.build import build
from derive.witness import witness
from tests.catalogue.refusals import refusal
from tests.machines.made import Array, Made, made
from tests.machines.task_machines import A1, A2, DRIVEN, L1, WITH_GEARS, Z
from tests.mechanisms import catalogue
from tests.random_axes import random_axes
from tests.text.controller import OK

EVERY = pytest.mark.parametrize("name", DRIVEN)


def anywhere(machine: Made, count: int, turns: float = 4.0) -> Array:
    """Axis values over several turns."""
    rng, about = np.random.default_rng(6), machine.closure.offsets
    return random_axes(machine.robot, count, rng, 360.0 * turns, 0.9 * machine.reach, about)


def tolerance(machine: Made) -> Array:
    return np.where(machine.closure.angles, 1e-6, 1e-9 * machine.reach)


def bytes_of_turns(machine: Made) -> list[int]:
    return [i for i, byte in enumerate(machine.robot.CONFIGURATION) if byte.kind == "period"]


@EVERY
def test_the_numbers_of_the_turns_lead_back_to_the_axes_whatever_the_reference(name: str) -> None:
    """In both languages: a configuration with its turns names one pose of the axes, many turns away, too."""
    machine = made(name)
    controller, away = machine.controller(), np.random.default_rng(7)
    turning = [machine.robot.AXES[i].multi_turn for i in range(len(machine.robot.AXES))]
    for axes in anywhere(machine, 25):
        frame, configuration = machine.robot.forward(axes)
        reference = np.where(turning, away.uniform(-9000.0, 9000.0, len(axes)), axes)
        answer = machine.robot.inverse(frame, configuration, reference)
        assert (np.abs(answer - axes) <= tolerance(machine)).all()
        status, found = controller.inverse(frame.position, frame.rotation, configuration, reference.tolist())
        assert status == OK
        assert (np.abs(np.array(found[: len(axes)]) - axes) <= tolerance(machine)).all()
        _, answer_st = controller.forward(axes.tolist())
        assert answer_st[2][: len(configuration)] == tuple(byte % 256 for byte in configuration)


@EVERY
def test_without_a_number_every_joint_stays_on_the_turn_of_the_reference(name: str) -> None:
    """A small step from the reference is a small step of the axes."""
    machine = made(name)
    rng = np.random.default_rng(8)
    branches = machine.robot.BRANCHES
    for axes in anywhere(machine, 25):
        frame, configuration = machine.robot.forward(axes)
        near = axes + rng.uniform(-3.0, 3.0, len(axes))
        answer = machine.robot.inverse(
            frame, (*configuration[:branches], *(0,) * (len(configuration) - branches)), near
        )
        assert (np.abs(answer - axes) <= tolerance(machine)).all()


@EVERY
def test_one_number_more_is_the_next_pose_of_the_axis_and_no_pose_lies_between(name: str) -> None:
    """By the closure alone: along one axis, with those behind it following, the pose repeats first after one number."""
    machine = made(name)
    places, joints = bytes_of_turns(machine), machine.robot.PERIOD_AXES
    axes = anywhere(machine, 1, 0.1)[0]
    frame, configuration = machine.robot.forward(axes)
    for place, axis in zip(places, joints, strict=True):
        later = [p for p, i in zip(places, joints, strict=True) if i > axis]
        number = configuration[place]
        for step in (1, 2, -1):
            more = list(configuration)
            more[place] = number + step + (1 if number + step == 0 and step > 0 else -1 if number + step == 0 else 0)
            for other in later:
                more[other] = 0
            moved = np.array(machine.robot.inverse(frame, tuple(more), axes))
            residual = machine.error(moved[None], np.array([frame.position]), np.array([frame.rotation]))
            assert residual[0] <= 1e-9
            assert np.abs(moved - axes)[[i for i in range(axis) if i in joints]].max(initial=0.0) <= 1e-6
            assert abs(moved[axis] - axes[axis]) > 1.0
            if step == 1:
                assert_none_between(machine, axes, moved, axis)


def assert_none_between(machine: Made, axes: Array, moved: Array, axis: int) -> None:
    """No value between repeats the pose, whatever the axes behind it turn by and all others move by."""
    turning = machine.robot.PERIOD_AXES
    behind = [i for i in turning if i > axis]
    assert len(behind) <= 2
    positions, rotations = machine.closure.poses(axes[None])
    rows = [axes + np.eye(len(axes))[axis] * share * (moved[axis] - axes[axis]) for share in np.arange(1, 24) / 24.0]
    steps = [np.eye(len(axes))[behind].T @ np.array(c) for c in product(np.arange(-12, 13) * 60.0, repeat=len(behind))]
    tried = np.array([row + step for row in rows for step in steps])
    reached, turned = machine.closure.poses(tried)
    missing = reached - positions
    following = [np.eye(len(axes))[i] for i in range(len(axes)) if i not in turning]  # along straight lines
    if following:
        moves = np.stack([machine.closure.poses(tried + step)[0] - reached for step in following], axis=2)
        shares = np.linalg.pinv(moves) @ missing[:, :, None]
        missing = missing - (moves @ shares)[:, :, 0]
    apart = np.maximum(
        np.abs(turned - rotations).reshape(len(tried), -1).max(axis=1) if machine.closure.follows_rotation else 0.0,
        np.abs(missing).max(axis=1) / machine.reach,
    )
    assert apart.min() > 1e-3


@EVERY
def test_limits_over_several_turns_refuse_and_name_the_turn_inside(name: str) -> None:
    """With one value inside, it is taken; beyond both, the pose is refused."""
    machine = made(name)
    joints = machine.robot.PERIOD_AXES
    axes = anywhere(machine, 1, 1.2)[0]
    frame, configuration = machine.robot.forward(axes)
    branches = configuration[: machine.robot.BRANCHES]
    free = (*branches, *(0,) * len(joints))
    for axis in joints:
        key = machine.mechanism.joints[axis].key
        around = {f"lower_{key}": axes[axis] - 30.0, f"upper_{key}": axes[axis] + 30.0}
        limited = type(machine.robot)(**{**machine.robot.parameters, **around})
        earlier = [i for i in joints if i < axis]
        reference = axes.copy()
        reference[axis] += 3 * 360.0
        reference[earlier] = axes[earlier]
        if period_of(machine, axis) > 70.0:  # one value is inside: it is taken, wherever the reference is
            answer = limited.inverse(frame, free, reference)
            assert abs(answer[axis] - axes[axis]) <= 1e-6
        shifted = {f"lower_{key}": axes[axis] + 0.4, f"upper_{key}": axes[axis] + 0.6}
        closed = type(machine.robot)(**{**machine.robot.parameters, **shifted})
        assert refusal(closed.inverse, frame, free, axes) is Status.UNREACHABLE


def period_of(machine: Made, axis: int) -> float:
    """After how many degrees of an axis the pose repeats, those behind it following."""
    joint = with_gears(machine.mechanism).joints[axis]
    return 360.0 / abs(float(joint.ratio.subs({p.symbol: p.nominal for p in machine.mechanism.parameters})))


@pytest.mark.parametrize(
    ("name", "periods"),
    [
        ("SCARA with gears", [1080.0, 720.0]),
        ("SCARA with gears of any ratio", [1080.0, 144.0]),
        ("SCARA whose gears stand at its joints", [1080.0, 144.0]),
        ("SCARA whose quill is geared", [120.0, 360.0, 720.0]),
        ("CoreXY with C", [360.0]),
        ("head on a differential", [360.0, 720.0]),
        ("head on a differential without gears", [180.0, 360.0]),
        ("SCARA with a nut and a spline", [360.0, 360.0, 360.0]),
        ("wrist with three motors", [360.0, 720.0, 1080.0]),
        ("SCARA with belts", [360.0, 360.0, 360.0]),
        ("arm with its elbow motor on the base, and gears", [720.0, 1080.0, 1440.0]),
    ],
)
def test_the_periods_of_the_axes(name: str, periods: list[float]) -> None:
    machine = made(name)
    assert [period_of(machine, i) for i in machine.robot.PERIOD_AXES] == pytest.approx(periods)


@pytest.mark.parametrize("gear", [3.0, -3.0, 0.25, 1e-3, -250.0, 1.0])
def test_a_gear_of_any_size_and_sign(gear: float) -> None:
    machine = made("SCARA with gears of any ratio")
    robot = type(machine.robot)(**{**machine.robot.parameters, "gear_1": gear, "gear_2": -gear})
    controller = machine.controller()
    assert controller.initialise(robot.parameters) == OK
    rng = np.random.default_rng(4)
    for shares in rng.uniform(-3.0, 3.0, (10, 2)):
        axes = np.array([360.0 * shares[0] * gear - 20.0, 360.0 * shares[1] / gear, 12.0])
        frame, configuration = robot.forward(axes)
        by_hand = np.radians([(axes[0] + 20.0) / gear, -gear * (axes[1] + 13.0)])
        elbow = 300.0 * np.array([np.cos(by_hand[0]), np.sin(by_hand[0])])
        hand = elbow + 400.0 * np.array([np.cos(by_hand.sum()), np.sin(by_hand.sum())])
        assert np.allclose(frame.position[:2], hand, rtol=0.0, atol=1e-8)
        scale = np.array([max(1.0, abs(gear)), max(1.0, 1 / abs(gear)), 1.0])
        for reference in (axes, axes * 0.0, axes + 5e5):
            answer = robot.inverse(frame, configuration, reference)
            assert (np.abs(answer - axes) <= 1e-7 * scale).all()
            status, found = controller.inverse(frame.position, frame.rotation, configuration, reference.tolist())
            assert status == OK and (np.abs(np.array(found[:3]) - axes) <= 1e-7 * scale).all()


KINDS = {
    "SCARA with gears": "geared geared linear",
    "SCARA whose quill is geared": "rotary rotary linear geared",
    "CoreXY with C": "driving driving linear rotary",
    "beam on two racks": "driving geared linear",
    "head on a differential": "linear linear linear geared geared",
    "head on a differential without gears": "linear linear linear rotary rotary",
    "SCARA with a nut and a spline": "rotary rotary driving rotary",
    "SCARA with belts": "rotary rotary linear rotary",
}


@pytest.mark.parametrize("name", KINDS)
def test_axes_that_do_not_repeat_after_360_degrees_are_no_modulo_axes(name: str) -> None:
    """SoftMotion's modulo axes have a period of 360 degrees: all others are declared linear, like a quill."""
    expected = KINDS[name].split()
    assert [axis.kind for axis in made(name).robot.AXES] == expected
    declared = [made(name).controller().axis_properties(i)[0] for i in range(len(expected))]
    assert declared == ["Rotary" if kind == "rotary" else "Linear" for kind in expected]


@pytest.mark.parametrize("name", WITH_GEARS)
def test_the_limits_of_drives_choose_among_turns_of_the_joint(name: str) -> None:
    """A block to which drives hand over limits answers as Python does, to which these limits are given."""
    machine = made(name)
    rng = np.random.default_rng(12)
    answered = 0
    for axes in anywhere(machine, 40, 1.5):
        frame, configuration = machine.robot.forward(axes)
        free = (*configuration[: machine.robot.BRANCHES], *(0,) * len(machine.robot.PERIOD_AXES))
        controller, given = machine.controller(), dict(machine.robot.parameters)
        for i in machine.robot.PERIOD_AXES:
            width = period_of(machine, i) * float(rng.choice([0.3, 0.9, 1.1, 2.2]))
            low = float(axes[i] - width * rng.uniform(0.05, 0.95))
            assert controller.axis_settings(i, (low, low + width)) == OK
            key = machine.mechanism.joints[i].key
            given |= {f"lower_{key}": low, f"upper_{key}": low + width}
        reference = axes + rng.uniform(-700.0, 700.0, len(axes))
        status, found = controller.inverse(frame.position, frame.rotation, free, reference.tolist())
        try:
            expected = type(machine.robot)(**given).inverse(frame, free, reference)
        except KinematicsError:
            assert status != OK
            continue
        assert status == OK and (np.abs(np.array(found[: len(axes)]) - expected) <= tolerance(machine)).all()
        answered += 1
    assert answered >= 3


@pytest.mark.parametrize("name", DRIVEN)
def test_batches_write_the_same_numbers_of_turns(name: str) -> None:
    machine = made(name)
    axes = anywhere(machine, 40)
    _, _, configurations, statuses = machine.robot.forward_batch(axes)
    assert (statuses == Status.OK).all()
    single = [machine.robot.forward(row)[1] for row in axes]
    assert configurations.tolist() == [list(row) for row in single]
    positions, rotations, _, _ = machine.robot.forward_batch(axes)
    back, statuses = machine.robot.inverse_batch(positions, rotations, configurations, np.zeros_like(axes))
    assert (statuses == Status.OK).all() and (np.abs(back - axes) <= tolerance(machine)).all()


@pytest.mark.parametrize("gear", [3.0, -3.0, 0.4, -0.4])
def test_an_axis_on_the_edge_of_a_turn_stays_on_its_side(gear: float) -> None:
    """Half a turn of the joint is where one number ends: there, and by rounding beside it, the axes come back."""
    machine = made("SCARA with gears of any ratio")
    robot = type(machine.robot)(**{**machine.robot.parameters, "gear_1": gear, "offset_a1": 0.0, "offset_a2": 0.0})
    controller = machine.controller()
    assert controller.initialise(robot.parameters) == OK
    for half in range(-5, 6):
        for beside in (0.0, 1e-13, -1e-13, 1e-6, -1e-6):
            axes = np.array([180.0 * half * gear * (1.0 + beside), 72.0 * half * (1.0 + beside) + 20.0, 5.0])
            frame, configuration = robot.forward(axes)
            answer = robot.inverse(frame, configuration, (0.0, 0.0, 0.0))
            assert np.abs(answer - axes).max() <= 1e-6
            status, found = controller.inverse(frame.position, frame.rotation, configuration, (0.0, 0.0, 0.0))
            assert status == OK and np.abs(np.array(found[:3]) - axes).max() <= 1e-6


def test_a_machine_with_gears_carries_an_orientation_kinematics() -> None:
    """A coupling numbers the turns of each part as that part does."""
    machine = made("SCARA with gears")
    coupled = softkin.Coupled(machine.robot, softkin.CAxis())
    rng = np.random.default_rng(3)
    for shares in rng.uniform(-3.0, 3.0, (20, 4)):
        axes = shares * np.array([1000.0, 700.0, 100.0, 400.0])
        frame, configuration = coupled.forward(axes)
        assert np.abs(np.array(coupled.inverse(frame, configuration, np.zeros(4))) - axes).max() <= 1e-6


def test_a_gear_that_is_written_as_a_decimal_number_is_a_fraction() -> None:
    chain = Rz(A1 * 0.3333333333333333) * Tx(L1) * Rz(A2 * 0.0125) * Tz(Z)
    own = with_gears(replace(DRIVEN["SCARA with gears"], chain=chain))
    assert [str(joint.ratio) for joint in own.joints] == ["1/3", "1/80", "1"]


def test_a_loop_with_gears_is_the_loop_without_them() -> None:
    """The arms of a five-bar behind gears: three turns of a motor are one of its arm."""
    own = next(m for _, m in catalogue() if m.name == "Kin_P2C_Type1")
    table = {joint.symbol: -joint.symbol / 3 for joint in own.joints}
    described = in_other_joints(replace(own, joints=tuple(replace(j, domain=None) for j in own.joints)), table)
    geared = build(described)
    assert [abs(joint.ratio) for joint in geared.mechanism.joints] == [Rational(1, 3)] * 2
    assert witness(geared, described).inverted is not None
