"""The arm that is searched, with frames that are rotations to a few digits: the chain reaches the repaired frame."""

import numpy as np
import pytest
from softkin import Status

from derive.description.mechanism import Mechanism
from derive.mechanisms.kin_ac6_rzryryrxryrz_j6offset import MECHANISM
from tests.catalogue.refusals import refusal
from tests.catalogue.search.arms import IRB_2400, LATERALS, arm, frame
from tests.orthonormal import Array, mirrored, repaired, slightly_off, too_far_off
from tests.text.controller import BAD_INPUT, OK, Controller
from tests.text.units import compiled

AXES = np.array([20.0, -30.0, 40.0, 50.0, 60.0, -70.0])


@pytest.mark.parametrize("lateral", (0.0, *LATERALS))
def test_the_repaired_frame_is_reached(lateral: float) -> None:
    robot, pose = arm(lateral), frame(AXES, lateral)
    position, turn = tuple(pose[:3, 3].tolist()), pose[:3, :3]
    configuration = robot.forward(AXES)[1]
    for matrix in list(slightly_off(turn))[::4]:
        axes = robot.inverse((position, matrix), configuration, AXES)
        _reached(frame(np.array(axes), lateral), position, matrix)
        table, statuses = robot.inverse_batch([position], [matrix], configuration, AXES)
        assert statuses.tolist() == [Status.OK] and table[0] == pytest.approx(axes, abs=1e-8)
        found = [s.axes for s in robot.inverse_all((position, matrix), AXES) if s.axes is not None]
        assert found
        for each in found:
            _reached(frame(np.array(each), lateral), position, matrix)


def _reached(pose: Array, position: tuple[float, ...], matrix: Array) -> None:
    assert np.abs(pose[:3, 3] - position).max() < 1e-8
    assert np.abs(pose[:3, :3] - repaired(matrix)).max() < 1e-11


@pytest.mark.long
@pytest.mark.parametrize("lateral", (0.0, LATERALS[0]))
def test_beyond_that_it_is_refused(lateral: float) -> None:
    """A rotation with a larger error is refused, in Python and by the block."""
    robot, pose = arm(lateral), frame(AXES, lateral)
    position, turn = tuple(pose[:3, 3].tolist()), pose[:3, :3]
    block = _block(MECHANISM, lateral)
    configuration = robot.forward(AXES)[1]
    for matrix in (*too_far_off(turn), *mirrored(turn)):
        says = r"columns not|right-handed"
        assert refusal(robot.inverse, (position, matrix), reference=AXES, says=says) is Status.BAD_INPUT
        assert {s.status for s in robot.inverse_all((position, matrix), AXES)} == {Status.BAD_INPUT}
        assert robot.inverse_batch([position], [matrix])[1].tolist() == [Status.BAD_INPUT]
        assert block.inverse(position, matrix.tolist(), configuration, AXES.tolist())[0] == BAD_INPUT
    single = next(slightly_off(turn))
    status, axes = block.inverse(position, single.tolist(), configuration, AXES.tolist())
    assert status == OK and axes == pytest.approx(robot.inverse((position, single), configuration, AXES), abs=1e-9)


def _block(mechanism: Mechanism, lateral: float) -> Controller:
    made = Controller(compiled(mechanism), mechanism)
    assert made.initialise({**IRB_2400, "j6_offset_x": lateral}) == OK
    return made
