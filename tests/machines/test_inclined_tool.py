"""A tool of the user's own that is inclined, as an orientation kinematics: coupled, and mounted behind that."""

from functools import cache

import numpy as np
import pytest
import softkin
from softkin import Frame, KinematicsError, Status
from sympy import pi

from derive import compile_mechanism
from derive.frames import Ry, Rz, Tx, Tz
from derive.mechanism import Task, Turning, distance
from tests.machines.textbook import textbook

BESIDE, BELOW = distance("beside", "Along X", nominal=30.0), distance("below", "Along Z", nominal=-50.0)
CHAIN = Tx(BESIDE) * Ry(pi / 6) * Tz(BELOW) * Rz(pi / 3)
INCLINED = textbook(
    (BESIDE, BELOW), "InclinedTool", CHAIN, Task("", Turning.NONE), family="orientation", offset_interface=None
)
"""A tool that is inclined against the flange."""
TOOL = Frame((30.0, 0.0, 0.0)) @ Frame.from_euler(0.0, 30.0, 60.0, (-25.0, 0.0, -50.0 * 0.75**0.5))
"""The same as a frame: 50 along the inclined axis, downward."""
FURTHER = Frame.from_euler(10.0, 20.0, 30.0, (1.0, 2.0, 3.0))
CARRIERS = {
    "gantry": softkin.Gantry3(),
    "quill": softkin.Scara4ZCcoupledType1(link_length_1=325.0, link_length_2=225.0, pitch_zc=20.0),
    "cutter": softkin.GantryCutter3(),
}


@cache
def inclined() -> softkin.Mechanism:
    found: softkin.Mechanism = compile_mechanism(INCLINED)(beside=30.0, below=-50.0)
    return found


@pytest.mark.parametrize("name", CARRIERS)
def test_a_coupling_with_it_is_the_mounted_machine(name: str) -> None:
    """The same frames, axes and image as with the tool as a frame; and it carries a further tool."""
    carrier = CARRIERS[name]
    coupled, mounted = softkin.Coupled(carrier, inclined()), carrier.with_tool(TOOL)  # type: ignore[arg-type]
    for axes in np.random.default_rng(4).uniform(5.0, 80.0, (5, len(carrier.AXES))):
        for one, other in ((coupled, mounted), (coupled.with_tool(FURTHER), mounted.with_tool(FURTHER))):
            frame, configuration = one.forward(axes)
            assert np.abs(frame.matrix - other.forward(axes)[0].matrix).max() < 1e-11
            assert one.inverse(frame, configuration, axes) == pytest.approx(tuple(axes), abs=1e-9)
            assert one.inverse_batch([frame], None, configuration, axes)[0][0] == pytest.approx(tuple(axes), abs=1e-9)
    image, same = coupled.orientation_image(), mounted.orientation_image()
    assert image.freedom == same.freedom
    assert np.abs(np.subtract(image.rotation, same.rotation)).max() < 1e-14
    assert np.array(image.rotation) @ image.flange_axis == pytest.approx(np.array(image.base_axis))


def test_a_flange_that_turns_by_itself_refuses_it() -> None:
    """As a coupling and as a frame."""
    scara = softkin.Scara2Z(arm_length_1=300.0, arm_length_2=250.0)
    with pytest.raises(KinematicsError) as refusal:
        softkin.Coupled(scara, inclined())  # type: ignore[arg-type]
    assert refusal.value.status is Status.INVALID_COUPLING
    with pytest.raises(KinematicsError, match="does not determine the flange"):
        scara.with_tool(TOOL)
