"""Files of MJCF and tables that an import refuses, and what it says of each."""

from collections.abc import Mapping

from derive.importing.importing import Options

Refusals = Mapping[str, Mapping[str, tuple[str, str] | tuple[str, str, Options]]]
"""By the name of the file and what is wrong: its text, what is said, and how it is imported."""
SCARA_TABLE = 'convention = "standard"\nangles = "degrees"\nlengths = "mm"\n[[joints]]\na = 200\n[[joints]]\na = 100\n'
TABLE = SCARA_TABLE.partition("[[joints]]")[0]
CELLS = "# convention: standard\n# angles: degrees\n# lengths: mm\n"
MODEL = '<mujoco><worldbody><body name="a">{}<body name="b">{}</body></body></worldbody>{}</mujoco>'
BODIES = '<mujoco>{0}<worldbody><body name="a"><joint name="j" {1}/><body name="b" {2}/></body></worldbody></mujoco>'
HINGE = '<joint name="{}" pos="0.1 0 0"/>'
OTHER_FORMATS: Refusals = {
    "r.xml": {
        "no body": (MODEL.format("", "", ""), r"no body or site is called 'z' \(--tip\)", Options("a", "z")),
        "an include": ("<mujoco><include file='a.xml'/></mujoco>", r"includes .*a\.xml, and there is no such file"),
        "an include of itself": (
            "<mujoco><include file='r.xml'/></mujoco>",
            r"includes .*r\.xml twice: write it once$",
        ),
        "a free joint": (
            MODEL.format("<freejoint/>", HINGE.format("j"), ""),
            r"body 'a' moves freely in space: choose a base that it carries$",
        ),
        "a ball joint": (
            MODEL.format('<joint name="j" type="ball"/>', "", ""),
            r"joint 'j' turns freely about a point: choose a base that it carries$",
        ),
        "a curve": (
            MODEL.format(
                HINGE.format("i"),
                HINGE.format("j"),
                '<equality><joint joint1="j" joint2="i" polycoef="0 1 2 0 0"/></equality>',
            ),
            r"joint 'j' follows no joint, or by a curve: only `joint1 = a0 \+ a1 \* joint2` is known$",
        ),
        "two orientations": (
            MODEL.format("", "", "").replace('name="b"', 'name="b" euler="1 0 0" quat="1 0 0 0"'),
            r"body 'b' gives its orientation twice: quat and euler$",
        ),
        "global coordinates": (
            '<mujoco><compiler coordinate="global"/><worldbody/></mujoco>',
            r"gives global coordinates",
        ),
        "another root": ("<mujoco/>", "has no worldbody$"),
        "no bodies": ("<mujoco><worldbody/></mujoco>", "has no bodies$"),
        "a base that is the tip": (BODIES.format("", "", ""), "base and tip are the same body, 'b'", Options("b", "b")),
        "two tips": (
            '<mujoco><worldbody><body name="a"/><body name="b"/></worldbody></mujoco>',
            "has 2 possible tips: choose with --tip: a, b$",
        ),
        "copies": (
            '<mujoco><worldbody><replicate count="2"><body name="a"/></replicate></worldbody></mujoco>',
            "replicates or attaches bodies: save the expanded model and import that, or choose with --tip$",
        ),
        "gradians": (
            BODIES.format('<compiler angle="gradian"/>', "", ""),
            "angles in 'gradian': there are degree and radian$",
        ),
        "an axis of zeros": (BODIES.format("", 'axis="0 0 0"', ""), "joint 'j': its axis has no direction$"),
        "an unknown type": (
            BODIES.format("", 'type="screw"', ""),
            "joint 'j' has the unknown type 'screw'; there are hinge and slide$",
        ),
        "limits the wrong way round": (
            BODIES.format('<compiler angle="radian"/>', 'range="2 -1"', ""),
            "joint 'j': its lower limit 2 is above its upper limit -1$",
        ),
        "two bodies of one name": (
            '<mujoco><worldbody><body name="a"><body name="a"/></body></worldbody></mujoco>',
            "two bodies or sites are called 'a'$",
        ),
        "two joints of one name": (
            '<mujoco><worldbody><body name="a"><joint name="j"/><body name="b"><joint name="j"/></body></body>'
            "</worldbody></mujoco>",
            "two joints are called 'j'$",
        ),
        "a joint in a frame": (
            '<mujoco><worldbody><body name="a"><frame><joint name="j"/></frame></body></worldbody></mujoco>',
            "a frame in body 'a' holds a joint: write the joint into the body$",
        ),
        "a sequence of angles": (
            BODIES.format('<compiler eulerseq="xyw"/>', "", 'euler="1 2 3"'),
            "its sequence of angles 'xyw' is not three of xyz, or of XYZ$",
        ),
        "a quaternion of zeros": (
            BODIES.format("", "", 'quat="0 0 0 0"'),
            "body 'b': its orientation has no direction$",
        ),
    },
    "r.toml": {
        "a table without units": (
            SCARA_TABLE.replace('angles = "degrees"\n', ""),
            r"says nothing for angles: it must be degrees or radians$",
        ),
        "a table in inches": (SCARA_TABLE.replace('"mm"', '"inch"'), r"says 'inch' for lengths: it must be mm or m$"),
        "a table with a misspelt entry": (
            SCARA_TABLE.replace("a = 100", "aplha = 100"),
            r"row 'A2' has an unknown entry 'aplha'; there are name, type, theta, d, a, alpha, lower, upper, coupling$",
        ),
        "a table with links": (SCARA_TABLE, r"a table has no links: leave --base and --tip out$", Options(tip="A2")),
        "broken TOML": ("a = [", r"r\.toml: broken TOML: "),
        "a table that is coupled to nothing": (
            SCARA_TABLE + "coupling = {A9 = 1}\n",
            r"row 'A2' is coupled to 'A9', which is no joint of its kind in the table$",
        ),
        "a table without rows": (TABLE, "has no rows$"),
        "rows of one name": (
            TABLE + '[[joints]]\nname = "A1"\n[[joints]]\nname = "A1"\n',
            "two rows have the same name$",
        ),
        "rows that are no tables": (TABLE + "joints = 3\n", r"its rows must be tables \[\[joints\]\]$"),
        "a row of an unknown type": (
            TABLE + '[[joints]]\ntype = "screw"\n',
            "row 'A1' has the unknown type 'screw'; there are revolute, prismatic, fixed$",
        ),
        "a row with its limits the wrong way round": (
            TABLE + "[[joints]]\nlower = 9.5\nupper = -3\n",
            r"row 'A1': its lower limit 9\.5 is above its upper limit -3$",
        ),
        "a row whose coupling is a number": (
            TABLE + "[[joints]]\n[[joints]]\ncoupling = -1\n",
            r"row 'A2': its coupling -1 is not like {A2 = -1}$",
        ),
    },
    "r.csv": {
        "an uneven table": (CELLS + "name,a,d\nA1,1\n", r"the row 'A1' has 2 cells, and the header has 3$"),
        "an empty table": (CELLS, "has no rows$"),
    },
}
