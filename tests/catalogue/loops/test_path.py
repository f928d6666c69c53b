"""Continuous motions of a loop, each step with the last result as reference: across ±180 degrees, and out of a
limit."""

import numpy as np
import pytest

from tests.catalogue.closure import Array
from tests.catalogue.loop_machines import LoopMachine
from tests.catalogue.test_path import TOLERANCE, follow

pytestmark = pytest.mark.slow

STEPS = 500
SIZES = (60.0, 30.0, 15.0, 8.0, 4.0, 2.0, 1.0)
"""The amplitude of the axes, in degrees or lengths: the path stays regular."""


def swing(machine: LoopMachine, axis: int) -> Array:
    """A way on which all axes swing at their own pace, about a pose whose one axis stands at half a
    turn, or anywhere.
    """
    turns = machine.closure.angles[axis]
    centres = machine.with_axis_at(axis, 180.0, 5) if turns else machine.draw(5, np.random.default_rng(9))
    time = np.linspace(0.0, 2 * np.pi, STEPS)
    waves = np.stack([np.sin((i + 1) * time) for i in range(centres.shape[1])], axis=1)
    ways = (centre + size * waves for size in SIZES for centre in centres)
    return next(way for way in ways if machine.is_possible(way[::40]).all() and machine.is_possible(way[::4]).all())


def test_across_half_turns(machines: tuple[LoopMachine, ...]) -> None:
    """No jump anywhere, whichever axis crosses; the way is regular, so automatic bytes keep to it as well."""
    for axis, machine in enumerate(machines[2:]):
        axes = swing(machine, axis)
        for branches in (None, (0,) * machine.robot.BRANCHES):
            way = axes[:: 1 if branches is None else 3]
            found, answered = follow(machine.robot, machine, way, branches)
            assert answered.all()
            assert np.abs(found - way).max() < TOLERANCE
        if machine.closure.angles[axis]:
            assert axes[:, axis].min() < 180.0 < axes[:, axis].max()
            periods = machine.robot.forward_batch(axes)[2][:, machine.robot.BRANCHES + axis]
            assert set(periods) == {1, 2}


def test_through_a_limit(machines: tuple[LoopMachine, ...]) -> None:
    """Answered inside, refused outside, step by step: in a range of several turns no other turn is taken instead."""
    for machine in machines[:1]:
        axis = len(machine.mechanism.joints) - 1
        key = machine.mechanism.joints[axis].key
        axes = swing(machine, axis)[::3]
        end = float(axes[0, axis])
        for sign in (1.0, -1.0):
            lower, upper = sorted((end, end - sign * 700.0))
            robot = machine.changed(**{f"lower_{key}": lower, f"upper_{key}": upper})
            inside = sign * (axes[:, axis] - end) <= 1e-9
            clear = np.abs(axes[:, axis] - end) > 1e-6
            answered = follow(robot, machine, axes)[1]
            assert (answered == inside)[clear].all()
            assert 0 < answered.sum() < len(axes)
