"""Pairs of singular factors driven together, in executed Structured Text: no pose is lost, and every answer is met."""

from dataclasses import replace

import numpy as np
import pytest

from derive.description.mechanism import Mechanism
from tests.catalogue.cornered import KR6_D3, PAIRED, places, poses
from tests.catalogue.machines import machine
from tests.catalogue.references import held_at
from tests.text.controller import OK
from tests.text.serial_pairs import serial_pair

pytestmark = pytest.mark.slow

BOUND = 1e-11
"""Of what is missed: two free angles at their thresholds of 2e-12, either of them a chord of 2, and rounding."""
SOME = 3
"""Poses of a corner: the package is tested on all of them."""


@pytest.mark.parametrize("paired", PAIRED, ids=lambda m: m.name)
def test_no_pose_is_lost(paired: Mechanism) -> None:
    """Where two singularities coincide the block reaches every pose."""
    rng = np.random.default_rng(11)
    for one, corner in places(paired):
        given = {**one.given, "check_limits": 0.0}
        pair = serial_pair(replace(one, robot=one.changed(check_limits=False), given=given))
        axes = poses(one, corner)
        for row in axes[rng.choice(len(axes), SOME)].tolist():
            status, answer = pair.controller.forward(row)
            assert status == OK
            position, rotation, own = answer
            opened = (0,) * len(one.robot.CONFIGURATION)
            branches = (*own[: one.robot.BRANCHES], *opened[one.robot.BRANCHES :])
            references = (row, [0.0] * len(row), rng.uniform(-180.0, 180.0, len(row)).tolist())
            for any_reference in references:
                reference = held_at(one.robot, row, any_reference).tolist()
                for configuration in (branches, opened):
                    status, found = pair.controller.inverse(position, rotation, configuration, reference)
                    assert status == OK, f"{pair} {corner.names} {row} {configuration} {reference}"
                    met = np.array([found[: len(row)]]), np.array([position]), np.array([rotation])
                    assert one.miss(*met)[0] < BOUND, f"{pair} {corner.names} {row} {configuration} {reference}"


def test_a_shoulder_and_an_elbow_at_once() -> None:
    """The shoulder's root is rounding, 5.4e-9 too long for the elbow that is stretched."""
    (mechanism,) = (m for m in PAIRED if m.name == "Kin_ArticulatedRobot_6DOF")
    pair = serial_pair(machine(mechanism, "shifted", KR6_D3))
    axes = (110.0, 1.6345249003522546, 85.23635830927383, -70.0, -30.0, 100.0)
    _, (position, rotation, own) = pair.controller.forward(axes)
    for configuration in (own, (0,) * len(own)):
        status, found = pair.controller.inverse(position, rotation, configuration, axes)
        assert status == OK
        assert pair.machine.miss(np.array([found]), np.array([position]), np.array([rotation]))[0] < 1e-12
