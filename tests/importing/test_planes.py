"""Robot files whose tip moves in some of x, y and z alone."""

from pathlib import Path

import numpy as np
import pytest

from derive.pipeline import derive_one
from tests.importing.kinematics import by_yourdfpy, described, imported_text
from tests.importing.robots import joint, urdf
from tests.machines.made import imported_class

ACROSS = "0 1 0"
FLAT = {
    "xz": urdf(
        "upright", joint("a", "revolute", "0 0.05 0.4", axis=ACROSS), joint("b", "revolute", "0.3 0 0", axis=ACROSS),
        joint("tip", "fixed", "0.2 0 0"),
    ),
    "yz": urdf("rack", joint("a", "prismatic", "0.1 0 0", axis=ACROSS), joint("b", "prismatic", axis="0 0 -1")),
    "z": urdf("lift", joint("a", "prismatic", "0.1 0.2 0", axis="0 0 1")),
}  # fmt: skip


@pytest.mark.parametrize("position", FLAT)
def test_a_tip_that_moves_in_some_coordinates_commands_these(position: str, tmp_path: Path) -> None:
    path = tmp_path / "robot.urdf"
    base, tip = "link0", f"link{FLAT[position].count('<joint name')}"
    mechanism = described(imported_text(path, FLAT[position], base, tip), tmp_path)
    assert mechanism.task.position == position
    robot = imported_class(mechanism, derive_one(mechanism))(check_limits=False)
    pose = by_yourdfpy(path, base, tip)
    for axes in np.random.default_rng(3).uniform(-1.0, 1.0, (20, len(mechanism.joints))):
        joints = np.where([j.is_angle for j in mechanism.joints], np.degrees(axes), 1000.0 * axes)
        frame, _ = robot.forward(joints)
        seen = pose(dict(zip("ab", axes, strict=False)))
        assert np.allclose(np.array(frame.position) / 1000.0, seen[:3, 3], rtol=0.0, atol=1e-12)
        found = [s.axes for s in robot.inverse_all(frame, joints) if s.axes is not None]
        assert any(np.allclose(one, joints, rtol=0.0, atol=1e-6) for one in found)
