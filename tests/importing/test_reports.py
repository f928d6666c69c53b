"""What an import tells, and what it makes of names, which are data whatever they hold, of limits and of followers."""

import ast
import json
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
import pytest

from derive.description.validate import validate
from derive.mechanism import Turning
from tests.importing.kinematics import by_yourdfpy, described, differences, imported, imported_text
from tests.importing.robots import COLLECTION, joint, rounded, ur5e, urdf
from tests.machines.hostile import MARKS, UNPRINTED

CLOSED = {
    "KR 16": "A closed form is likely: A4, A5, A6 meet in one point.",
    "iiwa": "A closed form is likely: A5, A6, A7 meet in one point.",
    "IRB 140": "or are parallel; with --snap 0.0047 A4, A5, A6 meet in one point.",
}


@pytest.mark.parametrize("name", CLOSED)
def test_the_report_says_what_a_closed_form_needs_and_that_snap_gives_it(name: str, tmp_path: Path) -> None:
    file = COLLECTION[name]
    assert CLOSED[name] in imported(file.path, file.base, file.tip).report
    if "--snap" in CLOSED[name]:
        snapped = imported(file.path, file.base, file.tip, snap=0.0047)
        assert "Ry(A5) * Rx(A6)" in snapped.text.replace("\n    * ", " * ")
        assert "A6: its position by 20 mm" in snapped.report


def test_neighbouring_axes_are_told_with_the_snap_that_they_need() -> None:
    file = COLLECTION["iiwa"]
    report = imported(file.path, file.base, file.tip).report
    assert "A1-A2: distance 0.43624 mm, angle 90°; square; they would meet with --snap 0.00034" in report
    assert "A2-A3: distance 0 mm, angle 90°; square; they meet" in report
    assert "Held where the reference has it: A1 (choose another with --hold)." in report
    held = imported(file.path, file.base, file.tip, snap=3.4e-4, hold=("joint_a3",))
    assert "A1-A2: distance 0.43624 mm, angle 90°; square; they meet, snapped" in held.report
    assert "held=(A3,)" in held.text


def test_a_rounded_right_angle_is_put_back_and_told(tmp_path: Path) -> None:
    """1.5708 is 3.7e-6 off a right angle: more than `--snap`, but no more than four decimals are."""
    path = tmp_path / "ur.urdf"
    found = imported_text(path, ur5e(5))
    assert "A1-A2: distance 0 mm, angle 89.9998°; square, snapped; they meet" in found.report
    assert f"shoulder_lift_joint: {rounded(5)[0]} is 90° rounded, off by 3.7e-06 rad" in found.report
    assert "A closed form is likely: A2, A3, A4 are parallel." in found.report
    assert "radians(" not in found.text and found.text.count("length(") == 6


def test_what_is_no_rounding_is_told_and_put_back_by_the_snap_that_the_report_names(tmp_path: Path) -> None:
    path = tmp_path / "ur.urdf"
    report = imported_text(path, ur5e(5).replace("1.5708", "1.5711")).report
    assert "A1-A2: distance 0 mm, angle 89.9826°; nearly square: square with --snap 0.00031; they meet" in report
    snapped = imported(path, snap=3.1e-4)
    assert "A1-A2: their angle read as 90°, off by 0.0003 rad" in snapped.report
    assert snapped.text.count("length(") == 6


def test_limits_that_are_none(tmp_path: Path) -> None:
    path = tmp_path / "robot.urdf"
    text = urdf(
        "r",
        joint("a", "continuous", limits=(-1.0, 1.0)),
        joint("b", "revolute", "0.1 0 0", limits=(float("-inf"), float("inf"))),
        joint("c", "revolute", "0.1 0 0", limits=(0.0, 0.0)),
        joint("d", "prismatic", limits=(-0.25, 0.0)),
    )
    joints = described(imported_text(path, text), tmp_path).joints
    assert [j.limits for j in joints] == [None, None, None, (-250.0, 0.0)]
    path.write_text(path.read_text(encoding="utf-8"), encoding="utf-16")  # XML says itself how it is written
    assert [j.limits for j in described(imported(path, unit="m"), tmp_path).joints][3] == (-0.25, 0.0)


def test_a_joint_may_follow_one_that_is_not_on_the_way(tmp_path: Path) -> None:
    """A bar beside the arm is driven; the arm follows it, turns back, and a gripper behind the tip is left out."""
    path = tmp_path / "robot.urdf"
    links = "".join(f'<link name="{name}"/>' for name in ("base", "bar", "arm", "hand", "palm", "finger"))
    text = """<joint name="{}" type="{}"><parent link="{}"/><child link="{}"/><origin xyz="{}"/><axis xyz="{}"/>
        <limit lower="-1" upper="1.5"/>{}</joint>"""
    follow = '<mimic joint="bar_joint" multiplier="{}" offset="{}"/>'
    robot = (
        "<robot name='r'>"
        + links
        + text.format("arm_joint", "revolute", "base", "arm", "0 0 0.3", "0 0 1", follow.format(-1, 0.3))
        + text.format("bar_joint", "revolute", "base", "bar", "0 0.1 0.3", "0 0 1", "")
        + text.format("hand_joint", "revolute", "arm", "hand", "0.4 0 0", "0 0 1", "")
        + text.format("palm_joint", "fixed", "hand", "palm", "0.2 0 0", "0 0 1", "")
        + text.format("finger_joint", "prismatic", "hand", "finger", "0.1 0 0", "1 0 0", follow.format(0.01, 0.0))
        + "</robot>"
    )
    found = imported_text(path, robot, "base", "palm")
    assert [axis.name for axis in found.robot.axes] == ["bar_joint", "hand_joint"]
    assert "Left out, because they are not between base and tip: arm_joint, finger_joint." not in found.report
    assert "Left out, because they are not between base and tip: finger_joint." in found.report
    mechanism = described(found, tmp_path)
    position, rotation = differences(found, mechanism, by_yourdfpy(path, "base", "palm"))
    assert position <= 1e-9 and rotation <= 1e-12
    assert mechanism.task.turning is Turning.NONE and mechanism.joints[0].limits == pytest.approx((-57.29578, 85.94367))
    finger = imported(path, "base", "finger")
    position, rotation = differences(finger, described(finger, tmp_path), by_yourdfpy(path, "base", "finger"))
    assert position <= 1e-9 and rotation <= 1e-12 and np.isfinite(finger.bounds.position)


def dh_table(rows: list[tuple[float, float, float, float]]) -> str:
    joints = (
        f'[[joints]]\nname = "A{k}"\ntheta = {theta}\nd = {d}\na = {a}\nalpha = {alpha}\n'
        for k, (theta, d, a, alpha) in enumerate(rows, 1)
    )
    return 'convention = "standard"\nangles = "degrees"\nlengths = "mm"\n' + "".join(joints)


ARM = [(0.0, 310.0, 40.0, -90.0), (0.0, 0.0, 270.0, 0.0), (0.0, 0.0, 30.0, -90.0)]
REDUNDANT = {
    "A5 and A6 turn about the same line": [*ARM, (0, 290, 0, 90), (0, 0, 0, 0), (0, 0, 0, 0)],
    "A3, A4, A5, A6 meet in one point": [*ARM[:2], (0, 0, 0, -90), (0, 0, 0, 90), (0, 0, 0, -90), (0, 65, 0, 0)],
    "A2, A3, A4, A5 are parallel": [
        ARM[0],
        *[(0, 0, size, 0) for size in (200, 180, 90)],
        (0, 0, 50, 90),
        (0, 70, 0, 0),
    ],
}


@pytest.mark.parametrize("words", [*REDUNDANT, ""])
def test_a_joint_that_moves_nothing_of_its_own_is_told(words: str, tmp_path: Path) -> None:
    """As a table typed by the other convention has one; an arm with a spherical wrist has none."""
    path = tmp_path / "arm.toml"
    wrist = [(0, 290, 0, 90), (0, 0, 0, -90), (0, 65, 0, 0)]
    found = imported_text(path, dh_table(REDUNDANT.get(words, [*ARM, *wrist])))
    told = [line for line in found.report.splitlines() if "moves nothing of its own" in line]
    assert told == ([f"{words}: one of them moves nothing of its own."] if words else [])


HOSTILE = [name.replace("${", "$ {") for name in (" ".join(MARKS), *MARKS)]  # an unexpanded macro is refused


def hostile_urdf(name: str) -> str:
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


FORMATS = {"urdf": (hostile_urdf, ".urdf"), "mjcf": (mjcf, ".xml"), "loop": (loop, ".xml"), "table": (toml, ".toml")}


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
