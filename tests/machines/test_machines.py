"""Every machine of the collection: no solution is wrong, none is lost, and both languages say the same."""

from collections.abc import Iterator, Sequence
from contextlib import suppress

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from tests.catalogue.refusals import refusal
from tests.machines.both import forward_in_both
from tests.machines.carried import CARRIED
from tests.machines.chain_machines import BENT_WRISTS
from tests.machines.collection import COSTLY, MACHINES, PARAMETERS_DECIDE, SOLUTIONS
from tests.machines.grid import grid, is_own, margins
from tests.machines.made import Array, Made, made
from tests.text.controller import OK

pytestmark = pytest.mark.slow(*COSTLY, *CARRIED)

EVERY = pytest.mark.parametrize("name", [*MACHINES, *CARRIED])
_CLOSED, _SAME, _NEAR_SINGULAR = 1e-9, 1e-7, 1e-3
_DOUBLE, _NEAR_DOUBLE = 1e-6, 1e-3


Answers = Iterator[tuple[tuple[int, ...], Sequence[float] | None]]


def own_grid(machine: Made) -> Array:
    """Poses of the grid at which the machine may stand; of a search, which takes long, each fifth."""
    axes = grid(machine)
    return axes[is_own(machine, axes)][:: 5 if machine.is_searched else 1]


def answers(machine: Made, frame: softkin.Frame, axes: list[float]) -> Answers:
    """The answer on every branch; of a search by calls for one branch, which a double root does not mislead."""
    for solution in machine.robot.inverse_all(frame, axes):
        found = solution.axes
        if machine.is_searched:
            with suppress(KinematicsError):
                found = None
                found = machine.robot.inverse(frame, solution.configuration, axes)
        yield solution.configuration, found


def are_same(machine: Made, one: Array, other: Array, frame: softkin.Frame) -> bool:
    """Whether two answers are one solution. Of a double root half of the digits are rounding: there both have to close.
    Beside one of a search the machine may move while its flange stands, and rounding decides which root is the nearest.
    """
    if np.allclose(one, other, rtol=0.0, atol=_SAME * machine.reach):
        return True
    is_double = any(min(np.abs(margins(machine, axes.tolist()))) < _DOUBLE for axes in (one, other))
    pose = np.array([frame.position]), np.array([frame.rotation])
    closes = all(machine.error(axes[None], *pose).max() <= _CLOSED for axes in (one, other))
    return is_double and closes and (machine.is_searched or bool(np.abs(one - other).max() <= _NEAR_DOUBLE))


@EVERY
def test_the_number_of_solutions(name: str) -> None:
    """The witness counts them; it has also compared every slot, the Jacobian and the margins with the closure."""
    evidence = made(name).built.evidence
    assert evidence is not None and evidence.inverted is not None
    assert evidence.inverted.solutions == SOLUTIONS.get(name, 4)  # in one assembly mode of a loop


@EVERY
def test_every_solution_closes_and_no_pose_is_lost(name: str) -> None:
    machine = made(name)
    axes = own_grid(machine)
    assert len(axes) > 20
    positions, rotations = machine.closure.poses(axes)
    slots, statuses = machine.robot.inverse_all_batch(positions, rotations, axes)
    found = statuses == Status.OK
    assert found.any(axis=1).all(), "a pose at which the machine stands is refused in every slot"
    assert machine.worst(slots, statuses, positions, rotations) <= _CLOSED


@EVERY
def test_an_answer_closes_from_any_reference(name: str) -> None:
    """A joint that is free where the machine is singular keeps its reference, and the others follow it."""
    machine = made(name)
    axes = own_grid(machine)[1::3]
    positions, rotations = machine.closure.poses(axes)
    held = [j in machine.mechanism.held_joints for j in machine.mechanism.joints]
    turned = np.random.default_rng(6).uniform(-1.0, 1.0, axes.shape) * np.where(machine.closure.angles, 170.0, 0.5)
    references = np.where(held, axes, axes + turned * np.where(machine.closure.angles, 1.0, machine.reach))
    slots, statuses = machine.robot.inverse_all_batch(positions, rotations, references)
    assert (statuses == Status.OK).any()
    assert machine.worst(slots, statuses, positions, rotations) <= _CLOSED


@EVERY
def test_the_way_back(name: str) -> None:
    """Away from singular poses the configuration that forward kinematics names leads to the same axes."""
    machine = made(name)
    axes = grid(machine)
    axes = axes[is_own(machine, axes)]
    regular = np.array([min(np.abs(margins(machine, row)), default=1.0) > _NEAR_SINGULAR for row in axes.tolist()])
    positions, rotations, configurations, statuses = machine.robot.forward_batch(axes[regular])
    assert (statuses == Status.OK).all() and regular.sum() > 20
    back, statuses = machine.robot.inverse_batch(positions, rotations, configurations, axes[regular])
    assert (statuses == Status.OK).all()
    assert np.abs(back - axes[regular]).max() <= 1e-6


@EVERY
def test_both_languages_say_the_same(name: str) -> None:
    machine = made(name)
    if not machine.has_block:
        assert len(machine.mechanism.joints) > 6
        return
    controller, robot = machine.controller(), machine.robot
    chosen = grid(machine)[:: 30 if machine.is_searched else 5]
    for axes in chosen.tolist():
        there = forward_in_both(controller, robot, axes, machine.reach)
        assert there is not None or not is_own(machine, np.array([axes]))[0]
        frame = there[0] if there is not None else None
        for configuration, own in answers(machine, frame, axes) if frame is not None else ():
            status, found = controller.inverse(frame.position, frame.rotation, configuration, axes)
            assert (status == OK) == (own is not None)
            if own is not None:
                assert are_same(machine, np.array(found[: len(axes)]), np.array(own), frame)


@EVERY
def test_garbage_ends_in_a_status(name: str) -> None:
    machine = made(name)
    count, axes = len(machine.mechanism.joints), grid(machine)
    frame, _ = machine.robot.forward(axes[is_own(machine, axes)][-1])
    controller = machine.controller() if machine.has_block else None
    for garbage in (float("nan"), float("inf"), -float("inf"), 1e300):
        turned = ((garbage, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
        wrong = [((garbage, 0.0, 0.0), frame.rotation)]
        wrong += [(frame.position, turned)] if machine.robot.READS_ROTATION else []
        with pytest.raises(KinematicsError):
            machine.robot.forward([garbage] * count)
        assert controller is None or controller.forward([garbage] * count)[0] != OK
        for pose in wrong:
            with pytest.raises(KinematicsError):
                machine.robot.inverse(pose, None, [0.0] * count)
            assert controller is None or controller.inverse(*pose, (), [0.0] * count)[0] != OK


@pytest.mark.parametrize("name", BENT_WRISTS)
@pytest.mark.parametrize("degrees", [1e-3, 1e-5, 1e-7, 1e-9, 0.0])
def test_a_leaning_axis_keeps_its_digits_near_zero(name: str, degrees: float) -> None:
    """The entry of the rotation that tells A5 has lost them: it is one less a multiple of the squared angle."""
    machine = made(name)
    bent = next(k for k, joint in enumerate(machine.mechanism.joints) if joint.name == "A5")
    axes = grid(machine)[-50:]
    axes[:, bent] = machine.closure.offsets[bent] + degrees
    positions, rotations = machine.closure.poses(axes)
    slots, statuses = machine.robot.inverse_all_batch(positions, rotations, axes)
    away = np.where(statuses == Status.OK, np.abs(slots[:, :, bent] - axes[:, None, bent]), np.inf)
    assert away.min(axis=1).max() <= 1e-11
    assert machine.worst(slots, statuses, positions, rotations) <= 1e-12


def test_a_flange_that_bars_keep_level_turns_about_one_axis() -> None:
    """What an orientation kinematics behind it is told: the rotations of its chain cancel but for those about z."""
    robot = made("palletizer with both motors at the base").robot
    image = robot.orientation_image()
    assert (robot.FREEDOM, image.flange_axis, image.base_axis) == ("one", (0.0, 0.0, 1.0), (0.0, 0.0, 1.0))


@pytest.mark.parametrize(("name", "lean"), [("skewed rail", 89.99999999999), ("rails in a wedge", 1e-12)])
def test_parallel_slides_are_refused_when_the_machine_is_set_up(name: str, lean: float) -> None:
    machine = made(name)
    assert len(PARAMETERS_DECIDE) == 2
    robot = type(machine.robot)
    assert isinstance(robot(lean=45.0), softkin.Mechanism)
    assert refusal(robot, lean=lean, says=r"must not be 0: parallel slides") is Status.NOT_INITIALIZED
    controller = machine.controller()
    assert controller.initialise({**machine.robot.parameters, "lean": lean}) != OK


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_a_radius_that_an_arm_swings_has_margins_without_a_unit(unit: float) -> None:
    """The polar radius is the arm times a sine: its margin is the sine, and its angle is free at 1e-11 of the arm."""
    robot = type(made("jib that swings on a hoist").robot)(link_1=300.0 * unit)
    for angle in (90.0, 30.0, -0.01):
        found = robot.singularity((20.0, angle, 5.0 * unit)).margins
        assert found["side"] == pytest.approx(np.sin(np.radians(angle)), rel=1e-9)
    frame, configuration = robot.forward((20.0, 1e-6, 5.0 * unit))
    assert robot.inverse(frame, configuration, (0.0, 0.0, 0.0)) == pytest.approx((20.0, 1e-6, 5.0 * unit), abs=1e-6)


def test_a_flange_that_turns_about_another_axis_than_z() -> None:
    """The image of its orientations: one of them, and the axis of its turn in both frames, at any axis values."""
    machine = made("boom on a carriage")
    image = machine.robot.orientation_image()
    lean = np.radians(machine.robot.parameters["lean"])
    assert image.freedom == "one"
    assert np.allclose(image.base_axis, (-np.sin(lean), np.cos(lean), 0.0), rtol=0.0, atol=1e-15)
    for row in grid(machine)[::40]:
        rotation = np.array(machine.robot.forward(row)[0].rotation)
        assert np.allclose(rotation @ image.flange_axis, image.base_axis, rtol=0.0, atol=1e-14)
    zero = np.array(image.rotation)
    assert np.allclose(zero @ image.flange_axis, image.base_axis, rtol=0.0, atol=1e-15)
