"""Accelerations, bare and mounted: the truth is differences of the twist, and of the inverse along lines and turns."""

import math
from collections.abc import Callable

import numpy as np
import pytest
import softkin
from softkin import Frame, Status

from derive.description.mechanism import Mechanism, Turning
from tests.catalogue.closure import Array
from tests.catalogue.mounted.machines import EVERY, Sample, couplings, sample_of
from tests.catalogue.mounted.test_velocities import ARM, EVERY_MECHANISM, EVERY_ONE, STRETCHED, both
from tests.catalogue.refusals import refusal

pytestmark = pytest.mark.long("Hexapod")

STEP = 5e-4
Axes = tuple[float, ...]


def units_of(robot: softkin.Mechanism) -> Array:
    """One radian or length of each axis, in its unit."""
    return np.array([math.degrees(1.0) if axis.unit == "deg" else 1.0 for axis in robot.AXES])


def motion_of(robot: softkin.Mechanism, reach: float) -> tuple[Array, Array]:
    """Velocities and accelerations of the axes, in radians and parts of the reach."""
    sizes = np.array([1.0 if axis.unit == "deg" else 0.3 * reach for axis in robot.AXES])
    return tuple(sizes * np.random.default_rng(5).uniform(-1.0, 1.0, (2, len(sizes))))


def rate(function: Callable[[float], Array]) -> Array:
    """The derivative at zero, of fourth order."""
    near, far = (function(k * STEP) - function(-k * STEP) for k in (1, 2))
    return (8.0 * near - far) / (12.0 * STEP)


def confirm_rates(robot: softkin.Mechanism, axes: Array, reach: float) -> None:
    """`twist_rate` is the derivative of the twist as axes move; `axis_accelerations` is its inverse; so are batches."""
    velocities, accelerations = motion_of(robot, reach)
    units = units_of(robot)

    def twist(time: float) -> Array:
        moved = axes + units * (velocities * time + accelerations * time**2 / 2)
        return np.array(robot.twist(moved, velocities + accelerations * time))

    found = np.array(robot.twist_rate(axes, velocities, accelerations))
    assert np.abs(found - rate(twist)).max(initial=0.0) < 1e-7 * (reach + 600.0)
    if not robot.AXES or robot.singularity(axes).is_singular:
        return
    held = accelerations[list(robot.HELD)]
    back = robot.axis_accelerations(axes, velocities, found, held=held)
    assert back == pytest.approx(tuple(accelerations), abs=1e-6 * (1.0 + np.abs(accelerations).max()))
    still = np.where(np.isin(np.arange(len(axes)), robot.HELD), 0.0, 1.0)
    rows = np.vstack([axes, np.full(len(axes), np.nan)])
    many, statuses = robot.axis_velocities_batch(rows, robot.twist(axes, still * velocities))
    assert statuses.tolist() == [Status.OK, Status.BAD_INPUT] and np.isnan(many[1]).all()
    assert many[0] == pytest.approx(still * velocities, abs=1e-6 * (1.0 + np.abs(velocities).max()))
    goal = robot.twist_rate(axes, velocities, still * accelerations)
    many, statuses = robot.axis_accelerations_batch(rows, velocities, goal)
    assert statuses.tolist() == [Status.OK, Status.BAD_INPUT] and np.isnan(many[1]).all()
    assert many[0] == pytest.approx(still * accelerations, abs=1e-6 * (1.0 + np.abs(accelerations).max()))


@EVERY_ONE
def test_the_rate_of_the_twist_is_its_derivative(mechanism: Mechanism | str) -> None:
    sample = sample_of(mechanism)
    for robot in (*both(sample), sample.robot.in_radians().in_degrees()):
        for axes in sample.axes[:2]:
            confirm_rates(robot, axes, sample.reach)
    turned = sample.robot.in_radians()
    velocities, accelerations = motion_of(sample.robot, sample.reach)
    axes = sample.axes[0] / np.where(units_of(sample.robot) == 1.0, 1.0, units_of(sample.robot))
    expected = sample.robot.twist_rate(sample.axes[0], velocities, accelerations)
    assert turned.twist_rate(axes, velocities, accelerations) == pytest.approx(expected, abs=1e-9 * sample.reach)


DEVIATIONS = {"a1_tilt_x": 0.1, "a2_shift_y": 1.0, "a3_gain": 0.01, "tool_b": 1.0, "base_a": 0.5}


def test_a_machine_with_deviations_accelerates_as_its_twist_changes() -> None:
    """An arm, and a delta whose loops have other dimensions."""
    sample = sample_of(next(m for m in EVERY if m.name == "Kin_Tripod_Rotary"))
    loop = sample.robot.calibrated({"a1_gain": 0.01, "tool_b": 0.4})
    confirm_rates(loop, sample.axes[0], sample.reach)
    confirm_rates(ARM.calibrated(DEVIATIONS), np.array([10.0, 20.0, 30.0, 40.0, 50.0, 60.0]), 1500.0)


def line_of(sample: Sample, axes: Array) -> tuple[Array, Callable[[float], Frame]]:
    """A twist at constant speed, and the frames along it: a line, and a turn that the machine follows."""
    turning, rng = sample.mechanism.task.turning, np.random.default_rng(3)
    shift = 0.05 * sample.reach * rng.uniform(-1.0, 1.0, 3)
    spins = {Turning.ABOUT_Z: np.array([0.0, 0.0, 0.7]), Turning.FULL: rng.uniform(-0.7, 0.7, 3)}
    spin = spins.get(turning, np.zeros(3))
    names = ("x", "y", "z", "turn x", "turn y", "turn z")
    known = dict(zip(names, (*shift, *spin), strict=True))
    frame, _ = sample.robot.forward(axes)
    own = np.array([known.get(row, 0.0) for row in sample.robot.JACOBIAN_ROWS])
    moved = np.where([c in sample.mechanism.task.position for c in "xyz"], shift, 0.0)
    size = np.linalg.norm(spin) or 1.0
    follows = sample.mechanism.followed_turns > 0
    skew = np.cross(np.eye(3), np.array([0.0, 0.0, 1.0]) if follows else spin / size)

    def at(time: float) -> Frame:
        position = np.array(frame.position) + time * moved
        angle = size * time if spin.any() else 0.0
        if follows:  # the heading follows the position
            angle = math.atan2(position[1], position[0]) - math.atan2(frame.position[1], frame.position[0])
        turn = np.eye(3) + math.sin(angle) * skew + (1.0 - math.cos(angle)) * skew @ skew
        return Frame(tuple(position), tuple(map(tuple, turn @ np.array(frame.rotation))))

    return own, at


@EVERY_MECHANISM
def test_the_axes_move_along_a_line_as_the_inverse_does(mechanism: Mechanism) -> None:
    """Velocities and accelerations against differences of the inverse: independent of the Jacobian and its rate."""
    sample = sample_of(mechanism)
    robot, units = sample.robot, units_of(sample.robot)
    regular = [axes for axes in sample.axes if robot.AXES and not robot.singularity(axes).is_singular]
    assert regular or not robot.AXES
    for axes in regular[:3]:
        twist, frame_at = line_of(sample, axes)
        _, own = robot.forward(axes)
        named = (*own[: robot.BRANCHES], *(0,) * (len(own) - robot.BRANCHES))

        def solved(
            time: float, at: Callable[[float], Frame] = frame_at, own: Axes = named, near: Array = axes
        ) -> Array:
            return np.array(robot.inverse(at(time), own, near)) / units

        assert np.abs(solved(0.0) - axes / units).max() < 1e-9 * (1.0 + np.abs(axes).max())
        velocities = robot.axis_velocities(axes, twist)
        accelerations = robot.axis_accelerations(axes, velocities, np.zeros(len(twist)))
        sizes = 1.0 + np.abs(velocities), 1.0 + np.abs(accelerations) + np.square(velocities)
        assert np.abs(rate(solved) - velocities).max() < 1e-6 * sizes[0].max()
        second = (16.0 * _apart(solved, STEP) - _apart(solved, 2.0 * STEP)) / (12.0 * STEP**2)
        assert np.abs(second - accelerations).max() < 1e-5 * sizes[1].max()


def _apart(function: Callable[[float], Array], step: float) -> Array:
    """The second difference."""
    return function(step) - 2.0 * function(0.0) + function(-step)


@EVERY_MECHANISM
def test_the_largest_feed_is_where_an_axis_meets_its_limit(mechanism: Mechanism) -> None:
    """Velocities and accelerations at this speed are within their limits, and one of them is at it."""
    sample = sample_of(mechanism)
    robot, axes = sample.robot, sample.axes[0]
    if not robot.AXES or robot.singularity(axes).is_singular:
        return
    twist, bends = np.random.default_rng(4).uniform(-1.0, 1.0, (2, len(robot.JACOBIAN_ROWS)))
    sizes = np.where(units_of(robot) == 1.0, 0.2 * sample.reach, 2.0)
    own, turning = {"velocities": sizes}, {"accelerations": 0.5 * sizes}
    for limits in (own, turning, own | turning):
        feed = robot.largest_feed(axes, twist, twist_rate=bends, **limits)
        velocities = np.array(robot.axis_velocities(axes, feed * twist))
        accelerations = np.array(robot.axis_accelerations(axes, velocities, feed**2 * bends))
        used = {"velocities": velocities, "accelerations": accelerations}
        shares = np.concatenate([np.abs(used[name]) / limit for name, limit in limits.items()])
        assert shares.max() == pytest.approx(1.0, abs=1e-6)
        found, statuses = robot.largest_feed_batch([axes, axes], twist, twist_rates=bends, **limits)
        assert found == pytest.approx(feed, rel=1e-9) and not statuses.any()
    assert robot.largest_feed(axes, twist) == math.inf


def test_feeds_along_a_path_are_those_at_its_poses() -> None:
    """On a line that only shifts: the axes are differentiated, without the Jacobian. Angles are in degrees there."""
    line = ARM.line(((500.0, -200.0, 500.0), Frame.from_euler(0.0, 180.0, 0.0).rotation),
                    ((600.0, 250.0, 400.0), Frame.from_euler(0.0, 180.0, 0.0).rotation), samples=12)  # fmt: skip
    assert line
    way = np.array([100.0, 450.0, -100.0])
    twist = (*(way / np.linalg.norm(way)), 0.0, 0.0, 0.0)
    speeds, turns = (2.0, 2.5, 3.0, 4.0, 5.0, 6.0), (8.0, 7.0, 9.0, 20.0, 25.0, 30.0)
    for limits in ((speeds, None), (None, turns), (speeds, turns)):
        in_degrees = [None if limit is None else np.degrees(limit) for limit in limits]
        expected, statuses = ARM.largest_feed_batch(line.axes, twist, velocities=limits[0], accelerations=limits[1])
        assert not statuses.any()
        assert line.feeds(*in_degrees)[1:-1] == pytest.approx(expected[1:-1], rel=1e-5)
    assert set(line.feeds()) == {math.inf}
    turn = ARM.line(line.frames[0], (line.frames[0].position, Frame.from_euler(0.0, 150.0, 0.0).rotation), samples=3)
    assert turn and max(turn.feeds(np.full(6, 90.0))) <= 90.0 * 2.0
    for wrong in ((1.0,) * 5, (0.0,) * 6, (math.nan,) * 6):
        assert refusal(line.feeds, wrong, says="velocities must be 6 positive numbers") is Status.BAD_INPUT


def test_what_is_not_possible_is_refused() -> None:
    """A singular pose, a motion that the axes do not have, and what are no numbers."""
    axes, six = (10.0, 20.0, 30.0, 40.0, 50.0, 60.0), (1.0,) * 6
    assert refusal(ARM.axis_accelerations, STRETCHED, six, six, says="singular") is Status.IMPOSSIBLE
    assert np.isfinite(ARM.axis_accelerations(STRETCHED, six, six, damping=0.01, length=400.0)).all()
    assert refusal(ARM.axis_accelerations, axes, (1.0,) * 5, six, says="velocities must be 6") is Status.BAD_INPUT
    nothing = (math.nan,) * 6
    assert refusal(ARM.axis_accelerations, axes, six, nothing, says="twist_rate must be finite") is Status.BAD_INPUT
    assert refusal(ARM.twist_rate, axes, six, (math.inf,) * 6, says="accelerations must be finite") is Status.BAD_INPUT
    assert refusal(ARM.twist_rate, axes, (2e9,) * 6, six) is Status.BAD_INPUT
    found, statuses = ARM.axis_velocities_batch([STRETCHED, axes], six)
    assert statuses.tolist() == [Status.IMPOSSIBLE, Status.OK] and np.isnan(found[0]).all()
    robot = couplings()["scara, C"]
    held = (10.0, 50.0, 30.0, 40.0)
    twists = [(1.0, 2.0, 3.0, 0.0, 0.0, 0.5), (1.0, 2.0, 3.0, 0.0, 5.0, 0.5)]
    _, statuses = robot.axis_velocities_batch([held, held], twists)
    assert statuses.tolist() == [Status.OK, Status.UNREACHABLE]
