"""A coupling repairs the commanded frame once, and so does each of the blocks that SoftMotion's coupling asks."""

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from derive.description.mechanism import Mechanism, Turning
from tests.catalogue.coupling.parts import EVERYTHING, orientation_parts, position_part
from tests.orthonormal import mirrored, repaired, slightly_off, too_far_off
from tests.text.controller import BAD_INPUT, OK
from tests.text.coupling.blocks import ORIENTATIONS, Image, orientation_pairs_of
from tests.text.coupling.test_coupled_blocks import Coupling
from tests.text.samples import Rows, tilted

CARRIERS = ("Kin_Gantry3", "Kin_Pos_RRR", "Kin_Scara3_Z")
"""Flanges that keep their orientation, that turn freely, and that follow the twist."""
PAIRS = [(c, w) for c in CARRIERS for w in ORIENTATIONS]
UNIT = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def rows(matrix: np.ndarray) -> Rows:
    """A matrix as rows of plain numbers."""
    return tuple(map(tuple, matrix.tolist()))


@pytest.mark.parametrize(("carrier", "wrist"), PAIRS, ids=[f"{c}-{w.name}" for c, w in PAIRS])
def test_a_coupling_answers_as_for_the_repaired_frame(carrier: str, wrist: Mechanism) -> None:
    first = position_part(EVERYTHING[carrier])
    second = orientation_parts(wrist)[0]
    try:
        coupled = softkin.Coupled(first.robot, second.robot)
    except KinematicsError:
        return
    rng = np.random.default_rng(3)
    axes = (*first.draw(1, rng)[0].tolist(), *second.draw(1, rng)[0].tolist())
    frame, data = coupled.forward(axes)
    cut, bytes_ = len(first.robot.AXES), len(first.robot.CONFIGURATION)
    blocks = Coupling(first, second, "rows")
    rotation = np.array(frame.rotation)
    for matrix in slightly_off(rotation):
        meant = repaired(matrix) if coupled.READS_ROTATION else rotation
        expected = coupled.inverse((frame.position, meant), data, axes)
        found = coupled.inverse((frame.position, matrix), data, axes)
        assert found == pytest.approx(expected, rel=0, abs=1e-9)
        table, statuses = coupled.inverse_batch([frame.position], [matrix], data, axes)
        assert statuses.tolist() == [Status.OK] and table[0] == pytest.approx(expected, rel=0, abs=1e-8)
        if carrier != "Kin_Scara3_Z":  # follows the twist itself: nothing is to be asked of what it carries
            command = frame.position, rows(matrix)
            status, (one, other) = blocks.inverse(command, (data[:bytes_], data[bytes_:]), (axes[:cut], axes[cut:]))
            assert status == OK and (*one[:cut], *other[: len(axes) - cut]) == pytest.approx(expected, rel=0, abs=1e-8)
    for matrix in (*too_far_off(rotation), *mirrored(rotation)) if coupled.READS_ROTATION else ():
        with pytest.raises(KinematicsError) as error:
            coupled.inverse((frame.position, matrix), data, axes)
        assert error.value.status is Status.BAD_INPUT
        reason = coupled.diagnose((frame.position, matrix), data, axes).reason
        assert "columns" in reason or "right-handed" in reason
        assert coupled.inverse_batch([frame.position], [matrix], data, axes)[1].tolist() == [Status.BAD_INPUT]
        assert {s.status for s in coupled.inverse_all((frame.position, matrix), axes)} == {Status.BAD_INPUT}


@pytest.mark.parametrize("wrist", ORIENTATIONS, ids=lambda m: m.name)
def test_what_a_coupling_asks_is_repaired(wrist: Mechanism) -> None:
    """The end point, and the images, of a commanded rotation and of a flange: as of the repaired ones."""
    one = orientation_pairs_of(wrist)[0]
    turning = wrist.task.turning
    data, axes = one.robot.DEFAULT_CONFIGURATION, (0.0,) * len(wrist.joints)
    rng = np.random.default_rng(9)
    commanded, flange = (np.array(tilted(rng)) for _ in range(2))
    for matrix in slightly_off(commanded):
        for image in (
            Image("zero", rows(flange)),
            Image("zero", rows(next(slightly_off(flange)))),
            Image("three", rows(flange)),
        ):
            found = one.controller.end_point(rows(matrix), image, data, axes)
            exact = Image(image.freedom, rows(repaired(np.array(image.zero))))
            expected = one.controller.end_point(rows(repaired(matrix)), exact, data, axes)
            assert found[0] == expected[0]
            if found[0] == OK:
                assert found[1] == pytest.approx(expected[1], rel=0, abs=1e-10)
        status, (_, zero, base_axis, _), _ = one.controller.with_orientation(rows(matrix), Image("one"))
        assert status == OK
        if turning in (Turning.DIRECTION, Turning.FULL):
            np.testing.assert_allclose(zero, repaired(matrix), rtol=0, atol=1e-15)
            np.testing.assert_allclose(base_axis, repaired(matrix)[:, 2], rtol=0, atol=1e-15)
    for matrix in slightly_off(flange):
        off, exact = (Image("zero", rows(m)) for m in (matrix, repaired(matrix)))
        assert one.controller.total(off)[0] == OK
        if one.robot.FREEDOM != "three":
            found = one.controller.total(off)[1][1]
            np.testing.assert_allclose(found, one.controller.total(exact)[1][1], rtol=0, atol=1e-14)
            np.testing.assert_allclose(one.robot.image_on(off.in_python()).rotation, found, rtol=0, atol=1e-14)


@pytest.mark.parametrize("wrist", ORIENTATIONS, ids=lambda m: m.name)
def test_what_is_no_rotation_is_refused(wrist: Mechanism) -> None:
    """A matrix that is no rotation is refused by every method that reads it."""
    one = orientation_pairs_of(wrist)[0]
    data, axes = one.robot.DEFAULT_CONFIGURATION, (0.0,) * len(wrist.joints)
    rotation = np.array(tilted(np.random.default_rng(10)))
    reads = one.robot.READS_ROTATION
    for matrix in (*too_far_off(rotation), *mirrored(rotation)):
        wrong = rows(matrix)
        assert (one.controller.end_point(wrong, Image("zero"), data, axes)[0] == BAD_INPUT) == reads
        assert one.controller.end_point(UNIT, Image("zero", wrong), data, axes)[0] == BAD_INPUT
        asked = one.controller.with_orientation(wrong, Image("one"))[0]
        assert (asked == BAD_INPUT) == (wrist.task.turning in (Turning.DIRECTION, Turning.FULL))
        assert (one.controller.total(Image("zero", wrong))[0] == BAD_INPUT) == (one.robot.FREEDOM != "three")
        if one.robot.FREEDOM != "three":
            with pytest.raises(KinematicsError, match=r"columns not|right-handed"):
                one.robot.image_on(Image("zero", wrong).in_python())
