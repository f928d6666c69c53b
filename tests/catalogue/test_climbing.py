"""A helical axis moves a linear one along by its pitch: then it has no period, and is always limited."""

import numpy as np
import pytest
from softkin import Status

from derive.description.mechanism import Kind, Mechanism
from tests.catalogue.machines import Machine, few
from tests.catalogue.machines import machine as machine_of
from tests.catalogue.references import held_at
from tests.catalogue.test_limits import fitting, one_pose, outcome

pytestmark = pytest.mark.serial


def climbing(machine: Machine) -> float:
    """How far the carried axis travels per turn: zero where there is no such axis, or no pitch."""
    parameters = machine.robot.parameters
    return parameters.get("pitch_zc", 0.0) or parameters.get("gear_coupling", 0.0)


@pytest.mark.long
def test_an_axis_that_carries_another_is_always_limited(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    """To two turns either way where no limit is given; without a pitch it turns without end, as any other axis."""
    helical = [i for i, j in enumerate(mechanism.joints) if j.kind is Kind.HELICAL]
    assert bool(helical) == mechanism.name.endswith(("ZCcoupled", "ZCcoupled_Type1"))
    chosen = list(few(machines))
    if "gear_coupling" in machines[0].robot.parameters:
        chosen.append(machine_of(mechanism, "geared", {**machines[0].given, "gear_coupling": -0.05}))
    limited = set()
    for machine in chosen:
        axes = machine.draw(1, np.random.default_rng(8))[0]
        for i, joint in enumerate(mechanism.joints):
            if not joint.multi_turn:
                continue
            ends = i in helical and climbing(machine) != 0.0
            limited.add(ends)
            for value in (719.99, 720.0, -720.0, 720.0 + 1e-5, 720.01, -720.01, 5000.0, -5000.0):
                axes[i] = value
                expected = Status.UNREACHABLE if ends and abs(value) > 720.0 else Status.OK
                positions, rotations = machine.closure.poses(axes[None])
                configuration, near = machine.robot.forward(axes)[1], held_at(machine.robot, axes)
                assert machine.robot.inverse_batch(positions, rotations, configuration, near)[1][0] == expected
                unchecked = machine.changed(check_limits=False)
                assert unchecked.inverse_batch(positions, rotations, configuration, near)[1][0] == Status.OK
            axes[i] = 20.0
    assert (True in limited) == bool(helical)


def test_limits_of_its_own_replace_the_two_turns(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    for machine in fitting(machines):
        for i, joint in enumerate(mechanism.joints):
            if joint.kind is not Kind.HELICAL:
                continue
            robot = machine.changed(**{f"lower_{joint.key}": -90.0, f"upper_{joint.key}": 400.0})
            axes = one_pose(machine, 9)
            for value in (399.0, -89.0, 401.0, -91.0):
                axes[i] = value
                assert outcome(robot, machine, axes) is (Status.OK if -90 < value < 400 else Status.UNREACHABLE)
