"""Invalid poses, axes, numbers and dimensions: a status and one clear message; other rows of a batch are unaffected."""

import contextlib
from collections.abc import Iterator
from math import inf, nan

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from derive.description.mechanism import Mechanism
from tests.catalogue.closure import Array
from tests.catalogue.extreme import extreme_dimensions
from tests.catalogue.machines import Machine
from tests.catalogue.references import held_at
from tests.catalogue.refusals import refusal

NUMBERS = (nan, inf, -inf, 1e300, -1e300, 1.1e9)
"""Not finite, or beyond what is allowed."""
NO_NUMBERS: tuple[object, ...] = (
    "12345678", None, 5, 5.0, [None] * 4, ["1", "2", "3", "4"], [[1.0], [2.0]], {"a": 1}, 1j,
)  # fmt: skip
IDENTITY = np.eye(3)
NO_ROTATIONS = {
    "scaled": 1.001 * IDENTITY,
    "shrunk": 0.5 * IDENTITY,
    "zero": 0 * IDENTITY,
    "reflected": np.diag([1.0, 1.0, -1.0]),
    "turned inside out": -IDENTITY,
    "sheared": IDENTITY + np.array([[0, 1e-3, 0], [0, 0, 0], [0, 0, 0]]),
    "of rank one": np.ones((3, 3)),
    "huge": 1e300 * IDENTITY,
    "a little off": IDENTITY + 1.1e-4,
}


def some(machines: tuple[Machine, ...]) -> tuple[Machine, Array, Array, Array]:
    """The last machine with a few axis values, and their positions and rotations."""
    machine = machines[-1]
    axes = machine.draw(7, np.random.default_rng(1))
    return (machine, axes, *machine.closure.poses(axes))


def test_axis_values_that_are_no_numbers_of_reasonable_size(machines: tuple[Machine, ...]) -> None:
    machine, axes, _, _ = some(machines)
    robot = machine.robot
    for i in range(axes.shape[1]):
        for number in NUMBERS:
            values = axes[0].copy()
            values[i] = number
            for call in (robot.forward, robot.orientation, robot.jacobian):
                assert refusal(call, values) is Status.BAD_INPUT
            singularity = robot.singularity(values)
            assert singularity.is_singular and tuple(singularity.margins) == robot.MARGINS
            assert np.isnan(list(singularity.margins.values())).all()
            table = axes.copy()
            table[3] = values
            positions, rotations, configurations, statuses = robot.forward_batch(table)
            assert statuses.tolist() == [0, 0, 0, Status.BAD_INPUT, 0, 0, 0]
            assert np.isnan(positions[3]).all() and np.isnan(rotations[3]).all() and not configurations[3].any()
            for got, expected in zip((positions, rotations, configurations), robot.forward_batch(axes), strict=False):
                assert (np.delete(got, 3, axis=0) == np.delete(expected, 3, axis=0)).all()


def test_too_few_or_too_many_axes(machines: tuple[Machine, ...]) -> None:
    machine, axes, positions, rotations = some(machines)
    robot = machine.robot
    frame = positions[0], rotations[0]
    for wrong in ([], axes[0][:-1], [*axes[0], 0.0], [*axes[0], *axes[0]], *NO_NUMBERS):
        for call in (robot.forward, robot.orientation, robot.jacobian, robot.singularity):
            assert refusal(call, wrong) is Status.BAD_INPUT
        if wrong is not None:  # no reference at all is allowed: zeros
            assert refusal(robot.inverse, frame, None, wrong) is Status.BAD_INPUT
            assert refusal(robot.inverse_all, frame, wrong) is Status.BAD_INPUT


def test_positions_and_references_of_no_reasonable_size(machines: tuple[Machine, ...]) -> None:
    machine, axes, positions, rotations = some(machines)
    robot = machine.robot
    own, near = machine.own(axes), held_at(robot, axes, 0.0 * axes)
    clean = robot.inverse_batch(positions, rotations, own, near)[0]
    for i in range(3):
        for number in NUMBERS:
            wrong = positions.copy()
            wrong[2, i] = number
            got, statuses = robot.inverse_batch(wrong, rotations, own, near)
            task = machine.mechanism.task
            if not task.position or "xyz"[i] in task.passive:  # it only turns, and reads none; or not this one
                assert (statuses == Status.OK).all() and (got == clean).all()
                continue
            assert refusal(robot.inverse, (wrong[2], rotations[2]), None, near[2]) is Status.BAD_INPUT
            found = robot.inverse_all((wrong[2], rotations[2]), near[2])
            assert [s.status for s in found] == [Status.BAD_INPUT] * 2**robot.BRANCHES
            assert all(s.axes is None for s in found)
            assert statuses.tolist() == [0, 0, Status.BAD_INPUT, 0, 0, 0, 0]
            assert np.isnan(got[2]).all()
            assert (np.delete(got, 2, axis=0) == np.delete(clean, 2, axis=0)).all()
    for i, joint in enumerate(machine.mechanism.joints):
        for number in NUMBERS:
            references = near.copy()
            references[4, i] = number
            statuses = robot.inverse_batch(positions, rotations, own, references)[1]
            read = statuses[4] == Status.BAD_INPUT
            assert (np.delete(statuses, 4) == Status.OK).all()
            assert read or (statuses[4] == Status.OK and not joint.multi_turn)  # a linear axis has one value
            if read:
                assert refusal(robot.inverse, (positions[4], rotations[4]), None, references[4]) is Status.BAD_INPUT


def no_rotations(rotation: Array) -> Iterator[Array]:
    """Matrices that are none; then an entry that is no number, each in its turn."""
    for factor in NO_ROTATIONS.values():
        yield factor @ rotation
    for i in range(9):
        for number in (nan, NUMBERS[1 + i % 5]):
            entries = rotation.copy()
            entries.flat[i] = number
            yield entries


def test_frames_that_are_no_rotation(machines: tuple[Machine, ...]) -> None:
    """Refused where the rotation is read; accepted where it is not."""
    machine, axes, positions, rotations = some(machines)
    robot, own = machine.robot, machine.own(axes)
    near = held_at(robot, axes, 0.0 * axes)
    clean = robot.inverse_batch(positions, rotations, own, near)[0]
    for wrong in no_rotations(rotations[3]):
        table = rotations.copy()
        table[3] = wrong
        got, statuses = robot.inverse_batch(positions, table, own, near)
        if robot.READS_ROTATION:
            assert statuses.tolist() == [0, 0, 0, Status.BAD_INPUT, 0, 0, 0]
            assert np.isnan(got[3]).all()
            assert refusal(robot.inverse, (positions[3], wrong), None, near[3]) is Status.BAD_INPUT
            if machine.closure.follows_turn:
                assert refusal(robot.project, wrong) is Status.BAD_INPUT
            assert (np.delete(got, 3, axis=0) == np.delete(clean, 3, axis=0)).all()
        else:
            assert (statuses == Status.OK).all()
            assert (got == clean).all()
            found = robot.inverse((positions[3], wrong), own[3].tolist(), near[3])
            assert np.allclose(found, clean[3], rtol=0, atol=1e-10)


def test_whether_the_rotation_is_read_is_said(machines: tuple[Machine, ...]) -> None:
    machine, axes, positions, rotations = some(machines)
    robot, own = machine.robot, machine.own(axes)
    assert machine.closure.follows_rotation == robot.READS_ROTATION
    if robot.READS_ROTATION:
        near = held_at(robot, axes)
        assert refusal(robot.inverse_batch, positions, None, None, near) is Status.BAD_INPUT
        assert refusal(robot.inverse, (positions[0], None), None, None if near is None else near[0]) is Status.BAD_INPUT
    else:
        assert (robot.inverse_batch(positions, None, own)[1] == Status.OK).all()
        code = own[0].tolist()
        assert robot.inverse((positions[0], None), code) == robot.inverse((positions[0], rotations[0]), code)


def test_what_has_not_the_form_of_a_frame(machines: tuple[Machine, ...]) -> None:
    machine, axes, positions, rotations = some(machines)
    robot, near = machine.robot, axes[0]
    p, r = positions[0], rotations[0]
    wrongs: list[object] = [None, 5, "frame", (), (p,), (p, r, r), (p[:2], r), ([*p, 0], r), (None, r), ("123", r)]
    if robot.READS_ROTATION:
        wrongs += [(p, r[:2]), (p, r.ravel()), (p, r[:, :2]), (p, 5), (p, "123456789"), (p, [["1"] * 3] * 3)]
    for wrong in wrongs:
        assert refusal(robot.inverse, wrong, None, near) is Status.BAD_INPUT
        assert refusal(robot.inverse_all, wrong, near) is Status.BAD_INPUT


MACHINES = 8


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_every_call_ends(mechanism: Mechanism) -> None:
    """Numbers that overflow are refused like others that are none."""
    made = softkin.catalogue()[mechanism.name]
    accepted = 0
    for given in extreme_dimensions(mechanism, MACHINES):
        given = {p.name: given[p.name] for p in made.PARAMETERS if p.name in given}
        with contextlib.suppress(KinematicsError):
            robot = made(**given)
            accepted += 1
            axes = [10.0 * (k + 1) for k in range(len(made.AXES))]
            frame = softkin.Frame.from_euler(20.0, 0.0, 0.0, (30.0, -20.0, 10.0))
            for call in (robot.forward, robot.jacobian, robot.singularity):
                with contextlib.suppress(KinematicsError):
                    call(axes)
            with contextlib.suppress(KinematicsError):
                frame, _ = robot.forward(axes)
            with contextlib.suppress(KinematicsError):
                robot.inverse(frame, robot.DEFAULT_CONFIGURATION, axes)
            with contextlib.suppress(KinematicsError):
                tuple(robot.inverse_all(frame, axes))
    assert accepted >= 2


def test_the_least_length_is_refused_and_the_next_is_not() -> None:
    """The bound is one number, and belongs to what is refused."""
    made = softkin.catalogue()["Kin_Scara2_Z"]
    for length in (1e-12, 1e-200, 5e-324):
        with pytest.raises(KinematicsError, match="more than 1e-12"):
            made(arm_length_1=length, arm_length_2=length)
    assert made(arm_length_1=1.1e-12, arm_length_2=1.1e-12).parameters["arm_length_1"] == 1.1e-12
