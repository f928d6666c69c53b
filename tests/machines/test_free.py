"""Angles that a pose leaves free: they move to where the later joints have solutions, however far the reference is."""

from __future__ import annotations

import numpy as np
import pytest
from softkin import Status

from tests.machines.free_machines import FREED, FREED_SOLUTIONS
from tests.machines.grid import grid
from tests.machines.made import Array, Made, made
from tests.text.controller import OK


def far_from(machine: Made, axes: Array) -> Array:
    rng = np.random.default_rng(9)
    sizes = np.where(machine.closure.angles, 170.0, 0.5 * machine.reach)
    return np.asarray(axes + rng.uniform(-1.0, 1.0, axes.shape) * sizes)


@pytest.mark.slow
@pytest.mark.parametrize("name", FREED)
def test_no_pose_is_lost_from_a_far_reference(name: str) -> None:
    """Nor where the free angle is near its threshold: half of its digits are then in the pose."""
    machine = made(name)
    assert machine.built.evidence is not None and machine.built.evidence.inverted is not None
    assert machine.built.evidence.inverted.solutions == FREED_SOLUTIONS[name]
    axes = grid(machine)
    tiny = np.where(machine.closure.angles, 10.0 ** np.random.default_rng(1).uniform(-13.0, -3.0, axes.shape), 0.0)
    axes = np.concatenate([axes, axes[:300] + tiny[:300]])
    positions, rotations = machine.closure.poses(axes)
    slots, statuses = machine.robot.inverse_all_batch(positions, rotations, far_from(machine, axes))
    found = statuses == Status.OK
    assert found.any(axis=1).all()
    for slot in range(slots.shape[1]):
        rows = found[:, slot]
        assert machine.error(slots[rows, slot], positions[rows], rotations[rows]).max(initial=0.0) <= 1e-9


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
        for solution in robot.inverse_all(frame, near):
            status, found = controller.inverse(frame.position, frame.rotation, solution.configuration, near)
            assert (status == OK) == (solution.axes is not None)
            if solution.axes is not None:
                assert found[: len(row)] == pytest.approx(solution.axes, abs=1e-7 * max(1.0, machine.reach))
    assert singular > 20


STRETCHED = ("seven axes",)


@pytest.mark.parametrize("name", STRETCHED)
@pytest.mark.parametrize("bend", [0.0, 1e-9, 1e-7, 1e-6, 1e-5, 1e-3])
def test_an_arm_that_is_nearly_stretched_above_its_first_axis_keeps_its_rotation(name: str, bend: float) -> None:
    """Two folds at once: the arm's part across A1 may round to nothing while the wrist is off A1. Then A1 is free, and
    the commanded rotation is met all the same; the position within the root of the rounding."""
    machine = made(name)
    bent = next(k for k, j in enumerate(machine.mechanism.joints) if j.name == "A3")
    second, held = (next(k for k, j in enumerate(machine.mechanism.joints) if j.name == n) for n in ("A2", "E1"))
    joints = np.random.default_rng(3).uniform(-120.0, 120.0, (300, len(machine.mechanism.joints)))
    joints[:, bent] = bend
    joints[:, second] = np.tile([0.0, 180.0, 1e-9, 1e-7, 180.0 - 1e-6, 1e-4], 50)
    joints[:, held] = np.tile([90.0, -90.0, 0.0, 37.0, 90.0], 60)
    axes = machine.axes(joints)
    positions, rotations = machine.closure.poses(axes)
    references = axes + np.where(np.arange(axes.shape[1]) == held, 0.0, 80.0 * np.sign(joints))
    slots, statuses = machine.robot.inverse_all_batch(positions, rotations, references)
    assert (statuses == Status.OK).any(axis=1).all()
    for slot in range(slots.shape[1]):
        rows = statuses[:, slot] == Status.OK
        residual = np.abs(
            machine.closure.equations(machine.closure.joints(slots[rows, slot]), positions[rows], rotations[rows])
        )
        assert residual[:, 3:].max(initial=0.0) <= 1e-12
        assert residual[:, :3].max(initial=0.0) <= 3e-8 * machine.reach
