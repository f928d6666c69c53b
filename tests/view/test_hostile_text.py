"""The page is a program of its own: text of a machine is shown, and no other script runs."""

import re
from base64 import b64encode
from hashlib import sha256

import pytest

from derive.command.view import PACKAGES
from derive.view.page import Content, page
from tests.javascript.modules import files_of
from tests.machines.hostile import MARKS
from tests.machines.test_hostile_text import Elements, pair
from tests.view.available import available

pytestmark = pytest.mark.slow


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
