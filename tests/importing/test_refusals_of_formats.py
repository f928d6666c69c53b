"""What the readers of MJCF, of tables and of URDF refuse beside `test_refusals`: one sentence each, with the place."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import pytest

from derive.importing.importing import Options, import_robot
from derive.importing.robot import UnreadableRobot
from tests.importing.robots import joint, urdf

MODEL = '<mujoco>{0}<worldbody><body name="a"><joint name="j" {1}/><body name="b" {2}/></body></worldbody></mujoco>'
TABLE = 'convention = "standard"\nangles = "degrees"\nlengths = "mm"\n'
REFUSALS: Mapping[str, tuple[str, str, str]] = {
    "another root": ("r.xml", "<mujoco/>", "has no worldbody$"),
    "no bodies": ("r.xml", "<mujoco><worldbody/></mujoco>", "has no bodies$"),
    "two tips": (
        "r.xml",
        '<mujoco><worldbody><body name="a"/><body name="b"/></worldbody></mujoco>',
        "has 2 possible tips: choose with --tip: a, b$",
    ),
    "copies": (
        "r.xml",
        '<mujoco><worldbody><replicate count="2"><body name="a"/></replicate></worldbody></mujoco>',
        "replicates or attaches parts: save the expanded model, and import that$",
    ),
    "gradians": (
        "r.xml",
        MODEL.format('<compiler angle="gradian"/>', "", ""),
        "angles in 'gradian': there are degree and radian$",
    ),
    "an axis of zeros": ("r.xml", MODEL.format("", 'axis="0 0 0"', ""), "joint 'j': its axis has no direction$"),
    "an unknown type": (
        "r.xml",
        MODEL.format("", 'type="screw"', ""),
        "joint 'j' has the unknown type 'screw'; there are hinge and slide$",
    ),
    "limits the wrong way round": (
        "r.xml",
        MODEL.format('<compiler angle="radian"/>', 'range="2 -1"', ""),
        "joint 'j': its lower limit 2 is above its upper limit -1$",
    ),
    "two bodies of one name": (
        "r.xml",
        '<mujoco><worldbody><body name="a"><body name="a"/></body></worldbody></mujoco>',
        "two bodies or sites are called 'a'$",
    ),
    "two joints of one name": (
        "r.xml",
        '<mujoco><worldbody><body name="a"><joint name="j"/><body name="b"><joint name="j"/></body></body></worldbody>'
        "</mujoco>",
        "two joints are called 'j'$",
    ),
    "a joint in a frame": (
        "r.xml",
        '<mujoco><worldbody><body name="a"><frame><joint name="j"/></frame></body></worldbody></mujoco>',
        "a frame in body 'a' holds a joint: write the joint into the body$",
    ),
    "a sequence of angles": (
        "r.xml",
        MODEL.format('<compiler eulerseq="xyw"/>', "", 'euler="1 2 3"'),
        "its sequence of angles 'xyw' is not three of xyz, or of XYZ$",
    ),
    "a quaternion of zeros": (
        "r.xml",
        MODEL.format("", "", 'quat="0 0 0 0"'),
        "body 'b': its orientation has no direction$",
    ),
    "a table without rows": ("r.toml", TABLE, "has no rows$"),
    "an empty table": ("r.csv", "# convention: standard\n# angles: degrees\n# lengths: mm\n", "has no rows$"),
    "rows of one name": (
        "r.toml",
        TABLE + '[[joints]]\nname = "A1"\n[[joints]]\nname = "A1"\n',
        "two rows have the same name$",
    ),
    "rows that are no tables": ("r.toml", TABLE + "joints = 3\n", r"its rows must be tables \[\[joints\]\]$"),
    "a row of an unknown type": (
        "r.toml",
        TABLE + '[[joints]]\ntype = "screw"\n',
        "row 'A1' has the unknown type 'screw'; there are revolute, prismatic, fixed$",
    ),
    "a row with its limits the wrong way round": (
        "r.toml",
        TABLE + "[[joints]]\nlower = 9.5\nupper = -3\n",
        r"row 'A1': its lower limit 9\.5 is above its upper limit -3$",
    ),
    "a row whose coupling is a number": (
        "r.toml",
        TABLE + "[[joints]]\n[[joints]]\ncoupling = -1\n",
        r"row 'A2': its coupling -1 is not like {A2 = -1}$",
    ),
    "a mimic without a joint": (
        "r.urdf",
        urdf("r", joint("a", "revolute"), joint("b", "revolute", mimic='<mimic multiplier="2"/>')),
        "the mimic of joint 'b' names no joint$",
    ),
    "a mimic of a fixed joint": (
        "r.urdf",
        urdf("r", joint("a", "fixed"), joint("b", "revolute", mimic='<mimic joint="a"/>')),
        "a joint mimics 'a', which is fixed$",
    ),
    "a tip that leans": (
        "r.urdf",
        urdf(
            "r",
            joint("a", "revolute"),
            joint("b", "revolute", "0.3 0 0"),
            joint("c", "revolute", "0.2 0 0"),
            joint("tip", "fixed", "0.1 0 0", "0.3 0 0"),
        ),
        "its tip turns about z of the base, and its own z axis is not along that: choose a --tip whose z axis is$",
    ),
    "a plane that is no coordinate plane": (
        "r.urdf",
        urdf("r", joint("a", "prismatic", axis="1 0 0"), joint("b", "prismatic", axis="0 0.6 0.8")),
        "its tip has 2 free motions and moves along x, y, z, and a description commands each coordinate that moves: "
        "choose a base link whose axes are along the motions, or another tip$",
    ),
    "ways that are no task": (
        "r.urdf",
        urdf(
            "r",
            joint("a", "revolute"),
            joint("b", "revolute", axis="1 0 0"),
            joint("c", "prismatic", axis="1 0 0"),
        ),
        "its tip moves in 3 ways that are no task of a description: choose another base or tip, or write the "
        "description by hand$",
    ),
    "a tip on the last axis": (
        "r.urdf",
        urdf(
            "r",
            joint("a", "revolute"),
            joint("b", "revolute", "0.1 0 0", axis="0 1 0"),
            joint("c", "revolute", "0 0 0.4", axis="0 0 1"),
            joint("tip", "fixed", "0 0 0.2"),
        ),
        "its tip moves in 3 ways that are no task of a description: it lies on the axis of the last joint; choose a "
        "--tip beside that axis, or one before this joint$",
    ),
}


def refused(path: Path, options: Options = Options()) -> str:  # noqa: B008
    """What is said of a file."""
    with pytest.raises(UnreadableRobot) as refusal:
        import_robot(path, options)
    said = str(refusal.value)
    assert said.startswith(str(path)) and "\n" not in said
    return said


@pytest.mark.parametrize("name", REFUSALS)
def test_what_is_refused(name: str, tmp_path: Path) -> None:
    file, text, sentence = REFUSALS[name]
    path = tmp_path / file
    path.write_text(text, encoding="utf-8")
    said = refused(path)
    assert re.search(sentence, said), said


def test_files_that_are_none(tmp_path: Path) -> None:
    assert "is a folder; name the robot file in it" in refused(tmp_path)
    path = tmp_path / "r.toml"
    path.write_bytes(b"\xff\xfe\xfa")
    assert "is no text in UTF-8" in refused(path)


def test_a_base_that_is_the_tip(tmp_path: Path) -> None:
    path = tmp_path / "r.xml"
    path.write_text(MODEL.format("", "", ""), encoding="utf-8")
    assert "base and tip are the same body, 'b'" in refused(path, Options("b", "b"))


def test_a_tip_without_a_direction_that_follows(tmp_path: Path) -> None:
    """Four axes that command a pitch, and a tip of which no axis stays square to the last one."""
    path = tmp_path / "r.urdf"
    arm = [joint("a", "revolute"), *(joint(k, "revolute", "0 0 0.3", axis="0 1 0") for k in "bcd")]
    path.write_text(urdf("r", *arm, joint("tip", "fixed", "0.1 0 0", "0.3 0.4 0.5")), encoding="utf-8")
    assert "no axis of its tip is a direction that the chain can follow: choose a --tip whose z axis" in refused(path)
