"""The edge of the workspace belongs to it: reach, the hole in the middle, the plane, and the wrong side of a tool."""

from fractions import Fraction

import numpy as np
import pytest
from softkin import Status

from derive.description.mechanism import Mechanism, Role, Turning
from tests.catalogue.both_ways import inverse
from tests.catalogue.closure import Array
from tests.catalogue.loci import Locus, loci
from tests.catalogue.machines import LENGTHS, Machine, few
from tests.catalogue.references import held_at
from tests.catalogue.refusals import refusal
from tests.catalogue.self_motion import inward, is_free, twisted
from tests.catalogue.test_round_trip import slots
from tests.catalogue.turning_machines import TurningMachine
from tests.mechanisms import has_struts, in_the_task

BOUNDARY = Fraction(1, 10**12)
"""A squared sine that is negative by at most this is zero."""
BESIDE = (0.0, *(s * 10.0**-k for k in (13, 12, 11, 9, 6, 3) for s in (1, -1)))
FOLD = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 0.0, -1e-14, -1e-9, -1e-8, -1e-6, -1e-4)
"""How far (radians and reaches) poses are inside a fold."""
PLANE = 1e-6


def lengths(machine: Machine) -> list[float]:
    """Of its links: coordinates of a loop, which may be negative, are none."""
    counted = [p for p in machine.mechanism.parameters if p.role in (*LENGTHS, Role.DISTANCE)]
    return [abs(machine.robot.parameters[p.name]) for p in counted if p.low >= 0.0 or not machine.mechanism.rods]


def turned(machine: Machine, count: int) -> tuple[Array, Array]:
    """Some rotations that the flange can have, and their headings."""
    axes = machine.draw(count, np.random.default_rng(1))
    rotations = machine.closure.poses(axes)[1]
    return rotations, np.arctan2(rotations[:, 1, 0], rotations[:, 0, 0])


def at_wrist_distance(machine: Machine, distance: float, count: int) -> tuple[Array, Array]:
    """Poses whose wrist is at a distance from the base, in random directions."""
    rotations, headings = turned(machine, count)
    directions = np.random.default_rng(2).uniform(-np.pi, np.pi, count)
    beyond = ([*lengths(machine), 0.0])[2]
    positions = np.zeros((count, 3))
    positions[:, 0] = distance * np.cos(directions) + beyond * np.cos(headings)
    positions[:, 1] = distance * np.sin(directions) + beyond * np.sin(headings)
    if len(machine.closure.task) == 3:
        positions[:, 2] = 10.0
    return positions, rotations


def at_home(machine: Machine, count: int) -> Array | None:
    """References at which a held joint is at zero: the base of the arm is then where positions are measured from."""
    return held_at(machine.robot, np.tile(machine.closure.offsets, (count, 1)))


def squared_sine(machine: Machine, position: Array, rotation: Array) -> Fraction:
    """Of the elbow, exactly, for a pose as it is in floating point."""
    first, second, third = (Fraction(v) for v in (*lengths(machine), 0.0)[:3])
    x, y = Fraction(float(position[0])), Fraction(float(position[1]))
    if third:
        heading = np.arctan2(rotation[1, 0], rotation[0, 0])
        x, y = x - third * Fraction(float(np.cos(heading))), y - third * Fraction(float(np.sin(heading)))
    cosine = (x * x + y * y - first * first - second * second) / (2 * first * second)
    return 1 - cosine * cosine


@pytest.mark.long("Scara4")
@pytest.mark.serial
def test_reach_and_hole(machines: tuple[Machine, ...]) -> None:
    """Stretched and folded, exactly and beside: refused where the squared sine is below -1e-12, and only there."""
    outcomes = set()
    for machine in few(machines):
        if not machine.has_an_elbow:
            continue
        first, second = lengths(machine)[:2]
        for edge in (first + second, abs(first - second)):
            for relative in BESIDE:
                frames = at_wrist_distance(machine, edge * (1 + relative), 3)
                squares = [squared_sine(machine, p, r) for p, r in zip(*frames, strict=True)]
                for slot in slots(machine):
                    configuration = slot + (0,) * len(machine.robot.PERIOD_AXES)
                    found, statuses = inverse(machine.robot, *frames, configuration, at_home(machine, 3))
                    for square, status in zip(squares, statuses, strict=True):
                        if abs(square + BOUNDARY) > BOUNDARY / 10:
                            assert status == (Status.OK if square > -BOUNDARY else Status.UNREACHABLE), (
                                relative,
                                float(square),
                            )
                            outcomes.add((np.sign(relative), int(status)))
                    answered = statuses == Status.OK
                    inside = tuple(f[answered] for f in frames)
                    assert machine.miss(found[answered], *inside).max(initial=0.0) < 1e-11
    if machines[0].has_an_elbow:
        assert outcomes == {(-1, 0), (0, 0), (1, 0), (1, 3), (-1, 3)}
    elif machines[0].robot.BRANCHES == 0:  # else where branches meet is the edge: see below
        assert all(locus.branch is None for machine in machines for locus in loci(machine))


@pytest.mark.long("Pos_RRR")
@pytest.mark.serial
def test_where_two_branches_meet(machines: tuple[Machine, ...]) -> None:
    """On the one side of a fold both answer, however near; on the other none does, but for rounding."""
    folds = 0
    for machine in machines[1::2]:
        if machine.has_an_elbow:
            continue
        for locus in loci(machine):
            if locus.branch is None:
                continue
            axes = alone(machine, locus)[:2]
            axes = axes[~is_free(machine, axes)]
            folds += len(axes)
            if not len(axes):
                continue
            frames = machine.closure.poses(axes)
            twist = inward(machine, axes)
            configurations = machine.robot.forward_batch(axes)[2]
            assert (configurations[:, locus.branch] == 3).all()
            robot = machine.changed(check_limits=False)
            for size in FOLD:
                moved = twisted(machine, frames, *twist, size)
                found, statuses = inverse(robot, *moved, configurations, axes)
                if abs(size) < 1e-13 or size > 0:
                    assert (statuses == Status.OK).all(), size
                    assert machine.miss(found, *moved).max() < 1e-10
                else:
                    assert (statuses == Status.UNREACHABLE).all(), size
    has_an_edge = machines[0].has_a_reach or machines[0].lowest_direction > -1.0
    assert bool(folds) == (has_an_edge and not machines[0].has_an_elbow)


def alone(machine: Machine, locus: Locus) -> Array:
    """Poses where the branches of a locus meet, and no others nearly do."""
    axes = locus.moved(machine.draw(40, np.random.default_rng(6)), 0.0)
    indicators = np.abs(machine.closure.indicators(machine.closure.joints(axes))) / machine.largest
    return axes[(np.delete(indicators, locus.branch or 0, axis=1) > 0.1).all(axis=1)]


@pytest.mark.serial
def test_far_away(machines: tuple[Machine, ...]) -> None:
    """An arm does not reach far away; a gantry and a boom do."""
    for machine in machines:
        rotations, _ = turned(machine, 4)
        positions = np.array([[1e7, 0, 0], [0, -1e7, 0], [1e6, 1e6, 0], [-7e6, 7e6, 0]])
        _, statuses = machine.robot.inverse_batch(positions, rotations, None, at_home(machine, 4))
        is_far = in_the_task(machine.mechanism.name, positions).any(axis=1) & machine.has_a_reach
        assert (statuses == np.where(is_far, Status.UNREACHABLE, Status.OK)).all()


def test_the_plane_of_a_planar_machine(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    """Met within 1e-6 of the sum of the lengths; a machine without lengths has one user's unit."""
    if mechanism.rods and "z" in mechanism.task.position:
        return  # another height is another pose
    is_planar = bool(mechanism.task.position) and "z" not in mechanism.task.position
    for machine in few(machines):
        axes = machine.draw(40, np.random.default_rng(3))
        positions, rotations = machine.closure.poses(axes)
        own = machine.robot.forward_batch(axes)[2]
        scale = machine.reach if mechanism.is_platform else sum(lengths(machine)) or 1.0
        for factor, met in ((0.0, True), (0.999, True), (-0.999, True), (1.001, False), (-1.001, False), (1e3, False)):
            shifted = positions + np.array([0.0, 0.0, factor * PLANE * scale])
            if abs(factor) > 2 and machine.is_spatial:
                continue  # there is no plane, but perhaps an edge
            found, statuses = inverse(machine.changed(check_limits=False), shifted, rotations, own, axes)
            expected = Status.UNREACHABLE if is_planar and not met else Status.OK
            assert (statuses == expected).all()
            assert np.isnan(found[statuses != Status.OK]).all()
            if expected is Status.UNREACHABLE:
                near = held_at(machine.robot, axes[0])
                assert refusal(machine.robot.inverse, (shifted[0], rotations[0]), None, near) is expected


def test_a_tool_that_points_the_opposite_way(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    """No heading is nearest then; the least tilt away from it, there is one. Machines that do not turn do not look."""
    for machine in machines:
        axes = machine.draw(20, np.random.default_rng(4))
        positions, rotations = machine.closure.poses(axes)
        angles = np.random.default_rng(5).uniform(-np.pi, np.pi, 20)
        horizontal = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
        half_turns = 2 * horizontal[:, :, None] * horizontal[:, None, :] - np.eye(3)
        opposite = half_turns @ rotations
        own = machine.robot.forward_batch(axes)[2]
        robot = machine.open_robot
        _, statuses = robot.inverse_batch(positions, opposite, own, axes)
        turns = mechanism.task.turning is Turning.ABOUT_Z
        is_far = mechanism.is_platform or machine.has_a_reach  # its other end may be beyond the reach
        if machine.lowest_direction > -1.0:
            is_low = opposite[:, 2, 2] < machine.lowest_direction
            assert (statuses == np.where(is_low, Status.UNREACHABLE, Status.OK)).all()
            continue
        if mechanism.task.turning in (Turning.FULL, Turning.PITCH) or (is_far and not turns):
            if isinstance(machine, TurningMachine) and has_struts(mechanism):  # one pose of its legs, in either mode
                where = positions, machine.closure.reachable(opposite)
                joints, closed = machine.closure.joints_at(*where, np.random.default_rng(6))
                assert ((statuses == Status.OK) == (closed & (machine.closure.side(joints, *where) > 0))).all()
            else:
                assert machine.answers(statuses).any()  # another pose as any
            continue
        assert (statuses == (Status.UNREACHABLE if turns else Status.OK)).all()
        tilt = 1e-3
        lean = np.array([[1, 0, 0], [0, np.cos(tilt), -np.sin(tilt)], [0, np.sin(tilt), np.cos(tilt)]])
        statuses = robot.inverse_batch(positions, lean @ opposite, own, axes)[1]
        assert (statuses == Status.OK).sum() >= (1 if lengths(machine)[2:] else 20)
        if turns:
            near = held_at(machine.robot, axes[0])
            assert refusal(machine.robot.inverse, (positions[0], opposite[0]), None, near) is Status.UNREACHABLE
            assert refusal(machine.robot.project, opposite[0]) is Status.UNREACHABLE
