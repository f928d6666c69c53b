"""Seven axes, one of them held where the axes beside it are parallel: there it stays, and there it begins."""

import numpy as np
import pytest

from derive.description.mechanism import Mechanism, Task, Turning, angle, length, radians
from derive.description.validate import validate
from derive.geometry.frames import Chain, Rx, Ry, Rz, Tx, Ty, Tz
from derive.ir.interpret import run
from derive.ir.program import Status
from derive.ir.symbols import branch_sign
from derive.kinematics.build import build
from derive.kinematics.search.choice import with_search
from derive.kinematics.solution import prepared
from derive.witness.onward import every_root
from tests.unit.kinematics.test_elimination import commanded, poses_of
from tests.unit.kinematics.test_refusals import J

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
    search = with_search(prepared(validate(arm))).search
    assert search is not None and search.is_eliminated


FOLDED = (
    Tz(317) * Rz(A1) * Tx(81) * Ry(A2) * Ty(192.5) * Rx(A3) * Tx(400) * Ry(A4) * Ty(-168.5) * Rx(A5) * Tx(400)
) * (Ry(A6) * Ty(136.3) * Rx(A7) * Tx(133.75))


@pytest.mark.slow
@pytest.mark.parametrize(("chain", "held", "angles"), [(CHAIN, 2, (0.0, 90.0, 180.0, -90.0)), (FOLDED, 3, (180.0,))])
def test_no_planted_joints_are_missed(chain: Chain, held: int, angles: tuple[float, ...]) -> None:
    """Joints anywhere, and the held one at each right angle: they are among all solutions of their pose. Where the
    elbow is folded, two solutions have the same searched joint.
    """
    arm = Mechanism("Arm", joints=J[:7], chain=chain, task=Task("xyz", Turning.FULL), held=(J[held],))
    kin = build(validate(arm))
    assert kin.mechanism.search is not None and kin.mechanism.search.is_eliminated
    joints = np.random.default_rng(5).uniform(-np.pi, np.pi, (16, 7))
    joints[:, held] = np.radians(np.resize(angles, 16))
    references = np.degrees(joints)
    references[:, [k for k in range(7) if k != held]] = 0.0
    found, are = every_root(kin, commanded(kin, poses_of(chain, kin.mechanism, joints), references))
    apart = np.abs(np.exp(1j * np.radians(found)) - np.exp(1j * joints)).max(axis=2)
    assert np.all(np.where(are, apart, 9.0).min(axis=0) < 1e-6)
    named = {branch_sign(b.name).name: np.ones(16) for b in kin.branches}
    own = commanded(kin, poses_of(chain, kin.mechanism, joints), np.degrees(joints))
    answers = [run(kin.branch, own | {name: side * one for name, one in named.items()}) for side in (1.0, -1.0)]
    gaps = [np.stack([a[j.axis.name] for j in kin.mechanism.joints], axis=1) - np.degrees(joints) for a, _ in answers]
    least = [
        np.where(status == Status.OK, np.abs(gap).max(axis=1), 9.0)
        for (_, status), gap in zip(answers, gaps, strict=True)
    ]
    assert np.all(np.min(least, axis=0) < 1e-5)
