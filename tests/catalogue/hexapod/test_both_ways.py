"""There and back, as others compute it and with frames of a few digits; from home, from a start, in batches."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from softkin import KinematicsError, Status

from tests.catalogue import both_ways
from tests.catalogue.hexapod.machines import Array, Machine, machines, rotation
from tests.catalogue.refusals import refusal
from tests.orthonormal import mirrored, slightly_off, too_far_off
from tests.text.controller import OK
from tests.text.hexapod.blocks import controller


def test_all_over_a_realistic_workspace(machine: Machine) -> None:
    """Every pose within 25 degrees of home about each axis is found from home: its lengths have only one pose there."""
    positions, turns = machine.poses(1500)
    axes, status = machine.robot.inverse_batch(positions, turns)
    assert not status.any()
    assert_allclose(axes, machine.axes(positions, turns), rtol=1e-13)
    back, turned, configurations, status = machine.robot.forward_batch(axes)
    assert not status.any() and configurations.shape == (1500, 0)
    assert_allclose(back, positions, atol=1e-11 * machine.shift)
    assert_allclose(turned, turns, atol=1e-11)


@pytest.mark.long
def test_what_the_inverse_accepts_is_found_from_home(machine: Machine) -> None:
    """Up to 40 degrees about each axis: what the inverse refuses is in the other assembly mode, or nearly singular."""
    positions, turns = machine.poses(800, turn=40.0)
    axes, status = machine.robot.inverse_batch(positions, turns)
    accepted = status == Status.OK
    assert accepted.sum() > 740 and set(status[~accepted]) <= {Status.UNREACHABLE}
    side = machine.side(machine.home[:3], machine.home_turn)
    margins = side * np.array([machine.normalised(p, r) for p, r in zip(positions, turns, strict=True)])
    assert (accepted == (margins >= 1e-3)).all()
    back, turned, _, status = machine.robot.forward_batch(axes[accepted])
    assert not status.any()
    assert_allclose(back, positions[accepted], atol=1e-9 * machine.shift)
    assert_allclose(turned, turns[accepted], atol=1e-9)


@pytest.mark.long
def test_far_poses_are_found_or_refused_never_mistaken(machine: Machine) -> None:
    """Beyond the realistic: whatever answers has these lengths, in the machine's assembly mode."""
    positions, turns = machine.poses(700, turn=100.0)
    axes = machine.axes(positions, turns)
    back, turned, _, status = machine.robot.forward_batch(axes)
    assert set(status) == {Status.OK, Status.IMPOSSIBLE}
    found = status == Status.OK
    assert found.mean() > 0.5
    assert_allclose(machine.axes(back[found], turned[found]), axes[found], rtol=1e-9)
    assert np.abs(turned[found] @ np.moveaxis(turned[found], 1, 2) - np.eye(3)).max() <= 1e-12
    side = machine.side(machine.home[:3], machine.home_turn)
    assert {machine.side(p, r) for p, r in zip(back[found], turned[found], strict=True)} == {side}


def test_a_start_is_where_the_search_starts(machine: Machine) -> None:
    """On a path, forward kinematics from the previous frame finds the next one."""
    positions, turns = machine.path(40)
    robot, frame = machine.robot, None
    axes, _ = robot.inverse_batch(positions, turns)
    together = robot.forward_batch(axes, (positions, turns))
    one = robot.forward_batch(axes, (positions[0], turns[0]))
    assert not one[3].any() and not together[3].any()
    for i, values in enumerate(axes):
        frame, _ = robot.forward(values, start=frame or (positions[0], turns[0]))
        for found in (frame.position, together[0][i], one[0][i], robot.forward(values)[0].position):
            assert_allclose(found, positions[i], atol=1e-11 * machine.shift)


def test_the_answer_is_in_the_mode_of_the_machine_wherever_the_search_starts() -> None:
    """A flat platform below its base has the lengths of the one above: a search that ends there is refused."""
    machine = machines()["nominal"]
    mirror = np.diag((1.0, 1.0, -1.0))
    turn = machine.poses(1)[1][0]
    pose = (np.array((20.0, -30.0, 590.0)), turn)
    below = (mirror @ pose[0], mirror @ turn @ mirror)
    axes = machine.axes(*pose)
    assert_allclose(machine.axes(*below), axes, rtol=1e-14)
    assert_allclose(machine.robot.forward(axes)[0].position, pose[0], atol=1e-9)
    assert refusal(machine.robot.forward, axes, start=below) is Status.IMPOSSIBLE
    assert refusal(machine.robot.inverse, below) is Status.UNREACHABLE


def test_the_home_pose_chooses_the_mode() -> None:
    machine = machines()["nominal"]
    hanging = Machine(machine.base, machine.platform, (0, 0, -600, 0, 0, 0), 180.0)
    positions, turns = hanging.poses(200)
    back, _, _, status = hanging.robot.forward_batch(hanging.axes(positions, turns))
    assert not status.any() and (back[:, 2] < 0.0).all()
    assert_allclose(back, positions, atol=1e-9)


def test_calls_leave_no_trace(machine: Machine) -> None:
    """Whatever was asked before, an answer is the same to the last digit; what cannot be solved spoils nothing."""
    robot = machine.robot
    axes = [tuple(a) for a in machine.axes(*machine.poses(12))]
    first = [robot.forward(a) for a in axes]
    assert [robot.forward(a) for a in reversed(axes)][::-1] == first
    for a, answer in zip(axes, first, strict=True):
        with pytest.raises(KinematicsError):
            robot.forward((1e6,) * 6)
        robot.forward(axes[0], start=first[-1][0])
        assert robot.forward(a) == answer


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
    assert set(both_ways.forward(machine.robot, axes)[3]) == {Status.OK, Status.IMPOSSIBLE, Status.BAD_INPUT}


def test_forward_from_starts(machine: Machine) -> None:
    positions, turns = machine.poses(120, turn=60.0)
    axes = spoiled(machine.axes(positions, turns), np.nan)
    positions, turns = np.roll(positions, 1, axis=0), spoiled(np.roll(turns, 1, axis=0), 0.3, np.nan, np.inf, 1e200)
    assert {Status.OK, Status.BAD_INPUT} <= set(both_ways.forward(machine.robot, axes, (positions, turns))[3])


CASES = {
    (0, 0, 20, 0, 0, 0): (29.746680487073, 29.746680487073, 29.746714726168, 29.746363424795, 29.746363424795,
        29.746714726168),
    (2, 1, 22, 5, -3, 10): (31.759871169751, 31.881509190096, 28.585823216412, 33.902245895411, 29.170986025026,
        32.229428923312),
    (-3, 2, 25, -8, 6, -15): (
        32.047073012586, 32.191238992908, 35.261838360772, 32.093952052596, 38.929389073320, 31.114809124200,
    ),
}  # fmt: skip


@pytest.mark.parametrize("pose", CASES)
def test_the_lengths_that_linuxcnc_computes(pose: tuple[float, ...]) -> None:
    robot, turn = machines()["inch"].robot, rotation(*pose[3:])
    axes = robot.inverse((pose[:3], turn))
    assert_allclose(axes, CASES[pose], atol=5e-12)
    frame, configuration = robot.forward(CASES[pose])
    assert configuration == ()
    assert_allclose(frame.position, pose[:3], atol=2e-11)  # the published lengths have twelve decimals
    assert_allclose(frame.rotation, turn, atol=2e-12)
    status, (position, rows, _) = controller("inch").forward(CASES[pose])
    assert status == OK
    assert_allclose(position, pose[:3], atol=2e-11)
    assert_allclose(rows, turn, atol=2e-12)


def test_a_start_is_repaired_too(machine: Machine) -> None:
    """A start in single precision ends where an exact one does; a wrong start is refused."""
    positions, turns = machine.poses(2, 5.0)
    axes = machine.axes(positions[0], turns[0])
    for matrix in list(slightly_off(turns[0]))[:3]:
        frame, _ = machine.robot.forward(axes, (positions[0], matrix))
        assert np.abs(np.array(frame.rotation) - turns[0]).max() < 1e-9
        found = machine.robot.forward_batch([axes, axes], (positions[0], matrix))
        assert (found[3] == Status.OK).all() and np.abs(found[1] - turns[0]).max() < 1e-9
    for matrix in (*too_far_off(turns[0]), *mirrored(turns[0])):
        start = positions[0], matrix
        assert refusal(machine.robot.forward, axes, start, says=r"columns not|right-handed") is Status.BAD_INPUT
        assert (machine.robot.forward_batch([axes], start)[3] == Status.BAD_INPUT).all()
