"""Forward and inverse kinematics of arms with a root search, on every branch, and the number of solutions."""

from itertools import combinations, product

import numpy as np
import pytest
import softkin
from softkin import Status

from tests.catalogue.refusals import refusal
from tests.catalogue.search.arms import IRB_2400, LATERALS, Array, all_roots, arm, frame, miss, posed


@pytest.mark.parametrize("lateral", (0.0, *LATERALS))
def test_the_reported_configuration_leads_back(lateral: float) -> None:
    robot, rng = arm(lateral), np.random.default_rng(1)
    axes = rng.uniform(-500, 500, (150, 6))
    positions, rotations, configurations, statuses = robot.forward_batch(axes)
    assert (statuses == Status.OK).all()
    for row, position, rotation in zip(axes, positions, rotations, strict=True):
        assert np.abs(np.subtract(posed(frame(row, lateral))[0], position)).max() < 1e-9
        assert np.abs(posed(frame(row, lateral))[1] - rotation).max() < 1e-13
    found, statuses = robot.inverse_batch(positions, rotations, configurations, axes)
    assert (statuses == Status.OK).all()
    assert np.abs(found - axes).max() < 1e-6
    assert max(miss(a, lateral, frame(b, lateral)) for a, b in zip(found, axes, strict=True)) < 1e-12


@pytest.mark.slow
@pytest.mark.parametrize("lateral", (0.0, *LATERALS))
def test_right_angles_with_the_reference_at_the_same_axes(lateral: float) -> None:
    grid = np.array(list(product((-90.0, 0.0, 90.0, 180.0), repeat=6)))
    axes = grid if lateral == 0.0 else grid[np.random.default_rng(2).choice(len(grid), 300, replace=False)]
    robot = arm(lateral)
    positions, rotations, configurations, _ = robot.forward_batch(axes)
    found, statuses = robot.inverse_batch(positions, rotations, configurations, axes)
    assert (statuses == Status.OK).all()
    assert max(miss(a, lateral, frame(b, lateral)) for a, b in zip(found, axes, strict=True)) < 1e-10


@pytest.mark.slow
@pytest.mark.parametrize("lateral", LATERALS)
def test_every_solution_is_found(lateral: float) -> None:
    """The witness asks the same of more poses and machines, before anything is generated."""
    robot, rng = arm(lateral), np.random.default_rng(3)
    total = missed = 0
    for axes in rng.uniform(-180, 180, (8, 6)):
        wanted = frame(axes, lateral)
        solutions = ranked(robot, wanted, axes)
        assert all(miss(a, lateral, wanted) < 1e-12 for a in solutions)
        assert all(apart(a, b) > 1e-5 for a, b in combinations(solutions, 2))
        for root in all_roots(wanted, lateral, rng):
            total += 1
            missed += min((apart(root, a) for a in solutions), default=9.0) > 1e-5
    assert total > 42
    assert missed == 0


def ranked(robot: softkin.Mechanism, wanted: Array, reference: Array) -> list[Array]:
    slots = (s for s in robot.inverse_all(posed(wanted), reference) if s.axes is not None)
    return [np.array(axes) for s in slots for axes in (s.axes, *s.others)]


def apart(one: Array, other: Array) -> float:
    """How far two solutions are apart, whole turns not counted."""
    return float(np.abs(np.exp(1j * np.radians(one)) - np.exp(1j * np.radians(other))).max())


def test_the_solutions_of_a_slot_are_ranked_by_how_far_they_are() -> None:
    """Between a pose with two solutions on one branch: each is the first where the reference lies at it."""
    robot, here = arm(-35.0), np.array([-39.919, 90.278, 77.852, -212.045, 95.808, -183.919])
    wanted, configuration = frame(here, -35.0), robot.forward(here)[1][:4]
    (slot,) = (s for s in robot.inverse_all(posed(wanted), here) if s.configuration[:4] == configuration)
    assert slot.axes is not None
    assert np.abs(slot.axes - here).max() < 1e-9
    (there,) = slot.others
    assert robot.forward(there)[1][:4] == configuration
    assert apart(np.array(there), here) > 0.1
    (slot,) = (s for s in robot.inverse_all(posed(wanted), there) if s.configuration[:4] == configuration)
    assert slot.axes is not None
    assert np.abs(np.subtract(slot.axes, there)).max() < 1e-9
    assert [apart(np.array(a), here) < 1e-9 for a in slot.others] == [True]


def test_a_slot_holds_a_solution_once_in_singular_poses_too() -> None:
    robot, solved = arm(60.0), 0
    for axes in np.random.default_rng(4).choice((-90.0, 0.0, 90.0, 180.0), (30, 6)):
        for slot in robot.inverse_all(posed(frame(axes, 60.0)), axes):
            found = [slot.axes, *slot.others] if slot.axes is not None else []
            assert all(apart(np.array(a), np.array(b)) > 1e-5 for a, b in combinations(found, 2))
            solved += len(found)
    assert solved > 100


def test_a_solution_beyond_the_limits_gives_way_to_another_of_its_slot() -> None:
    here = np.array([-39.919, 90.278, 77.852, -212.045, 95.808, -183.919])
    robot = softkin.Ac6RZRYRYRXRYRZJ6Offset(**IRB_2400, j6_offset_x=-35.0, lower_a6=-120.0, upper_a6=120.0)
    wanted, configuration = frame(here, -35.0), robot.forward(here)[1][:4]
    (slot,) = (s for s in robot.inverse_all(posed(wanted), here) if s.configuration[:4] == configuration)
    assert slot.others == ()
    assert slot.axes is not None
    assert abs(slot.axes[5]) <= 120.0
    assert miss(np.array(slot.axes), -35.0, wanted) < 1e-12


def test_every_slot_says_its_own_configuration() -> None:
    robot = arm(60.0)
    for axes in np.random.default_rng(5).uniform(-180, 180, (10, 6)):
        solutions = robot.inverse_all(posed(frame(axes, 60.0)), axes)
        assert [s.configuration[:4] for s in solutions] == [t[::-1] for t in product((1, 2), repeat=4)]
        for solution in solutions:
            if solution.axes is not None:
                assert robot.forward(solution.axes)[1][:4] == solution.configuration[:4]


def test_without_the_offset_there_is_no_second_crossing() -> None:
    """Without the offset only the first branch of the crossing has a solution, and the refusal says so."""
    robot, axes = arm(0.0), (10.0, 20.0, 30.0, 40.0, 50.0, 60.0)
    reached, configuration = robot.forward(axes)
    assert refusal(robot.inverse, reached, (*configuration[:3], 2, *configuration[4:]), axes) is Status.UNREACHABLE


@pytest.mark.long
def test_a_path_in_one_configuration_is_followed() -> None:
    """Small steps with the reference at the previous result, in one configuration."""
    robot, rng = arm(60.0), np.random.default_rng(6)
    followed = 0
    while followed < 2:
        start = rng.uniform(-170, 170, 6)
        path = start + np.linspace(0.0, 1.0, 200)[:, None] * rng.uniform(-50, 50, 6)
        configurations = robot.forward_batch(path)[2][:, :4]
        if (configurations != configurations[0]).any():
            continue
        axes, held = start, (*(int(b) for b in configurations[0]), 0, 0, 0, 0, 0, 0)
        for expected in path:
            axes = np.array(robot.inverse(posed(frame(expected, 60.0)), held, axes))
            assert np.abs(axes - expected).max() < 1e-6
        followed += 1
