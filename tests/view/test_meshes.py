"""An imported robot is shown with its meshes: each moves with its link; two themes, three sizes."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from derive.view.node import node, run
from tests.importing.robots import joint, urdf
from tests.importing.test_meshes import ARM, BOX, LINKS, POINTS, SHAPES, points_of, robot
from tests.view.conftest import PICTURES
from tests.view.driver import available, prepared
from tests.view.pages import run_derive

pytestmark = pytest.mark.slow
COLLADA, REFUSED, BASE, LINK = 0x0000FF, 0xD83A34, 0x8B95A3, 0xE08A2E
Row = tuple[float, ...]


@dataclass(frozen=True)
class Case:
    """A robot: its file, the shapes of its links, its joints with their values (of slides in millimetres), and the
    links of every body: one that moves against a body of the machine is called by the axes that move it.
    """

    text: str
    shapes: Mapping[str, str]
    tip: str
    joints: tuple[str, ...]
    rows: tuple[Row, ...]
    links: Mapping[str, tuple[str, ...]]


LOST = '<link name="lost"/><joint name="j" type="fixed"><parent link="link4"/><child link="lost"/></joint></robot>'
GANTRY = urdf(
    "gantry",
    joint("x", "prismatic", axis="0.6 0.8 0"),
    joint("y", "prismatic", "0 0 0.2"),
    joint("z", "prismatic", "0.1 0 0.2", axis="0.8 -0.6 0"),
    joint("c", "revolute", "0 0 0.1"),
)
SLIDES = ((0.0, 0.0, 0.0, 0.0), (100.0, 0.0, 0.0, 0.0), (0.0, 50.0, -70.0, 0.0), (-30.0, 40.0, 90.0, 75.0))
TURNS = ((0.0, 0.0, 0.0), (30.0, 0.0, 0.0), (30.0, -40.0, 0.0), (-100.0, 25.0, 70.0))
CASES = {
    "arm": Case(
        ARM, SHAPES, "link5", ("turn", "lift", "bend"), TURNS, {body: names for (body, _), names in LINKS.items()}
    ),
    "gantry": Case(
        GANTRY, {f"link{k}": SHAPES["link3"] for k in range(5)}, "link4", ("x", "y", "z", "c"), SLIDES,
        {"base": ("link0",), "base+1": ("link1",), "base+1+2": ("link2",), "base+1+2+3": ("link3",), "A2": ("link4",)},
    ),
}  # fmt: skip


@pytest.fixture(scope="module", params=CASES)
def case(request: pytest.FixtureRequest) -> Case:
    return CASES[request.param]


@pytest.fixture(scope="module")
def file(case: Case, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The robot file; one of its meshes is not there."""
    shapes = {**case.shapes, "lost": '<mesh filename="no.stl"/>'}
    return robot(tmp_path_factory.mktemp("robot"), shapes, case.text.replace("</robot>", LOST))


@pytest.fixture(scope="module")
def shown(case: Case, file: Path) -> dict[str, Any]:
    """What is shown of it."""
    folder = file.parent
    said = run_derive(folder, "import", "arm.urdf", "--base", "link0", "--tip", case.tip, "--meshes")
    assert "Left out: a shape of link 'lost': 'no.stl' is not there." in said
    assert "Written: arm.glb. `softkin view arm.py` shows it on the machine." in said
    assert "with the meshes of arm.glb" in run_derive(folder, "view", "arm.py", "--out", "pages")
    PICTURES.mkdir(parents=True, exist_ok=True)
    arguments = (folder / "pages" / "arm.html", json.dumps(case.rows), PICTURES, folder / "shown.json")
    done = run([str(part) for part in (node(), available(prepared) / "meshes.mjs", *arguments)], folder)
    assert (folder / "shown.json").is_file(), done.stderr
    found: dict[str, Any] = json.loads((folder / "shown.json").read_text(encoding="utf-8"))
    return found


def test_nothing_is_fetched_and_all_is_in_the_picture(shown: dict[str, Any]) -> None:
    assert shown["errors"] == []
    assert len(shown["inside"]) == 6 and all(shown["inside"].values())


def test_they_move_with_their_links(case: Case, file: Path, shown: dict[str, Any]) -> None:
    """A box around each is where an independent reader of the file has its links."""
    for row, pose in zip(case.rows, shown["poses"], strict=True):
        units = [1e-3 if name in "xyz" else np.pi / 180.0 for name in case.joints]
        values = {name: value * unit for name, value, unit in zip(case.joints, row, units, strict=True)}
        assert pose.keys() == case.links.keys()
        for body, names in case.links.items():
            shapes = [BOX if case.shapes[name] == SHAPES["link3"] else POINTS[name] for name in names]
            points = [points_of(file, name, shape, values) for name, shape in zip(names, shapes, strict=True)]
            corners = 1000.0 * np.concatenate(points)
            assert np.allclose(pose[body]["low"], corners.min(axis=0), rtol=0, atol=1e-3), (row, body)
            assert np.allclose(pose[body]["high"], corners.max(axis=0), rtol=0, atol=1e-3), (row, body)


@pytest.mark.parametrize("case", ["arm"], indirect=True, scope="module")
def test_colours(shown: dict[str, Any]) -> None:
    """Those of the file, else those of the theme; what refuses is red."""
    colours = {body: one["colours"] for body, one in shown["poses"][0].items()}
    assert colours == {"base": [BASE], "A1": [LINK], "A2": [LINK], "A3": [COLLADA]}
    refused = {body: one["colours"] for body, one in shown["refused"].items()}
    assert refused["base"] == [BASE] and [REFUSED] in refused.values()
