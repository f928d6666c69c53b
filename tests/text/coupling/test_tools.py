"""Tools: what SoftMotion asks of a block for `SMC_GroupSetTool`, against `with_tool` in Python.

The stand-in for SoftMotion takes the tool's frame off the commanded one, asks for the rotation that the flange will
have, moves back by the tool in that rotation, and calls `CartesianToAxes`; it computes nothing else.
"""

from typing import Any

import numpy as np
import pytest
import softkin
from softkin import Frame, KinematicsError

from derive.description.mechanism import Mechanism
from tests.catalogue.mounted.machines import TOOL, Sample, sample_of
from tests.catalogue.references import held_at
from tests.mechanisms import catalogue
from tests.text.controller import OK, Controller, asked
from tests.text.samples import tilted
from tests.text.units import compiled, public_methods

MACHINES = tuple(m for _, m in catalogue() if m.task.position)
ALONG = Frame((0.0, 0.0, 44.0))
ASIDE = Frame((25.0, 0.0, 0.0))
UNIT = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
"""A rotation that is commanded of a flange that keeps its own, or whose turn the position decides."""


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
            frame = Frame(frame.position, UNIT)
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
