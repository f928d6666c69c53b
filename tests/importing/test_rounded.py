"""Angles that a file has rounded, by the decimals that it writes: in every format, and never one that is none."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from derive.importing.arms.rounded import snapped_robot
from derive.importing.formats.documents import rounding
from derive.importing.importing import SNAP
from derive.importing.robot import Robot, Step, Turned
from tests.importing.kinematics import (
    assert_is,
    by_yourdfpy,
    chain_pose,
    described,
    differences,
    facing,
    imported,
    imported_text,
)
from tests.importing.robots import joint, urdf
from tests.importing.test_mjcf import by_mujoco

ROUNDED = (
    "1.5708 1.571 -1.5708 3.1415 3.14160 3.142 1.570800 +1.5707963 1.5708e0 15708e-4 1.570796E+00 0.7854 0.785 4.7124"
    " 6.283 2.0944 1.0472 0.523599 -0.261799 1.570796325 1.57079632679 3.14159265358979311600"
)
NOT_ROUNDED = "1.57 3.14 1.5703 1.5700 3.1420 0.7850 3.1410 1.5710 0.0001 -0.001 0.00010 1.58 0.3 2.5000 1.0470 1.57081"


def put_back(text: str, limit: float = SNAP) -> float:
    """The angle that is read."""
    turned = Turned(0, float(text), rounding(text))
    robot, moved = snapped_robot(Robot("r", "s", "b", "t", (Step("j", (turned,)),), ()), limit)
    (place,) = robot.steps[0].places
    assert isinstance(place, Turned)
    assert sum(m.amount for m in moved) == pytest.approx(abs(place.angle - float(text)), abs=1e-13)
    return place.angle


@pytest.mark.parametrize("text", ROUNDED.split())
def test_a_rounded_angle_is_put_back(text: str) -> None:
    angle = put_back(text)
    assert angle / (np.pi / 12) == pytest.approx(round(float(text) / (np.pi / 12)), abs=1e-14)
    assert put_back(text, 0.0) == pytest.approx(float(text), abs=1e-13), "--snap 0 puts nothing back"


@pytest.mark.parametrize("text", NOT_ROUNDED.split())
def test_an_angle_that_is_no_rounding_stays(text: str) -> None:
    assert put_back(text) == float(text)


@settings(max_examples=30)
@given(st.integers(1, 48), st.sampled_from("+-"), st.integers(3, 15), st.booleans())
def test_every_multiple_of_15_degrees_with_any_number_of_decimals(
    multiple: int, sign: str, decimals: int, is_cut: bool
) -> None:
    meant = multiple * np.pi / 12
    text = f"{sign}{meant:.{decimals}f}"
    if is_cut and decimals > 3:
        text = f"{sign}{meant:.17f}"[: len(text)]
    assert abs(put_back(text)) == pytest.approx(meant, abs=1e-14)


@given(st.integers(-60000, 60000), st.integers(3, 4))
def test_nothing_is_moved_by_more_than_a_unit_of_its_last_decimal(number: int, decimals: int) -> None:
    text = f"{number / 10**decimals:.{decimals}f}"
    unit = 10.0**-decimals / (2 if decimals == 3 else 1)
    assert abs(put_back(text) - float(text)) <= unit * (1.0 + 1e-9)


def test_a_table_in_radians_is_read_by_its_decimals(tmp_path: Path) -> None:
    rows = "[[joints]]\nd = 0.3\nalpha = {0}\n[[joints]]\na = 0.4\n[[joints]]\na = 0.3\ntheta = {1}\nalpha = {0}\n"
    toml, table = tmp_path / "r.toml", tmp_path / "r.csv"
    head = "# convention: standard\n# angles: {}\n# lengths: m\ntheta,d,a,alpha\n"
    for half, quarter, is_read in (("1.5708", "0.7854", True), ("1.5712", "0.7856", False), ("1.57", "0.7860", False)):
        settings = 'convention = "standard"\nangles = "radians"\nlengths = "m"\n'
        cells = head.format("radians") + f"0,0.3,0,{half}\n0,0,0.4,0\n{quarter},0,0.3,{half}\n"
        written = ((toml, settings + rows.format(half, quarter)), (table, cells))
        texts = [imported_text(*file).text for file in written]
        assert [("radians(" not in text) for text in texts] == [is_read, is_read]
        assert not is_read or all("pi/4" in text for text in texts)
    degrees = head.format("degrees") + "0,0.3,0,89.9999\n0,0,0.4,0\n0,0,0.3,90\n"
    assert "radians(" in imported_text(table, degrees).text, "a file in degrees has no reason to round 90"


MODEL = """<mujoco><compiler angle="radian"/><worldbody>
  <body name="a" pos="0 0 0.3"><joint name="j1"/><geom size="0.01"/>
    <body name="b" pos="0.1 0 0" {}><joint name="j2"/><geom size="0.01"/>
      <body name="c" pos="0.4 0 0"><joint name="j3"/><geom size="0.01"/>
        <body name="d" pos="0.3 0.02 0" {}/></body></body></body></worldbody></mujoco>"""
SQUARE = ('euler="1.5708 0 0"', 'axisangle="-1 0 0 1.5708"', 'quat="0.7071 0.7071 0 0"', 'xyaxes="1 0 0 0 0 1"')
INCLINED = (
    'euler="0 0 0.5236"', 'axisangle="0 0 2 0.524"', 'quat="0.9659 0 0 0.2588"', 'quat="-0.965926 0 0 -0.258819"',
    'xyaxes="0.866 0.5 0 -0.5 0.866 0"', 'quat="0.2706 0.6533 0.2706 0.6533"',
)  # fmt: skip
NOT_SIMPLE = (
    'euler="0.0001 0 0"', 'axisangle="0 0 1 0.5231"', 'axisangle="0 0.0001 1 0.5236"', 'quat="1 0.0001 0 0"',
    'quat="0.9659 0.0001 0 0.2588"', 'xyaxes="1 0.0001 0 0 1 0"', 'quat="0.97 0 0 0.26"',
)  # fmt: skip


@pytest.mark.parametrize("given_", [*SQUARE, *INCLINED, *NOT_SIMPLE])
def test_an_orientation_of_a_model_is_read_by_its_decimals(given_: str, tmp_path: Path) -> None:
    path = tmp_path / "model.xml"
    found = imported_text(path, MODEL.format(SQUARE[0], given_), tip="d")
    pose = by_mujoco(path, "world", "d")
    degrees = [p.nominal for p in assert_is(found, tmp_path, pose).parameters if p.unit == "deg"]
    if given_ in NOT_SIMPLE:
        assert any("d: " in m.what for m in found.moved) is False
    else:
        assert not degrees, "every turn is a multiple of 15 degrees"
    exact = imported(path, tip="d", snap=0.0)
    position, rotation = differences(exact, described(exact, tmp_path), pose)
    assert position <= 1e-9 and rotation <= 1e-12


def test_the_offset_of_a_joint_that_follows_is_put_back(tmp_path: Path) -> None:
    path = tmp_path / "r.urdf"
    mimic = '<mimic joint="j2" multiplier="-1" offset="1.5708"/>'
    text = urdf(
        "r",
        joint("j1", "revolute", "0 0 0.4"),
        joint("j2", "revolute", "0.1 0 0", axis="0 1 0"),
        joint("j3", "revolute", "0 0 0.5", axis="0 1 0", mimic=mimic),
        joint("j4", "revolute", "0.4 0 0", axis="0 1 0"),
        joint("tool", "fixed", "0 0 0.1"),
    )
    found = imported_text(path, text)
    assert "j3, offset: 1.5708 is 90° rounded, off by 3.7e-06 rad" in found.report
    assert "radians(" not in found.text
    assert_is(found, tmp_path, by_yourdfpy(path, "link0", "link5"))


def test_a_wide_limit_turns_axes_and_no_joint(tmp_path: Path) -> None:
    """A calibrated arm: every offset stays, the axes become parallel or square, and what that moves is little."""
    path = tmp_path / "arm.toml"
    offsets, tilts = (0.11, -0.08, 0.13, 0.07), (0.02, -0.03, 0.01, 0.05)
    rows = zip(offsets, tilts, (90.0, 0.0, 0.0, 90.0), (0.0, 400.0, 300.0, 0.0), strict=True)
    text = "".join(
        f"[[joints]]\ntheta = {theta}\nd = 100.0\na = {a}\nalpha = {alpha + tilt}\n" for theta, tilt, alpha, a in rows
    )
    text = f'convention = "standard"\nangles = "degrees"\nlengths = "mm"\n{text}'
    found, exact = imported_text(path, text, snap=0.002), imported(path, snap=0.0)
    angles = [m.amount for m in found.moved if m.is_angle]
    assert np.allclose(sorted(angles), sorted(np.radians(np.abs(tilts))), rtol=1e-6, atol=0.0)
    assert found.text.count(" = angle(") == 3, "the offsets of A1, A3 and A4: a link is along x"
    mechanism, unchanged = described(found, tmp_path), described(exact, tmp_path)
    for values in np.random.default_rng(4).uniform(-3.0, 3.0, (20, 4)):
        row = dict(zip(found.axes, map(float, values), strict=True))
        stated = chain_pose(unchanged, row) @ facing(exact).T @ facing(found)
        off = np.abs(chain_pose(mechanism, row) - stated)
        assert off[:3, 3].max() < 3.0 and off[:3, :3].max() < 1.2 * sum(angles)
