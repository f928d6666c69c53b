"""The pages themselves: their size, their complaints, their links, their speed, and hostile texts in them."""

import re
from base64 import b64encode
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest

from derive.command.view import PACKAGES
from derive.view.page import Content, page
from tests.javascript.modules import files_of
from tests.machines.hostile import MARKS
from tests.machines.test_hostile_text import Elements, pair
from tests.mechanisms import named
from tests.view.available import available
from tests.view.states import ARM, Seen

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
