"""The pages themselves, in a notebook too: every machine is drawn, fast, and hostile texts are texts."""

from __future__ import annotations

import json
import re
from base64 import b64encode
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest
import softkin

from derive.command.view import PACKAGES
from derive.view.node import node, run
from derive.view.page import Content, page
from tests.javascript.modules import files_of
from tests.machines.hostile import MARKS
from tests.machines.test_hostile_text import Elements, pair
from tests.mechanisms import catalogue, named
from tests.view.driver import available, prepared
from tests.view.pages import ARM, Seen

pytestmark = pytest.mark.slow

MEGABYTE = 1_000_000


def test_the_pages_are_small(pages: tuple[Path, Path]) -> None:
    """All of the catalogue in 3 MB, one machine in 1 MB; nothing is fetched, and three.js's licence is there."""
    whole, own = (page.read_text(encoding="utf-8") for page in pages)
    assert len(whole.encode()) <= 3 * MEGABYTE
    assert len(own.encode()) <= MEGABYTE
    for text in (whole, own):
        assert not re.search(r"<(script|link|img)[^>]*(src|href)=\"(?!data:)", text)
        assert "Copyright © 2010-" in text and "three.js authors" in text


def test_nothing_is_complained_of(seen: Seen) -> None:
    """No error and no warning on the console, no request, in any part of the run."""
    assert seen["errors"] == []


def test_the_derivation_is_linked(seen: Seen) -> None:
    """The page of the machine that is shown, where `make report` and `explain --html` write it."""
    assert seen["report"] == f"report/{named(ARM).block_name}.html"
    assert seen["own"]["report"] == "report/MyMachine.html"


def test_a_mesh_of_ones_own(seen: Seen) -> None:
    """A mesh stands in the frame of its body; the page of one machine has that machine alone."""
    assert seen["own"]["names"] == ["MyMachine"]
    assert np.allclose(seen["own"]["at"], seen["own"]["body"], atol=1e-6)
    assert np.linalg.norm(seen["own"]["body"]) > 100
    assert seen["own"]["licence"]


def test_it_is_fast(seen: Seen) -> None:
    """A frame with all ghosts is 16 ms of script; all branches are 0.2 ms in closed form, and 5 ms where searched."""
    for found in seen["times"].values():
        assert found["frame"] < 16
        assert found["all"] < (5 if found["isSearched"] else 0.2)
    assert seen["times"][ARM]["ghosts"] == 7
    for marks in seen["pictures"].values():  # of several pages, on a machine that does other things as well
        assert 0 < min(one["program"] for one in marks) < min(one["first picture"] for one in marks) < 1000


def shown(index: int) -> str:
    """The page of the arm with hostile texts (0), or with plain ones (1)."""
    kinematics, built = pair("chain").kinematics[index], pair("chain").built[index]
    files = {path: text.encode() for path, text in files_of(built.parts["javascript"]).items() if path.endswith(".js")}
    names = {kinematics.mechanism.name: " ".join(MARKS) if index == 0 else "x"}
    content = Content(names[kinematics.mechanism.name], files, "softkin", names, reports=names)
    return available(lambda: page(content, PACKAGES))


def test_the_elements_are_those_of_a_plain_machine() -> None:
    """A title, a name of a class, an address of a report, and every text of the machine add none."""
    assert Elements(shown(0)).found == Elements(shown(1)).found


def test_the_policy_allows_this_program_alone() -> None:
    """By its digest, as that of the style: a page with another program, or with code in an attribute, runs nothing."""
    text = shown(0)
    policy = re.search(r'<meta http-equiv="Content-Security-Policy" content="([^"]*)">', text)
    program = re.search(r'<script id="program">(.*?)</script>', text, re.DOTALL)
    assert policy and program and "unsafe" not in policy[1] and "default-src 'none'" in policy[1]
    digest = b64encode(sha256(program[1].encode()).digest()).decode()
    assert re.findall(r"script-src ([^;]*);", policy[1]) == [f"'sha256-{digest}'"]
    assert text.index(policy[0]) < text.index("<script")


@pytest.mark.parametrize("name", [mechanism.name for _, mechanism in catalogue()])
def test_every_machine_is_drawn(name: str, seen: Seen) -> None:
    """Its bodies alone cover part of the picture; it stands where Python says, with all its solutions."""
    found = seen["machines"][name]
    assert found["refusal"] is None
    assert found["covered"] > 500
    assert found["isLabelled"]
    robot = softkin.catalogue()[name](**found["parameters"])
    if not found["axes"]:
        return
    frame, configuration = robot.forward(found["axes"])
    is_iterated = name in ("Kin_Hexapod", "Softkin_Hexaglide", "Softkin_Pentapod", "Softkin_Planar_3RRR")
    tolerance = 1e-6 if is_iterated else 1e-9
    assert np.allclose(frame.position, found["frame"]["position"], rtol=0, atol=tolerance)
    assert list(configuration) == found["configuration"]
    there = (found["frame"]["position"], found["frame"]["rotation"])
    slots = robot.inverse_all(there, reference=found["axes"])
    assert sum(slot.status == softkin.Status.OK for slot in slots) == found["solutions"]


@pytest.mark.parametrize("name", [mechanism.name for _, mechanism in catalogue() if mechanism.joints])
def test_the_part_that_refuses_is_marked(name: str, seen: Seen) -> None:
    """Far away every machine that ends somewhere refuses: the axis or the rod is marked that its sentence names."""
    found = seen["machines"][name]["farAway"]
    if found["reason"] is None:
        assert found["marked"] == []
        return
    subject = re.split(r"[:,]| cannot | where ", found["reason"])[0]
    kinds = {part.partition(" ")[0] for part in found["marked"]}
    names = {part.partition(" ")[2] for part in found["marked"]}
    axes = {axis.name for axis in softkin.catalogue()[name].AXES}
    if subject in axes:
        assert names and all(subject in words.split() or kinds == {"rod"} for words in names)
    elif " " in subject:
        rod = subject.rpartition("rod ")[2]
        assert kinds == {"rod"} and {words.rstrip("ab") for words in names} == {rod}
    elif subject == "a3_from_a2":
        assert names == {"A2", "A2 A3", "A3"}
    else:
        assert kinds in ({"plate"}, {"tool"})


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
