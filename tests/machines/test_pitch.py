"""Arms that follow the pitch, and the roll, of the commanded rotation: what of it they reach is the nearest."""

from dataclasses import replace

import numpy as np
import pytest
from softkin import Frame, KinematicsError, Status

from derive.description.mechanism import DescriptionError, Mechanism, Task, Turning
from derive.frames import Rx, Ry, Rz, Tx, Ty, Tz
from derive.kinematics.build import build
from derive.solver.unsolved import Unsolved
from tests.catalogue.mounted.machines import BASE, matrices
from tests.catalogue.refusals import refusal
from tests.machines.made import Array, Made, made
from tests.machines.task_machines import (
    A1,
    A2,
    A3,
    A4,
    A5,
    L2,
    L3,
    L4,
    TASK_MACHINES,
    WITH_PITCH,
    WITH_PITCH_AND_ROLL,
    B,
    X,
    Y,
    Z,
)
from tests.orthonormal import random_rotations
from tests.text.controller import OK

FOLLOWING = {**WITH_PITCH, **WITH_PITCH_AND_ROLL}
EVERY = pytest.mark.parametrize("name", FOLLOWING)


def within_reach(machine: Made, count: int) -> Array:
    rng = np.random.default_rng(5)
    sizes = np.where(machine.closure.angles, 150.0, 0.9)
    return machine.axes(rng.uniform(-1.0, 1.0, (count, len(sizes))) * sizes)


def tool_of(mechanism: Mechanism) -> Array:
    """The direction that the pitch moves, in the frame of the flange."""
    return np.array([1.0, 0.0, 0.0] if mechanism.name == "Kin_FiveAlongX" else [0.0, 0.0, 1.0])


@EVERY
def test_no_other_direction_of_the_arm_is_nearer_to_the_commanded_one(name: str) -> None:
    """A rotation that the machine cannot reach: of all turns of the pitch and the roll none comes nearer."""
    machine = made(name)
    axes, tool = within_reach(machine, 12), tool_of(machine.mechanism)
    positions, _ = machine.closure.poses(axes)
    around = np.linspace(-180.0, 180.0, 721)
    compared = 0
    for reference, position, commanded in zip(axes, positions, random_rotations(len(axes), 3), strict=True):
        for solution in machine.robot.inverse_all((position, commanded), reference):
            if solution.axes is None:
                continue
            row = np.array([solution.axes])
            reached, flange = machine.closure.poses(row)
            assert np.abs(reached[0] - position).max() <= 1e-9 * machine.reach
            pitch = len(row[0]) - machine.mechanism.followed_turns
            pitched = np.repeat(row, len(around), axis=0)
            pitched[:, pitch] += around
            others = machine.closure.poses(pitched)[1] @ tool @ (commanded @ tool)
            own = float(flange[0] @ tool @ (commanded @ tool))
            assert own >= others.max() - 1e-12
            if machine.mechanism.followed_turns > 1:
                rolled = np.repeat(row, len(around), axis=0)
                rolled[:, -1] += around
                agreement = np.einsum("nij,ij->n", machine.closure.poses(rolled)[1], commanded)
                assert np.einsum("ij,ij->", flange[0], commanded) >= agreement.max() - 1e-12
            compared += 1
    assert compared > 10


@EVERY
def test_a_tool_across_the_plane_of_the_arm_is_refused_in_both_languages(name: str) -> None:
    machine = made(name)
    axes = within_reach(machine, 1)
    positions, flange = machine.closure.poses(axes)
    square = machine.closure._about(machine.closure.joints(axes))[0][0]
    tool = tool_of(machine.mechanism)
    across = np.cross(square, flange[0] @ tool)
    swing = np.outer(square, flange[0] @ tool) - np.outer(flange[0] @ tool, square) + np.outer(across, across)
    commanded = swing @ flange[0]
    assert np.allclose(commanded @ tool, square)
    message = "the tool points across the plane in which the arm can turn it"
    assert refusal(machine.robot.inverse, (positions[0], commanded), None, axes[0], says=message) is Status.UNREACHABLE
    status, _ = machine.controller().inverse(positions[0], commanded, (), axes[0])
    assert status != OK


@pytest.mark.parametrize("name", ["arm with four axes over its column", "arm with four axes", "arm with five axes"])
def test_over_the_first_axis_the_tool_tells_where_the_arm_stands(name: str) -> None:
    """The position leaves the first axis free there, the commanded direction does not, whatever the reference."""
    machine = made(name)
    rng = np.random.default_rng(8)
    found = 0
    for bend, lean in rng.uniform(-1.2, 1.2, (16, 2)):
        axes = _over_the_first_axis(machine, bend, lean)
        if axes is None:
            continue
        positions, flange = machine.closure.poses(axes[None])
        assert np.hypot(*positions[0, :2]) <= 1e-9
        for turned in (0.0, 30.0, 90.0, 179.0, -120.0):
            reference = axes + np.eye(len(axes))[0] * turned
            answers = [s.axes for s in machine.robot.inverse_all((positions[0], flange[0]), reference)]
            given = np.array([a for a in answers if a is not None])
            assert len(given) >= 2
            assert machine.error(given, positions.repeat(len(given), 0), flange.repeat(len(given), 0)).max() <= 1e-9
            reached = machine.closure.poses(given)[1]
            assert np.abs((reached - flange[0])[:, :, 2]).max() <= 1e-9
            found += 1
    assert found >= 10


def _over_the_first_axis(machine: Made, bend: float, lean: float) -> Array | None:
    """Axis values at which the tip is on the first axis and the tool leans: the second joint is sought."""
    axes = machine.axes(np.degrees([[0.3, 0.0, bend, lean, 0.4]])[:, : len(machine.mechanism.joints)])[0]
    around = np.linspace(-180.0, 180.0, 400)

    def aside(second: float) -> float:
        axes[1] = second
        position, _ = machine.closure.poses(axes[None])
        heading = machine.closure.joints(axes[None])[0, 0]
        if machine.mechanism.name == "Kin_OverColumn":
            heading = np.pi / 2 - heading
        return float(position[0, 0] * np.cos(heading) + position[0, 1] * np.sin(heading))

    values = [aside(a) for a in around]
    for low, high, first, last in zip(around, around[1:], values, values[1:], strict=False):
        if first * last < 0:
            for _ in range(60):
                middle = (low + high) / 2
                low, high = (middle, high) if aside(middle) * first > 0 else (low, middle)
            aside((low + high) / 2)
            return axes
    return None


MILLIMETRES = ("SCARA whose quill is geared", "CoreXY with C", "SCARA with a nut and a spline")
"""The machines whose descriptions state a travel as a number."""


@pytest.mark.parametrize("name", [name for name in TASK_MACHINES if name not in MILLIMETRES])
def test_metres_and_far_references(name: str) -> None:
    """In metres the angles are the same and the lengths a thousandth; references may be far away."""
    machine = made(name)
    robot = machine.robot
    lengths = {p.name: robot.parameters[p.name] / 1000 for p in robot.PARAMETERS if p.unit == "u"}
    small = type(robot)(**{**robot.parameters, **lengths})
    sizes = np.where(machine.closure.angles, 1.0, 1e-3)
    for axes in within_reach(machine, 12):
        frame, configuration = robot.forward(axes)
        tiny, same = small.forward(axes * sizes)
        assert np.allclose(tiny.position, np.array(frame.position) / 1000, rtol=0.0, atol=1e-12)
        assert same == configuration
        far = (axes + np.where(machine.closure.angles, 36000.0, 10.0)) * sizes
        back = small.inverse(tiny, configuration, far)
        assert np.allclose(back, axes * sizes, rtol=0.0, atol=1e-7)


def _arm(chain: object, turning: Turning, joints: tuple[object, ...] = (A1, A2, A3, A4)) -> Mechanism:
    own = WITH_PITCH["arm with four axes"]
    return replace(own, chain=chain, joints=joints, task=Task("xyz", turning), branches=(), parameters=(L2, L3, L4))


LINKS = Rz(A1) * Ry(A2) * Tz(L2) * Ry(A3) * Tz(L3)


@pytest.mark.parametrize(
    ("mechanism", "message"),
    [
        (
            _arm(LINKS * Ry(A4) * Tz(L4) * Rx(1), Turning.PITCH_ROLL),
            "the task commands 5 quantities (x, y, z, pitch, roll), and there are only 4 joints; command less of "
            "the pose, or add joints",
        ),
        (
            _arm(Rz(A1) * Rx(A2) * Tz(L2) * Rx(A3) * Tz(L3) * Rx(A4) * Tz(L4) * Rx(1) * Ry(1), Turning.PITCH),
            "the task commands pitch, but the z axis of the flange is not square to the axis of the turn before it:"
            " turn the flange by fixed rotations at the end of the chain so that its z axis is the direction of the"
            " tool",
        ),
        (
            _arm(LINKS * Ry(A4) * Tz(L4), Turning.DIRECTION),
            "the task commands 5 quantities (x, y, z, tilt x, tilt y), and there are only 4 joints; where the position"
            " decides the heading of the tool, command its pitch: Turning.PITCH",
        ),
        (
            _arm(LINKS * Ry(A4) * Tz(L4) * Rz(A5), Turning.DIRECTION, (A1, A2, A3, A4, A5)),
            "the closure does not determine a5: 5 unknowns in 3 equations (x_from_a1, y_from_a1, z_from_a1) and the"
            " commanded direction leave 1 free to move; command one more quantity, or leave out one of these joints;"
            " where the position decides the heading of the tool, command its pitch and roll: Turning.PITCH_ROLL",
        ),
        (
            replace(_arm(LINKS * Ry(A4) * Tz(L4), Turning.PITCH), task=Task("xy", Turning.PITCH)),
            "one joint too many: the task commands 3 quantities (x, y, pitch), and 4 joints are to be solved for; name"
            " the one that is held at the reference: held=(A1,)",
        ),
        (
            replace(_arm(LINKS * Ry(A4) * Tz(L4), Turning.PITCH), task=Task("xy", Turning.PITCH_ROLL)),
            "z is not commanded but the joints move it",
        ),
        (
            replace(_arm(Tz(L2) * Ry(A4), Turning.PITCH, (A4,)), task=Task("", Turning.PITCH)),
            "a task with pitch commands a position too: as in Task('xyz', Turning.PITCH)",
        ),
        (
            replace(_arm(None, Turning.PITCH), closure=(X - A1, Y - A2, Z - A3)),
            "a task with pitch needs a chain: its last turns follow the commanded rotation",
        ),
        (
            replace(WITH_PITCH["slides and a tilting head"], chain=Tx(X) * Ty(Y) * Tz(Z) * Tx(B)),
            "the task commands pitch, and the chain has no pitch at its end: no joint turns so",
        ),
    ],
)
def test_what_cannot_be_commanded_is_refused(mechanism: Mechanism, message: str) -> None:
    with pytest.raises((DescriptionError, Unsolved)) as refusal:
        build(mechanism)
    assert str(refusal.value) == message


def test_a_tip_beside_the_roll_is_refused_with_what_helps() -> None:
    beside = LINKS * Ry(A4) * Tz(L4) * Rz(A5) * Tx(L2)
    with pytest.raises(Unsolved, match="it would help if the tip were on the axis of the roll: leave out the shift"):
        build(_arm(beside, Turning.PITCH_ROLL, (A1, A2, A3, A4, A5)))


def carried_tool(machine: Made) -> Frame:
    """A tool to every side, a tenth of the reach long, and inclined."""
    shift = (0.06 * machine.reach, -0.04 * machine.reach, 0.07 * machine.reach)
    return Frame.from_euler(20.0, 30.0, 40.0, shift)


@EVERY
def test_an_arm_that_follows_a_pitch_carries_any_tool(name: str) -> None:
    """Forward kinematics is base times flange times tool by the equations; the inverse leads back, also in a batch."""
    machine = made(name)
    axes = within_reach(machine, 8)
    tool = carried_tool(machine)
    robot = machine.robot.with_tool(tool).with_base(BASE)
    expected = BASE.matrix @ matrices(*machine.closure.poses(axes)) @ tool.matrix
    positions, rotations, configurations, statuses = robot.forward_batch(axes)
    assert (statuses == Status.OK).all()
    assert np.abs(matrices(positions, rotations) - expected).max() < 1e-11 * (machine.reach + 600.0)
    back, statuses = robot.inverse_batch(expected, None, configurations, axes)
    assert (statuses == Status.OK).all() and np.abs(back - axes).max() < 1e-6
    for row, matrix, data in zip(axes, expected, configurations, strict=True):
        assert robot.inverse(matrix, data, row) == pytest.approx(tuple(row), abs=1e-6)
        jacobian = np.array(robot.jacobian(row))
        assert np.abs(jacobian - robot.jacobian_batch([row])[0][0]).max() < 1e-9 * (machine.reach + 600.0)


@EVERY
def test_the_position_is_met_or_refused(name: str) -> None:
    """A rotation that the arm cannot take: the tool is where it was commanded, or nowhere; alone as in a batch."""
    machine = made(name)
    axes = within_reach(machine, 8)
    tool = carried_tool(machine)
    robot = machine.robot.with_tool(tool)
    rng = np.random.default_rng(9)
    met = 0
    for row in axes:
        pose = robot.forward(row)[0].matrix
        for angle in (0.5, 5.0, 40.0, 170.0):
            turn = Frame.from_euler(rng.uniform(-180.0, 180.0), angle, rng.uniform(-180.0, 180.0))
            command = Frame.from_matrix(pose) @ turn
            slots = robot.inverse_all(command, row)
            every, statuses = robot.inverse_all_batch([command], None, row)
            for slot, found, status in zip(slots, every[0], statuses[0], strict=True):
                assert slot.status == status
                if slot.axes is None:
                    continue
                met += 1
                assert np.abs(np.subtract(slot.axes, found)).max() < 1e-5
                reached = machine.closure.poses(np.array([slot.axes]))
                at = reached[0][0] + reached[1][0] @ tool.position
                assert np.abs(at - command.position).max() < 1e-9 * machine.reach
    assert met > 8


@EVERY
def test_the_reason_of_the_arm_is_said(name: str) -> None:
    """Out of reach it is the arm's own reason, and never an answer."""
    machine = made(name)
    robot = machine.robot.with_tool(carried_tool(machine))
    row = within_reach(machine, 1)[0]
    frame, configuration = robot.forward(row)
    far = Frame(tuple(50.0 * machine.reach + v for v in frame.position), frame.rotation)
    if all(a.unit == "deg" for a in robot.AXES):
        with pytest.raises(KinematicsError) as refusal:
            robot.inverse(far, configuration, row)
        assert refusal.value.status is Status.UNREACHABLE and refusal.value.refusal is not None
        assert robot.inverse_batch([far], None, configuration, row)[1].tolist() == [Status.UNREACHABLE]
    with pytest.raises(KinematicsError):
        robot.inverse(Frame((float("nan"),) * 3, frame.rotation), configuration, row)


@EVERY
def test_nearest_is_the_least_of_every_branch_with_a_tool(name: str) -> None:
    """The nearest axes are not further than those of any slot, alone, in a batch, and in radians; limits choose."""
    machine = made(name)
    robot = machine.robot.with_tool(carried_tool(machine)).with_base(BASE)
    counted = list(robot._criteria[0].axes)
    for row in within_reach(machine, 3):
        frame, near = robot.forward(row)[0], tuple((row + 3.0).tolist())
        found = robot.nearest(frame.matrix, near)
        slots = [slot.axes for slot in robot.inverse_all(frame, near) if slot.axes is not None]
        away = [float((np.subtract(axes, near)[counted] ** 2).sum()) for axes in (found, *slots)]
        assert slots and away[0] <= min(away[1:]) + 1e-4
        reached = robot.forward(found)[0]
        assert np.abs(np.subtract(reached.position, frame.position)).max() < 1e-8 * (machine.reach + 600.0)
        axes, statuses = robot.nearest_batch([frame], None, near)
        assert statuses[0] == Status.OK and np.abs(axes[0] - found).max() < 1e-5
        turns = np.array([np.pi / 180.0 if axis.unit == "deg" else 1.0 for axis in robot.AXES])
        own = robot.in_radians().nearest(frame, turns * near)
        assert np.abs(own - turns * found).max() < 1e-6
        first = robot.AXES[0].name
        narrow = robot.changed(limits={first: (found[0] + 1.0, found[0] + 359.0)})
        if all(abs((axes[0] - found[0] + 180.0) % 360.0 - 180.0) < 0.5 for axes in slots):
            with pytest.raises(KinematicsError, match=first):
                narrow.nearest(frame, near)
        else:
            assert narrow.nearest(frame, near)[0] != pytest.approx(found[0], abs=0.5)
