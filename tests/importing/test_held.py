"""Which of seven joints an import holds: one without which the rest has a closed form; and joints that are not read."""

from pathlib import Path

import pytest

from tests.importing.kinematics import described, imported_text
from tests.importing.robots import joint, urdf
from tests.machines.made import built_of

_HALF = "1.57079632679"
PANDA = urdf(
    "panda",
    joint("joint_1", "revolute", "0 0 0.333"),
    joint("joint_2", "revolute", rpy=f"-{_HALF} 0 0"),
    joint("joint_3", "revolute", "0 -0.316 0", f"{_HALF} 0 0"),
    joint("joint_4", "revolute", "0.0825 0 0", f"{_HALF} 0 0"),
    joint("joint_5", "revolute", "-0.0825 0.384 0", f"-{_HALF} 0 0"),
    joint("joint_6", "revolute", rpy=f"{_HALF} 0 0"),
    joint("joint_7", "revolute", "0.088 0 0", f"{_HALF} 0 0"),
    joint("flange", "fixed", "0 0 0.107"),
)
"""Franka Emika Panda, from the Denavit-Hartenberg parameters that the maker publishes."""


@pytest.mark.slow
def test_an_arm_whose_wrist_axes_miss_each_other_holds_its_last_joint(tmp_path: Path) -> None:
    """Its shoulder is a point, and the axes of A5 and A6 meet; with any other joint held no closed form is known."""
    found = imported_text(tmp_path / "robot.urdf", PANDA)
    assert "held=(A7,)" in found.text and "Held where the reference has it: A7" in found.report
    evidence = built_of(described(found, tmp_path)).evidence
    assert evidence is not None and evidence.inverted is not None and evidence.inverted.solutions == 8


def test_a_mimic_of_nothing_that_no_joint_of_the_chain_follows_is_not_read(tmp_path: Path) -> None:
    """A hand behind the tip, or on another arm, may be written badly."""
    fingers = joint("finger", "revolute", "0 0 0.1", mimic='<mimic joint="thumb"/>')
    text = urdf(
        "arm",
        joint("turn", "revolute"),
        joint("bend", "revolute", "0.3 0 0"),
        joint("end", "fixed", "0.2 0 0"),
        fingers,
    )
    found = imported_text(tmp_path / "robot.urdf", text, tip="link3")
    assert found.axes == ("A1", "A2") and "finger" in found.text
