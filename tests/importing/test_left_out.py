"""What kinematics does not need is a line of the report, and other frames of links are the same description."""

import re
from collections.abc import Iterator, Mapping
from math import cos, sin
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from derive.description.joints import Kind
from derive.importing.arms.lines import Arm, arm_of
from derive.importing.formats.urdf import read_urdf
from derive.importing.importing import Options
from derive.pipeline import derive_one
from tests.importing.kinematics import assert_is, by_yourdfpy, described, imported, imported_text, refused
from tests.importing.robots import COLLECTION, WRITTEN, File, joint, urdf, written
from tests.machines.made import imported_class
from tests.orthonormal import random_rotations

PLAIN = urdf(
    "arm",
    joint("turn", "revolute", "0 0 0.4"),
    joint("lift", "revolute", "0.1 0 0", axis="0 1 0"),
    joint("bend", "revolute", "0 0 0.5", axis="0 1 0"),
    joint("tool", "fixed", "0 0 0.1"),
)
XACRO = PLAIN.replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ')
ENDS = ("link0", "link4")
MACROS: Mapping[str, tuple[str, tuple[str | None, str | None], str]] = {
    "a property": ('<xacro:property name="mass" value="2"/>', (None, None), "property"),
    "an argument": ('<xacro:arg name="prefix" default=""/>', (None, None), "arg"),
    "a macro that nothing calls": (
        '<xacro:macro name="box" params="m"><inertial><mass value="${m}"/></inertial></xacro:macro>',
        (None, None),
        "macro",
    ),
    "a call, with both ends named": ('<xacro:gripper parent="link4"/>', ENDS, "gripper"),
    "an include, with both ends named": ('<xacro:include filename="$(find x)/colours.xacro"/>', ENDS, "include"),
    "a condition, with both ends named": ('<xacro:if value="$(arg s)"><gazebo/></xacro:if>', ENDS, "if"),
}


@pytest.mark.parametrize("name", MACROS)
@pytest.mark.parametrize("file", ["arm.urdf", "arm.xacro", "arm.urdf.xacro"])
def test_a_macro_that_the_chain_does_not_need_is_told(name: str, file: str, tmp_path: Path) -> None:
    macro, ends, told = MACROS[name]
    found = imported_text(tmp_path / file, XACRO.replace("</robot>", f"{macro}</robot>"), *ends)
    assert f"Not read, because nothing between base and tip needs them: macros ({told}" in found.report
    chain = found.text.split("chain=")[1].split("\n")[0]
    assert chain == imported_text(tmp_path / "plain.urdf", PLAIN).text.split("chain=")[1].split("\n")[0]


def test_expressions_in_masses_and_meshes_are_not_read(tmp_path: Path) -> None:
    shape = '<visual><origin xyz="${x} 0 0"/><geometry><mesh filename="$(find p)/a.stl"/></geometry></visual>'
    text = XACRO.replace('<link name="link1"/>', f'<link name="link1">{shape}</link>')
    assert imported_text(tmp_path / "arm.urdf", text.replace('effort="1"', 'effort="${e}"')).axes == ("A1", "A2", "A3")


ACTUATORS = '<actuator><position joint="m1"/><motor joint="m2"/></actuator>'
LEGS = """<mujoco><worldbody><body name="k1" pos="-0.1 0 0"><joint name="m1"/><body name="r1" pos="0.3 0 0">
  <joint name="p1"/><site name="end1" pos="0.4 0 0"/>{0}</body></body><body name="k2" pos="0.1 0 0"><joint name="m2"/>
  <body name="r2" pos="0.3 0 0"><joint name="p2"/><site name="end2" pos="0.4 0 0"/></body></body>
  <body name="part" pos="1 0 0"><freejoint/></body><body name="goal" mocap="true"/></worldbody>
  <equality>{1}</equality>{2}</mujoco>"""
CONNECT = '<connect body1="r1" body2="r2" anchor="0.4 0 0"/>'
BOUND: Mapping[str, tuple[str, str]] = {
    "connect": (CONNECT, "a connect of 'r1' and 'r2' closes a loop of the joints"),
    "connect of sites": ('<connect site1="end1" site2="end2"/>', "a connect of 'end1' and 'end2'"),
    "weld": ('<weld body1="r1" body2="r2"/>', "a weld of 'r1' and 'r2'"),
    "weld to the world": ('<weld body1="r1"/>', "a weld of 'r1' and 'world' closes a loop of the joints 'p1', 'm1'"),
}
OPEN: Mapping[str, str] = {
    "switched off": CONNECT.replace("/>", ' active="false"/>'),
    "what it holds": '<weld body1="r1" body2="part"/>',
    "where a program leads it": '<weld body1="r1" body2="goal"/>',
    "a loop of other joints": CONNECT.replace("r1", "k2"),
}


@pytest.mark.parametrize("name", BOUND)
def test_a_loop_that_binds_the_arm_is_refused(name: str, tmp_path: Path) -> None:
    """The rods meet beside the tip (`test_rods` has those that meet in it)."""
    closed, sentence = BOUND[name]
    said = refused(tmp_path / "r.xml", LEGS.format("", closed, ACTUATORS), Options(tip="r1"))
    assert sentence in said and "describe it with rods" in said
    assert ("'p1', 'p2' are passive" if "'r2'" in sentence else "passive") in said or "end" in sentence


@pytest.mark.parametrize("name", OPEN)
def test_a_loop_that_does_not_bind_it_is_not(name: str, tmp_path: Path) -> None:
    found = imported_text(tmp_path / "r.xml", LEGS.format("", OPEN[name], ACTUATORS), tip="end1")
    assert ("closes a loop" in found.report) == name.startswith("a loop")


def test_a_loop_whose_joints_follow_each_other_is_that_of_the_arm(tmp_path: Path) -> None:
    """A parallelogram, with its equality, and the bar that a simulator closes."""
    text = """<mujoco><worldbody><body name="k"><joint name="m0"/><body name="l" pos="0.3 0 0"><joint name="m1"/>
        <body name="r" pos="0.4 0 0"><joint name="p"/><site name="end" pos="0.1 0 0"/></body></body></body></worldbody>
        <equality><joint joint1="p" joint2="m1" polycoef="0 -1 0 0 0"/><connect body1="k" body2="r" anchor="0 0.1 0"/>
        </equality></mujoco>"""
    found = imported_text(tmp_path / "r.xml", text, tip="end")
    assert "Not read, because its joints follow each other: a connect of 'k' and 'r' closes a loop" in found.report


URDF_LOOPS = {
    "a joint for Gazebo": '<gazebo><joint name="c" type="revolute"><parent>{0}</parent><child>{1}</child></joint>'
    "</gazebo>",
    "a loop joint": '<loop_joint name="c" type="revolute"><link1 link="{0}"/><link2 link="{1}"/></loop_joint>',
    "a second joint above a link": '<joint name="c" type="revolute"><parent link="{1}"/><child link="{0}"/></joint>',
}
FINGER = "".join(
    f'<link name="{child}"/><joint name="j_{child}" type="revolute"><parent link="{parent}"/><child link="{child}"/>'
    "</joint>"
    for parent, child in (("link4", "finger"), ("finger", "nail"))
)


@pytest.mark.parametrize("name", URDF_LOOPS)
def test_a_loop_of_a_urdf_is_refused_and_told_where_it_is_beside_the_chain(name: str, tmp_path: Path) -> None:
    path = tmp_path / "r.urdf"
    said = refused(
        path, PLAIN.replace("</robot>", URDF_LOOPS[name].format("link2", "link0") + "</robot>"), Options(*ENDS)
    )
    assert re.search(r"joint 'c'.* closes a loop of the joints '.*: as an open arm", said)
    beside = FINGER + URDF_LOOPS[name].format("nail", "link4")
    found = imported_text(path, PLAIN.replace("</robot>", f"{beside}</robot>"), *ENDS)
    assert "Not read, because no joint between base and tip is in it: " in found.report


def test_a_joint_of_gazebo_to_the_world_closes_nothing(tmp_path: Path) -> None:
    fixed = '<gazebo><joint name="c" type="fixed"><parent>world</parent><child>link0</child></joint></gazebo>'
    assert "loop" not in imported_text(tmp_path / "r.urdf", PLAIN.replace("</robot>", f"{fixed}</robot>")).report


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


Array = NDArray[np.float64]
SEEDS = 8
ROWS: Mapping[str, tuple[tuple[str, str], ...]] = {
    "three parallel axes, beside each other": (
        ("0 0 0.15", "0 0 1"),
        ("0 0.11 0", "0 1 0"),
        ("-0.25 0 0", "0 1 0"),
        ("-0.21 0 0.02", "0 1 0"),
        ("0 0.08 -0.085", "0 0 1"),
        ("0 0.08 0", "0 1 0"),
    ),
    "forearm beside its axis by more than what is snapped": (
        ("0 0 0.22", "0 0 1"),
        ("0 0 0", "0 1 0"),
        ("0 0 0.38", "0 1 0"),
        ("0 0.0000028 0.4", "0 0 1"),
        ("0 0 0", "0 1 0"),
        ("0 0 0.1", "0 0 1"),
    ),
    "an inclined wrist": (
        ("0 0 0.3", "0 0 1"),
        ("0.1 0 0", "0 1 0"),
        ("0 0 0.4", "0 1 0"),
        ("0.35 0 0.05", "1 0 0"),
        ("0 0 0", f"{cos(1.0)!r} 0 {sin(1.0)!r}"),
        ("0 0 0", "1 0 0"),
    ),
    "an offset wrist": (
        ("0 0 0.245", "0 0 1"),
        ("0 0 0", "0 1 0"),
        ("0 0 0.71", "0 1 0"),
        ("0 0 0", "1 0 0"),
        ("0.54 0 0", "0 1 0"),
        ("0 -0.15 0", "1 0 0"),
    ),
}
"""The way to each axis, and its direction, at zero."""
FILES = tuple(name for name in (*COLLECTION, *WRITTEN) if name != "Fanuc")
"""In the file of the Fanuc a joint follows another, which is no matter of frames."""


def _file(name: str, folder: Path) -> File:
    if name in COLLECTION:
        return COLLECTION[name]
    if name in WRITTEN:
        return written(name, 17, folder)
    path = folder / "rows.urdf"
    joints = (joint(f"a{k}", "revolute", xyz, axis=axis) for k, (xyz, axis) in enumerate(ROWS[name], 1))
    path.write_text(urdf("rows", *joints, joint("flange", "fixed", "0 0.05 0")), encoding="utf-8")
    return File(path, "link0", f"link{len(ROWS[name]) + 1}")


def _joints(arm: Arm, seed: int, digits: int = 17) -> Iterator[tuple[str, ...]]:
    """The joints of an arm, each at any place on its axis, in a frame that is turned anyhow."""
    rng = np.random.default_rng(seed)
    before = np.eye(4)
    for k, line in enumerate(arm.lines, 1):
        here = np.eye(4)
        here[:3, :3], here[:3, 3] = random_rotations(1, rng)[0], line.point + rng.uniform(-0.1, 0.1) * line.direction
        axis = here[:3, :3].T @ line.direction
        kind = "prismatic" if line.kind is Kind.LINEAR else "revolute"
        yield joint(f"a{k}", kind, *_origin(before, here, digits), axis=_text(axis, digits))
        before = here
    yield joint("flange", "fixed", *_origin(before, arm.tip, digits))


def _text(numbers: Array, digits: int) -> str:
    return " ".join(f"{number:.{digits}g}" for number in numbers)


def _origin(before: Array, here: Array, digits: int) -> tuple[str, str]:
    """The place of a frame in the one before: xyz, and turns about fixed x, y, z."""
    way = np.linalg.inv(before) @ here
    r = way[:3, :3]
    across = np.hypot(r[0, 0], r[1, 0])
    turns = np.array([np.arctan2(r[2, 1], r[2, 2]), np.arctan2(-r[2, 0], across), np.arctan2(r[1, 0], r[0, 0])])
    return _text(way[:3, 3], digits), _text(turns, digits)


@pytest.mark.slow
@pytest.mark.parametrize("name", [*ROWS, *FILES])
def test_a_description_does_not_depend_on_the_frames_of_the_file(name: str, tmp_path: Path) -> None:
    file = _file(name, tmp_path)
    arm = arm_of(read_urdf(file.path, file.base, file.tip, 1.0))
    assert all(len(line.drives) == 1 and line.drives[0][1] == 1.0 for line in arm.lines)
    texts = set()
    for seed in range(SEEDS):
        found = imported_text(tmp_path / "arm.urdf", urdf("arm", *_joints(arm, seed)))
        texts.add(found.text.split('"""', 2)[2])
    assert len(texts) == 1


@pytest.mark.parametrize("digits", [6, 9, 12])
@pytest.mark.parametrize("name", ["an offset wrist", "UR5e"])
def test_what_frames_have_rounded_makes_no_other_chain(name: str, digits: int, tmp_path: Path) -> None:
    """In frames at any angle no number is a rounded right angle: the turns between two axes are rounded together."""
    file = _file(name, tmp_path)
    arm = arm_of(read_urdf(file.path, file.base, file.tip, 1.0))
    path, exact = tmp_path / "arm.urdf", imported(file.path, file.base, file.tip)
    for seed in range(SEEDS):
        found = imported_text(path, urdf("arm", *_joints(arm, seed, digits)))
        chains = [one.chain.pieces for one in (found, exact) if one.chain is not None]
        own, stated = ([(p.motion, p.letter, p.drives) for p in pieces] for pieces in chains)
        assert own == stated and found.bounds.rotation <= 100.0 * 0.1**digits
        assert_is(found, tmp_path, by_yourdfpy(path, "link0", f"link{len(arm.lines) + 1}"))
