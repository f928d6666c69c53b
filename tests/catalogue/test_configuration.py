"""The configuration that forward kinematics writes, and that the inverse reads."""

import numpy as np
import pytest
from softkin import Status

from derive.description.mechanism import Mechanism
from tests.catalogue.both_ways import forward, inverse
from tests.catalogue.loci import loci
from tests.catalogue.machines import Machine, few
from tests.catalogue.references import held_at
from tests.catalogue.refusals import refusal

TURNS = {1: (-180.0, 180.0), 2: (180.0, 540.0), 3: (540.0, 900.0), 4: (900.0, 1260.0),
         -1: (-540.0, -180.0), -2: (-900.0, -540.0), -3: (-1260.0, -900.0)}  # fmt: skip
"""The period numbers and what they mean."""


def turn_of(value: float) -> int:
    """The number of the turn, by looking it up."""
    (number,) = (n for n, (low, high) in TURNS.items() if low <= value < high)
    return number


def turning(mechanism: Mechanism) -> list[int]:
    """The multi-turn axes by index, in the order of their bytes."""
    names = [j.name for j in mechanism.joints]
    order = mechanism.periods or tuple(j.name for j in mechanism.joints if j.multi_turn)
    return [names.index(name) for name in order]


def test_bytes_say_branch_and_turn(machines: tuple[Machine, ...]) -> None:
    """The sign of the description's indicator, and the interval that the axis value is in."""
    for machine in machines:
        axes = machine.draw(60, np.random.default_rng(1))
        _, _, configurations, _ = forward(machine.robot, axes)
        positive = machine.closure.indicators(machine.closure.joints(axes)) > 0
        branches = positive.shape[1]
        assert configurations.shape == (60, branches + len(turning(machine.mechanism)))
        assert (configurations[:, :branches] == np.where(positive, 1, 2)).all()
        for column, axis in enumerate(turning(machine.mechanism), branches):
            assert configurations[:, column].tolist() == [turn_of(v) for v in axes[:, axis]]


@pytest.mark.long
def test_turns_are_counted_at_their_edges(machines: tuple[Machine, ...]) -> None:
    """An edge belongs to the turn above it, in spite of rounding: so does what is 1e-10 below."""
    for one in few(machines)[:2]:
        for column, axis in enumerate(turning(one.mechanism), one.robot.BRANCHES):
            machine, first = one.placed(axis, 180.0, 7)
            for edge, above in ((-180.0, 1), (180.0, 2), (540.0, 3), (-540.0, -1)):
                below = {1: -1, -1: -2}.get(above, above - 1)
                axes = first.copy()
                axes[:, axis] = edge + np.array([-1e-4, -1e-8, -1e-10, 0.0, 1e-10, 1e-8, 1e-4])
                positions, rotations, configurations, _ = forward(machine.robot, axes)
                assert configurations[:, column].tolist() == [below, below, above, above, above, above, above]
                regular = machine.is_regular(axes)
                robot = machine.changed(check_limits=False)
                near = held_at(robot, axes)
                found, statuses = inverse(robot, positions, rotations, configurations, near)
                assert (statuses == Status.OK).all()
                assert np.abs((found - axes)[regular]).max(initial=0.0) < 1e-9
                again = forward(robot, found)[2]
                assert (again == configurations)[regular].all()


@pytest.mark.long("P2C")
def test_a_named_turn_is_where_the_axis_is_put(machines: tuple[Machine, ...]) -> None:
    """Far turns too, positive and negative, up to what a byte can hold; beyond it the byte is 0."""
    for one in few(machines)[1:]:
        for column, axis in enumerate(turning(one.mechanism), one.robot.BRANCHES):
            machine, axes = one.placed(axis, 17.0, 5)
            robot = machine.changed(check_limits=False)
            axes[:, axis] += 360.0 * np.array([126, -127, 127, -128, 1000])
            positions, rotations, configurations, _ = forward(robot, axes)
            assert configurations[:, column].tolist() == [127, -127, 0, 0, 0]
            nearest = axes.copy()
            nearest[:3] = 0.0
            nearest[2] = axes[2] + 1.0
            nearest = held_at(robot, axes, nearest)
            found, statuses = inverse(robot, positions, rotations, configurations, nearest)
            regular = machine.is_regular(axes) & (statuses == Status.OK)
            assert (statuses == Status.OK).all()
            assert np.abs((found - axes)[regular]).max(initial=0.0) < 1e-8


def test_negative_bytes_may_be_given_unsigned(machines: tuple[Machine, ...]) -> None:
    """A period byte from 128 to 255 is read as its negative number."""
    for machine in machines[:2]:
        axes = machine.draw(20, np.random.default_rng(4))
        robot = machine.changed(check_limits=False)
        positions, rotations, configurations, _ = forward(robot, axes)
        unsigned = configurations.astype(np.uint8).astype(int)
        found, statuses = inverse(robot, positions, rotations, unsigned, held_at(robot, axes))
        assert (statuses == Status.OK).all()
        assert np.abs(found - axes).max() < 1e-9


@pytest.mark.long("Pos_RRR")
@pytest.mark.serial
def test_where_branches_coincide_the_byte_is_3(machines: tuple[Machine, ...]) -> None:
    """Stretched and folded exactly; 1e-9 away the branch has a sign."""
    for machine in few(machines):
        axes = machine.draw(8, np.random.default_rng(5))
        for locus in loci(machine):
            if locus.branch is None:
                continue
            assert (forward(machine.robot, locus.moved(axes, 0.0))[2][:, locus.branch] == 3).all()
            for shift in (1e-9, -1e-9, 1e-4, -1e-4):
                beside = locus.moved(axes, shift)
                indicator = machine.closure.indicators(machine.closure.joints(beside))[:, locus.branch]
                written = forward(machine.robot, beside)[2][:, locus.branch]
                assert (written == np.where(indicator > 0, 1, 2)).all()


def test_wrong_bytes_are_refused(machines: tuple[Machine, ...]) -> None:
    for machine in machines[:2]:
        robot = machine.robot
        axes = machine.draw(5, np.random.default_rng(6))
        positions, rotations = machine.closure.poses(axes)
        frame, near = (positions[0], rotations[0]), held_at(robot, axes, 0.0 * axes)
        size = len(robot.CONFIGURATION)
        own = machine.own(axes)
        good = own[2].tolist()
        wrongs: list[object] = [[*good, 1], [*good, 0, 0], 7]
        if size:
            wrongs += [good[:-1], [300] * size, [-129] * size, [1.5] * size, ["1"] * size, "1" * size, [None] * size]
        for wrong in wrongs:
            assert refusal(robot.inverse, frame, wrong, near[0]) is Status.BAD_INPUT
        for branch in range(robot.BRANCHES):
            for byte in (4, 5, 100, 127, -1, -128, 255):
                wrong = list(good)
                wrong[branch] = byte
                assert refusal(robot.inverse, frame, wrong, near[0]) is Status.BAD_INPUT
                table = own.astype(int)
                table[2, branch] = byte
                found, statuses = robot.inverse_batch(positions, rotations, table, near)
                clean, expected = robot.inverse_batch(positions, rotations, own, near)
                assert statuses[2] == Status.BAD_INPUT
                assert np.isnan(found[2]).all()
                assert (np.delete(statuses, 2) == np.delete(expected, 2)).all()
                assert np.array_equal(np.delete(found, 2, axis=0), np.delete(clean, 2, axis=0), equal_nan=True)
