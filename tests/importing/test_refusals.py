"""What an import refuses: one sentence that names the file, the thing, and what helps."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import pytest

from derive.command.line import main
from derive.importing.importing import Options, import_robot
from derive.importing.robot import UnreadableRobot
from tests.importing.robots import joint, urdf

ARM = urdf("arm", joint("a", "revolute"), joint("b", "revolute", "0.1 0 0"), joint("c", "prismatic", "0.2 0 0"))
TURN = '<joint name="{}" type="{}"><parent link="{}"/><child link="{}"/></joint>'
SCARA_TABLE = 'convention = "standard"\nangles = "degrees"\nlengths = "mm"\n[[joints]]\na = 200\n[[joints]]\na = 100\n'
MODEL = '<mujoco><worldbody><body name="a">{}<body name="b">{}</body></body></worldbody>{}</mujoco>'
HINGE = '<joint name="{}" pos="0.1 0 0"/>'


def links(*names: str) -> str:
    """Links by their names."""
    return "".join(f'<link name="{name}"/>' for name in names)


def robot(inside: str) -> str:
    """A URDF with this inside."""
    return f'<robot name="r">{inside}</robot>'


Refusal = tuple[str, str, Options, str]
"""Name of the file, its text, how it is imported, and what is said."""
O = Options  # noqa: E741
REFUSALS: Mapping[str, Refusal] = {
    "no base": ("r.urdf", ARM, O("base_link"), r"no link is called 'base_link' \(--base\); there are link0, link1"),
    "no tip": ("r.urdf", ARM, O("link0", "tool0"), r"no link is called 'tool0' \(--tip\); there are link0"),
    "two tips": (
        "r.urdf",
        robot(links("a", "b", "c") + TURN.format("j", "revolute", "a", "b") + TURN.format("k", "revolute", "a", "c")),
        O(),
        r"has 2 possible tip links: choose with --tip: b, c$",
    ),
    "two bases": (
        "r.urdf",
        robot(links("a", "b", "c") + TURN.format("j", "revolute", "a", "c")),
        O(tip="c"),
        r"has 2 possible base links: choose with --base: a, b$",
    ),
    "no way": (
        "r.urdf",
        robot(links("a", "b", "c") + TURN.format("j", "revolute", "a", "c")),
        O("a", "b"),
        r"no way leads from 'a' to 'b'$",
    ),
    "the same link": ("r.urdf", ARM, O("link1", "link1"), r"base and tip are the same link, 'link1'$"),
    "a missing link": (
        "r.urdf",
        robot(links("a") + TURN.format("j", "revolute", "a", "b")),
        O(),
        r"joint 'j' names the link 'b', which the file has not$",
    ),
    "a joint without a child": (
        "r.urdf",
        robot(links("a") + '<joint name="j" type="fixed"><parent link="a"/></joint>'),
        O(),
        r"joint 'j' names no child link$",
    ),
    "two links of one name": ("r.urdf", robot(links("a", "a")), O(), r"two links are called 'a'$"),
    "an unknown type": (
        "r.urdf",
        ARM.replace('type="prismatic"', 'type="screw"'),
        O(),
        r"joint 'c' has the unknown type 'screw'; there are revolute, continuous, prismatic, fixed$",
    ),
    "no type": ("r.urdf", ARM.replace('type="prismatic"', ""), O(), r"<joint> 'c' has no type$"),
    "a floating joint": (
        "r.urdf",
        ARM.replace('type="prismatic"', 'type="floating"'),
        O(),
        r"joint 'c' is floating: it moves freely in space; choose a base behind it or a tip before it$",
    ),
    "a closed chain": (
        "r.urdf",
        robot(
            links("a", "b", "c")
            + TURN.format("j", "revolute", "a", "b")
            + TURN.format("k", "revolute", "a", "c")
            + TURN.format("l", "revolute", "b", "c")
        ),
        O("a", "c"),
        r"joint 'l' closes a loop of the joints 'j', 'k': as an open arm it would be another machine; describe it with",
    ),
    "a ring": (
        "r.urdf",
        robot(links("a", "b") + TURN.format("j", "revolute", "a", "b") + TURN.format("k", "revolute", "b", "a")),
        O("a", "b"),
        r"its links form a closed chain: 'a' is below itself$",
    ),
    "a ring without names": (
        "r.urdf",
        robot(links("a", "b") + TURN.format("j", "revolute", "a", "b") + TURN.format("k", "revolute", "b", "a")),
        O(),
        r"its links form a closed chain: no link is the base$",
    ),
    "nothing moves": ("r.urdf", urdf("r", joint("a", "fixed")), O(), r"no joint moves between 'link0' and 'link1'$"),
    "broken XML": ("r.urdf", "<robot>\n<link name='a'>\n</robot>", O(), r"r\.urdf:3: broken XML: mismatched tag"),
    "nothing": ("r.urdf", "", O(), r"r\.urdf:1: broken XML: no element found"),
    "another root": ("r.urdf", "<sdf/>", O(), r"its root is <sdf>, not <robot>: this is no URDF$"),
    "macros": (
        "r.xacro",
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="a"/></robot>',
        O(),
        r"'include' may add links: expand it, `xacro r\.xacro > r_expanded\.urdf`, and import that, or name --base and",
    ),
    "a macro alone": (
        "r.urdf",
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="m"><link/></xacro:macro></robot>',
        O(),
        r"'macro' may add links: expand it, `xacro r\.urdf > r_expanded\.urdf`",
    ),
    "an expression": (
        "my r.urdf",
        ARM.replace("0.1 0 0", "${width} 0 0"),
        O(),
        r"joint 'b' holds the macro '\${width} 0 0': expand it, `xacro 'my r\.urdf' > 'my r_expanded\.urdf'`, and",
    ),
    "an expression of the limits": (
        "r.urdf",
        ARM.replace('lower="-3.0"', 'lower="${-pi}"', 1),
        O(),
        r"joint 'a' holds the macro '\${-pi}'",
    ),
    "an include": ("r.urdf", robot("<include/>"), O(), r"'include' may add links: expand it"),
    "no links": ("r.urdf", "<robot/>", O(), r"has no links$"),
    "no number": ("r.urdf", ARM.replace("0.1 0 0", "0,1 0 0"), O(), r"joint 'b', xyz: '0,1' is no number$"),
    "not finite": ("r.urdf", ARM.replace("0.1 0 0", "nan 0 0"), O(), r"joint 'b', xyz: 'nan' is no number$"),
    "two numbers": ("r.urdf", ARM.replace("0.1 0 0", "0.1 0"), O(), r"joint 'b', xyz: '0\.1 0' has 2 numbers, not 3$"),
    "an axis of zeros": ("r.urdf", ARM.replace("0 0 1", "0 0 0", 1), O(), r"joint 'a': its axis has no direction$"),
    "limits the wrong way round": (
        "r.urdf",
        ARM.replace('lower="-3.0" upper="3.0"', 'lower="2" upper="-1"', 1),
        O(),
        r"joint 'a': its lower limit 2 is above its upper limit -1$",
    ),
    "mimics in a circle": (
        "r.urdf",
        urdf(
            "r",
            joint("a", "revolute", mimic='<mimic joint="b"/>'),
            joint("b", "revolute", mimic='<mimic joint="a"/>'),
        ),
        O(),
        r"joints mimic each other in a circle: a, b, a$",
    ),
    "a mimic of nothing": (
        "r.urdf",
        urdf("r", joint("a", "revolute", mimic='<mimic joint="z"/>')),
        O(),
        r"a joint mimics 'z', which is no joint of the file$",
    ),
    "an unknown unit": ("r.urdf", ARM, O(unit="inch"), r"the unit 'inch' is not known; there are mm, m$"),
    "much snapping": ("r.urdf", ARM, O(snap=0.2), r"--snap 0\.2 is not between 0 and 0\.05"),
    "a negative snap": ("r.urdf", ARM, O(snap=-1.0), r"--snap -1 is not between 0 and 0\.05"),
    "an unknown axis to hold": ("r.urdf", ARM, O(hold=("E7",)), r"no axis is called 'E7' \(--hold\); there are A"),
    "a tip that turns about x": (
        "r.urdf",
        urdf(
            "r",
            joint("a", "revolute", axis="1 0 0"),
            joint("b", "revolute", "0 0.2 0", axis="1 0 0"),
            joint("c", "revolute", "0 0.2 0", axis="1 0 0"),
        ),
        O(),
        r"its tip turns about one axis that is not z of the base: choose a base link whose z is along that axis",
    ),
    "one direction": (
        "r.urdf",
        urdf("r", joint("a", "prismatic", axis="0.6 0 0.8")),
        O(),
        r"its tip has 1 free motion and moves along x, z, and a description commands each coordinate that moves",
    ),
    "a file that is not there": ("", "", O(), r"there is no such file$"),
    "MJCF: no body": ("r.xml", MODEL.format("", "", ""), O("a", "z"), r"no body or site is called 'z' \(--tip\)"),
    "MJCF: an include": (
        "r.xml",
        "<mujoco><include file='a.xml'/></mujoco>",
        O(),
        r"includes .*a\.xml, and there is no such file",
    ),
    "MJCF: an include of itself": (
        "r.xml",
        "<mujoco><include file='r.xml'/></mujoco>",
        O(),
        r"includes .*r\.xml twice: write it once$",
    ),
    "MJCF: a free joint": (
        "r.xml",
        MODEL.format("<freejoint/>", HINGE.format("j"), ""),
        O(),
        r"body 'a' moves freely in space: choose a base that it carries$",
    ),
    "MJCF: a ball joint": (
        "r.xml",
        MODEL.format('<joint name="j" type="ball"/>', "", ""),
        O(),
        r"joint 'j' turns freely about a point: choose a base that it carries$",
    ),
    "MJCF: a curve": (
        "r.xml",
        MODEL.format(
            HINGE.format("i"),
            HINGE.format("j"),
            '<equality><joint joint1="j" joint2="i" polycoef="0 1 2 0 0"/></equality>',
        ),
        O(),
        r"joint 'j' follows no joint, or by a curve: only `joint1 = a0 \+ a1 \* joint2` is known$",
    ),
    "MJCF: two orientations": (
        "r.xml",
        MODEL.format("", "", "").replace('name="b"', 'name="b" euler="1 0 0" quat="1 0 0 0"'),
        O(),
        r"body 'b' gives its orientation twice: quat and euler$",
    ),
    "MJCF: global coordinates": (
        "r.xml",
        '<mujoco><compiler coordinate="global"/><worldbody/></mujoco>',
        O(),
        r"gives global coordinates",
    ),
    "a table without units": (
        "r.toml",
        SCARA_TABLE.replace('angles = "degrees"\n', ""),
        O(),
        r"says nothing for angles: it must be degrees or radians$",
    ),
    "a table in inches": (
        "r.toml",
        SCARA_TABLE.replace('"mm"', '"inch"'),
        O(),
        r"says 'inch' for lengths: it must be mm or m$",
    ),
    "a table with a misspelt entry": (
        "r.toml",
        SCARA_TABLE.replace("a = 100", "aplha = 100"),
        O(),
        r"row 'A2' has an unknown entry 'aplha'; there are name, type, theta, d, a, alpha, lower, upper, coupling$",
    ),
    "a table with links": ("r.toml", SCARA_TABLE, O(tip="A2"), r"a table has no links: leave --base and --tip out$"),
    "broken TOML": ("r.toml", "a = [", O(), r"r\.toml: broken TOML: "),
    "a table that is coupled to nothing": (
        "r.toml",
        SCARA_TABLE + "coupling = {A9 = 1}\n",
        O(),
        r"row 'A2' is coupled to 'A9', which is no joint of its kind in the table$",
    ),
    "an uneven table": (
        "r.csv",
        "# convention: standard\n# angles: degrees\n# lengths: mm\nname,a,d\nA1,1\n",
        O(),
        r"the row 'A1' has 2 cells, and the header has 3$",
    ),
}


@pytest.mark.parametrize("name", REFUSALS)
def test_what_is_refused(name: str, tmp_path: Path) -> None:
    file, text, options, sentence = REFUSALS[name]
    path = tmp_path / (file or "missing.urdf")
    if file:
        path.write_text(text, encoding="utf-8")
    with pytest.raises(UnreadableRobot) as refusal:
        import_robot(path, options)
    said = str(refusal.value)
    assert re.search(sentence, said), said
    assert "\n" not in said
    if "unit" not in name and "snap" not in name:
        assert said.startswith(str(path))


def test_the_command_writes_a_description_and_does_not_overwrite_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, out = tmp_path / "arm.urdf", tmp_path / "arm.py"
    path.write_text(ARM, encoding="utf-8")
    assert main(["import", str(path), "--base", "link0", "--tip", "link3", "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "A1-A2: distance 100 mm, angle 0°; parallel" in said and f"Written: {out}" in said
    edited = out.read_text(encoding="utf-8") + "# edited\n"
    out.write_text(edited, encoding="utf-8")
    assert main(["import", str(path), "--out", str(out)]) != 0
    assert "exists, and may have been edited: name another file with --out" in capsys.readouterr().err
    assert out.read_text(encoding="utf-8") == edited
