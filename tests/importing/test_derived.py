"""Imported robots are derived: the task that is chosen, transmissions and held joints, and where solutions stand."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
import softkin

from derive.importing.importing import Imported
from derive.pipeline import Built
from tests.importing.kinematics import assert_is, by_yourdfpy, described, facing, imported, imported_text
from tests.importing.robots import COLLECTION, File, joint, urdf, written
from tests.machines.made import built_of, imported_class
from tests.outside import temporary

SOLUTIONS = {
    "KR 16": 8, "KR 120": 8, "KR 210": 8, "iiwa": 8, "Puma 560": 8, "UR5e": 8, "Fanuc": 8, "Staubli": 8, "AL5D": 4,
    "IRB 140": 8, "xArm6": 8,
}  # fmt: skip
"""The IRB 140 and the xArm6 by the root finder."""
FEWEST_DIGITS = 4
"""Of pi in the files of `WRITTEN`: with more digits their descriptions are the same (`test_urdf`)."""
QUICK = ("KR 16",)
"""The others are slow."""
EVERY = pytest.mark.parametrize(
    "name", [name if name in QUICK else pytest.param(name, marks=pytest.mark.slow) for name in SOLUTIONS]
)


@cache
def derived(name: str) -> tuple[File, Imported, Built, type[softkin.Mechanism]]:
    """A robot file, its description, what was derived, and the class of the generated package."""
    folder = temporary("imported")
    file = COLLECTION.get(name) or written(name, FEWEST_DIGITS, folder)
    found = imported(file.path, file.base, file.tip)
    mechanism = described(found, folder)
    built = built_of(mechanism)
    return file, found, built, imported_class(mechanism, built)


@EVERY
def test_every_solution_stands_where_the_file_has_the_tip(name: str) -> None:
    file, found, built, robot_class = derived(name)
    assert built.evidence is not None and built.evidence.inverted is not None
    assert built.evidence.inverted.solutions == SOLUTIONS[name]
    robot, pose = robot_class(check_limits=False), by_yourdfpy(file.path, file.base, file.tip)
    rng = np.random.default_rng(8)
    most = 0
    for axes in rng.uniform(-90.0, 90.0, (20, len(found.axes))):
        frame, _ = robot.forward(axes)
        solutions = [s.axes for s in robot.inverse_all(frame, axes) if s.axes is not None]
        most = max(most, len(solutions))
        assert min(np.abs(np.array(s) - axes).max() for s in solutions) <= 1e-6
        for solution in solutions:
            values = {a.name: float(np.radians(v)) for a, v in zip(found.robot.axes, solution, strict=True)}
            theirs = pose(values) @ facing(found)
            position = np.linalg.norm(np.array(frame.position) - 1000.0 * theirs[:3, 3])
            assert position <= found.bounds.position + 1e-7
            off = np.abs(np.array(frame.rotation) - theirs[:3, :3])
            assert off[:, 2 if "Turning.PITCH)" in found.text else slice(0, 3)].max() <= found.bounds.rotation + 1e-9
    assert most >= SOLUTIONS[name] / 2


@EVERY
def test_the_limits_of_the_file_are_the_limits_of_the_axes(name: str) -> None:
    _, found, _, robot_class = derived(name)
    robot = robot_class()
    for own, axis in zip(found.axes, found.robot.axes, strict=True):
        assert axis.limits is not None
        ends = [robot.parameters[f"{word}_{own.lower()}"] for word in ("lower", "upper")]
        assert np.allclose(ends, np.degrees(axis.limits), rtol=0.0, atol=1e-6)
    inside = np.array([np.degrees(a.limits).mean() for a in found.robot.axes]) + 3.0  # type: ignore[arg-type]
    held = [found.axes[k] for k in robot.HELD]
    frame, configuration = robot.forward(inside)
    assert np.allclose(robot.inverse(frame, configuration, inside), inside, rtol=0.0, atol=1e-6)
    for k, axis in enumerate(found.robot.axes):
        outside = inside.copy()
        outside[k] = np.degrees(axis.limits[1]) + 0.5  # type: ignore[index]
        frame, configuration = robot.forward(outside)
        if found.axes[k] not in held:
            with pytest.raises(
                softkin.KinematicsError, match=f"{found.axes[k]}: (above its upper|this turn is beyond a) limit"
            ):
                robot.inverse(frame, configuration, outside)


HALF = "1.57079632679"
HEADING = joint("pan", "revolute", "0 0 0.12")
PITCHES = [joint(f"pitch{k}", "revolute", f"{x} 0 0", axis="0 1 0") for k, x in enumerate(("0.03", "0.11", "0.13"))]
ROLL = joint("roll", "revolute", "0.05 0 0", axis="1 0 0")
"""A desk arm: a heading, three parallel pitches, and a roll along x."""
SPREAD = [
    joint("a", "revolute", "0 0 0.11"),
    joint("b", "revolute", "0 0 0.2", axis="0 1 0"),
    joint("c", "revolute", "0 0 0.24", axis="0 1 0"),
    joint("d", "revolute", "0 0 0.12"),
    joint("e", "revolute", "0 0 0.14", axis="0 1 0"),
]
"""An arm whose fourth axis runs along its forearm, and whose last one is the pitch of its wrist."""
CASES = {
    "a tip on the roll": ([HEADING, *PITCHES, ROLL], ("0.1 0 0", "0 0 0"), "PITCH_ROLL", 0, None),
    "a tip beside it": ([HEADING, *PITCHES, ROLL], ("0.1 0.009 -0.002", "0 0 0"), "PITCH_ROLL", 0, (0.0, -9.0, 2.0)),
    "a tip beside it that is turned": (
        [HEADING, *PITCHES, ROLL],
        ("0.1 0.009 0", f"0 {HALF} 0"),
        "PITCH_ROLL",
        2,
        (0.0, -9.0, 0.0),
    ),
    "a tip that a tool inclines": ([HEADING, *PITCHES, ROLL], ("0.1 0 0", "0 0.8 0"), "DIRECTION", 2, None),
    "a roll that is not square to the pitches": (
        [HEADING, *PITCHES, joint("roll", "revolute", "0.05 0 0", axis="0.8 0.6 0")],
        ("0.1 0 0.02", "0 0 0"),
        "DIRECTION",
        2,
        None,
    ),
    "a wrist that pitches last": (SPREAD, ("0 0 0", "0 0 0"), "DIRECTION", 2, None),
    "a wrist that pitches last, with a tool": (SPREAD, ("0.02 0 0.1", "0 0 0"), "DIRECTION", 2, None),
    "a wrist that pitches last, its tool along x": (SPREAD, ("0.05 0 0", f"0 0 {HALF}"), "DIRECTION", 2, None),
}


def _arm(name: str, folder: Path) -> Path:
    joints, (xyz, rpy), *_ = CASES[name]
    path = folder / "arm.urdf"
    path.write_text(urdf("arm", *joints, joint("tip", "fixed", xyz, rpy)), encoding="utf-8")
    return path


@pytest.mark.parametrize("name", CASES)
def test_the_task_is_the_one_that_is_wanted(name: str, tmp_path: Path) -> None:
    *_, turning, facing, beside = CASES[name]
    path = _arm(name, tmp_path)
    found = imported(path)
    assert (found.task.turning, found.task.facing) == (turning, facing)
    assert (found.task.beside is None) == (beside is None)
    assert beside is None or np.allclose(found.task.beside, beside, rtol=0.0, atol=1e-9)
    assert ("The tip is moved by" in found.report) == (beside is not None)
    assert "hardly" not in found.report
    assert_is(found, tmp_path, by_yourdfpy(path, found.robot.base, found.robot.tip), turned=1e-11)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["a tip beside it", "a wrist that pitches last"])
def test_poses_near_those_that_are_reached_are_answered(name: str, tmp_path: Path) -> None:
    """The position is met, and all solutions of a pose that is reached have its rotation, as far as it is commanded."""
    found = imported(_arm(name, tmp_path))
    mechanism = described(found, tmp_path)
    robot = imported_class(mechanism, built_of(mechanism))(check_limits=False)
    rng, answered = np.random.default_rng(5), 0
    for axes in rng.uniform(-60.0, 60.0, (60, 5)):
        frame, _ = robot.forward(axes)
        for solution in robot.inverse_all(frame, axes):
            again = robot.forward(solution.axes)[0] if solution.axes else frame
            assert np.allclose(again.rotation, frame.rotation, 0.0, 1e-7) or found.task.turning != "PITCH_ROLL"
            assert np.allclose(np.array(again.rotation)[:, 2], np.array(frame.rotation)[:, 2], rtol=0.0, atol=1e-7)
        near = tuple(np.array(frame.position) + rng.uniform(-2.0, 2.0, 3))
        solved = [s.axes for s in robot.inverse_all((near, frame.rotation), axes) if s.axes is not None]
        answered += bool(solved)
        assert all(np.allclose(robot.forward(s)[0].position, near, rtol=0.0, atol=1e-6) for s in solved)
    assert answered > 50


def test_an_axis_that_hardly_moves_what_is_commanded_is_told(tmp_path: Path) -> None:
    elbow = [joint("a", "revolute"), joint("b", "revolute", "0.4 0 0"), joint("tip", "fixed", "0.003 0 0")]
    report = imported_text(tmp_path / "arm.urdf", urdf("arm", *elbow)).report
    assert "A2 hardly moves what is commanded: 0.00" in report and "A1 hardly" not in report


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


PANDA = urdf(
    "panda",
    joint("joint_1", "revolute", "0 0 0.333"),
    joint("joint_2", "revolute", rpy=f"-{HALF} 0 0"),
    joint("joint_3", "revolute", "0 -0.316 0", f"{HALF} 0 0"),
    joint("joint_4", "revolute", "0.0825 0 0", f"{HALF} 0 0"),
    joint("joint_5", "revolute", "-0.0825 0.384 0", f"-{HALF} 0 0"),
    joint("joint_6", "revolute", rpy=f"{HALF} 0 0"),
    joint("joint_7", "revolute", "0.088 0 0", f"{HALF} 0 0"),
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
