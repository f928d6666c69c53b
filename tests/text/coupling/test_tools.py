"""Tools and frames of a few digits: what SoftMotion asks of a block, against the package."""

from typing import Any

import numpy as np
import pytest
import softkin
from softkin import Frame, KinematicsError, Status

from derive.description.mechanism import Mechanism, Turning
from tests.catalogue.coupling.parts import EVERYTHING, orientation_parts, position_part
from tests.catalogue.mounted.machines import TOOL, Sample, sample_of
from tests.catalogue.references import held_at
from tests.mechanisms import catalogue
from tests.orthonormal import mirrored, repaired, rows, slightly_off, too_far_off
from tests.text.controller import BAD_INPUT, OK, Controller, asked
from tests.text.coupling.blocks import ORIENTATIONS, Image, orientation_pairs_of
from tests.text.coupling.test_coupled_blocks import Coupling
from tests.text.samples import NO_TURN, tilted
from tests.text.units import compiled, public_methods

MACHINES = tuple(m for _, m in catalogue() if m.task.position)
ALONG = Frame((0.0, 0.0, 44.0))
ASIDE = Frame((25.0, 0.0, 0.0))


class Tooled:
    """A block whose group has a tool."""

    def __init__(self, mechanism: Mechanism, robot: softkin.Mechanism, tool: Frame) -> None:
        self.block = Controller(compiled(mechanism), mechanism)
        assert self.block.initialise(robot.parameters) == OK
        self.tool, self.robot = tool, robot
        self.asks = "GetFlangeOrientationImageWithOri" in public_methods(mechanism)

    def image(self, flange: Any) -> tuple[str, Any]:
        """The orientation image for a commanded rotation of the flange; that of the machine where it has no other."""
        if self.asks:
            return self.block.image_with_orientation(flange)
        return self.block.image("GetOrientationImage")

    def allows(self) -> bool:
        """What the documentation says: with no degree of freedom any tool, with one a tool along vU."""
        status, (freedom, _, _, axis) = self.image(self.robot.orientation_image().rotation)
        assert status == OK
        shift = np.array(self.tool.position)
        if freedom == "zero":
            return True
        return bool(freedom == "one" and np.linalg.norm(np.cross(axis, shift)) < 1e-9)

    def inverse(self, frame: Frame, data: tuple[int, ...], reference: Any) -> tuple[str, Any]:
        """The axes at which the tool has the frame."""
        wanted = np.array(frame.rotation) @ np.array(self.tool.rotation).T
        status, image = self.image(wanted.tolist())
        if status != OK:
            return status, None
        freedom, zero, base_axis, flange_axis = image
        shift = np.array(zero) @ self.tool.position
        if freedom == "one":
            shift = np.array(base_axis) * np.dot(flange_axis, self.tool.position)
        place = (np.array(frame.position) - shift).tolist()
        return self.block.inverse(place, wanted.tolist(), data, reference)


@pytest.mark.broad
@pytest.mark.long("Ac6", "Hexapod")
@pytest.mark.parametrize("mechanism", MACHINES, ids=lambda m: m.name)
def test_a_tool_is_the_same_in_both_languages(mechanism: Mechanism) -> None:
    """The block allows the tools that Python carries, and answers with the same axes and statuses."""
    sample = sample_of(mechanism)
    for tool in (ALONG, ASIDE, TOOL):
        tooled = Tooled(mechanism, sample.robot, tool)
        try:
            robot = sample.robot.with_tool(tool)
        except KinematicsError as refusal:
            assert "does not determine the flange" in str(refusal)
            inclined = sample.follows_the_direction and tool is TOOL  # SoftMotion asks for the offset alone
            assert not tooled.allows() or inclined, tool
            continue
        assert tooled.allows(), tool
        _agree(tooled, robot, sample)


def _agree(tooled: Tooled, robot: softkin.Mechanism, sample: Sample) -> None:
    rng = np.random.default_rng(3)
    answered = 0
    for axes in sample.axes[:3]:
        frame, configuration = robot.forward(axes)
        if not tooled.robot.READS_ROTATION:
            frame = Frame(frame.position, NO_TURN)
        far = Frame(tuple(20.0 * v + 1e4 for v in frame.position), frame.rotation)
        near = held_at(robot, axes, axes)
        others = [] if sample.mechanism.followed_turns else [Frame(frame.position, tilted(rng))]
        for command in (frame, far, *others):  # a block that follows a pitch differs there, as docs/PYTHON.md says
            status, answer = asked(robot.inverse, command, configuration, near)
            found = tooled.inverse(command, configuration, near)
            assert found[0] == status, (robot, command)
            if answer is not None:
                answered += 1
                assert found[1][: len(answer)] == pytest.approx(answer, abs=1e-6)
    assert answered >= 3


CARRIERS = ("Kin_Gantry3", "Kin_Pos_RRR", "Kin_Scara3_Z")
"""Flanges that keep their orientation, that turn freely, and that follow the twist."""
PAIRS = [(c, w) for c in CARRIERS for w in ORIENTATIONS]


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
        assert one.controller.end_point(NO_TURN, Image("zero", wrong), data, axes)[0] == BAD_INPUT
        asked = one.controller.with_orientation(wrong, Image("one"))[0]
        assert (asked == BAD_INPUT) == (wrist.task.turning in (Turning.DIRECTION, Turning.FULL))
        assert (one.controller.total(Image("zero", wrong))[0] == BAD_INPUT) == (one.robot.FREEDOM != "three")
        if one.robot.FREEDOM != "three":
            with pytest.raises(KinematicsError, match=r"columns not|right-handed"):
                one.robot.image_on(Image("zero", wrong).in_python())
