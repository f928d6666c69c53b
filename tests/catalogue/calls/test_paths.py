"""Lines and paths, and their pictures: on the line, on one branch, without a jump, and stopped where it is true."""

from __future__ import annotations

import base64
import gzip
import json
import re
import sys
from pathlib import Path
from urllib.parse import parse_qs

import matplotlib
import numpy as np
import pytest
import softkin
from softkin import Frame, KinematicsError, Status
from softkin._plot import Line, lines_of

from tests.catalogue.calls.mountings import EVERY, NAMES, frame_at, machines, mounted, poses, radian, robots
from tests.catalogue.refusals import refusal
from tests.catalogue.robots import KR6_R900
from tests.catalogue.search.arms import turn

SAMPLES = 12


def shifted(one: softkin.Mechanism, frame: Frame, reach: float) -> Frame:
    return Frame(tuple(np.add(frame.position, reach * np.array([0.02, -0.03, 0.01]))), frame.rotation)  # type: ignore[arg-type]


@pytest.mark.long("Ac6")
@pytest.mark.parametrize("name", NAMES)
def test_a_line_is_straight_and_continuous(name: str) -> None:
    """Every sample is on the line and on the branch of the first; a stop is a refusal of the inverse, or a jump."""
    for number, one in enumerate(robots(name)):
        robot = one.made
        first, second = poses(name, number, 2)
        start, goal = frame_at(robot, first), frame_at(robot, second)
        configuration = robot.forward(first)[1]
        line = robot.line(start, goal, configuration, first, samples=SAMPLES)
        assert line.axes[0] == pytest.approx(first, abs=1e-7)
        assert line.configuration == configuration or 0 in configuration or 3 in configuration
        assert bool(line) == (line.stop is None) and line.corners[0].position == start.position
        assert list(line.places) == sorted(line.places) and line.places[-1] <= 1.0
        wanted = tuple(configuration[i] for i in robot._branch_bytes)
        for place, frame, axes in zip(line.places, line.frames, line.axes, strict=True):
            on_line = np.array(start.position) + place * np.subtract(goal.position, start.position)
            assert np.abs(on_line - frame.position).max() < 1e-9 * one.reach
            assert robot._beyond_limits(axes) is None
            again = robot._joined(wanted, (0,) * len(robot.PERIOD_AXES))
            assert robot.inverse(frame, again, axes) == pytest.approx(axes, abs=1e-6 * (1.0 + one.reach)), place
        if line.stop is not None:
            assert line.stop.place == line.places[-1] < 1.0
            assert line.stop.refusal.status is not Status.OK and line.stop.refusal.reason
            beyond = softkin._slerp.between(start, goal, line.stop.place + 1e-6)  # type: ignore[attr-defined]
            refused = robot.diagnose(beyond, configuration, line.axes[-1])
            jumps = "jump" in line.stop.refusal.reason
            assert jumps or refused.status is line.stop.refusal.status


@pytest.mark.long("Ac6")
@pytest.mark.parametrize("name", NAMES)
def test_velocities_are_those_of_the_jacobian(name: str) -> None:
    """The Jacobian times the speeds of the axes is the speed of the frame, on a short line without a stop."""
    for number, one in enumerate(robots(name)):
        robot = one.made
        axes = poses(name, number, 1)[0]
        start, configuration = robot.forward(axes)
        goal = Frame(tuple(np.add(start.position, one.reach * np.array([0.002, -0.003, 0.0]))), start.rotation)  # type: ignore[arg-type]
        line = robot.line(start, goal, configuration, axes, samples=4)
        if line.stop is not None or not line.axes or robot.ROLE == "orientation":
            continue
        factors = np.array([np.pi / 180.0 if axis.unit == "deg" else 1.0 for axis in robot.AXES])
        for values, rates in zip(line.axes, line.velocities(2.0), strict=True):
            rows = dict(zip(robot.JACOBIAN_ROWS, np.array(robot.jacobian(values)) @ (factors * rates), strict=True))
            wanted = np.subtract(goal.position, start.position) / 2.0
            for i, row in enumerate("xyz"):
                if row in rows:
                    assert rows[row] == pytest.approx(wanted[i], abs=1e-6 * one.reach), (row, rates)
        assert line.fastest(2.0) == tuple(np.abs(line.velocities(2.0)).max(axis=0))


def test_it_stops_where_the_arm_is_straight() -> None:
    """Out of reach: at 500 of 600, with the amount that is missing beyond it."""
    robot = softkin.Scara2Z(arm_length_1=300.0, arm_length_2=200.0)
    start, goal = ((400.0, 0.0, 0.0), None), ((600.0, 0.0, 0.0), None)
    line = robot.line(start, goal, robot.configuration(elbow="left"), samples=10)  # type: ignore[arg-type]
    assert line.stop is not None and line.stop.place == pytest.approx(0.5, abs=1e-7)
    assert line.stop.refusal.reason == "A2: out of reach [u]" and not line
    assert line.stop.frame.position == pytest.approx((500.0, 0.0, 0.0), abs=1e-5)
    assert [s.margin for s in line.singular] == ["elbow"] and line.singular[0].end == line.places[-1]
    limited = robot.changed(limits={"A2": (-90.0, 90.0)}).line(start, ((100.0, 0.0, 0.0), None))  # type: ignore[arg-type]
    assert limited.stop is not None and limited.stop.refusal.reason.startswith("A2: ")
    assert abs(limited.axes[-1][1]) == pytest.approx(90.0, abs=1e-4)


def test_it_stops_where_an_axis_jumps() -> None:
    """Straight through axis A1 it would turn half round at once."""
    robot = softkin.PolarZ()
    line = robot.line(((200.0, 0.0, 0.0), None), ((-200.0, 0.0, 0.0), None))  # type: ignore[arg-type]
    assert line.stop is not None and line.stop.refusal.reason == "C: would have to jump by 180.0 deg"
    assert line.stop.place == pytest.approx(0.5, abs=1e-7)
    radians = robot.in_radians().line(((200.0, 0.0, 0.0), None), ((-200.0, 0.0, 0.0), None))  # type: ignore[arg-type]
    assert radians.stop is not None and radians.stop.refusal.reason == "C: would have to jump by 3.142 rad"
    past = robot.line(((200.0, 1e-3, 0.0), None), ((-200.0, 1e-3, 0.0), None), samples=1)  # type: ignore[arg-type]
    assert past and past.axes[-1][0] == pytest.approx(180.0, abs=1e-3)


def test_turns_go_on() -> None:
    """Round and round by corners: the axis counts its turns, and stops at its limit."""
    robot = softkin.CAxis()
    frames = [((0.0, 0.0, 0.0), turn(2, np.radians(angle))[:3, :3]) for angle in range(0, 1081, 90)]
    path = robot.path(frames)  # type: ignore[arg-type]
    assert path and path.axes[-1] == pytest.approx((1080.0,)) and path.places[-1] == 12.0
    limited = robot.changed(limits={"C": (-400.0, 400.0)}).path(frames)  # type: ignore[arg-type]
    assert limited.stop is not None and limited.stop.place == pytest.approx(400.0 / 90.0, abs=1e-6)
    assert limited.axes[-1] == pytest.approx((400.0,), abs=1e-5)
    again = softkin.CAxis().path(frames, robot.configuration(C=2))  # type: ignore[arg-type]
    assert again.axes[0] == pytest.approx((360.0,)) and again.axes[-1] == pytest.approx((1440.0,))
    assert path.velocities(1.0)[3] == pytest.approx((90.0,))


def test_what_is_refused() -> None:
    """No frame, no rotation, no number of samples; a first frame out of reach is a stop at its place."""
    robot = softkin.Scara2Z(arm_length_1=300.0, arm_length_2=200.0)
    for frames, given in (((), {}), ([((1.0, 2.0), None)], {}), ([((1.0, 2.0, 0.0), None)], {"samples": 0})):
        assert refusal(robot.path, frames, **given) is Status.BAD_INPUT
    nowhere = robot.path([((900.0, 0.0, 0.0), None)])  # type: ignore[list-item]
    assert nowhere.stop is not None and nowhere.stop.place == 0.0 and not nowhere.axes and nowhere.configuration == ()
    assert nowhere.velocities() == () and nowhere.fastest() == ()
    here = robot.path([((400.0, 0.0, 0.0), None)])  # type: ignore[list-item]
    assert here and len(here.axes) == 1 and here.velocities() == ((0.0, 0.0, 0.0),)


matplotlib.use("Agg")


def ends(lines: list[Line]) -> np.ndarray:
    return np.array([line[:2] for line in lines]).reshape(-1, 2, 3)


@pytest.mark.broad
@pytest.mark.parametrize("name", EVERY)
def test_the_lines_of_a_machine_end_at_its_tool(name: str) -> None:
    """Bare, on a base with a tool, calibrated, and in radians; a chain is one line without a gap."""
    for bare, axes, size in machines(name):
        for robot in (bare, mounted(bare)):
            lines = lines_of(robot, axes)
            tool = np.array(robot.forward(axes)[0].position)
            assert lines or not robot.AXES
            places = ends(lines)
            assert np.abs(places[:, 1] - tool).max(axis=1).min() < 1e-7 * size if lines else np.abs(tool).max() < 1e-9
            if robot._chain() is not None:
                assert np.abs(places[1:, 0] - places[:-1, 1]).max(initial=0.0) < 1e-9 * size
                assert {n for line in lines for n in line.name.split()} == {axis.name for axis in robot.AXES}
            again = ends(lines_of(robot.in_radians(), radian(robot, axes)))
            assert np.abs(again - places).max(initial=0.0) < 1e-7 * size


@pytest.mark.parametrize("name", [name for name, cls in softkin.catalogue().items() if cls.LINES])
def test_the_bodies_of_a_loop_are_rigid(name: str) -> None:
    """Arms, rods and plates keep their lengths from pose to pose; what a slide drives does not."""
    for number, one in enumerate(robots(name)):
        robot = one.made
        slides = {axis.name for axis in robot.AXES if axis.unit == "u"}
        found = [lines_of(robot, axes) for axes in poses(name, number, 2)]
        rigid = [k for k, line in enumerate(found[0]) if not slides & set(line.name.split())]
        lengths = [np.linalg.norm(np.diff(ends(lines)[rigid], axis=1), axis=2) for lines in found]
        assert np.abs(lengths[0] - lengths[1]).max(initial=0.0) < 1e-7 * one.reach
        assert {n for line in found[0] for n in line.name.split()} <= {axis.name for axis in robot.AXES}
        assert np.abs(ends(found[0]) - ends(found[1])).max() > 1e-3 * one.reach


def test_a_plot_shows_the_lines_and_the_values() -> None:
    """Of a machine, a path that stops, and a motion: in given axes, or in a figure of their own."""
    arm = softkin.ArticulatedRobot6DOF(**KR6_R900)
    axes = (10.0, -60.0, 120.0, 40.0, 50.0, 60.0)
    shown = arm.plot(axes)
    x, y, z = shown.lines[0].get_data_3d()
    drawn = np.array([x, y, z]).T.reshape(-1, 3, 3)[:, :2]
    assert np.allclose(drawn, ends(lines_of(arm, axes)))
    assert {"A1", "A5 A6"} <= {text.get_text().strip() for text in shown.texts}
    assert arm.plot(axes, shown) is shown
    delta = softkin.DeltaC(base_radius=140.0, arm_length=200.0, rod_length=450.0, plate_radius=45.0)
    assert sorted(t.get_text().strip() for t in delta.plot((10.0, 20.0, 30.0, 40.0)).texts) == ["A1", "A2", "A3", "A4"]
    frame = arm.forward(axes)[0]
    path = arm.line(frame, frame.shifted(2000.0), None, axes, samples=20)
    graph = path.plot()
    assert np.allclose(np.array([line.get_ydata() for line in graph.lines[:6]]).T, path.axes)
    assert np.array_equal(np.asarray(path), path.axes)
    assert path.stop is not None and path.stop.refusal.in_words in graph.get_title()


def test_without_matplotlib_the_message_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(ImportError, match=r"pip install 'softkin\[plot\]'"):
        softkin.Gantry2().plot((1.0, 2.0))


def test_the_viewer_of_a_notebook_has_the_page_and_the_pose(tmp_path: Path) -> None:
    """The address of the frame is the page, packed, and behind it machine, parameters and axes."""
    page = tmp_path / "viewer.html"
    data = {"classes": {"Kin_Pos_RRR": "PosRRR"}, "keywords": {"Kin_Pos_RRR": {"a two": "a2"}}}
    page.write_text(f'<p>é</p><script type="application/json" id="page">{json.dumps(data)}</script>', encoding="utf-8")
    robot = softkin.PosRRR(d1=400.0, a2=455.0, d4=420.0)
    shown = robot.with_tool(Frame((0.0, 0.0, 0.0))).in_radians().view((np.pi / 2, 0.0, -np.pi), page)
    (source,) = re.findall(r'<iframe src="data:text/html;base64,([^"]*)"', shown._repr_html_())
    text, _, fragment = source.partition("#")
    packed = re.search(r'atob\("(.*?)"\)', base64.b64decode(text).decode())
    assert packed is not None and gzip.decompress(base64.b64decode(packed[1])) == page.read_bytes()
    given = parse_qs(fragment.replace("&amp;", "&"))
    assert given["machine"] == ["Kin_Pos_RRR"]
    assert [float(value) for value in given["axes"][0].split(",")] == pytest.approx([90.0, 0.0, -180.0])
    assert {"a two:455.0", "d4:420.0", "check_limits:1.0"} <= set(given["with"][0].split(","))
    assert repr(shown) == "<View of Kin_Pos_RRR: a notebook shows it>"
    with pytest.raises(KinematicsError, match="does not have this machine"):
        softkin.Gantry2().view(page=page)
    with pytest.raises(KinematicsError, match="make view"):
        robot.view(page=tmp_path / "nothing.html")
