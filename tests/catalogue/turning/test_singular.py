"""Poses where two branches meet, or a rod stands across its rail: the boundary belongs to the workspace."""

import numpy as np
import pytest
import sympy as sp
from softkin import Status

from tests.catalogue.refusals import status_of
from tests.catalogue.turning.test_home import home_slot
from tests.catalogue.turning_machines import TurningMachine, turning_machine
from tests.text.controller import OK, Controller
from tests.text.units import compiled

AWAY = 0.15
"""The distance from home at which the first leg ends, in reaches."""


def at_its_end(machine: TurningMachine) -> tuple[TurningMachine, np.ndarray, np.ndarray]:
    """The machine with a first rod that just reaches a pose beside home, and that pose: the one of many around home
    that is farthest from its base.
    """
    positions, rotations = machine.closure.around_home(60, np.random.default_rng(67), size=AWAY)
    span = _across(machine, positions, rotations)
    home = _across(machine, machine.closure.home_position[None], machine.closure.home_rotation[None])[0]
    chosen = int(np.argmax(span))
    assert span[chosen] > home
    crank = machine.given.get("arm_length_1", 0.0)
    given = {**machine.given, "rod_length_1": float(span[chosen]) - crank}
    return turning_machine(machine.mechanism, "ends", given), positions[chosen], rotations[chosen]


def _across(machine: TurningMachine, positions: np.ndarray, rotations: np.ndarray) -> np.ndarray:
    """The distance of the first rod's joint on the platform from its motor, or from its rail."""
    first, joint = machine.mechanism.rods[0], machine.mechanism.joints[0]
    ends = [p - b for p, b in zip(first.plate, first.base, strict=True)]
    kept = [sp.sympify(e).subs({sp.cos(joint.symbol): 0, sp.sin(joint.symbol): 0}) for e in ends]
    kept = [e for e in kept if joint.symbol not in e.free_symbols]
    joints = np.zeros((len(positions), len(machine.mechanism.joints)))
    return np.linalg.norm(machine.closure.at(kept, joints, positions, rotations), axis=1)


def test_at_the_end_of_a_leg_both_branches_answer_the_same(machines: tuple[TurningMachine, ...]) -> None:
    """In Python and in Structured Text; a little inside they are apart, a little beyond there is no answer."""
    if "rod_length_1" not in machines[0].given:  # its legs are joints, which end at limits alone
        assert machines[0].mechanism.name == "Kin_Hexapod"
        return
    machine, position, rotation = at_its_end(machines[0])
    own = home_slot(machine)
    reference = (0.0,) * len(machine.robot.AXES)
    axes = machine.robot.inverse((position, rotation), own, reference)
    assert machine.miss(np.array([axes]), position[None], rotation[None]).max() < 1e-9
    if machine.robot.BRANCHES:
        other = machine.robot.inverse((position, rotation), (3 - own[0], *own[1:]), reference)
        assert np.abs(np.subtract(axes, other)).max() < 1e-3
    found = machine.robot.singularity(axes)
    assert found.is_singular and min(abs(m) for m in found.margins.values()) < 1e-3
    controller = Controller(compiled(machine.mechanism), machine.mechanism)
    assert controller.initialise(machine.robot.parameters) == OK
    status, text = controller.inverse(tuple(position), rotation.tolist(), own, reference)
    assert status == OK and text[: len(axes)] == pytest.approx(axes, abs=1e-9)
    assert controller.is_singular(axes)
    outward = position - machine.closure.home_position
    for step, expected in ((-1e-4, Status.OK), (1e-4, Status.UNREACHABLE)):
        status = status_of(machine.robot.inverse, (position + step * outward, rotation), own)
        assert status is expected


@pytest.mark.slow("Hexaglide", "Planar")
def test_a_path_into_a_type_2_singularity_is_stopped_before(machines: tuple[TurningMachine, ...]) -> None:
    """The platform turns about z, in the configuration of home, until a leg ends or nothing holds it: until then it is
    in the mode of the machine, and what stops it there is the margin, which has become small.
    """
    reasons: list[str] = []
    for machine in machines:
        own = home_slot(machine)
        for side in (1.0, -1.0):
            left = 1.0
            for angle in np.radians(np.arange(0.0, 179.0, 0.25)) * side:
                turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1.0]])
                pose = (machine.closure.home_position, turn @ machine.closure.home_rotation)
                if status_of(machine.robot.inverse, pose, own) is not Status.OK:
                    reasons.append(str(machine.robot.diagnose(pose, own)))
                    assert "rods_dependent" not in reasons[-1] or left < 0.05
                    break
                axes = np.array([machine.robot.inverse(pose, own)])
                sides = machine.closure.side(machine.closure.joints(axes), *(p[None] for p in pose))
                assert sides[0] > 0
                left = sides[0] / machine.closure.at_home
    assert len(reasons) == 2 * len(machines)
    assert any("rods_dependent" in reason for reason in reasons)
