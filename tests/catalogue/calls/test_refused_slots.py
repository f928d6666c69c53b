"""Every slot without axes says why: the axis that is beyond a limit, and by how much, or what is out of reach."""

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from tests.catalogue.calls.mountings import BASE, EVERY, limited, radian, tool_of

pytestmark = pytest.mark.broad


@pytest.mark.parametrize("name", EVERY)
def test_a_slot_has_the_reason_of_diagnose(name: str) -> None:
    """Limits and reach refuse, bare and mounted, in degrees and in radians: the reason is that of the slot alone."""
    refused = 0
    for bare, axes, size in limited(name, np.random.default_rng(4)):
        mounted = bare.with_base(BASE).with_tool(tool_of(bare))
        for robot in (bare, mounted, bare.in_radians(), mounted.in_radians()):
            near = axes if robot.in_degrees() is robot else radian(robot.in_degrees(), axes)
            frame = robot.forward(near)[0]
            for asked in (frame, frame.shifted(x=30.0 * size)):
                for slot in robot.inverse_all(asked, near):
                    assert (slot.refusal is None) == (slot.status is Status.OK) == (slot.axes is not None)
                    if slot.refusal is not None:
                        refused += 1
                        assert slot.refusal.status is slot.status
                        alone = robot.diagnose(asked, slot.configuration, near)
                        assert slot.refusal.reason == alone.reason or alone.status is Status.OK
                        assert (
                            slot.refusal.turn == alone.turn and abs(slot.refusal.missing - alone.missing) < 1e-9 * size
                        )
    assert refused or isinstance(bare, softkin.Coupled) or not bare.AXES


def test_the_limit_and_the_amount() -> None:
    """An arm whose other elbow is 5 degrees beyond a limit; a rotation that is none refuses every slot."""
    robot = softkin.Scara4ZCcoupledType1(link_length_1=300.0, link_length_2=300.0, limits={"A2": (-15.0, 170.0)})
    frame = robot.forward((10.0, 20.0, 5.0, 30.0))[0]
    right, left = robot.inverse_all(frame)
    assert right.refusal is None and left.refusal is not None and left.axes is None
    assert left.refusal.in_words == "A2: below its lower limit, missing 5.0 deg"
    (first, second) = robot.in_radians().inverse_all(frame)
    assert first.axes and second.refusal and second.refusal.in_words == "A2: below its lower limit, missing 0.08727 rad"
    skewed = (frame.position, ((1.0, 0.1, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    with pytest.raises(KinematicsError, match="was the frame converted from REAL") as error:
        robot.inverse(skewed)
    assert [slot.refusal for slot in robot.inverse_all(skewed)] == [error.value.refusal] * 2
