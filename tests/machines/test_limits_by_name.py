"""Limits are known by the machine's own list: a dimension may be called like one, `lower_arm` and `upper_arm`."""

import pytest
from softkin import KinematicsError, Mechanism
from sympy import sin

from derive.description.validate import validate
from derive.frames import Rz, Tx
from derive.mechanism import Task, branch, length, rotary
from tests.machines.made import built_of, imported_class
from tests.machines.textbook import textbook

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
