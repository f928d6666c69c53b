"""Transmissions of a URDF, and joints that are held: forward kinematics is in joint values all the same."""

from pathlib import Path

import pytest

from tests.importing.kinematics import assert_is, by_yourdfpy, described, imported_text
from tests.importing.robots import joint, urdf
from tests.machines.made import built_of

ARM = urdf(
    "arm",
    joint("j1", "revolute", "0 0 0.4"),
    joint("j2", "revolute", "0.1 0 0", axis="0 1 0"),
    joint("j3", "revolute", "0 0 0.5", axis="0 1 0"),
    joint("tool", "fixed", "0 0 0.1"),
)
SIMPLE = """<transmission name="t1"><type>transmission_interface/SimpleTransmission</type>
  <joint name="j1"><hardwareInterface>PositionJointInterface</hardwareInterface></joint>
  <actuator name="m1"><mechanicalReduction> 101 </mechanicalReduction></actuator></transmission>"""
OLD = """<transmission name="t2" type="pr2_mechanism_model/SimpleTransmission">
  <actuator name="m2"/><joint name="j2"/><mechanicalReduction>-50.5</mechanicalReduction></transmission>"""
CONTROL = """<ros2_control name="c" type="system"><transmission name="t2">
  <plugin>transmission_interface/SimpleTransmission</plugin><actuator name="m2" role="actuator1"/>
  <joint name="j2" role="joint1"><mechanical_reduction>3</mechanical_reduction></joint></transmission></ros2_control>"""
COUPLED = """<transmission name="arm"><type>transmission_interface/FourBarLinkageTransmission</type>
  <actuator name="m2"><mechanicalReduction>50</mechanicalReduction></actuator><actuator name="m3"/>
  <joint name="j2"/><joint name="j3"/></transmission>"""
OTHER = SIMPLE.replace('"j1"', '"finger"')
STATED = "Transmissions are not part of a description: axis values are the joint values of the file."
REPORTS = {
    "reductions": (SIMPLE + OLD, [f"{STATED} Reductions, for the drives: j1 101, j2 -50.5."]),
    "ros2_control": (CONTROL, [f"{STATED} Reductions, for the drives: j2 3."]),
    "no number": (
        SIMPLE.replace("101", "1:50") + OLD,
        [f"{STATED} Reductions, for the drives: j1 '1:50' (no number), j2"],
    ),
    "no reduction": (SIMPLE.replace(" 101 ", "1"), [f"{STATED}\n"]),
    "coupled": (
        COUPLED,
        [
            "The FourBarLinkageTransmission 'arm' couples j2 and j3: a motor moves both. Axis values are joint values; "
            "where the controller commands the motors, add `coupling=` to j3.",
            f"{STATED} Reductions, for the drives: m2 50.",
        ],
    ),
}


@pytest.mark.parametrize("name", REPORTS)
def test_they_are_reported_and_change_nothing(name: str, tmp_path: Path) -> None:
    inside, lines = REPORTS[name]
    path, plain = tmp_path / "arm.urdf", tmp_path / "plain.urdf"
    chain = described(imported_text(plain, ARM), tmp_path).chain
    found = imported_text(path, ARM.replace("</robot>", f"{inside}</robot>"))
    for line in lines:
        assert line in found.report + "\n"
    assert found.bounds.position == found.bounds.rotation == 0.0
    mechanism = assert_is(found, tmp_path, by_yourdfpy(plain, "link0", "link4"))
    assert mechanism.chain == chain


def test_that_of_a_gripper_is_not_told(tmp_path: Path) -> None:
    assert "ransmission" not in imported_text(tmp_path / "arm.urdf", ARM.replace("</robot>", f"{OTHER}</robot>")).report


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
