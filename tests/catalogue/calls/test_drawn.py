"""Pictures of machines and paths: lines end at the tool and keep their lengths; the viewer stands in a notebook."""

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
from softkin import Frame, KinematicsError
from softkin._plot import Line, lines_of  # type: ignore[import-not-found, unused-ignore]

from tests.catalogue.calls.mountings import BASE, EVERY, machines, radian, tool_of
from tests.catalogue.calls.robots import poses, robots
from tests.catalogue.robots import KR6_R900

matplotlib.use("Agg")


def ends(lines: list[Line]) -> np.ndarray:
    """The ends of lines (N, 2, 3)."""
    return np.array([line[:2] for line in lines]).reshape(-1, 2, 3)


@pytest.mark.broad
@pytest.mark.parametrize("name", EVERY)
def test_the_lines_of_a_machine_end_at_its_tool(name: str) -> None:
    """Bare, on a base with a tool, calibrated, and in radians; a chain is one line without a gap."""
    for bare, axes, size in machines(name):
        for robot in (bare, bare.with_base(BASE).with_tool(tool_of(bare))):
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
