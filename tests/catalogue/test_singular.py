"""Singular poses: an answer and no error, and a free angle that stays at its reference."""

import numpy as np
import pytest
import softkin
from softkin import Status

from tests.catalogue.both_ways import inverse
from tests.catalogue.closure import Array
from tests.catalogue.loci import Locus, loci
from tests.catalogue.machines import Machine
from tests.catalogue.references import held_at
from tests.catalogue.self_motion import is_free
from tests.catalogue.test_boundary import alone
from tests.catalogue.test_round_trip import slots

pytestmark = pytest.mark.serial

SHIFTS = (0.0, *(s * 10.0**-k for k in range(4, 13) for s in (1, -1)))
"""How far from a singularity, in radians or per reach."""
REGULAR, NEAR = 1e-12, 1e-10
"""The error of forward of inverse, per size of the machine."""
THRESHOLD = 1e-3
EACH = 31
"""Of the answers of a batch so many are asked once as a single call."""


def shifts(locus: Locus) -> list[float]:
    """Those that the machine can make: a positive quantity ends at its locus."""
    return [s * locus.inward for s in SHIFTS if locus.branch is not None or s >= 0.0]


def configurations(machine: Machine, axes: Array) -> list[Array]:
    """The reported one; every slot with open periods; automatic; and 3 in every branch."""
    robot = machine.robot
    periods = (0,) * len(robot.PERIOD_AXES)
    chosen = [*slots(machine), (0,) * robot.BRANCHES, (3,) * robot.BRANCHES]
    return [robot.forward_batch(axes)[2], *(np.tile(np.array(c + periods, dtype=int), (len(axes), 1)) for c in chosen)]


def test_every_margin_vanishes_somewhere(machines: tuple[Machine, ...]) -> None:
    """At a place that the description names: branches that meet, or positive quantities that end."""
    for machine in machines:
        axes = machine.draw(5, np.random.default_rng(1))
        vanishing = set()
        for locus in loci(machine):
            for row in locus.moved(axes, 0.0):
                singularity = machine.robot.singularity(row)
                assert singularity.is_singular
                vanishing |= {name for name, margin in singularity.margins.items() if abs(margin) < 1e-12}
        assert vanishing == set(machine.robot.MARGINS)


@pytest.mark.long
@pytest.mark.slow("ThreeParallel")
def test_a_singular_pose_is_an_answer(machines: tuple[Machine, ...]) -> None:
    """At a singular pose the inverse answers, and reaches the frame: references are at the pose, zero, or anywhere."""
    for machine in machines:
        robot = machine.changed(check_limits=False)
        axes = machine.draw(5, np.random.default_rng(2))
        there = np.concatenate([axes, *(p.moved(axes, shift) for p in loci(machine) for shift in shifts(p))])
        asked = configurations(machine, there)
        every, rows = np.concatenate(asked), np.tile(np.arange(len(there)), len(asked))
        anywhere = np.random.default_rng(3).uniform(-400.0, 400.0, (len(rows), axes.shape[1]))
        kinds = axes[rows % len(axes)], 0.0 * anywhere, anywhere
        near = held_at(robot, there[rows], np.choose(np.arange(len(rows))[:, None] % 3, kinds))
        assert near is not None
        positions, rotations = (part[rows] for part in machine.closure.poses(there))
        found, statuses = robot.inverse_batch(positions, rotations, every, near)
        answered = machine.answers(statuses)
        assert machine.miss(found[answered], positions[answered], rotations[answered]).max() < NEAR
        alone = np.flatnonzero(answered)[::EACH]
        scalar = [robot.inverse((positions[i], rotations[i]), every[i].tolist(), near[i]) for i in alone]
        assert machine.miss(np.array(scalar), positions[alone], rotations[alone]).max() < NEAR
        by_configuration = answered.reshape(len(asked), len(there))
        assert by_configuration[[0, -2, -1]].all()  # as reported, and the two that leave every branch open


def test_singular_is_what_is_nearer_than_the_threshold(machines: tuple[Machine, ...]) -> None:
    """1e-3 of the margin itself; the margin of a branch is its indicator."""
    for machine in machines:
        axes = machine.draw(10, np.random.default_rng(5))
        assert not any(machine.robot.singularity(row).is_singular for row in axes)
        for locus in loci(machine):
            if locus.branch is None:
                continue
            there = locus.moved(axes, 0.0)
            slope = np.abs(scaled_indicator(machine, locus, locus.moved(axes, 1e-6))) / 1e-6
            other = np.delete(np.abs(machine.closure.indicators(machine.closure.joints(there))), locus.branch, axis=1)
            alone = (other > 0.01 * np.delete(machine.largest, locus.branch)).all(axis=1)
            assert alone.any()
            for row in locus.moved(axes, 0.99 * THRESHOLD / slope)[alone]:
                assert machine.robot.singularity(row).is_singular
            for row in locus.moved(axes, 1.01 * THRESHOLD / slope)[alone]:
                assert not machine.robot.singularity(row).is_singular


def scaled_indicator(machine: Machine, locus: Locus, axes: Array) -> Array:
    """The indicator of the locus' branch in the unit of its margin, which `test_jacobian.py` compares with it."""
    branch = machine.mechanism.branches[locus.branch or 0]
    regular = machine.draw(1, np.random.default_rng(9))
    (own,) = machine.closure.indicators(machine.closure.joints(regular))[:, locus.branch]
    unit = own / machine.robot.singularity(regular[0]).margins[branch.margin]
    return machine.closure.indicators(machine.closure.joints(axes))[:, locus.branch] / unit


def free_axes(locus: Locus) -> list[int]:
    """The axes that nothing determines at the locus: they do not move the flange, or only with others that follow."""
    machine = locus.machine
    if locus.branch is not None:
        folded = locus.second and machine.label == "equal" and machine.has_an_elbow
        return [int(np.flatnonzero(machine.closure.angles)[0])] if folded else []
    axes = locus.moved(machine.draw(1, np.random.default_rng(6)), 0.0)
    jacobian = machine.closure.jacobian(axes, machine.closure.poses(axes)[0])[0]
    return np.flatnonzero(np.abs(jacobian).max(axis=0) < 1e-9 * machine.reach).tolist()


@pytest.mark.long("Scara4")
def test_a_free_axis_stays_at_the_reference(machines: tuple[Machine, ...]) -> None:
    """Its value comes from the reference, turns and all; whichever configuration asks."""
    count = 0
    if machines[0].is_spatial and machines[0].robot.BRANCHES:
        return  # what is free there, a search tells: see below
    for machine in machines:
        robot = machine.changed(check_limits=False)
        axes = machine.draw(20, np.random.default_rng(7))
        turns = 360.0 * np.array([j.multi_turn for j in machine.mechanism.joints])
        references = np.random.default_rng(8).uniform(1.0, 179.0, axes.shape) + machine.closure.offsets + turns
        for locus in loci(machine):
            free = free_axes(locus)
            count += len(free)
            there = locus.moved(axes, 0.0)
            near = held_at(robot, there, references)
            frames = machine.closure.poses(there)
            for configuration in configurations(machine, there):
                configuration[:, robot.BRANCHES :] = 0
                found, statuses = inverse(robot, *frames, configuration, near)
                assert (statuses == Status.OK).all()
                assert np.abs(found - near)[:, free].max(initial=0.0) < 1e-9
    lines = {"Kin_Polar": 1, "Kin_Polar_Z": 1, "Softkin_Transmit": 1, "Kin_Crane": 4}
    on_the_axis = lines.get(machines[0].mechanism.name, 0)
    assert count == on_the_axis * len(machines) + machines[0].robot.BRANCHES * machines[0].has_an_elbow


@pytest.mark.long("Pos_RRR")
def test_the_reference_decides_where_something_is_free_in_space(machines: tuple[Machine, ...]) -> None:
    """At a self-motion some axis stays at its reference, or as near as the rest can be reached; else nothing moves."""
    free = 0
    for machine in machines[:5:2]:
        if not machine.is_spatial or machine.robot.BRANCHES == 0:
            continue
        robot = machine.changed(check_limits=False)
        for locus in loci(machine):
            there = alone(machine, locus)[:2]
            frames = machine.closure.poses(there)
            moves = is_free(machine, there)
            configurations = robot.forward_batch(there)[2]
            configurations[:, robot.BRANCHES :] = 0
            references = held_at(robot, there, there + np.random.default_rng(8).uniform(-150.0, 150.0, there.shape))
            found, statuses = inverse(robot, *frames, configurations, references)
            assert (statuses == Status.OK).all()
            assert machine.miss(found, *frames).max(initial=0.0) < NEAR
            stays = (np.abs(found - references) < 1e-9)[:, machine.closure.angles].any(axis=1)
            indicators = np.abs(machine.closure.indicators(machine.closure.joints(found))) / machine.largest
            at_an_end = (np.delete(indicators, locus.branch, axis=1) < 1e-6).any(axis=1)
            assert (stays | at_an_end)[moves].all()
            free += stays[moves].sum()
            apart = machine.closure.joints(found) - machine.closure.joints(there)
            turns = np.where(machine.closure.angles, 2 * np.pi * np.round(apart / (2 * np.pi)), 0.0)
            assert np.abs(apart - turns)[~moves][:, machine.closure.angles].max(initial=0.0) < 1e-5
    spatial = [m for m in machines if m.is_spatial and m.robot.BRANCHES]
    assert bool(free) == any(m.closure.follows_rotation or m.label == "plain" for m in spatial)


def test_a_free_polar_angle_stays_on_its_half_circle() -> None:
    """The boom of a crane at the origin: the reference where it is possible, else the nearer end."""
    robot = softkin.catalogue()["Kin_Crane"](offset_phi=10.0)
    near = {100.0: 100.0, 10.0: 10.0, 190.0: 190.0, -20.0: 10.0, 220.0: 190.0, 310.0: 10.0, 460.0: 100.0}
    for reference, polar in near.items():
        _, theta, phi = robot.inverse(((0.0, 0.0, 0.0), np.eye(3)), None, (5.0, 700.0, reference))
        assert (theta, phi) == pytest.approx((700.0, polar), abs=1e-9)
