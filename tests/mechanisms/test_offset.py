"""The offset interface: a point off the flange is brought to a place, with no word on the orientation."""

from __future__ import annotations

import numpy as np
from softkin import Status

from derive.mechanism import Mechanism
from tests.execution.closeness import asked
from tests.mechanisms.closure import Array
from tests.mechanisms.machines import Machine
from tests.mechanisms.refusals import refusal

POSES = 150
ROUND_TRIP = 1e-8
REGULAR = 0.03
"""How much the point moves at least, in reaches per radian or per length, whichever way."""
WITHOUT = ("Kin_Polar", "Kin_Polar_Z", "Kin_Scara3_Z")


def offered(machines: tuple[Machine, ...]) -> tuple[Machine, ...]:
    return machines if machines[0].mechanism.offset_interface else ()


def points(machine: Machine, axes: Array, offsets: Array) -> Array:
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
    """The axes that move: as many as coordinates are commanded, the last turning ones stay where the reference is."""
    excess = _count(machine) - len(machine.closure.task)
    turning = [i for i in range(_count(machine)) if machine.closure.angles[i]]
    frozen = turning[len(turning) - excess :] if excess > 0 else []
    return [i for i in range(_count(machine)) if i not in frozen]


def _count(machine: Machine) -> int:
    return len(machine.mechanism.joints)


def drawn(machine: Machine, seed: int) -> tuple[Array, Array]:
    """Regular axes with regular offsets, up to the reach."""
    rng = np.random.default_rng(seed)
    axes = machine.draw(6 * POSES, rng)
    offsets = rng.uniform(-0.6, 0.6, (len(axes), 3)) * machine.reach
    chosen = regular(machine, axes, offsets)
    assert chosen.sum() >= POSES
    return axes[chosen][:POSES], offsets[chosen][:POSES]


def test_who_offers_it(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    for machine in machines:
        assert hasattr(machine.robot, "inverse_offset") == (mechanism.name not in WITHOUT)
        assert hasattr(machine.robot, "configuration_offset") == (mechanism.name not in WITHOUT)


def test_round_trip_with_the_reference_at_the_same_axes(machines: tuple[Machine, ...]) -> None:
    for machine in offered(machines):
        axes, offsets = drawn(machine, 1)
        for values, offset, point in zip(axes, offsets, points(machine, axes, offsets), strict=True):
            configuration = machine.robot.configuration_offset(values, offset)
            found = machine.robot.inverse_offset(point, offset, configuration, values)
            assert np.abs(np.subtract(found, values)).max() < ROUND_TRIP


def test_every_branch_brings_the_point_there(machines: tuple[Machine, ...]) -> None:
    """With any reference; joints that the position does not determine stay where the reference is."""
    for machine in offered(machines):
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
            rows = zip(places, offsets, near, strict=True)
            asked_for = [asked(robot.inverse_offset, p, o, configuration, n) for p, o, n in rows]
            solved = [answer is not None for _, answer in asked_for]
            assert all(solved) or machine.mechanism.rods  # some working modes of a loop are on its other side
            found = np.array([answer for _, answer in asked_for if answer is not None]).reshape(-1, axes.shape[1])
            missed = (points(machine, found, offsets[solved]) - places[solved])[:, machine.closure.task]
            assert np.abs(missed).max(initial=0.0) < 1e-11 * machine.reach
            assert np.abs(machine.closure.joints(found)[:, frozen] - kept[solved]).max(initial=0.0) < 1e-10
            if byte in (1, 2) and robot.BRANCHES:
                written = [robot.configuration_offset(f, o)[0] for f, o in zip(found, offsets[solved], strict=True)]
                assert written == [byte] * len(found)


def test_zero_offset_is_the_inverse(machines: tuple[Machine, ...]) -> None:
    for machine in offered(machines):
        axes = machine.draw(40, np.random.default_rng(4))
        frames = machine.closure.poses(axes)
        third = machine.robot.parameters.get("link_length_3", 0.0)
        for values, position, rotation in zip(axes, *frames, strict=True):
            configuration = machine.robot.configuration_offset(values, (0.0, 0.0, 0.0))
            own = machine.robot.forward(values)[1]
            assert configuration == own or third > 0.0  # its elbow is that of the line to the point
            found = machine.robot.inverse_offset(position, (0.0, 0.0, 0.0), configuration, values)
            inverse = machine.robot.inverse((position, rotation), own, values)
            assert np.abs(np.subtract(found, inverse)).max() < 1e-7


def test_an_effective_link_that_is_too_short_cannot_be_aimed(machines: tuple[Machine, ...]) -> None:
    """The point on the axis of the elbow: nothing turns it, unless it is more than 1e-9 of the first link away."""
    for machine in offered(machines):
        if machine.robot.BRANCHES == 0 or machine.mechanism.chain is None:
            continue
        first, second, third = _links(machine)
        values = machine.draw(1, np.random.default_rng(5))[0]
        joints = machine.closure.joints(values[None])[0]
        angles = [i for i in range(len(values)) if machine.closure.angles[i]]
        last = joints[angles[2]] if len(angles) > 2 else 0.0
        down = -1.0 if machine.robot.parameters.get("flange_down") else 1.0
        for excess, expected in ((0.0, False), (0.3e-9 * first, False), (1e-6 * first, True), (1e-3 * first, True)):
            along = excess - second
            offset = (along * np.cos(last) - third, -down * along * np.sin(last), 0.0)
            point = _point_at(machine, values, offset, first)
            if expected:
                found = machine.robot.inverse_offset(point, offset, None, values)
                there = points(machine, np.array([found]), np.array([offset]))[0]
                assert np.abs(there - point)[machine.closure.task].max() < 1e-10 * machine.reach
            else:
                assert refusal(machine.robot.inverse_offset, point, offset, None, values) is Status.UNREACHABLE


def _links(machine: Machine) -> tuple[float, float, float]:
    found = [machine.robot.parameters.get(f"{word}_length_{k}") for k in (1, 2, 3) for word in ("link", "arm")]
    lengths = [v for v in found if v is not None]
    return lengths[0], lengths[1], (*lengths, 0.0)[2]


def _point_at(machine: Machine, values: Array, offset: tuple[float, float, float], distance: float) -> Array:
    """A place at a distance from the base, at the height of the point."""
    point = points(machine, values[None], np.array([offset]))[0]
    point[:2] = distance * np.cos(0.7), distance * np.sin(0.7)
    return point


def test_garbage(machines: tuple[Machine, ...]) -> None:
    for machine in offered(machines)[:1]:
        robot = machine.robot
        axes = machine.draw(1, np.random.default_rng(6))[0]
        point = machine.closure.poses(axes[None])[0][0]
        zero = (0.0, 0.0, 0.0)
        for number in (float("nan"), float("inf"), 1e300, -1.1e9):
            for i in range(3):
                wrong = [*point[:i], number, *point[i + 1 :]]
                assert refusal(robot.inverse_offset, wrong, zero) is Status.BAD_INPUT
                offset = [number if k == i else 0.0 for k in range(3)]
                assert refusal(robot.inverse_offset, point, offset) is Status.BAD_INPUT
            assert refusal(robot.configuration_offset, [number] * len(axes), zero) is Status.BAD_INPUT
        for wrong in (None, 5, "123", (1.0, 2.0), (1.0, 2.0, 3.0, 4.0)):
            assert refusal(robot.inverse_offset, wrong, zero) is Status.BAD_INPUT
            assert refusal(robot.inverse_offset, point, wrong) is Status.BAD_INPUT
            assert refusal(robot.configuration_offset, axes, wrong) is Status.BAD_INPUT
