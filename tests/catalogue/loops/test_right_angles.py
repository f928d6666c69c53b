"""All axes at multiples of 90 degrees, or at simple lengths: every flat, stretched and folded pose of a loop."""

from itertools import product

import numpy as np
from softkin import Status

from tests.catalogue import both_ways
from tests.catalogue.closure import Array
from tests.catalogue.loop_machines import LoopMachine, loop_machine

ANGLES = (-180.0, -90.0, 0.0, 90.0, 180.0, 270.0)
LENGTHS = (-0.5, -0.25, 0.0, 0.125, 0.25, 0.5)
"""Of a reach."""
LOST = 3e-8
"""Below this part of its size, a root of rounding, the determinant of the closure says nothing of a solution's
existence."""


def grid(machine: LoopMachine) -> Array:
    """All combinations of right angles and of a few lengths, as axis values."""
    values = [ANGLES if is_angle else np.multiply(LENGTHS, machine.reach) for is_angle in machine.closure.angles]
    return np.array(list(product(*values))) + machine.closure.offsets


def plates(machine: LoopMachine, axes: Array, positions: Array) -> Array:
    """|det A|, over the size that it can have."""
    determinants = np.linalg.det(machine.closure.by_position(machine.closure.joints(axes), positions))
    return np.abs(determinants) / 2.0 ** positions.shape[1]


def test_the_grid(machines: tuple[LoopMachine, ...]) -> None:
    """Forward closes the loop or refuses; what it answers goes round by scalar and batch, or is too near to losing the
    plate.
    """
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
