"""Boundaries of a loop: rods that are flat or do not meet, centres that coincide, legs without a direction."""

from itertools import product

import numpy as np
import pytest
import softkin
from softkin import Status

from tests.catalogue import both_ways
from tests.catalogue.closure import Array
from tests.catalogue.loop_machines import LOOPS, LoopMachine, facing, loop_machine
from tests.catalogue.loops.edges import EDGES, OTHER_WAY_ROUND, PLACES
from tests.catalogue.refusals import refusal


def test_every_loop_has_edges() -> None:
    assert set(EDGES) == {m.name for m in LOOPS}


@pytest.mark.parametrize("name", EDGES)
def test_flat_rods_are_a_pose_that_nothing_controls(name: str) -> None:
    """Forward answers at the boundary; there is no Jacobian, it is singular, and the inverse refuses it."""
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
    renamed = {n.replace("_1", "_0").replace("_3", "_1").replace("_0", "_3"): v for n, v in dimensions.items()}
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
            assert (here[2] > 30.0) == (flag != assembly.parameter.endswith("_below"))


ANGLES = (-180.0, -90.0, 0.0, 90.0, 180.0, 270.0)
LENGTHS = (-0.5, -0.25, 0.0, 0.125, 0.25, 0.5)
"""Of a reach."""
LOST = 3e-8
"""Below this part of its size the determinant of the closure says nothing of a solution's existence."""


def grid(machine: LoopMachine) -> Array:
    """All combinations of right angles and of a few lengths, as axis values."""
    values = [ANGLES if is_angle else np.multiply(LENGTHS, machine.reach) for is_angle in machine.closure.angles]
    return np.array(list(product(*values))) + machine.closure.offsets


def plates(machine: LoopMachine, axes: Array, positions: Array) -> Array:
    """|det A|, over the size that it can have."""
    determinants = np.linalg.det(machine.closure.by_position(machine.closure.joints(axes), positions))
    return np.abs(determinants) / 2.0 ** positions.shape[1]


def test_the_grid(machines: tuple[LoopMachine, ...]) -> None:
    """Forward closes the loop or refuses; what it answers goes round, or is too near to losing the plate."""
    nominal = machines[0]
    whole = {p.name: float(round(p.nominal, -1)) for p in nominal.mechanism.parameters}
    for machine in (*machines, loop_machine(nominal.mechanism, "round", whole)):
        axes = grid(machine)
        positions, rotations, configurations, statuses = both_ways.forward(machine.robot, axes)
        assert set(statuses.tolist()) <= {Status.OK, Status.IMPOSSIBLE}
        answered = statuses == Status.OK
        assert np.isnan(positions[~answered]).all()
        closes = np.isfinite(machine.closure.poses(axes)[0]).all(axis=1)
        here = axes[answered], positions[answered]
        flat = rotations[answered]
        clear = plates(machine, *here) > LOST
        assert (closes[answered] | ~clear).all()
        for row in axes[closes & ~answered]:  # only at the very edge may Newton's method still find something
            assert machine.robot.singularity(row).is_singular
        assert (closes & ~answered).sum() <= len(axes) / 10
        assert machine.miss(*here, flat)[clear].max(initial=0.0) < 1e-10
        robot = machine.changed(min_type2_margin=0.0)
        found, again = both_ways.inverse(robot, here[1], flat, configurations[answered], here[0])
        room = machine.closure.room(machine.closure.joints(here[0]), here[1])
        assert (again[clear & (room > 1e-9)] == Status.OK).all()
        solved = again == Status.OK
        there = found[solved], here[1][solved]
        assert machine.miss(*there, flat[solved]).max(initial=0.0) < 1e-9
        legs = np.abs(np.linalg.det(machine.closure.by_joints(machine.closure.joints(here[0]), here[1])))
        regular = solved & clear & (legs > 1e-3 * legs.max(initial=0.0))
        assert np.abs(found - here[0])[regular].max(initial=0.0) < 1e-6
        assert regular.sum() >= 5
