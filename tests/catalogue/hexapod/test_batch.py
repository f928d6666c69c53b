"""A batch answers as the calls one by one do, to the last digit and in every status."""

from collections.abc import Callable

import numpy as np
import pytest
from softkin import Frame, KinematicsError, Status

from tests.catalogue.hexapod.machines import Array, Machine


def one_by_one(call: Callable[[int], tuple[float, ...]], count: int, width: int) -> tuple[Array, list[Status]]:
    """Rows and statuses of single calls; not-a-number where one refuses."""
    rows, statuses = np.full((count, width), np.nan), []
    for i in range(count):
        try:
            rows[i] = call(i)
            statuses.append(Status.OK)
        except KinematicsError as refused:
            statuses.append(refused.status)
    return rows, statuses


def flat(frame: Frame) -> tuple[float, ...]:
    """Position and rotation in a row."""
    return (*frame.position, *(value for row in frame.rotation for value in row))


def spoiled(values: Array, *wrong: float) -> Array:
    """The rows, with something in each of the first ones that is no number."""
    values = values.copy()
    for i, value in enumerate(wrong):
        values.reshape(len(values), -1)[i, i % 3] = value
    return values


@pytest.mark.long
def test_forward(machine: Machine) -> None:
    far = machine.axes(*machine.poses(150, turn=150.0))
    axes = spoiled(np.concatenate([far, far[:10] * 0.1, machine.axes(*machine.poses(40))]), np.nan, np.inf, -2e9)
    robot = machine.robot
    rows, statuses = one_by_one(lambda i: flat(robot.forward(axes[i])[0]), len(axes), 12)
    position, turn, _, status = robot.forward_batch(axes)
    assert status.tolist() == statuses and set(statuses) == {Status.OK, Status.IMPOSSIBLE, Status.BAD_INPUT}
    assert np.array_equal(np.concatenate([position, turn.reshape(-1, 9)], axis=1), rows, equal_nan=True)


def test_forward_from_starts(machine: Machine) -> None:
    positions, turns = machine.poses(120, turn=60.0)
    axes = spoiled(machine.axes(positions, turns), np.nan)
    positions, turns = np.roll(positions, 1, axis=0), spoiled(np.roll(turns, 1, axis=0), 0.3, np.nan, np.inf, 1e200)
    robot = machine.robot
    rows, statuses = one_by_one(
        lambda i: flat(robot.forward(axes[i], start=(positions[i], turns[i]))[0]), len(axes), 12
    )
    position, turn, _, status = robot.forward_batch(axes, (positions, turns))
    assert status.tolist() == statuses and {Status.OK, Status.BAD_INPUT} <= set(statuses)
    assert np.array_equal(np.concatenate([position, turn.reshape(-1, 9)], axis=1), rows, equal_nan=True)


def test_inverse(machine: Machine) -> None:
    positions, turns = machine.poses(200, turn=110.0)
    positions, turns = spoiled(positions, np.nan, 2e9, np.inf), np.roll(spoiled(turns, 2.0, np.nan, 1e300), 5, axis=0)
    robot = machine.robot
    rows, statuses = one_by_one(lambda i: robot.inverse((positions[i], turns[i])), len(positions), 6)
    axes, status = robot.inverse_batch(positions, turns)
    assert status.tolist() == statuses and set(statuses) == {Status.OK, Status.UNREACHABLE, Status.BAD_INPUT}
    assert np.array_equal(axes, rows, equal_nan=True)
