"""Frames from REAL, and frames that are a little more off than that, in every method of a block that takes a matrix."""

import numpy as np

from derive.description.mechanism import Turning
from tests.orthonormal import mirrored, repaired, slightly_off, too_far_off
from tests.text.controller import BAD_INPUT, OK, asked, assert_same
from tests.text.pairs import Pair
from tests.text.reasons import compare_reason
from tests.text.samples import Command, Rows, Sample, tilted
from tests.text.serial_pairs import SerialPair

ROUNDING = 1e-9


def rows(matrix: np.ndarray) -> Rows:
    """A matrix as rows of plain numbers."""
    return tuple(map(tuple, matrix.tolist()))


def offered(one: SerialPair) -> bool:
    """Whether the block has the method that reads a commanded rotation."""
    return "getflangeorientationimagewithori" in one.controller.methods


def test_a_frame_from_real_is_answered_as_in_python(pairs: tuple[Pair, ...]) -> None:
    for one in (pairs[0], pairs[-1]):
        for sample in one.regular[:3]:
            (position, rotation), own = one.robot.forward(sample.axes)
            for matrix in slightly_off(np.array(rotation)):
                frame = position, rows(matrix)
                status, axes = asked(one.robot.inverse, frame, own, sample.axes)
                found = one.controller.inverse(*frame, own, sample.axes)
                assert_same(found, (status, axes and axes + (0.0,) * (6 - len(axes))), one, matrix)
                assert found[0] == asked(one.robot.inverse, (position, rotation), own, sample.axes)[0]


def test_beyond_that_it_is_refused_with_the_same_reason(pairs: tuple[Pair, ...]) -> None:
    """A rotation with a larger error is refused with the reason of Python."""
    one = pairs[0]
    sample = one.regular[0]
    (position, rotation), own = one.robot.forward(sample.axes)
    for matrix in (*too_far_off(np.array(rotation)), *mirrored(np.array(rotation))):
        found = one.controller.inverse(position, rows(matrix), own, sample.axes)
        assert found[0] == (BAD_INPUT if one.robot.READS_ROTATION else OK)
        compare_reason(one, Command(position, rows(matrix), own, sample.axes))
        if offered(one):
            assert one.controller.image_with_orientation(rows(matrix))[0] == BAD_INPUT


def test_the_image_is_the_rotation_that_the_inverse_gives_the_flange(serial_pairs: tuple[SerialPair, ...]) -> None:
    """GetFlangeOrientationImageWithOri and CartesianToAxes repair and project the same frame alike."""
    rng = np.random.default_rng(17)
    one = serial_pairs[0]
    for sample in one.regular[:3] if offered(one) else ():
        (position, rotation), own = one.robot.forward(sample.axes)
        turns = [np.array(rotation)]
        if one.mechanism.task.turning is Turning.ABOUT_Z:
            turns.append(np.array(tilted(rng)))
        for turn in turns:
            for matrix in slightly_off(turn):
                _agree(one, sample, position, matrix, own)


def _agree(
    one: SerialPair, sample: Sample, position: tuple[float, ...], matrix: np.ndarray, own: tuple[int, ...]
) -> None:
    status, image = one.controller.image_with_orientation(rows(matrix))
    assert status == OK
    freedom, zero, base_axis, _ = image
    outcome, axes = one.controller.inverse(position, rows(matrix), own, sample.axes)
    if outcome != OK:
        return  # limits
    reached = np.array(one.controller.forward(axes[: len(sample.axes)])[1][1])
    assert np.abs(np.array(base_axis) - reached[:, 2]).max() < ROUNDING
    if one.mechanism.task.turning is not Turning.DIRECTION:
        assert np.abs(np.array(zero) - reached).max() < ROUNDING
    if one.mechanism.task.turning is Turning.FULL:
        np.testing.assert_allclose(zero, repaired(matrix), rtol=0, atol=1e-15)
