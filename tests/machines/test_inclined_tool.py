"""What softkin takes of a user's own as its own: a tool that is inclined, and lengths that are called like limits."""

from functools import cache

import numpy as np
import pytest
import softkin
from softkin import Frame, KinematicsError, Mechanism, Status
from sympy import pi, sin

from derive import compile_mechanism
from derive.description.validate import validate
from derive.frames import Ry, Rz, Tx, Tz
from derive.mechanism import Task, Turning, branch, distance, length, rotary
from tests.catalogue.refusals import status_of
from tests.machines.made import built_of, imported_class
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
    assert status_of(softkin.Coupled, scara, inclined()) is Status.INVALID_COUPLING
    with pytest.raises(KinematicsError, match="does not determine the flange"):
        scara.with_tool(TOOL)


A1, A2 = (rotary(name, f"turn {name}") for name in ("A1", "A2"))
UPPER = length("upper_arm", "from the shoulder to the elbow", nominal=300.0)
LOWER = length("lower_arm", "from the elbow to the tool", nominal=200.0)


@pytest.fixture(scope="module")
def arm() -> type[Mechanism]:
    """A planar arm whose lengths are called like limits."""
    chain, elbow = Rz(A1) * Tx(UPPER) * Rz(A2) * Tx(LOWER), branch("elbow", sin(A2), right=+1, left=-1)
    description = textbook((A1, A2, UPPER, LOWER), "NamedArm", chain, Task("xy"), (elbow,), family="planar")
    mechanism = validate(description)
    return imported_class(mechanism, built_of(mechanism))


def test_lengths_are_no_limits(arm: type[Mechanism]) -> None:
    """The limits are those of the axes; the lengths stay what they are, by value and in JSON."""
    robot = arm(upper_arm=300.0, lower_arm=200.0, limits={"A1": (-100, 90), "A2": (None, 150)})
    assert robot.limits == {"A1": (-100.0, 90.0), "A2": (None, 150.0)}
    assert (robot.parameters["upper_arm"], robot.parameters["lower_arm"]) == (300.0, 200.0)
    assert arm.from_json(robot.to_json()) == robot
    assert robot.changed(lower_arm=250.0).parameters["lower_arm"] == 250.0


def test_the_nearest_solution_is_inside_them(arm: type[Mechanism]) -> None:
    """A limit of an axis refuses the other elbow; the same with base and tool, and in radians."""
    frame, _ = arm(upper_arm=300.0, lower_arm=200.0).forward((20.0, 60.0))
    robot = arm(upper_arm=300.0, lower_arm=200.0, limits={"A2": (-170, 0)})
    found = robot.nearest(frame, (20.0, 60.0))
    assert -170.0 <= found[1] <= 0.0
    assert robot.forward(found)[0].position == pytest.approx(frame.position, abs=1e-9)
    assert robot.in_radians().limits["A2"] == pytest.approx((-2.9670597283903604, 0.0))
    with pytest.raises(KinematicsError, match="A2"):
        arm(upper_arm=300.0, lower_arm=200.0, limits={"A2": (-1, 1)}).nearest(frame, (20.0, 60.0))
