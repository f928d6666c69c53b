"""Tasks that command some of x, y and z alone: what is not commanded has to be where the machine has it."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from derive.description.mechanism import DescriptionError, Mechanism, Role, Task
from derive.description.validate import validate
from derive.drawing.drawing import drawing_of
from derive.emit.picture.view import axes_of
from derive.kinematics.build import build
from tests.catalogue.mounted.test_velocities import matrix_of, rows_of
from tests.catalogue.refusals import refusal
from tests.machines.both import forward_in_both, in_both, inverse_in_both
from tests.machines.grid import grid
from tests.machines.made import Array, made
from tests.machines.subset_machines import A1, LOOPS, SUBSETS
from tests.random_axes import random_axes
from tests.text.controller import OK, UNREACHABLE, Controller

UPRIGHT = ("arm in an upright plane", "arm on a wall that leans", "arm in an upright plane that points its tool")
ORDER = "it must be coordinates in the order x, y, z, or '' of a machine that only turns"
NO_TURN = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@cache
def loop(name: str) -> tuple[softkin.Mechanism, Controller]:
    """A loop in both languages, with offsets."""
    mechanism = validate(LOOPS[name])
    offsets = {f"offset_{j.key}": 11.0 * k - 20.0 for k, j in enumerate(mechanism.joints)}
    return in_both(mechanism, offsets)[1:]


def missed(mechanism: Mechanism, robot: softkin.Mechanism, axes: Array, position: Array) -> float:
    """How far the rods are from their lengths, the description read as it stands."""
    values = {p.name: p.nominal for p in mechanism.parameters} | dict(zip("xyz", position, strict=True))
    for joint, axis in zip(mechanism.joints, axes, strict=True):
        values[joint.symbol.name] = np.radians(axis - robot.parameters[joint.offset.name])
    named = {s: values[s.name] for e in mechanism.equations for s in e.free_symbols}
    return max(abs(float(e.subs(named))) for e in mechanism.equations) / 200.0**2


@pytest.mark.slow("upright")
@pytest.mark.parametrize("name", LOOPS)
def test_a_loop_closes_in_both_languages(name: str) -> None:
    robot, controller = loop(name)
    mechanism = LOOPS[name]
    closed = 0
    for axes in random_axes(robot, 60, np.random.default_rng(2), 180.0, 180.0):
        there = forward_in_both(controller, robot, axes.tolist(), 1.0)
        if there is None:
            continue
        closed, frame = closed + 1, there[0]
        assert frame.position[1] == 0.0
        slots = inverse_in_both(controller, robot, frame, axes.tolist())
        assert any(np.allclose(found, axes, rtol=0.0, atol=1e-6) for found in slots)
        for found in (axes, *slots):
            assert missed(mechanism, robot, np.array(found), np.array(frame.position)) < 1e-12
    assert closed > 20


@pytest.mark.slow("upright")
@pytest.mark.parametrize("name", LOOPS)
def test_the_jacobian_of_a_loop_is_that_of_its_differences(name: str) -> None:
    """Also where a refusal has decided the very value that the program gives."""
    robot, _ = loop(name)
    compared = 0
    for axes in random_axes(robot, 20, np.random.default_rng(4), 60.0, 60.0):
        try:
            given, rates = matrix_of(robot, axes), rows_of(robot, axes, 1.0)
        except KinematicsError:
            continue
        assert np.allclose(given, rates, atol=1e-3 * max(1.0, float(np.abs(given).max())))
        compared += 1
    assert compared > 5


@pytest.mark.slow("upright")
@pytest.mark.parametrize("name", LOOPS)
def test_a_loop_refuses_what_it_cannot_command(name: str) -> None:
    robot, controller = loop(name)
    axes = (65.0, 90.0)[: len(robot.AXES)]
    frame, configuration = robot.forward(axes)
    moved = (frame.position[0], 0.01, frame.position[2])
    with pytest.raises(KinematicsError, match=r"y: no axis moves it, and it is not where the machine has it"):
        robot.inverse((moved, NO_TURN), configuration, axes)
    assert controller.inverse(moved, NO_TURN, configuration, axes)[0] == UNREACHABLE


@pytest.mark.parametrize("name", SUBSETS)
@pytest.mark.parametrize("unit", [1.0, 1e-3])
def test_a_coordinate_that_no_axis_moves_must_be_where_the_machine_has_it(name: str, unit: float) -> None:
    """Within a millionth of the reach it is taken as met, and changes no axis; beyond it the pose is refused."""
    machine = made(name)
    lengths = {p.name: p.nominal * unit for p in machine.mechanism.parameters}
    robot = type(machine.robot)(**lengths)
    controller = machine.controller()
    assert controller.initialise(robot.parameters) == OK
    scale = sum(lengths[p.name] for p in machine.mechanism.parameters if p.role is Role.LENGTH) or 1.0
    axes = [40.0 if a else 50.0 * unit for a in machine.closure.angles]
    frame, configuration = robot.forward(axes)
    others = [k for k, c in enumerate("xyz") if c not in machine.mechanism.task.position]
    assert others
    for k in others:
        for way in (-1.0, 1.0):
            near, far = (
                tuple(v + way * part * scale * (i == k) for i, v in enumerate(frame.position)) for part in (9e-7, 2e-6)
            )
            assert robot.inverse((near, frame.rotation), configuration, axes) == pytest.approx(axes, abs=1e-9)
            assert controller.inverse(near, frame.rotation, configuration, axes)[0] == OK
            asked, says = (far, frame.rotation), f"{'xyz'[k]}: no axis moves it"
            assert refusal(robot.inverse, asked, configuration, axes, says=says) is Status.UNREACHABLE
            assert controller.inverse(far, frame.rotation, configuration, axes)[0] == UNREACHABLE
    for k in (k for k in range(3) if k not in others):  # what is commanded is met
        far = tuple(v - 0.02 * scale * (i == k) for i, v in enumerate(frame.position))
        found = robot.inverse((far, frame.rotation), configuration, axes)
        assert robot.forward(found)[0].position == pytest.approx(far, abs=1e-9 * scale)


@pytest.mark.parametrize("name", UPRIGHT[:2])
def test_a_point_beside_the_flange_moves_in_the_plane_of_the_machine(name: str) -> None:
    """A point in the plane through the flange is met; one across it is refused where it is commanded elsewhere."""
    robot = made(name).robot
    for axes in grid(made(name))[-12:].tolist():
        frame, _ = robot.forward(axes)
        across = np.array(frame.rotation)[1]
        arm = np.array([30.0, 20.0, -10.0])
        arm -= across * (across @ arm)
        point = np.array(frame.position) + np.array(frame.rotation) @ arm
        configuration = robot.configuration_offset(axes, arm)
        found = robot.inverse_offset(point, arm, configuration, axes)
        assert found == pytest.approx(axes, abs=1e-6)
        with pytest.raises(KinematicsError, match="y: no axis moves it"):
            robot.inverse_offset(point, arm + 0.1 * across, configuration, axes)


@pytest.mark.parametrize("name", [*UPRIGHT, "five-bar that stands upright"])
def test_an_upright_machine_is_drawn_from_the_front(name: str) -> None:
    drawing = drawing_of(build(validate({**SUBSETS, **LOOPS}[name])))
    assert drawing.plane == (0, 2)
    assert axes_of(drawing.plane).tolist() == [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]


@pytest.mark.parametrize("name", ["crane in a store whose fork turns", "lift that turns"])
def test_a_machine_that_turns_out_of_its_plane_is_drawn_in_space(name: str) -> None:
    assert drawing_of(build(validate(SUBSETS[name]))).plane is None


@pytest.mark.parametrize(
    ("position", "message"),
    [
        ("zx", "the task commands 'zx': " + ORDER),
        ("xx", "the task commands 'xx': " + ORDER),
        ("yz", "x is not commanded but the joints move it"),
    ],
)
def test_what_cannot_be_a_task_is_refused(position: str, message: str) -> None:
    with pytest.raises(DescriptionError) as refusal:
        build(validate(replace(SUBSETS["arm in an upright plane"], task=Task(position))))
    assert str(refusal.value) == message


def test_a_loop_must_command_what_it_moves() -> None:
    whole = LOOPS["five-bar that stands upright"]
    with pytest.raises(DescriptionError, match=r"the task commands 'z', and the loop moves x as well"):
        validate(replace(whole, task=Task("z"), joints=(A1,)))
