"""Names in a robot file are data: whatever they hold, the description is the same program, and tells them in a line."""

import ast
import json
from pathlib import Path
from xml.sax.saxutils import quoteattr

import pytest

from derive.description.validate import validate
from tests.importing.kinematics import described, imported_text
from tests.machines.hostile import MARKS, UNPRINTED

HOSTILE = [name.replace("${", "$ {") for name in (" ".join(MARKS), *MARKS)]  # an unexpanded macro is refused


def urdf(name: str) -> str:
    """A SCARA whose robot, links and joints have names that begin with this."""

    def called(word: str) -> str:
        return quoteattr(f"{name} {word}")

    joints = "".join(
        f"<joint name={called(f'moving {k}')} type='{kind}'>"
        f"<parent link={called(str(k))}/><child link={called(str(k + 1))}/>"
        f"<origin xyz='{shift} 0 0'/><axis xyz='0 0 1'/><limit lower='-2' upper='2' effort='1' velocity='1'/></joint>"
        for k, (kind, shift) in enumerate((("revolute", 0), ("revolute", 0.3), ("prismatic", 0.2)))
    )
    links = "".join(f"<link name={called(str(k))}/>" for k in range(4))
    return f"<robot name={quoteattr(name)}>{links}{joints}</robot>"


def mjcf(name: str) -> str:
    """The same as bodies that stand in each other."""

    def body(k: int, inner: str) -> str:
        kind, shift = (("hinge", 0), ("hinge", 0.3), ("slide", 0.2))[k]
        joint = f"<joint name={quoteattr(f'{name} moving {k}')} type='{kind}' axis='0 0 1' range='-1 1'/>"
        return f"<body name={quoteattr(f'{name} {k}')} pos='{shift} 0 0'>{joint}{inner}</body>"

    whole = body(0, body(1, body(2, "<site name='tip'/>")))
    return f"<mujoco model={quoteattr(name)}><compiler angle='radian'/><worldbody>{whole}</worldbody></mujoco>"


def loop(name: str) -> str:
    """Arms and rods of a five-bar."""

    def half(k: int, x: float, inner: str) -> str:
        motor, hinge, arm, rod = (quoteattr(f"{name} {word} {k}") for word in ("motor", "hinge", "arm", "rod"))
        below = f"<body name={rod} pos='0 0.12 0'><joint name={hinge} axis='0 0 1'/>{inner}</body>"
        return f"<body name={arm} pos='{x} 0 0'><joint name={motor} axis='0 0 1'/>{below}</body>"

    halves = half(1, -0.05, "<site name='tip' pos='0.05 0.15 0'/>") + half(2, 0.05, "")
    bodies = " ".join(f"body{k}={quoteattr(f'{name} rod {k}')}" for k in (1, 2))
    motors = "".join(f"<position joint={quoteattr(f'{name} motor {k}')}/>" for k in (1, 2))
    closed = f"<equality><connect {bodies} anchor='0.05 0.15 0'/></equality><actuator>{motors}</actuator>"
    return f"<mujoco model={quoteattr(name)}><worldbody>{halves}</worldbody>{closed}</mujoco>"


def toml(name: str) -> str:
    rows = (("revolute", 0.3), ("revolute", 0.2), ("prismatic", 0))
    told = "".join(
        f'[[joints]]\nname = {json.dumps(f"{name} moving {k}")}\ntype = "{kind}"\na = {shift}\n'
        for k, (kind, shift) in enumerate(rows)
    )
    return f'convention = "standard"\nangles = "radians"\nlengths = "m"\n{told}'


FORMATS = {"urdf": (urdf, ".urdf"), "mjcf": (mjcf, ".xml"), "loop": (loop, ".xml"), "table": (toml, ".toml")}


@pytest.mark.parametrize("kind", FORMATS)
def test_names_of_a_file(kind: str, tmp_path: Path) -> None:
    """The statements are those of a plain file, and the description is valid."""
    write, ending = FORMATS[kind]

    def shape(name: str, file: str) -> str:
        found = imported_text(tmp_path / f"{file}{ending}", write(name), tip="tip" if kind == "loop" else None)
        mechanism = validate(described(found, tmp_path))
        assert mechanism.summary.isprintable() and mechanism.source.isprintable()
        tree = ast.parse(found.text)
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                node.value = ""
        return ast.dump(tree)

    plain = shape("a", "plain")
    unprinted = [odd for odd in UNPRINTED if kind == "table" and odd != "\ud800"]  # which no XML can hold
    for k, name in enumerate((*HOSTILE, *unprinted)):
        file = "".join(letter for letter in name if letter not in "/\0\ud800")[:60]
        assert shape(name, f"{k} {file}") == plain
