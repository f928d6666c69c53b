"""Frames that are rotations to a few digits: repaired before anything else, tool direction first. Beyond that, refused.

What is met is the repaired frame, as NumPy makes it. A mechanism that does not follow the rotation never looks at it.
"""

import numpy as np
import pytest
from softkin import KinematicsError, Status

from tests.catalogue.closure import Array
from tests.catalogue.machines import Machine, few
from tests.orthonormal import mirrored, repaired, single, slightly_off, too_far_off

COUNT = 9


def some(machine: Machine) -> tuple[Array, Array, Array]:
    """Axis values and their poses, the rotations turned away from what is exact in single precision."""
    axes = machine.draw(COUNT, np.random.default_rng(41), 170.0)
    return (axes, *machine.closure.poses(axes))


def test_a_frame_in_single_precision_is_answered(machines: tuple[Machine, ...]) -> None:
    """Scalar and batch alike, as the repaired frame is, and the closure holds there."""
    for machine in few(machines)[-2:]:
        robot = machine.robot
        axes, positions, rotations = some(machine)
        rounded = rotations.astype(np.float32)
        meant = np.array([repaired(r.astype(np.float64)) for r in rounded])
        own = machine.own(axes)
        found, statuses = robot.inverse_batch(positions, rounded, own, axes)
        assert (statuses == Status.OK).all()
        exact = robot.inverse_batch(positions, meant if robot.READS_ROTATION else rotations, own, axes)[0]
        assert np.abs(found - exact).max() < 1e-9 * machine.reach
        followed = meant if machine.closure.follows_rotation else rotations
        if machine.closure.follows_turn:
            followed = np.array([robot.project(m) for m in meant])
        assert machine.miss(found, positions, followed).max() < 1e-11
        assert np.abs(found - axes).max() < 1e-3 * machine.reach
        for k in range(COUNT):
            frame, code = (positions[k], rounded[k]), own[k].tolist()
            assert robot.inverse(frame, code, axes[k]) == pytest.approx(tuple(found[k]), abs=1e-9 * machine.reach)
            assert robot.diagnose(frame, code, axes[k]).status is Status.OK
            slots = [s.axes for s in robot.inverse_all(frame, axes[k])]
            table, outcomes = robot.inverse_all_batch(positions[k : k + 1], rounded[k : k + 1], axes[k])
            assert [s is None for s in slots] == (outcomes[0] != Status.OK).tolist()
            for slot, row in zip(slots, table[0], strict=True):
                assert slot is None or slot == pytest.approx(tuple(row), rel=0, abs=1e-9 * machine.reach)


def test_every_small_error_is_repaired_and_every_larger_one_refused(machines: tuple[Machine, ...]) -> None:
    machine = machines[-1]
    robot = machine.robot
    axes, positions, rotations = some(machine)
    near, code = axes[0], machine.own(axes)[0].tolist()
    refused = [*too_far_off(rotations[0]), *mirrored(rotations[0])]
    for matrix in (*slightly_off(rotations[0]), *(() if robot.READS_ROTATION else refused)):
        frame = positions[0], matrix
        meant = repaired(matrix) if robot.READS_ROTATION else rotations[0]
        found = robot.inverse(frame, code, near)
        assert found == pytest.approx(robot.inverse((positions[0], meant), code, near), rel=0, abs=1e-9 * machine.reach)
        assert robot.inverse_batch(positions[:1], matrix[None], code, near)[1].tolist() == [Status.OK]
        if machine.closure.follows_turn:
            assert np.abs(np.subtract(robot.project(matrix), robot.project(meant))).max() < 1e-12
    for matrix in refused if robot.READS_ROTATION else ():
        _refused(machine, (positions[0], matrix), code, near)
        assert robot.inverse_batch(positions[:1], matrix[None], code, near)[1].tolist() == [Status.BAD_INPUT]


def _refused(machine: Machine, frame: tuple[Array, Array], code: list[int], near: Array) -> None:
    """Every call says the same, with the amount where there is one."""
    robot = machine.robot
    found = robot.diagnose(frame, code, near)
    assert found.status is Status.BAD_INPUT and ("columns" in found.reason or "right-handed" in found.reason)
    assert (found.missing > 1e-4) == ("columns" in found.reason)
    said = f"by {found.missing:.2g}; was the frame converted from REAL?" if found.missing else "right-handed"
    with pytest.raises(KinematicsError) as error:
        robot.inverse(frame, code, near)
    assert error.value.status is Status.BAD_INPUT and said in str(error.value)
    assert {s.status for s in robot.inverse_all(frame, near)} == {Status.BAD_INPUT}
    if machine.closure.follows_turn:
        with pytest.raises(KinematicsError) as error:
            robot.project(frame[1])
        assert said in str(error.value)


def test_rows_of_a_batch_are_repaired_one_by_one(machines: tuple[Machine, ...]) -> None:
    """Exact rows are answered bit for bit as without the others."""
    machine = machines[0]
    axes, positions, rotations = some(machine)
    own = machine.own(axes)
    mixed = rotations.copy()
    mixed[::3] = [single(r) for r in rotations[::3]]
    mixed[1] *= 1.01
    alone, _ = machine.robot.inverse_batch(positions, rotations, own, axes)
    found, statuses = machine.robot.inverse_batch(positions, mixed, own, axes)
    kept = np.arange(COUNT) % 3 == 2
    assert (found[kept] == alone[kept]).all()
    assert np.abs(found[::3] - alone[::3]).max() < 1e-3 * machine.reach
    assert statuses[1] == (Status.BAD_INPUT if machine.robot.READS_ROTATION else Status.OK)
    assert (np.delete(statuses, 1) == Status.OK).all()
