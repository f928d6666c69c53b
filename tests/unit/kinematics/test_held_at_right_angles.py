"""Seven axes, one of them held where the axes beside it are parallel: there it stays, and there it begins."""

import numpy as np
import pytest

from derive.description.mechanism import Mechanism, Task, Turning, angle, length, radians
from derive.description.validate import validate
from derive.geometry.frames import Ry, Rz, Ty, Tz
from derive.kinematics.build import build
from derive.witness.onward import every_root
from tests.unit.kinematics.test_elimination import commanded, poses_of
from tests.unit.kinematics.test_refused_within_bounds import J

A1, A2, A3, A4, A5, A6, A7 = J[:7]
CHAIN_TO_WRIST = (
    Rz(A1) * Tz(280) * Ty(5) * Ry(A2) * Ty(7) * Tz(420) * Rz(A3) * Ty(13) * Ry(A4) * Tz(310) * Ty(-9) * Rz(A5)
) * (Ty(12) * Ry(A6) * Tz(110) * Ty(10))
CHAIN = CHAIN_TO_WRIST * Rz(A7) * Tz(60)
TWIST, TIP = angle("twist", "turn of the flange", nominal=20.0), length("tip", "flange to tip", nominal=80.0)


@pytest.mark.slow
def test_a_turn_by_a_held_joint_and_an_angle() -> None:
    """The last joint, held, stands in one factor of the chain with an angle of the machine."""
    chain = CHAIN_TO_WRIST * Rz(A7 + radians(TWIST)) * Ty(TIP)
    arm = Mechanism(
        "Arm", parameters=(TWIST, TIP), joints=J[:7], chain=chain, task=Task("xyz", Turning.FULL), held=(A7,)
    )
    search = build(validate(arm)).mechanism.search
    assert search is not None and search.is_eliminated


@pytest.mark.slow
def test_no_planted_joints_are_missed() -> None:
    """Joints anywhere, and the held one at each right angle: they are among all solutions of their pose."""
    kin = build(validate(Mechanism("Arm", joints=J[:7], chain=CHAIN, task=Task("xyz", Turning.FULL), held=(A3,))))
    assert kin.mechanism.search is not None and kin.mechanism.search.is_eliminated
    joints = np.random.default_rng(5).uniform(-np.pi, np.pi, (32, 7))
    joints[:, 2] = np.radians(np.tile([0.0, 90.0, 180.0, -90.0], 8))
    references = np.degrees(joints)
    references[:, [0, 1, 3, 4, 5, 6]] = 0.0
    found, are = every_root(kin, commanded(kin, poses_of(CHAIN, kin.mechanism, joints), references))
    apart = np.abs(np.exp(1j * np.radians(found)) - np.exp(1j * joints)).max(axis=2)
    assert np.all(np.where(are, apart, 9.0).min(axis=0) < 1e-6)
