"""Files that are broken or odd in any way: a sentence about the file, or the description of what it says; no crash."""

import ast
import random
import re
import shutil
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest

from derive.importing.importing import import_robot
from derive.importing.robot import UnreadableRobot
from tests.importing.kinematics import UNSNAPPED, assert_is, by_yourdfpy, described, imported, imported_text, refused
from tests.importing.robots import joint, urdf
from tests.importing.test_mjcf import by_mujoco
from tests.machines.made import built_of

HEAD = 'convention = "standard"\nangles = "{}"\nlengths = "mm"\n'
CELLS = "# convention: standard\n# angles: radians\n# lengths: m\nname,type,theta,d,a,alpha,lower,upper,coupling\n"
ARM = urdf(
    "arm",
    joint("a", "revolute", "0 0 0.4"),
    joint("b", "revolute", "0.1 0 0", "0 0 1.5708", "0 1 0"),
    joint("c", "revolute", "0.5 0 0", axis="0 1 0", mimic='<mimic joint="b" multiplier="-1" offset="0.1"/>'),
    joint("d", "revolute", "0.3 0 0", axis="0 1 0"),
    joint("e", "fixed", "0.1 0 0"),
)
MODEL = """<mujoco model="m"><compiler angle="radian"/><default><joint range="-1 2"/></default><worldbody>
  <body name="p" pos="0 0 0.3" quat="1 0 0 0"><joint name="a"/><geom size="1"/>
  <body name="q" pos="0.3 0 0" euler="1.5708 0 0"><joint name="b" axis="0 1 0" ref="0.1"/>
  <body name="r" pos="0.2 0 0" xyaxes="1 0 0 0 1 0"><joint name="c" axis="0 1 0"/><site name="t" pos="0.1 0 0"/>
  </body></body></body></worldbody><equality><joint joint1="c" joint2="b" polycoef="0 1 0 0 0"/></equality></mujoco>"""
ROW = """[[joints]]
name = "A{}"
type = "revolute"
theta = 0.1
d = 300
a = 200
alpha = "pi/2"
lower = -1
upper = 2
"""
TABLE = HEAD.format("radians") + "".join(ROW.format(k) for k in (1, 2, 3)) + "coupling = {A2 = -1}\n"
CSV = CELLS + "A1,revolute,0,0.3,0,pi/2,-1,2,\nA2,revolute,0,0,0.4,0,-1,2,\nA3,revolute,0.1,0,0.2,0,,,A2:-1\n"
WHOLE = {"r.urdf": ARM, "r.xml": MODEL, "r.toml": TABLE, "r.csv": CSV}

BROKEN: Mapping[str, tuple[str, str | bytes, str]] = {
    "a length beyond all machines": ("r.urdf", ARM.replace("0.5 0 0", "1e200 0 0"), "'1e200' is more than 1e\\+06$"),
    "a snake": (
        "r.urdf",
        urdf("s", *(joint(f"j{k}", "revolute", "0.1 0 0.1", "0.1 0.2 0.3") for k in range(90))),
        "90 joints move \\(at most 30 can\\) between 'link0' and 'link90'$",
    ),
    "bodies in bodies": (
        "r.xml",
        "<mujoco><worldbody>" + "<body>" * 3000 + "</body>" * 3000 + "</worldbody></mujoco>",
        "its parts stand in each other too deeply: no robot is that deep$",
    ),
    "lists in lists": ("r.toml", "name=" + "[" * 5000 + "]" * 5000, "its parts stand in each other too deeply"),
    "a multiple of pi with many digits": (
        "r.toml",
        TABLE.replace('"pi/2"', f'"{"7" * 6000}*pi/3"', 1),
        r"row 'A1', alpha: '7{40}…' is more than 1e\+06$",
    ),
    "an integer with many digits": ("r.toml", TABLE.replace("300", "3" * 6000, 1), "broken TOML: Exceeds the limit"),
    "an integer with many digits, in hexadecimal": (
        "r.toml",
        TABLE.replace("300", "0x" + "3" * 6000, 1),
        "row 'A1', d: 'an integer of thousands of digits' is no number$",
    ),
    "a cell without an end": ("r.csv", CSV.replace("0.4", f'"{"4" * 200000}'), "broken CSV: field larger than"),
    "two columns of one name": ("r.csv", CSV.replace("theta", "alpha"), "two columns are called 'alpha'$"),
    "two entries of one name": (
        "r.toml",
        TABLE.replace("d = 300", "d = 300\nD = 200", 1),
        "two entries differ in capital letters alone: ",
    ),
    "a joint that turns with itself": ("r.csv", CSV.replace("A2:-1", "A3:-1"), "is coupled to 'A3' twice"),
    "an unknown encoding": (
        "r.urdf",
        ARM.replace('version="1.0"', 'version="1.0" encoding="klingon"'),
        "its encoding cannot be read|broken XML: unknown encoding$",
    ),
    "another encoding than it says": (
        "r.urdf",
        ARM.replace('version="1.0"', 'version="1.0" encoding="utf-8"').encode("utf-16"),
        "broken XML: ",
    ),
    "a character of zero": ("r.urdf", ARM.replace('"link1"', '"link\0"'), r"r\.urdf:\d+: broken XML: "),
    "limits that are none": ("r.urdf", ARM.replace('lower="-3.0"', 'lower="nan"', 1), "'nan' is no number$"),
    "a class that another file defines": (
        "r.xml",
        MODEL.replace('name="b"', 'name="b" class="tilt"'),
        "joint 'b': its class 'tilt' is not defined: import the model that includes this file$",
    ),
    "three joints on one line": (
        "r.toml",
        TABLE.replace("a = 200", "a = 0", 2).replace('"pi/2"', "0"),
        "1 free motion .*another tip; A1 and A2 turn about the same line: one of them moves nothing of its own$",
    ),
    "a range of one number": ("r.xml", MODEL.replace("-1 2", "-1"), "joint 'a', range: '-1' is not two numbers$"),
}

AXES = ("1 0 0", "0 1 0", "0 0 1")


@pytest.mark.parametrize("name", BROKEN)
def test_it_is_refused_in_a_sentence(name: str, tmp_path: Path) -> None:
    file, text, sentence = BROKEN[name]
    said = refused(tmp_path / file, text)
    assert re.search(sentence, said) and said.isprintable() and len(said) < 400


def test_text_of_a_file_ends_no_text_of_the_description(tmp_path: Path) -> None:
    hostile = 'x\\u0000 (* \\u001b[31m \\"\\"\\" *) \\\\'
    text = f'name = "{hostile}"\n' + TABLE.replace('"A1"', f'"{hostile}"')
    found = imported_text(tmp_path / "r.toml", text)
    assert found.report.replace("\n", "").isprintable() and found.text.replace("\n", "").isprintable()
    described(found, tmp_path)


def test_limits_of_any_size_are_none(tmp_path: Path) -> None:
    """And the bound on forward kinematics stays a number."""
    slides = [joint(f"s{k}", "prismatic", axis=axis, limits=(float("-inf"), 1e300)) for k, axis in enumerate(AXES)]
    found = imported_text(tmp_path / "r.urdf", urdf("slides", *slides, joint("tool", "fixed", rpy="1.5708 0 0")))
    assert "limits=" not in found.text and 0.0 <= found.bounds.position < 1.0


HOSTILE = (
    "", "nan", "-inf", "1e308", "-1e-320", "0", "1e5", "1e-9", "9" * 5000, "0x" + "f" * 5000, "1e-999999999", "null",
    "true", "[]", "{}", "-", '"', "'", "<", ">", "&", "&#0;", "&#10;", "<!--", "]]>", "\0", "\x1b", "\ufeff", "\u202e",
    "é", "\ud800", "${x}", "$(find x)", "a", "b", "link1", "link9", "A2", "A1:2", "pi", "pi/0", "0.1 0 0", "1 1 1",
    "world", "type", "\n", ",", ";", "\t", "#", "[[joints]]", "revolute", "prismatic", "fixed", "floating", "slide",
)  # fmt: skip
Change = Callable[[random.Random, str], str]


def _part(chance: random.Random, text: str) -> tuple[int, int]:
    """A word, a tag, or any stretch of a text."""
    start = chance.randrange(len(text))
    if chance.random() < 0.7:
        ends = [k for k, c in enumerate(text) if c in ' "<>=,\n']
        after = [k for k in ends if k >= start] or [len(text)]
        return max([0, *(k + 1 for k in ends if k < start)]), after[0]
    return start, min(len(text), start + chance.randrange(60))


def _replaced(chance: random.Random, text: str) -> str:
    start, end = _part(chance, text)
    return text[:start] + chance.choice(HOSTILE) + text[end:]


def _repeated(chance: random.Random, text: str) -> str:
    lines = text.splitlines(keepends=True)
    line = chance.choice(lines)
    lines.insert(chance.randrange(len(lines)), line * chance.choice((1, 2, 50)))
    return "".join(lines)


def _removed(chance: random.Random, text: str) -> str:
    start, end = _part(chance, text)
    return text[:start] + text[end:]


def _exchanged(chance: random.Random, text: str) -> str:
    (a, b), (c, d) = sorted((_part(chance, text), _part(chance, text)))
    return text if b > c else text[:a] + text[c:d] + text[b:c] + text[a:b] + text[d:]


CHANGES: tuple[Change, ...] = (_replaced, _replaced, _repeated, _removed, _exchanged)
ENCODINGS = ("utf-8", "utf-8", "utf-8", "utf-8-sig", "utf-16", "latin-1")
ATTEMPTS = 200


@pytest.mark.parametrize("file", WHOLE)
def test_any_change_of_a_file_is_read_or_refused(file: str, tmp_path: Path) -> None:
    chance = random.Random(f"import {file}")
    path, read = tmp_path / file, 0
    for _ in range(ATTEMPTS):
        text = WHOLE[file]
        for _ in range(chance.choice((1, 1, 2, 4)) if read else 0):
            text = chance.choice(CHANGES)(chance, text)
        path.write_bytes(text.encode(chance.choice(ENCODINGS), "replace"))
        try:
            found = import_robot(path)
        except UnreadableRobot as refusal:
            assert str(refusal).startswith(str(path)) and "\n" not in str(refusal)
            continue
        ast.parse(found.text)
        assert found.bounds.position < 1e9 and found.text.replace("\n", "").isprintable()
        read += 1
    assert read > 5, "some changes do no harm"


DIRECTIONS = (
    "1 0 0", "-1 0 0", "0 -1 0", "0 0 1", "0 0 -2", "0 0.70710678 0.70710678", "-0.5 0.5 0", "0.2 0.3 0.9",
    "1e-9 0 1",
)  # fmt: skip
TURNS = ("0", "0", "0", "1.5708", "3.14159", "-1.570796325", "3.141592653589793", "0.7853982", "0.3", "-2.5", "1e-7")
SHIFTS = ("0", "0", "0", "0.1", "-0.25", "0.3333333", "1e-6", "0.00043624", "0.5")
KINDS = ("revolute", "revolute", "revolute", "continuous", "prismatic", "fixed")
SEEDS = 10


def odd(seed: int) -> str:
    """A chain of eight or nine moving joints and some fixed ones; every third robot has joints that follow others."""
    rng = np.random.default_rng(seed)
    kinds = ["revolute"] * 6 + [str(rng.choice(KINDS)) for _ in range(6)]
    rng.shuffle(kinds)
    joints, moving = [], []
    for k, kind in enumerate(kinds):
        xyz, rpy = (" ".join(map(str, rng.choice(values, 3))) for values in (SHIFTS, TURNS))
        mimic = ""
        if kind != "fixed" and moving and seed % 3 == 0 and rng.random() < 0.3:
            leader = str(rng.choice(moving))
            mimic = f'<mimic joint="{leader}" multiplier="{rng.choice([-1, 0.5, 3])}" offset="{rng.choice([0, 0.2])}"/>'
        elif kind != "fixed":
            moving.append(f"odd_joint-{k}")
        limits = None if kind == "continuous" else (-2.5, float(rng.choice([-0.5, 1.0])))
        axis = str(
            rng.choice(DIRECTIONS[:4] if kind == "prismatic" else DIRECTIONS)
        )  # the other reader takes the length of a slide's
        joints.append(joint(f"odd_joint-{k}", kind, xyz, rpy, axis, limits, mimic))
    return urdf("odd robot", *joints)


def shuffled(text: str, seed: int) -> str:
    """The same file with its joints in another order."""
    parts = re.findall(r"<joint name.*?</joint>\n", text, re.S)
    order = np.random.default_rng(seed).permutation(len(parts))
    head = text.split("<joint name", 1)[0]
    return head + "".join(parts[k] for k in order) + "</robot>\n"


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(SEEDS))
def test_an_odd_file_is_what_it_says(seed: int, tmp_path: Path) -> None:
    path = tmp_path / "odd.urdf"
    text = shuffled(odd(seed), seed)
    tip = f"link{text.count('<joint name')}"
    for snap in (0.0, 1e-4):
        found = imported_text(path, text, "link0", tip, snap=snap)
        assert_is(found, tmp_path, by_yourdfpy(path, "link0", tip), 1e-8, 1e-11)
        assert snap > 0.0 or found.bounds.rotation <= UNSNAPPED
        assert sum(len(name) > 3 for name in found.axes) == 0


@pytest.mark.slow
def test_a_small_arm_far_from_its_base(tmp_path: Path) -> None:
    path = tmp_path / "far.urdf"
    arm = [joint("a", "revolute", "40 0 3"), joint("b", "revolute", "0.1 0 0"), joint("tip", "fixed", "0.1 0 0")]
    found = imported_text(path, urdf("far", *arm))
    assert_is(found, tmp_path, by_yourdfpy(path, "link0", "link3"), 1e-8, 1e-11)


FILES = Path(__file__).parent / "files"
SOLUTIONS = {
    "namespace_and_tabs.urdf": 4, "axis_left_out.urdf": 2, "same_names.urdf": 2, "mixed_decimals.urdf": 8,
    "inclined_wrist.urdf": 8, "degrees_and_classes.xml": 4, "short_quaternions.xml": 12, "frames.xml": 2,
    "includes.xml": 2, "three_slides.xml": 2, "directions.xml": 4,
}  # fmt: skip
TIPS = {"degrees_and_classes.xml": "tcp", "frames.xml": "t", "short_quaternions.xml": "tip"}
SLOW = ("mixed_decimals.urdf", "inclined_wrist.urdf", "short_quaternions.xml")
FOR_THE_OTHER_READER: Mapping[str, tuple[tuple[str, str], ...]] = {
    "namespace_and_tabs.urdf": ((' xmlns="http://www.ros.org"', ""),),
    "degrees_and_classes.xml": (("<joint/>", '<joint name="l2.0"/>'), ('class="B" ', 'class="B" name="l3.0" ')),
}
"""What the other reader does not know: it reads no namespace, and ours names a joint without a name."""


@pytest.mark.slow
@pytest.mark.parametrize("name", SOLUTIONS)
@pytest.mark.parametrize("snap", [0.0, 1e-6])
def test_it_is_what_the_other_reader_says(name: str, snap: float, tmp_path: Path) -> None:
    found = imported(FILES / name, tip=TIPS.get(name), snap=snap)
    shutil.copytree(FILES, tmp_path / "files")
    plain = tmp_path / "files" / name
    text = plain.read_text(encoding="utf-8")
    for ours, theirs in FOR_THE_OTHER_READER.get(name, ()):
        assert ours in text
        text = text.replace(ours, theirs)
    plain.write_text(text, encoding="utf-8")
    reader = by_yourdfpy if plain.suffix == ".urdf" else by_mujoco
    pose = reader(plain, found.robot.base, found.robot.tip)
    assert_is(found, tmp_path, pose)
    assert snap > 0.0 or found.bounds.rotation <= UNSNAPPED


@pytest.mark.slow
@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.slow) if n in SLOW else n for n in SOLUTIONS])
def test_it_is_derived(name: str, tmp_path: Path) -> None:
    evidence = built_of(described(imported(FILES / name, tip=TIPS.get(name)), tmp_path)).evidence
    assert evidence is not None and evidence.inverted is not None
    assert evidence.inverted.solutions == SOLUTIONS[name]
