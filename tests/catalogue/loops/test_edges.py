"""Boundaries of a loop: rods that meet flat, rods that do not meet, centres that coincide, legs without a direction."""

import pytest
import softkin
from softkin import Status

from tests.catalogue.loop_machines import LOOPS, facing
from tests.catalogue.loops.edges import EDGES, OTHER_WAY_ROUND, PLACES
from tests.catalogue.refusals import refusal


def test_every_loop_has_edges() -> None:
    assert set(EDGES) == {m.name for m in LOOPS}


@pytest.mark.parametrize("name", EDGES)
def test_flat_rods_are_a_pose_that_nothing_controls(name: str) -> None:
    """Forward kinematics answers at the boundary; there is no Jacobian, it is singular, and the inverse refuses to go
    there.
    """
    dimensions, axes = EDGES[name][0]
    robot = softkin.catalogue()[name](**dimensions)
    frame, configuration = robot.forward(axes)
    assert robot.singularity(axes).is_singular
    assert refusal(robot.jacobian, axes) is Status.IMPOSSIBLE
    assert refusal(robot.inverse, frame, configuration, axes) is Status.UNREACHABLE


@pytest.mark.parametrize("name", EDGES)
def test_where_nothing_can_be_assembled(name: str) -> None:
    for dimensions, axes in EDGES[name][1:]:
        robot = softkin.catalogue()[name](**dimensions)
        assert robot.singularity(axes).is_singular
        calls = [robot.forward, robot.jacobian]
        if robot.FREEDOM == "zero":  # whatever the axes are
            assert robot.orientation(axes) == ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
        else:
            calls.append(robot.orientation)
        for call in calls:
            assert refusal(call, axes) is Status.IMPOSSIBLE


@pytest.mark.parametrize("name", PLACES)
def test_a_leg_that_cannot_aim_refuses_in_every_slot(name: str) -> None:
    for dimensions, places in PLACES[name]:
        robot = softkin.catalogue()[name](**dimensions)
        for place in places:
            assert {s.status for s in robot.inverse_all((place, facing(robot)))} == {Status.UNREACHABLE}


@pytest.mark.parametrize("name", OTHER_WAY_ROUND)
def test_the_side_does_not_depend_on_how_legs_are_numbered(name: str) -> None:
    """Below is below: turned round, a machine is the same machine with its axes exchanged."""
    dimensions, axes = OTHER_WAY_ROUND[name]
    renamed = {
        key.replace("_1", "_0").replace("_3", "_1").replace("_0", "_3"): value for key, value in dimensions.items()
    }
    swapped = name == "MC_KIN_TYPE_12_XY"
    same = dict(dimensions, swap_xy=0.0) if swapped else renamed
    for flag in (False, True):
        assembly = next(m for m in LOOPS if m.name == name).assembly
        assert assembly is not None
        one, other = (softkin.catalogue()[name](**given, **{assembly.parameter: flag}) for given in (dimensions, same))
        here = one.forward(axes)[0].position
        there = other.forward(axes if swapped else axes[::-1])[0].position
        assert here == pytest.approx((there[1], there[0], there[2]) if swapped else there, abs=1e-9)
        if not swapped:
            assert (here[2] > 30.0) == flag
