"""A joint that is held keeps the value of the reference: it is needed, tested, and left out of the margins."""

import numpy as np
import pytest
import softkin
from softkin import KinematicsError

from tests.machines.collection import COSTLY
from tests.machines.grid import grid, margins
from tests.machines.held_machines import HELD
from tests.machines.made import made

pytestmark = pytest.mark.slow(*COSTLY)

_CLOSED = 1e-9


@pytest.mark.parametrize("name", HELD)
def test_a_held_joint_keeps_the_value_of_the_reference(name: str) -> None:
    machine = made(name)
    held = [machine.mechanism.joints.index(j) for j in machine.mechanism.held_joints]
    assert machine.robot.HELD == tuple(held) != ()
    axes = grid(machine)[-20:]
    positions, rotations = machine.closure.poses(axes)
    answered = 0
    for own, position, rotation in zip(axes, positions, rotations, strict=True):
        for turn in (0.0, 5.0):
            reference = own.copy()
            reference[held] += turn
            for solution in machine.robot.inverse_all((position, rotation), reference):
                if solution.axes is not None:
                    answered += 1
                    assert [solution.axes[i] for i in held] == [reference[i] for i in held]
                    error = machine.error(np.array([solution.axes]), position[None], rotation[None])
                    assert error.max() <= _CLOSED
    assert answered >= 2 * len(axes)


@pytest.mark.parametrize("name", HELD)
def test_a_held_joint_needs_a_reference(name: str) -> None:
    robot = made(name).robot
    frame, _ = robot.forward(made(name).axes(np.full((1, len(robot.AXES)), 0.4))[0])
    calls = (
        lambda: robot.inverse(frame),
        lambda: robot.inverse_all(frame),
        lambda: robot.inverse_batch([frame.position], [frame.rotation]),
        lambda: robot.inverse_all_batch([frame.position], [frame.rotation]),
    )
    for call in calls:
        with pytest.raises(KinematicsError, match="a reference is needed: it holds the value of"):
            call()
    assert set(robot.branches((frame.position, frame.rotation))) == {None}


@pytest.mark.parametrize("name", HELD)
def test_the_jacobian_has_a_column_for_every_axis_and_the_margins_leave_the_held_ones_out(name: str) -> None:
    """Where the margins vanish the axes that are solved for cannot move the flange, whatever the held ones can."""
    machine = made(name)
    solved = [j not in machine.mechanism.held_joints for j in machine.mechanism.joints]
    ratios = []
    for axes in grid(machine)[-40:].tolist():
        jacobian = np.array(machine.robot.jacobian(axes))
        expected = machine.closure.jacobian(np.array([axes]), machine.closure.poses(np.array([axes]))[0])[0]
        assert np.allclose(jacobian, expected, rtol=1e-9, atol=1e-9 * machine.reach)
        ratios.append(abs(np.linalg.det(jacobian[:, solved])) / np.prod(np.abs(margins(machine, axes))))
    assert np.ptp(np.log(ratios)) <= 1e-6


def test_a_machine_with_a_held_joint_carries_an_orientation_kinematics() -> None:
    """A coupling holds what its position kinematics holds, asks for a reference, and reaches the frame from another."""
    robot = made("SCARA on a rail").robot
    coupled = softkin.Coupled(robot, softkin.Tool(tool_z=-50.0))
    axes = np.array([30.0, 20.0, 40.0, 10.0, 70.0])
    frame, configuration = coupled.forward(axes)
    assert coupled.HELD == robot.HELD == (0,)
    assert np.allclose(coupled.inverse(frame, configuration, axes), axes, rtol=0.0, atol=1e-9)
    with pytest.raises(KinematicsError, match="a reference is needed: it holds the value of X"):
        coupled.inverse(frame, configuration)
    elsewhere = coupled.inverse(frame, configuration, axes + np.array([50.0, 0.0, 0.0, 0.0, 0.0]))
    assert elsewhere[0] == 80.0
    assert np.allclose(coupled.forward(elsewhere)[0].position, frame.position, rtol=0.0, atol=1e-9)


def test_the_limits_of_a_held_joint_refuse_the_reference() -> None:
    """A held axis is not moved inside its limits: the pose is refused, and the refusal names the axis."""
    robot = type(made("SCARA on a rail").robot)(**{**made("SCARA on a rail").robot.parameters, "upper_x": 50.0})
    frame, configuration = robot.forward((30.0, 20.0, 40.0, 10.0, 70.0))
    with pytest.raises(KinematicsError, match=r"X: above its upper limit, missing 30\.0 u"):
        robot.inverse(frame, configuration, (80.0, 20.0, 40.0, 10.0, 70.0))
