"""What an import refuses: one sentence that names the file, the thing, and what helps."""

import re
from pathlib import Path

import pytest

from derive.command.line import main
from derive.importing.importing import Options
from tests.importing.kinematics import refused
from tests.importing.refusals import OTHER_FORMATS, Refusals
from tests.importing.robots import joint, urdf

ARM = urdf("arm", joint("a", "revolute"), joint("b", "revolute", "0.1 0 0"), joint("c", "prismatic", "0.2 0 0"))


def links(names: str) -> str:
    """Links, each called by one letter."""
    return "".join(f'<link name="{name}"/>' for name in names)


def turning(*joints: str) -> str:
    """Joints that turn, each by three letters: its name, its parent and its child."""
    return "".join(
        f'<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/></joint>'
        for name, parent, child in joints
    )


def robot(inside: str) -> str:
    """A URDF with this inside."""
    return f'<robot name="r">{inside}</robot>'


REFUSALS: Refusals = {
    "r.urdf": {
        "no base": (ARM, r"no link is called 'base_link' \(--base\); there are link0, link1", Options("base_link")),
        "no tip": (ARM, r"no link is called 'tool0' \(--tip\); there are link0", Options("link0", "tool0")),
        "two tips": (
            robot(links("abc") + turning("jab", "kac")),
            r"has 2 possible tip links: choose with --tip: b, c$",
        ),
        "two bases": (
            robot(links("abc") + turning("jac")),
            r"has 2 possible base links: choose with --base: a, b$",
            Options(tip="c"),
        ),
        "no way": (robot(links("abc") + turning("jac")), r"no way leads from 'a' to 'b'$", Options("a", "b")),
        "the same link": (ARM, r"base and tip are the same link, 'link1'$", Options("link1", "link1")),
        "a missing link": (
            robot(links("a") + turning("jab")),
            r"joint 'j' names the link 'b', which the file has not$",
        ),
        "a joint without a child": (
            robot(links("a") + '<joint name="j" type="fixed"><parent link="a"/></joint>'),
            r"joint 'j' names no child link$",
        ),
        "two links of one name": (robot(links("aa")), r"two links are called 'a'$"),
        "an unknown type": (
            ARM.replace('type="prismatic"', 'type="screw"'),
            r"joint 'c' has the unknown type 'screw'; there are revolute, continuous, prismatic, fixed$",
        ),
        "no type": (ARM.replace('type="prismatic"', ""), r"<joint> 'c' has no type$"),
        "a floating joint": (
            ARM.replace('type="prismatic"', 'type="floating"'),
            r"joint 'c' is floating: it moves freely in space; choose a base behind it or a tip before it$",
        ),
        "a closed chain": (
            robot(links("abc") + turning("jab", "kac", "lbc")),
            r"joint 'l' closes a loop of the joints 'j', 'k': as an open arm it would be another machine; describe it",
            Options("a", "c"),
        ),
        "a ring": (
            robot(links("ab") + turning("jab", "kba")),
            r"its links form a closed chain: 'a' is below itself$",
            Options("a", "b"),
        ),
        "a ring without names": (
            robot(links("ab") + turning("jab", "kba")),
            r"its links form a closed chain: no link is the base$",
        ),
        "nothing moves": (urdf("r", joint("a", "fixed")), r"no joint moves between 'link0' and 'link1'$"),
        "broken XML": ("<robot>\n<link name='a'>\n</robot>", r"r\.urdf:3: broken XML: mismatched tag"),
        "nothing": ("", r"r\.urdf:1: broken XML: no element found"),
        "another root": ("<sdf/>", r"its root is <sdf>, not <robot>: this is no URDF$"),
        "a macro alone": (
            '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="m"><link/></xacro:macro></robot>',
            r"'macro' may add links: expand it, `xacro r\.urdf > r_expanded\.urdf`",
        ),
        "an expression of the limits": (
            ARM.replace('lower="-3.0"', 'lower="${-pi}"', 1),
            r"joint 'a' holds the macro '\${-pi}'",
        ),
        "an include": (robot("<include/>"), r"'include' may add links: expand it"),
        "no links": ("<robot/>", r"has no links$"),
        "no number": (ARM.replace("0.1 0 0", "0,1 0 0"), r"joint 'b', xyz: '0,1' is no number$"),
        "not finite": (ARM.replace("0.1 0 0", "nan 0 0"), r"joint 'b', xyz: 'nan' is no number$"),
        "two numbers": (ARM.replace("0.1 0 0", "0.1 0"), r"joint 'b', xyz: '0\.1 0' has 2 numbers, not 3$"),
        "an axis of zeros": (ARM.replace("0 0 1", "0 0 0", 1), r"joint 'a': its axis has no direction$"),
        "limits the wrong way round": (
            ARM.replace('lower="-3.0" upper="3.0"', 'lower="2" upper="-1"', 1),
            r"joint 'a': its lower limit 2 is above its upper limit -1$",
        ),
        "mimics in a circle": (
            urdf(
                "r",
                joint("a", "revolute", mimic='<mimic joint="b"/>'),
                joint("b", "revolute", mimic='<mimic joint="a"/>'),
            ),
            r"joints mimic each other in a circle: a, b, a$",
        ),
        "a mimic of nothing": (
            urdf("r", joint("a", "revolute", mimic='<mimic joint="z"/>')),
            r"a joint mimics 'z', which is no joint of the file$",
        ),
        "an unknown axis to hold": (ARM, r"no axis is called 'E7' \(--hold\); there are A", Options(hold=("E7",))),
        "a tip that turns about x": (
            urdf(
                "r",
                joint("a", "revolute", axis="1 0 0"),
                joint("b", "revolute", "0 0.2 0", axis="1 0 0"),
                joint("c", "revolute", "0 0.2 0", axis="1 0 0"),
            ),
            r"its tip turns about one axis that is not z of the base: choose a base link whose z is along that axis",
        ),
        "one direction": (
            urdf("r", joint("a", "prismatic", axis="0.6 0 0.8")),
            r"its tip has 1 free motion and moves along x, z, and a description commands each coordinate that moves",
        ),
        "a mimic without a joint": (
            urdf("r", joint("a", "revolute"), joint("b", "revolute", mimic='<mimic multiplier="2"/>')),
            "the mimic of joint 'b' names no joint$",
        ),
        "a mimic of a fixed joint": (
            urdf("r", joint("a", "fixed"), joint("b", "revolute", mimic='<mimic joint="a"/>')),
            "a joint mimics 'a', which is fixed$",
        ),
        "a tip that leans": (
            urdf(
                "r",
                joint("a", "revolute"),
                joint("b", "revolute", "0.3 0 0"),
                joint("c", "revolute", "0.2 0 0"),
                joint("tip", "fixed", "0.1 0 0", "0.3 0 0"),
            ),
            "its tip turns about z of the base, and its own z axis is not along that: choose a --tip whose z axis is$",
        ),
        "a tip without a direction that four axes can follow": (
            urdf(
                "r",
                joint("a", "revolute"),
                *(joint(k, "revolute", "0 0 0.3", axis="0 1 0") for k in "bcd"),
                joint("tip", "fixed", "0.1 0 0", "0.3 0.4 0.5"),
            ),
            "no axis of its tip is a direction that the chain can follow: choose a --tip whose z axis",
        ),
        "a plane that is no coordinate plane": (
            urdf("r", joint("a", "prismatic", axis="1 0 0"), joint("b", "prismatic", axis="0 0.6 0.8")),
            "its tip has 2 free motions and moves along x, y, z, and a description commands each coordinate that "
            "moves: choose a base link whose axes are along the motions, or another tip$",
        ),
        "a tip on the last axis": (
            urdf(
                "r",
                joint("a", "revolute"),
                joint("b", "revolute", "0.2 0 0", axis="0 1 0"),
                joint("c", "revolute", "0.2 0 0", axis="1 0 0"),
            ),
            "its tip lies on the axis of its last joint, which turns it and shifts it nowhere: choose the link before "
            "that joint as --tip, or one beside its axis$",
        ),
        "a tip on the last of two parallel axes": (
            urdf("r", joint("a", "revolute"), joint("b", "revolute", "0.2 0 0")),
            "its tip lies on the axis of its last joint",
        ),
        "ways that are no task": (
            urdf(
                "r", joint("a", "revolute"), joint("b", "revolute", axis="1 0 0"), joint("c", "prismatic", axis="1 0 0")
            ),
            "its tip moves in 3 ways that are no task of a description: choose another base or tip, or write the "
            "description by hand$",
        ),
    },
    "r.xacro": {
        "macros": (
            '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="a"/></robot>',
            r"'include' may add links: expand it, `xacro r\.xacro > r_expanded\.urdf`, and import that, or name --base",
        )
    },
    "my r.urdf": {
        "an expression": (
            ARM.replace("0.1 0 0", "${width} 0 0"),
            r"joint 'b' holds the macro '\${width} 0 0': expand it, `xacro 'my r\.urdf' > 'my r_expanded\.urdf'`, and",
        )
    },
    **OTHER_FORMATS,
}
CASES = [(file, what) for file, cases in REFUSALS.items() for what in cases]


@pytest.mark.parametrize(("file", "what"), CASES, ids="-".join)
def test_what_is_refused(file: str, what: str, tmp_path: Path) -> None:
    text, sentence, *options = REFUSALS[file][what]
    said = refused(tmp_path / file, text, *options)
    assert re.search(sentence, said), said


def test_files_that_are_none(tmp_path: Path) -> None:
    assert "there is no such file" in refused(tmp_path / "missing.urdf", None)
    assert "is a folder; name the robot file in it" in refused(tmp_path, None)
    assert "is no text in UTF-8" in refused(tmp_path / "r.toml", b"\xff\xfe\xfa")


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (Options(unit="inch"), r"the unit 'inch' is not known; there are mm, m$"),
        (Options(snap=0.2), r"--snap 0\.2 is not between 0 and 0\.05"),
        (Options(snap=-1.0), r"--snap -1 is not between 0 and 0\.05"),
    ],
)
def test_options_that_no_file_can_have(options: Options, sentence: str, tmp_path: Path) -> None:
    said = refused(tmp_path / "r.urdf", ARM, options, is_of_the_file=False)
    assert re.search(sentence, said), said


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
