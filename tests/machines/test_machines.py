"""Every machine of the collection: no solution is wrong, none is lost, and both languages say the same."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from tests.machines import angle_machines
from tests.machines.chain_machines import BENT_WRISTS, CHAIN_SOLUTIONS
from tests.machines.collection import COSTLY, MACHINES, PARAMETERS_DECIDE
from tests.machines.grid import grid, is_own, margins
from tests.machines.made import Array, Made, made
from tests.machines.subset_machines import SUBSET_SOLUTIONS
from tests.machines.task_machines import TASK_SOLUTIONS
from tests.text.controller import OK

pytestmark = pytest.mark.slow(*COSTLY)

EVERY = pytest.mark.parametrize("name", MACHINES)
EXPECTED = {
    "arm beside the rail that it turns about": 4,
    "telescope on a rocker that points the tool": 4,
    "boom on a carriage": 2,
    "slide on a rocker": 4,
    "slide on a swivel": 2,
    "ram that a head may lay flat": 2,
    "slide that turns on a slide": 1,
    "SCARA below a ceiling": 2,
    "SCARA by its table": 2,
    "telescope in front of an arm": 2,
    "telescope in front of an arm that may turn inside out": 2,
    "telescope that a tilting arm points": 4,
    "trunnion": 2,
    "table with B and C": 2,
    "table with an oblique axis": 2,
    "oblique slides on a table": 1,
    "telescope beside its column": 1,
    "telescope that may turn inside out": 2,
    "telescope above its shoulder": 2,
    "skewed rail": 1,
    "rails in a wedge": 1,
    "rail and arm with two links": 2,
    "SCARA on a rail": 2,
    "arm on a track": 8,
    "seven axes": 8,
    "arm in metres with a held turn of its upper arm": 4,
    "seven axes beside each other, the first held": 8,
    "arm whose elbow bends one way": 2,
    "SCARA that bends to the left alone": 1,
    "numbers for lengths": 2,
    "flange that turns against two axes": 4,
    "jib that swings on a hoist": 4,
    "jib with a number for its length": 4,
    "palletizer with both motors at the base": 4,
    "arm whose wrist goes sideways": 8,
    "arm in metres with a bent wrist and a shoulder beside its axis": 8,
    **angle_machines.EXPECTED,
    **TASK_SOLUTIONS,
    **SUBSET_SOLUTIONS,
    "three axes that miss each other, the elbow across": 4,
    "three axes that miss each other, each across the next": 4,
    **CHAIN_SOLUTIONS,
}
"""The largest number of solutions, as a search of the closure from many starts finds them."""
_CLOSED, _SAME, _NEAR_SINGULAR = 1e-9, 1e-7, 1e-3
_DOUBLE, _NEAR_DOUBLE = 1e-6, 1e-3


def is_searched(machine: Made) -> bool:
    """Whether its inverse is a search."""
    return hasattr(machine.robot, "SIDES")


Answers = Iterator[tuple[tuple[int, ...], Sequence[float] | None]]


def own_grid(machine: Made) -> Array:
    """Poses of the grid at which the machine may stand; of a search, which takes long, each third."""
    axes = grid(machine)
    return axes[is_own(machine, axes)][:: 3 if is_searched(machine) else 1]


def answers(machine: Made, frame: softkin.Frame, axes: list[float]) -> Answers:
    """The answer on every branch. A search sorts what it finds for all branches by the signs at the root, and a double
    root has none; a call for one branch does not.
    """
    for solution in machine.robot.inverse_all(frame, axes):
        found = solution.axes
        if is_searched(machine):
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
    return is_double and closes and (is_searched(machine) or bool(np.abs(one - other).max() <= _NEAR_DOUBLE))


@EVERY
def test_the_number_of_solutions(name: str) -> None:
    """The witness counts them; it has also compared every slot, the Jacobian and the margins with the closure."""
    evidence = made(name).built.evidence
    assert evidence is not None and evidence.inverted is not None
    assert evidence.inverted.solutions == EXPECTED[name]


@EVERY
def test_every_solution_closes_and_no_pose_is_lost(name: str) -> None:
    machine = made(name)
    axes = own_grid(machine)
    assert len(axes) > 50
    positions, rotations = machine.closure.poses(axes)
    slots, statuses = machine.robot.inverse_all_batch(positions, rotations, axes)
    found = statuses == Status.OK
    assert found.any(axis=1).all(), "a pose at which the machine stands is refused in every slot"
    for slot in range(slots.shape[1]):
        rows = found[:, slot]
        assert machine.error(slots[rows, slot], positions[rows], rotations[rows]).max(initial=0.0) <= _CLOSED


@EVERY
def test_an_answer_closes_from_any_reference(name: str) -> None:
    """A joint that is free where the machine is singular keeps its reference, and the others follow it."""
    machine = made(name)
    axes = own_grid(machine)
    positions, rotations = machine.closure.poses(axes)
    held = [j in machine.mechanism.held_joints for j in machine.mechanism.joints]
    turned = np.random.default_rng(6).uniform(-1.0, 1.0, axes.shape) * np.where(machine.closure.angles, 170.0, 0.5)
    references = np.where(held, axes, axes + turned * np.where(machine.closure.angles, 1.0, machine.reach))
    slots, statuses = machine.robot.inverse_all_batch(positions, rotations, references)
    assert (statuses == Status.OK).any()
    for slot in range(slots.shape[1]):
        rows = statuses[:, slot] == Status.OK
        assert machine.error(slots[rows, slot], positions[rows], rotations[rows]).max(initial=0.0) <= _CLOSED


@EVERY
def test_the_way_back(name: str) -> None:
    """Away from singular poses the configuration that forward kinematics names leads to the same axes."""
    machine = made(name)
    axes = grid(machine)
    axes = axes[is_own(machine, axes)]
    regular = np.array([min(np.abs(margins(machine, row)), default=1.0) > _NEAR_SINGULAR for row in axes.tolist()])
    positions, rotations, configurations, statuses = machine.robot.forward_batch(axes[regular])
    assert (statuses == Status.OK).all() and regular.sum() > 50
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
    chosen = grid(machine)[:: 20 if is_searched(machine) else 5]
    for axes in chosen.tolist():
        status, answer = controller.forward(axes)
        if status != OK:
            assert not is_own(machine, np.array([axes]))[0]
            with pytest.raises(KinematicsError):
                robot.forward(axes)
            continue
        (frame, configuration), (position, rows, data) = robot.forward(axes), answer
        assert np.allclose(position, frame.position, rtol=0.0, atol=1e-9 * machine.reach)
        assert np.allclose(rows, frame.rotation, rtol=0.0, atol=1e-12)
        assert data[: len(robot.CONFIGURATION)] == tuple(byte % 256 for byte in configuration)
        for configuration, own in answers(machine, frame, axes):
            status, found = controller.inverse(frame.position, frame.rotation, configuration, axes)
            assert (status == OK) == (own is not None)
            if own is not None:
                assert are_same(machine, np.array(found[: len(axes)]), np.array(own), frame)


@EVERY
@pytest.mark.parametrize("garbage", [float("nan"), float("inf"), -float("inf"), 1e300])
def test_garbage_ends_in_a_status(name: str, garbage: float) -> None:
    machine = made(name)
    count = len(machine.mechanism.joints)
    with pytest.raises(KinematicsError):
        machine.robot.forward([garbage] * count)
    axes = grid(machine)
    frame, _ = machine.robot.forward(axes[is_own(machine, axes)][-1])
    with pytest.raises(KinematicsError):
        machine.robot.inverse(((garbage, 0.0, 0.0), frame.rotation), None, [0.0] * count)
    if machine.has_block:
        controller = machine.controller()
        assert controller.forward([garbage] * count)[0] != OK
        assert controller.inverse((garbage, 0.0, 0.0), frame.rotation, (), [0.0] * count)[0] != OK


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
    for slot in range(slots.shape[1]):
        rows = statuses[:, slot] == Status.OK
        assert machine.error(slots[rows, slot], positions[rows], rotations[rows]).max(initial=0.0) <= 1e-12


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
    with pytest.raises(KinematicsError, match=r"must not vanish: slides would be parallel") as refusal:
        robot(lean=lean)
    assert refusal.value.status is Status.NOT_INITIALIZED
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
