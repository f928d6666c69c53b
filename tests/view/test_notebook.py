"""The viewer in a notebook: its page in a frame, as `robot.view` makes it, computes and draws without a network."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import softkin

from derive.view.node import node, run
from tests.view.available import available
from tests.view.driver import prepared

pytestmark = pytest.mark.slow


def test_a_frame_in_a_notebook_shows_the_machine_at_its_pose(pages: tuple[Path, Path], tmp_path: Path) -> None:
    """Dimensions, limits and axes are those of Python; the console has no error, and nothing is asked of a network."""
    robot = softkin.Scara3Z(arm_length_1=310.0, arm_length_2=240.0, arm_length_3=90.0, limits={"Z": (-20.0, 180.0)})
    axes = (10.0, -20.0, 30.0, 40.0)
    around, answer = tmp_path / "notebook.html", tmp_path / "answer.json"
    around.write_text(f"<!doctype html>{robot.view(axes, pages[0])._repr_html_()}", encoding="utf-8")
    done = run([str(part) for part in (node(), available(prepared) / "frame.mjs", around, answer)], tmp_path)
    assert answer.is_file(), done.stderr
    shown = json.loads(answer.read_text(encoding="utf-8"))
    assert shown["errors"] == [] and shown["machine"] == robot.NAME
    assert shown["axes"] == pytest.approx(axes)
    assert shown["parameters"] == {name: float(value) for name, value in robot.parameters.items()}
    assert shown["frame"]["position"] == pytest.approx(robot.forward(axes)[0].position)
