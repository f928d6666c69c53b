"""Files that are broken in any way: a sentence about the file, or a description that Python reads; never a crash."""

import ast
import random
import re
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from derive.importing.importing import import_robot
from derive.importing.robot import UnreadableRobot
from tests.importing.kinematics import described, imported_text, refused
from tests.importing.robots import joint, urdf

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
