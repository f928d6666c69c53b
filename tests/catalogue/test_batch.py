"""Batches: row by row what the scalar calls do, and nothing happens between the rows."""

import numpy as np
import pytest
import softkin
from numpy.random import Generator
from softkin import KinematicsError, Status, _batch

from tests.catalogue.closure import Array
from tests.catalogue.machines import Machine, few
from tests.catalogue.references import held_at
from tests.catalogue.refusals import refusal

ROWS = 100


def mixed(machine: Machine, rng: Generator) -> tuple[Array, Array, Array, Array]:
    """Poses, some out of reach, some with a frame that is none; configurations of every kind; any references."""
    axes = machine.draw(ROWS, rng)
    positions, rotations = machine.closure.poses(axes)
    positions[::7] *= 1.4
    positions[::13, 0] = np.nan
    rotations[::17] *= 2.0
    robot = machine.robot
    branches = rng.integers(0, 4, (ROWS, robot.BRANCHES))
    branches[::11] = 4
    shape = (ROWS, len(robot.PERIOD_AXES))
    periods = np.where(rng.random(shape) < 0.5, 0, rng.integers(-2, 4, shape))
    references = rng.uniform(-500, 500, axes.shape)
    references[::19, 0] = np.inf
    return positions, rotations, np.hstack([branches, periods]), references


def test_mixed_rows_are_the_scalar_calls(machines: tuple[Machine, ...]) -> None:
    for number, machine in enumerate(few(machines)):
        positions, rotations, configurations, references = mixed(machine, np.random.default_rng(number))
        found, statuses = machine.robot.inverse_batch(positions, rotations, configurations, references)
        assert found.shape == (ROWS, len(machine.mechanism.joints)) and statuses.dtype == np.uint8
        for row in range(ROWS):
            frame = positions[row], rotations[row]
            try:
                scalar = machine.robot.inverse(frame, configurations[row].tolist(), references[row])
            except KinematicsError as error:
                assert statuses[row] == error.status
                assert np.isnan(found[row]).all()
            else:
                assert statuses[row] == Status.OK
                assert np.abs(np.subtract(scalar, found[row])).max() < 1e-9
        assert {int(Status.OK), int(Status.BAD_INPUT)} <= set(statuses.tolist())


def test_a_batch_is_its_parts(machines: tuple[Machine, ...]) -> None:
    """Longer than a chunk, and bit for bit what each row gives alone."""
    for machine in machines[1:2]:
        axes = machine.draw(200, np.random.default_rng(1))
        many = np.tile(axes, (101, 1))
        forward = machine.robot.forward_batch(many)
        inverse = machine.robot.inverse_batch(forward[0], forward[1], forward[2], many)
        for whole, part in zip(forward, machine.robot.forward_batch(axes), strict=True):
            assert (whole == np.tile(part, (101,) + (1,) * (part.ndim - 1))).all()
        for whole, part in zip(inverse, machine.robot.inverse_batch(*forward[:3], many)[:2], strict=True):
            assert (whole[:200] == part[-200:]).all()
        assert (inverse[1] == Status.OK).all()


def test_few_singular_rows_among_many_are_what_they_are_alone() -> None:
    """Rows whose lost digits are restored by steps wait until all others are computed; among four they need not."""
    robot = softkin.Ac6ThreeParallel(d1=89.159, a2=-425.0, a3=-392.25, d4=109.15, d5=94.65, d6=82.3)
    rng = np.random.default_rng(3)
    axes = rng.uniform(-170.0, 170.0, (2000, 6))
    axes[::100] = 90.0 * rng.integers(-2, 3, (20, 6)) + 1e-5 * rng.uniform(-1.0, 1.0, (20, 6))
    positions, rotations = robot.forward_batch(axes)[:2]
    together = robot.inverse_all_batch(positions, rotations)
    parts = [robot.inverse_all_batch(positions[k : k + 4], rotations[k : k + 4]) for k in range(0, 2000, 4)]
    for whole, some in zip(together, zip(*parts, strict=True), strict=True):
        assert np.array_equal(whole, np.concatenate(some), equal_nan=whole.dtype == float)


def test_no_rows(machines: tuple[Machine, ...]) -> None:
    robot = machines[0].robot
    width, size = len(robot.AXES), len(robot.CONFIGURATION)
    shapes = [part.shape for part in robot.forward_batch(np.zeros((0, width)))]
    assert shapes == [(0, 3), (0, 3, 3), (0, size), (0,)]
    for configurations in (None, np.zeros((0, size), int), [0] * size):
        for references in (held_at(robot, np.zeros((0, width))), np.zeros((0, width)), [0.0] * width):
            found = robot.inverse_batch(np.zeros((0, 3)), np.zeros((0, 3, 3)), configurations, references)
            assert [part.shape for part in found] == [(0, width), (0,)]


def test_one_row_may_stand_for_all(machines: tuple[Machine, ...]) -> None:
    for machine in machines[:2]:
        axes = machine.draw(30, np.random.default_rng(2))
        axes = held_at(machine.robot, np.tile(axes[0], (30, 1)), axes)
        positions, rotations = machine.closure.poses(axes)
        robot = machine.changed(check_limits=False)
        configuration, reference = robot.forward(axes[0])[1], axes[0]
        one = robot.inverse_batch(positions, rotations, configuration, reference)
        each = robot.inverse_batch(positions, rotations, [configuration] * 30, np.tile(reference, (30, 1)))
        assert one[1][0] == Status.OK
        assert machine.answers(one[1]).any()
        assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip(one, each, strict=True))
        lists = robot.inverse_batch(positions.tolist(), rotations.tolist(), list(configuration), reference.tolist())
        assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip(one, lists, strict=True))


@pytest.mark.long("P2C", "Pos_RRR")
def test_one_configuration_may_leave_branches_open_in_many_rows(
    machines: tuple[Machine, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """In several pieces, whose sizes depend on how many branches are open: as where every row has its own."""
    monkeypatch.setattr(_batch, "EVERY_SLOT", 24)
    for machine in machines[:2]:
        rng = np.random.default_rng(5)
        axes = machine.draw(40, rng)
        positions, rotations, _, _ = machine.robot.forward_batch(axes)
        for _ in range(2):
            one = np.zeros(len(machine.robot.CONFIGURATION), int)
            one[: machine.robot.BRANCHES] = rng.integers(0, 4, machine.robot.BRANCHES)
            for configuration in (one, one * 0):
                rows = np.tile(configuration, (40, 1))
                rows[0] = 1  # the rows then differ
                found, statuses = machine.robot.inverse_batch(positions, rotations, configuration, axes)
                own, expected = machine.robot.inverse_batch(positions, rotations, rows, axes)
                assert (statuses[1:] == expected[1:]).all()
                assert np.array_equal(found[1:], own[1:], equal_nan=True)
                answered = statuses == Status.OK
                assert answered.all() or configuration.any() or not machine.branches_meet_together


def test_inputs_are_left_alone(machines: tuple[Machine, ...]) -> None:
    machine = machines[1]
    axes = machine.draw(30, np.random.default_rng(3))
    positions, rotations, configurations, _ = machine.robot.forward_batch(axes)
    given = (positions, rotations, configurations, axes)
    copies = [part.copy() for part in given]
    machine.robot.inverse_batch(*given)
    for part, copy in zip(given, copies, strict=True):
        assert (part == copy).all()


def wrong_calls(robot: softkin.Mechanism) -> list[tuple[object, ...]]:
    """Arguments of `inverse_batch` of a wrong shape or type, one at a time."""
    width, size = len(robot.AXES), len(robot.CONFIGURATION)
    positions, rotations = np.zeros((5, 3)), np.tile(np.eye(3), (5, 1, 1))
    wrong_positions: list[object] = [np.zeros(3), np.zeros((5, 2)), np.zeros((5, 4)), "abc", None]
    wrong_positions += [[[1, 2, 3], [1, 2]], [["a"] * 3] * 5]
    wrong_rotations: list[object] = [np.zeros((4, 3, 3)), np.zeros((5, 9)), np.zeros((5, 3, 2)), "abc", [["a"] * 3] * 3]
    wrong_configurations = [
        np.zeros((4, size), int),
        np.zeros((5, size + 1), int),
        [0] * (size + 1),
        "abc",
        [[None] * size] * 5,
    ]
    wrong_references = [
        np.zeros((4, width)),
        np.zeros((5, width + 1)),
        np.zeros(width + 1),
        5.0,
        "abc",
        [["a"] * width] * 5,
    ]
    calls: list[tuple[object, ...]] = [(wrong, rotations) for wrong in wrong_positions]
    if robot.READS_ROTATION:
        calls += [(positions, wrong) for wrong in wrong_rotations]
    calls += [(positions, rotations, wrong) for wrong in wrong_configurations[: 5 if size else 4]]
    calls += [(positions, rotations, np.zeros((5, size)) + 0.5)] if size else []
    return calls + [(positions, rotations, None, wrong) for wrong in wrong_references]


def test_wrong_shapes_and_types(machines: tuple[Machine, ...]) -> None:
    robot = machines[0].robot
    for arguments in wrong_calls(robot):
        assert refusal(robot.inverse_batch, *arguments) is Status.BAD_INPUT
    width = len(robot.AXES)
    shapes = ((width,), (5, width + 1), (5, width, 1))
    for axes in (*map(np.zeros, shapes), "abc", None, [["a"] * width], [[1.0], [1.0, 2.0]], 1j):
        assert refusal(robot.forward_batch, axes) is Status.BAD_INPUT


def test_several_threads_may_share_a_robot(machines: tuple[Machine, ...]) -> None:
    from concurrent.futures import ThreadPoolExecutor

    machine = machines[1]
    axes = machine.draw(1000, np.random.default_rng(4))
    expected = machine.robot.forward_batch(axes)[0]
    with ThreadPoolExecutor(4) as pool:
        for found in pool.map(lambda _: machine.robot.forward_batch(axes)[0], range(8)):
            assert (found == expected).all()
