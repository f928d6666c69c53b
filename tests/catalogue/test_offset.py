"""The offset interface: the position of a point off the flange is commanded, without the orientation."""

from collections.abc import Iterator

import numpy as np
import pytest
from softkin import KinematicsError, Status

from derive.description.mechanism import Mechanism, Role, Turning
from tests.catalogue.closure import Array
from tests.catalogue.loci import loci
from tests.catalogue.machines import Machine, few
from tests.catalogue.refusals import refusal

POSES = 24
POINTS = 12
ROUND_TRIP = 1e-8
REGULAR = 0.03
"""How much the point moves at least, in reaches per radian or per length, whichever way."""
NO_POINT = (Turning.DIRECTION, Turning.PITCH, Turning.FULL)
WITHOUT = ("Kin_Polar", "Kin_Polar_Z", "Kin_Scara3_Z", "Softkin_Planar_3RRR", "Softkin_SwivelArm", "Softkin_Transmit")


def offered(machines: tuple[Machine, ...]) -> tuple[Machine, ...]:
    """The machines, if the mechanism answers for a point off the flange."""
    return few(machines) if machines[0].mechanism.offers_points else ()


def points(machine: Machine, axes: Array, offsets: Array) -> Array:
    """Where the points of the flange are, by the closure."""
    positions, rotations = machine.closure.poses(axes)
    return positions + np.einsum("nij,nj->ni", rotations, offsets)


def regular(machine: Machine, axes: Array, offsets: Array) -> Array:
    """Rows in which the point moves well with every axis that its position can determine."""
    step = 1e-6
    base = points(machine, axes, offsets)[:, machine.closure.task]
    columns = []
    for i in range(axes.shape[1]):
        shifted = axes.copy()
        shifted[:, i] += step
        slope = (points(machine, shifted, offsets)[:, machine.closure.task] - base) / step
        columns.append(np.degrees(slope) / machine.reach if machine.closure.angles[i] else slope)
    slopes = np.stack(columns, axis=2)[:, :, _moving(machine)]
    return np.linalg.svd(slopes, compute_uv=False)[:, -1] > REGULAR


def _moving(machine: Machine) -> list[int]:
    """The axes that move: as many as coordinates are commanded.

    Held ones and, of the others, the last turning ones stay where the reference is.
    """
    solved = [i for i, _ in enumerate(machine.mechanism.joints) if machine.solved[i]]
    excess = len(solved) - len(machine.closure.task)
    turning = [i for i in solved if machine.closure.angles[i]]
    frozen = turning[len(turning) - excess :] if excess > 0 else []
    return [i for i in solved if i not in frozen]


def drawn(machine: Machine, seed: int) -> tuple[Array, Array]:
    """Regular axes with regular offsets, up to the reach."""
    rng = np.random.default_rng(seed)
    axes = machine.draw(10 * POSES, rng)
    offsets = rng.uniform(-0.6, 0.6, (len(axes), 3)) * machine.reach
    chosen = regular(machine, axes, offsets)
    assert chosen.sum() >= POSES
    return axes[chosen][:POSES], offsets[chosen][:POSES]


def test_who_offers_it(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    """Exactly the mechanisms that can command a point beside the flange offer the offset interface."""
    for machine in machines:
        expected = mechanism.name not in WITHOUT and mechanism.task.turning not in NO_POINT
        assert hasattr(machine.robot, "inverse_offset") == expected
        assert hasattr(machine.robot, "configuration_offset") == expected


@pytest.mark.long("P2C")
def test_round_trip_with_the_reference_at_the_same_axes(machines: tuple[Machine, ...]) -> None:
    for machine in offered(machines):
        axes, offsets = drawn(machine, 1)
        for values, offset, point in zip(axes, offsets, points(machine, axes, offsets), strict=True):
            configuration = machine.robot.configuration_offset(values, offset)
            found = machine.robot.inverse_offset(point, offset, configuration, values)
            assert np.abs(np.subtract(found, values)).max() < ROUND_TRIP


@pytest.mark.long
def test_every_branch_brings_the_point_there(machines: tuple[Machine, ...]) -> None:
    """With any reference; joints that the position does not determine stay where the reference is."""
    for machine in (m for m in offered(machines) if not m.mechanism.drives):  # other branches have loops that stay open
        robot = machine.changed(check_limits=False)
        axes, offsets = drawn(machine, 2)
        places = points(machine, axes, offsets)
        frozen = [i for i in range(axes.shape[1]) if i not in _moving(machine)]
        kept = machine.closure.joints(axes)[:, frozen]
        references = axes + np.random.default_rng(3).uniform(-30, 30, axes.shape)
        near = machine.closure.joints(references)
        near[:, frozen] = kept
        near = machine.closure.axes(near)
        for byte in (0, 1, 2, 3):
            configuration = (byte,) * robot.BRANCHES + (0,) * len(robot.PERIOD_AXES)
            found = _answers(machine, places, offsets, configuration, near)
            answered = np.isfinite(found[:, 0])
            found = found[answered]
            missed = (points(machine, found, offsets[answered]) - places[answered])[:, machine.closure.task]
            assert np.abs(missed).max(initial=0.0) < 1e-11 * machine.reach
            assert np.abs(machine.closure.joints(found)[:, frozen] - kept[answered]).max(initial=0.0) < 1e-10
            if byte in (1, 2) and robot.BRANCHES:
                bytes_ = [robot.configuration_offset(f, o) for f, o in zip(found, offsets[answered], strict=True)]
                assert {b[: robot.BRANCHES] for b in bytes_} <= {(byte,) * robot.BRANCHES}
            assert answered.all() or (byte in (1, 2) and not machine.branches_meet_together)


def _answers(machine: Machine, places: Array, offsets: Array, configuration: tuple[int, ...], near: Array) -> Array:
    """The axes of every row; not a number where a branch, which may have a reach of its own, does not answer."""
    robot = machine.changed(check_limits=False)
    found = np.full(near.shape, np.nan)
    for row, (place, offset, reference) in enumerate(zip(places, offsets, near, strict=True)):
        try:
            found[row] = robot.inverse_offset(place, offset, configuration, reference)
        except KinematicsError as error:
            assert error.status is Status.UNREACHABLE
    return found


def test_zero_offset_is_the_inverse(machines: tuple[Machine, ...]) -> None:
    for machine in offered(machines):
        axes = machine.draw(POSES, np.random.default_rng(4))
        frames = machine.closure.poses(axes)
        wrist = machine.robot.parameters.get("link_length_3", 0.0) > 0.0  # its elbow is that of the line to the point
        for values, position, rotation in zip(axes, *frames, strict=True):
            configuration = machine.robot.configuration_offset(values, (0.0, 0.0, 0.0))
            own = machine.robot.forward(values)[1]
            assert configuration == own or wrist
            found = machine.robot.inverse_offset(position, (0.0, 0.0, 0.0), configuration, values)
            inverse = machine.robot.inverse((position, rotation), own, values)
            assert np.abs(np.subtract(found, inverse)).max() < 1e-7


def test_an_effective_link_that_is_too_short_cannot_be_aimed(machines: tuple[Machine, ...]) -> None:
    """The point on the axis of the last joint that moves: nothing turns it, unless it is over 1e-9 of a link away.

    Where bars keep the flange level that joint shifts every point of the flange, and each is aimed.
    """
    for machine in offered(machines):
        if machine.robot.BRANCHES == 0 or machine.mechanism.chain is None:
            continue
        first = next(machine.robot.parameters[p.name] for p in machine.mechanism.parameters if p.role is Role.LENGTH)
        values = machine.draw(1, np.random.default_rng(5))
        moving = [i for i in _moving(machine) if machine.closure.turning[i]]
        turning = [i for i in moving if turns_the_flange(machine, values, i)]
        shifts = turning[-1] != moving[-1]
        fixed, away = on_the_axis(machine, values, turning[-1])
        for excess, is_aimed in ((0.0, False), (0.3e-9 * first, False), (1e-6 * first, True), (1e-3 * first, True)):
            offset = fixed + excess * away
            point = points(machine, values, offset[None])[0]
            if is_aimed or shifts:
                configuration = machine.robot.configuration_offset(values[0], offset)
                found = machine.robot.inverse_offset(point, offset, configuration, values[0])
                there = points(machine, np.array([found]), offset[None])[0]
                assert np.abs(there - point)[machine.closure.task].max() < 1e-10 * machine.reach
            else:
                own = machine.robot.forward(values[0])[1]
                assert refusal(machine.robot.inverse_offset, point, offset, own, values[0]) is Status.UNREACHABLE


def test_a_point_beside_the_first_axis_of_a_stretched_arm(machines: tuple[Machine, ...]) -> None:
    """At two edges at once: the point is as near to the axis as the arm passes it, and the arm is straight."""
    for machine in (m for m in offered(machines) if not m.mechanism.drives):  # other branches have loops that stay open
        for axes, offsets in beside_the_first_axis(machine):
            robot = machine.changed(check_limits=False)
            for values, offset, point in zip(axes, offsets, points(machine, axes, offsets), strict=True):
                configuration = robot.configuration_offset(values, offset)
                found = np.array([robot.inverse_offset(point, offset, configuration, values)])
                missed = (points(machine, found, offset[None])[0] - point)[machine.closure.task]
                assert np.abs(missed).max() < 1e-10 * machine.reach


def beside_the_first_axis(machine: Machine) -> Iterator[tuple[Array, Array]]:
    """Axis values of an arm in space where branches meet, and points of its flange straight beside its first axis."""
    if not machine.is_spatial or machine.robot.BRANCHES < 2 or machine.mechanism.chain is None:
        return
    axes = machine.draw(POINTS, np.random.default_rng(11), farthest=170.0)
    aside = np.random.default_rng(12).uniform(-0.3, 0.3, (POINTS, 2)) * machine.reach
    for locus in loci(machine):
        there = locus.moved(axes, 0.0)
        positions, rotations = machine.closure.poses(there)
        heading = machine.closure.joints(there)[:, 0]
        across = np.stack([-np.sin(heading), np.cos(heading), 0.0 * heading], axis=1)
        wanted = across * aside[:, :1] + np.array([0.0, 0.0, 1.0]) * (positions[:, 2:] + aside[:, 1:])
        yield there, np.einsum("nji,nj->ni", rotations, wanted - positions)


def turns_the_flange(machine: Machine, values: Array, joint: int) -> bool:
    """Whether the rotation of the flange changes with a joint."""
    turned = np.repeat(machine.closure.joints(values), 2, axis=0)
    turned[1, joint] += 1.0
    before, after = machine.closure.frames(turned)[1]
    return bool(np.abs(after - before).max() > 1e-9)


def on_the_axis(machine: Machine, values: Array, joint: int) -> tuple[Array, Array]:
    """The point of the flange next to its origin that the joint does not move, and a direction away from the axis."""
    turned = np.repeat(machine.closure.joints(values), 3, axis=0)
    turned[1:, joint] += (1.0, 3.5)
    positions, rotations = machine.closure.frames(turned)
    twice = (rotations[1:] - rotations[0]).reshape(6, 3)
    fixed = np.linalg.lstsq(twice, (positions[0] - positions[1:]).ravel(), rcond=1e-9)[0]
    return fixed, np.linalg.svd(twice)[2][0]


def test_garbage(machines: tuple[Machine, ...]) -> None:
    for machine in offered(machines)[:1]:
        robot = machine.robot
        axes = machine.draw(1, np.random.default_rng(6))[0]
        point = machine.closure.poses(axes[None])[0][0]
        zero = (0.0, 0.0, 0.0)
        for number in (float("nan"), float("inf"), 1e300, -1.1e9):
            for i in range(3):
                wrong = [*point[:i], number, *point[i + 1 :]]
                assert refusal(robot.inverse_offset, wrong, zero, None, axes) is Status.BAD_INPUT
                offset = [number if k == i else 0.0 for k in range(3)]
                assert refusal(robot.inverse_offset, point, offset, None, axes) is Status.BAD_INPUT
            assert refusal(robot.configuration_offset, [number] * len(axes), zero) is Status.BAD_INPUT
        for wrong in (None, 5, "123", (1.0, 2.0), (1.0, 2.0, 3.0, 4.0)):
            assert refusal(robot.inverse_offset, wrong, zero, None, axes) is Status.BAD_INPUT
            assert refusal(robot.inverse_offset, point, wrong, None, axes) is Status.BAD_INPUT
            assert refusal(robot.configuration_offset, axes, wrong) is Status.BAD_INPUT
