"""The nearest solution of machines with gears, belts and differentials: their turns move several axes."""

import numpy as np
import pytest
from softkin import KinematicsError, Status

from tests.catalogue.calls.test_nearest import NUMBERS, by_naming
from tests.machines.made import made
from tests.machines.task_machines import DRIVEN
from tests.machines.test_gears import anywhere, tolerance


@pytest.mark.parametrize("name", DRIVEN)
@pytest.mark.parametrize("measure", ["squares", "largest"])
def test_no_sum_of_turns_is_nearer(name: str, measure: str) -> None:
    """Limits about the pose, references on other turns; a batch says the same."""
    machine, rng = made(name), np.random.default_rng(8)
    counted = list(machine.robot._criteria[0].axes)
    angles = machine.closure.angles
    outcomes = []
    for axes in anywhere(machine, 2, turns=1.0):
        frame = machine.robot.forward(axes)[0]
        size = np.where(angles, 1.0, machine.reach / 300.0)
        limits = {
            axis.name: (float(value - rng.uniform(-50, 700) * s), float(value + rng.uniform(60, 700) * s))
            for axis, value, s in zip(machine.robot.AXES, axes, size, strict=True)
        }
        robot = machine.robot.changed(limits=limits)
        near = tuple((axes + np.where(angles, rng.uniform(-400.0, 400.0, len(axes)), 0.0)).tolist())
        truth = by_naming(robot, frame, near, NUMBERS if len(robot.PERIOD_AXES) <= 2 else (-2, -1, 1, 2))
        batch, statuses = robot.nearest_batch([frame.position], [frame.rotation], [near], measure=measure)
        try:
            found = robot.nearest(frame, near, measure=measure)
        except KinematicsError as error:
            assert not truth and error.status == statuses[0]
            continue
        assert statuses[0] == Status.OK and np.abs(batch[0] - found).max() < 1e-9 * (1.0 + machine.reach)
        outcomes.append(found)
        assert robot._beyond_limits(found) is None
        again = robot.inverse(frame, robot.forward(found)[1], found)
        assert (np.abs(np.subtract(again, found)) <= tolerance(machine)).all()
        apart = [np.abs(np.subtract(other, near))[counted] for other in (found, *truth)]
        own, *others = [(a.max() if measure == "largest" else (a * a).sum()) for a in apart]
        assert own <= min(others, default=np.inf) + (2e-3 if measure == "largest" else 2e-6) + 1e-9 * own
    assert outcomes
