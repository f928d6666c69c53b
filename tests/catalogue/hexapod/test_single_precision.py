"""A platform whose commanded frame is a rotation to a few digits: the lengths of its legs are those of the repaired
frame."""

import numpy as np
import pytest
from softkin import Status

from tests.catalogue.hexapod.conftest import NAMES
from tests.catalogue.hexapod.machines import Machine, machines
from tests.catalogue.refusals import refusal
from tests.orthonormal import mirrored, repaired, slightly_off, too_far_off
from tests.text.controller import BAD_INPUT, OK
from tests.text.hexapod.blocks import controller


def test_the_legs_are_those_of_the_repaired_frame(machine: Machine) -> None:
    """The leg lengths for a rotation with a small error are those for the repaired rotation."""
    positions, turns = machine.poses(2, 10.0)
    for position, turn in zip(positions, turns, strict=True):
        matrices = list(slightly_off(turn))
        table, statuses = machine.robot.inverse_batch([position] * len(matrices), matrices)
        assert (statuses == Status.OK).all()
        for matrix, row in zip(matrices, table, strict=True):
            expected = machine.axes(position, repaired(matrix))
            assert machine.robot.inverse((position, matrix)) == pytest.approx(tuple(expected), rel=1e-12)
            assert row == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_the_block_does_the_same(name: str) -> None:
    machine, block = machines()[name], controller(name)
    positions, turns = machine.poses(2, 10.0)
    for matrix in slightly_off(turns[0]):
        status, axes = block.inverse(positions[0], matrix.tolist(), (), (0.0,) * 6)
        assert status == OK and axes == pytest.approx(tuple(machine.axes(positions[0], repaired(matrix))), rel=1e-12)
    for matrix in (*too_far_off(turns[0]), *mirrored(turns[0])):
        assert block.inverse(positions[0], matrix.tolist(), (), (0.0,) * 6)[0] == BAD_INPUT
        found = machine.robot.diagnose((positions[0], matrix))
        assert block.diagnose(positions[0], matrix.tolist(), (), (0.0,) * 6) == (found.reason, found.missing)


def test_a_start_is_repaired_too(machine: Machine) -> None:
    """Forward kinematics from a start in single precision ends where it ends from an exact one; a wrong start is
    refused.
    """
    positions, turns = machine.poses(2, 5.0)
    axes = machine.axes(positions[0], turns[0])
    for matrix in list(slightly_off(turns[0]))[:3]:
        frame, _ = machine.robot.forward(axes, (positions[0], matrix))
        assert np.abs(np.array(frame.rotation) - turns[0]).max() < 1e-9
        found = machine.robot.forward_batch([axes, axes], (positions[0], matrix))
        assert (found[3] == Status.OK).all() and np.abs(found[1] - turns[0]).max() < 1e-9
    for matrix in (*too_far_off(turns[0]), *mirrored(turns[0])):
        assert (
            refusal(machine.robot.forward, axes, (positions[0], matrix), says=r"columns not|right-handed")
            is Status.BAD_INPUT
        )
        assert (machine.robot.forward_batch([axes], (positions[0], matrix))[3] == Status.BAD_INPUT).all()
