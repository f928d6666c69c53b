"""An imported robot is shown with its meshes: each moves with its link; two themes, three sizes."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from derive.view.node import node, run
from tests.importing.test_meshes import ARM, LINKS, POINTS, SHAPES, points_of, robot
from tests.view.conftest import PICTURES
from tests.view.driver import available, prepared
from tests.view.pages import run_derive

pytestmark = pytest.mark.slow
ROWS = ((0.0, 0.0, 0.0), (30.0, 0.0, 0.0), (30.0, -40.0, 0.0), (-100.0, 25.0, 70.0))
COLLADA, REFUSED, BASE, LINK = 0x0000FF, 0xD83A34, 0x8B95A3, 0xE08A2E


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The robot file; one of its meshes is not there."""
    lost = '<link name="lost"/><joint name="j" type="fixed"><parent link="link5"/><child link="lost"/></joint>'
    text = ARM.replace("</robot>", f"{lost}</robot>")
    return robot(tmp_path_factory.mktemp("robot"), {**SHAPES, "lost": '<mesh filename="no.stl"/>'}, text)


@pytest.fixture(scope="module")
def shown(file: Path) -> dict[str, Any]:
    """What is shown of it."""
    folder = file.parent
    said = run_derive(folder, "import", "arm.urdf", "--base", "link0", "--tip", "link5", "--meshes")
    assert "Left out: a shape of link 'lost': 'no.stl' is not there." in said
    assert "Written: arm.glb. `softkin view arm.py` shows it on the machine." in said
    assert "with the meshes of arm.glb" in run_derive(folder, "view", "arm.py", "--out", "pages")
    PICTURES.mkdir(parents=True, exist_ok=True)
    arguments = (folder / "pages" / "arm.html", json.dumps(ROWS), PICTURES, folder / "shown.json")
    done = run([str(part) for part in (node(), available(prepared) / "meshes.mjs", *arguments)], folder)
    assert (folder / "shown.json").is_file(), done.stderr
    found: dict[str, Any] = json.loads((folder / "shown.json").read_text(encoding="utf-8"))
    return found


def test_nothing_is_fetched_and_all_is_in_the_picture(shown: dict[str, Any]) -> None:
    assert shown["errors"] == []
    assert len(shown["inside"]) == 6 and all(shown["inside"].values())


def test_they_move_with_their_links(file: Path, shown: dict[str, Any]) -> None:
    """A box around each is where an independent reader of the file has its links."""
    for row, pose in zip(ROWS, shown["poses"], strict=True):
        values = dict(zip(("turn", "lift", "bend"), np.radians(row), strict=True))
        assert pose.keys() == {body for body, _ in LINKS}
        for (body, _), names in LINKS.items():
            points = 1000.0 * np.concatenate([points_of(file, name, POINTS[name], values) for name in names])
            assert np.allclose(pose[body]["low"], points.min(axis=0), rtol=0, atol=1e-3), (row, body)
            assert np.allclose(pose[body]["high"], points.max(axis=0), rtol=0, atol=1e-3), (row, body)


def test_colours(shown: dict[str, Any]) -> None:
    """Those of the file, else those of the theme; what refuses is red."""
    colours = {body: one["colours"] for body, one in shown["poses"][0].items()}
    assert colours == {"base": [BASE], "A1": [LINK], "A2": [LINK], "A3": [COLLADA]}
    refused = {body: one["colours"] for body, one in shown["refused"].items()}
    assert refused["base"] == [BASE] and [REFUSED] in refused.values()
