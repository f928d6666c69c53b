"""Poses where two branches meet, or a rod stands across its rail: the boundary belongs to the workspace."""

import numpy as np
import pytest
from softkin import Status

from derive.description.mechanism import Turning
from tests.catalogue.refusals import status_of
from tests.catalogue.turning.test_home import home_slot
from tests.catalogue.turning_machines import TurningMachine, turning_machine
from tests.mechanisms import has_struts
from tests.orthonormal import rodrigues
from tests.text.controller import OK, Controller
from tests.text.units import compiled

AWAY = 0.15
"""The distance from home at which the first leg ends, in reaches."""
UPRIGHT = np.array([[0.0, 0.0, 1.0]])
TILTS = np.array([[np.cos(angle), np.sin(angle), 0.0] for angle in np.radians((30.0, 120.0))])


def at_its_end(machine: TurningMachine) -> tuple[TurningMachine, np.ndarray, np.ndarray]:
    """The machine with a first rod that just reaches a pose beside home, and that pose."""
    positions, rotations = machine.closure.around_home(60, np.random.default_rng(67), size=AWAY)
    span = _across(machine, positions, rotations)
    home = _across(machine, machine.closure.home_position[None], machine.closure.home_rotation[None])[0]
    chosen = int(np.argmax(span))
    assert span[chosen] > home
    given = {**machine.given, "rod_length_1": float(span[chosen])}
    return turning_machine(machine.mechanism, "ends", given), positions[chosen], rotations[chosen]


def _across(machine: TurningMachine, positions: np.ndarray, rotations: np.ndarray) -> np.ndarray:
    """The least distance between the first rod's joints: its square is a sine of an angle, a parabola of a length."""
    first, joints = machine.mechanism.rods[0], np.zeros((len(positions), len(machine.mechanism.joints)))
    ends = [p - b for p, b in zip(first.plate, first.base, strict=True)]

    def squared(value: float) -> np.ndarray:
        joints[:, 0] = value
        return np.sum(machine.closure.at(ends, joints, positions, rotations) ** 2, axis=1)

    quarter = np.pi / 2.0 if machine.closure.angles[0] else machine.reach
    back, there, ahead = (squared(k * quarter) for k in (-1, 0, 1))
    middle, slope = (ahead + back) / 2.0, (ahead - back) / 2.0
    if machine.closure.angles[0]:
        return np.sqrt(middle - np.hypot(there - middle, slope))
    return np.sqrt(there - slope**2 / (4.0 * (middle - there)))


def test_at_the_end_of_a_leg_both_branches_answer_the_same(machines: tuple[TurningMachine, ...]) -> None:
    """In Python and in Structured Text; a little inside they are apart, a little beyond there is no answer."""
    if "rod_length_1" not in machines[0].given:  # its legs are joints, which end at limits alone
        assert has_struts(machines[0].mechanism)
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
    outward = position - machine.closure.home_position, rotation - machine.closure.home_rotation
    for step, expected in ((-1e-4, Status.OK), (1e-4, Status.UNREACHABLE)):
        turned = machine.closure.reachable((rotation + step * outward[1])[None])[0]
        assert status_of(machine.robot.inverse, (position + step * outward[0], turned), own) is expected


@pytest.mark.slow("Hexaglide", "Pentapod", "Planar")
def test_a_path_into_a_type_2_singularity_is_stopped_before(machines: tuple[TurningMachine, ...]) -> None:
    """The platform turns, or tilts, until a leg ends or nothing holds it: what stops it there is the margin."""
    reasons: list[str] = []
    for machine in machines:
        own = home_slot(machine)
        about = TILTS if machine.mechanism.task.turning is Turning.DIRECTION else UPRIGHT
        for axis in (*about, *-about):
            left = 1.0
            for angle in np.radians(np.arange(0.0, 179.0, 0.25)):
                turned = (rodrigues(axis, angle) @ machine.closure.home_rotation)[None]
                pose = (machine.closure.home_position, machine.closure.reachable(turned)[0])
                if status_of(machine.robot.inverse, pose, own) is not Status.OK:
                    reasons.append(str(machine.robot.diagnose(pose, own)))
                    assert "rods_dependent" not in reasons[-1] or left < 0.05
                    break
                axes = np.array([machine.robot.inverse(pose, own)])
                sides = machine.closure.side(machine.closure.joints(axes), *(p[None] for p in pose))
                assert sides[0] > 0
                left = sides[0] / machine.closure.at_home
    assert len(reasons) == 2 * len(about) * len(machines)
    assert any("rods_dependent" in reason for reason in reasons)
