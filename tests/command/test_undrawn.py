"""A drawing that cannot be made is a warning with its reason: package and block are written, and proven."""

import re

import pytest

from derive.description.catalogue import MECHANISMS, load
from derive.pipeline import Built, derive_one, languages, unwritten
from tests.command.files import Folder
from tests.command.guide import MACHINES
from tests.command.wrong import changed
from tests.mechanisms import named

WRONG_BAR = changed(
    MACHINES["five_bar"],
    ("    task=Task", '    bars=(rod("1", KNEE_1, TOOL, ROD_1), rod("2", KNEE_2, TOOL, 2 * ROD_2)),\n    task=Task'),
)
"""One bar is drawn with another length than the rod that it stands for."""


def test_a_machine_that_cannot_be_drawn_is_written_without_a_picture(folder: Folder) -> None:
    folder.write("five_bar.py", WRONG_BAR)
    said = folder.run("derive", "five_bar.py")
    assert (said.status, said.err) == (0, "")
    assert re.search(
        r"^  warning: five_bar\.py:\d+: not drawn: bar '2' is \d+ long, but its ends are \d+ apart", said.out, re.M
    )
    names = folder.names("build")
    assert "st/own/FiveBar.st" in names and not [n for n in names if n.startswith("st/pictures")]
    assert "image::" not in (folder.path / "build/st/own/FiveBar.st").read_text()
    assert re.search(
        r"^\| \[`FiveBar`\]\(own/FiveBar\.st\) \| no \|", (folder.path / "build/st/README.md").read_text(), re.M
    )


def test_whatever_a_drawing_meets_is_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also an error that nobody expects; the machine is that of a run in which it is drawn."""

    def broken(_: object) -> dict[str, bytes]:
        raise ZeroDivisionError("no size")

    gantry = named("Kin_Gantry2")
    drawn = derive_one(gantry)
    monkeypatch.setattr("derive.emit.softmotion.pictures.pictures_of", broken)
    built = derive_one(gantry)
    assert (drawn.undrawn, built.undrawn) == ("", "ZeroDivisionError: no size")
    assert drawn.pictures and not built.pictures
    assert built.parts["python"] == drawn.parts["python"]


def test_a_machine_with_seven_axes_has_a_package_and_no_block(folder: Folder) -> None:
    """A position in SoftMotion has six axes; Python has as many as there are."""
    slides = changed(
        MACHINES["arm_on_track"],
        ("joints=(E1, A1, A2)", "joints=(E1, *MORE, A1, A2)"),
        ("held=(E1,)", "held=(E1, *MORE)"),
        ("chain=Tx(E1) * ", "chain=Tx(E1) * Tx(MORE[0]) * Tx(MORE[1]) * Tx(MORE[2]) * Tx(MORE[3]) * "),
        ("MECHANISM =", 'MORE = [linear(f"E{k}", "another track") for k in (2, 3, 4, 5)]\n\nMECHANISM ='),
    )
    folder.write("tracks.py", slides)
    said = folder.run("derive", "tracks.py")
    assert (said.status, said.err) == (0, "")
    assert "note: no block: it has 7 axes, and SoftMotion knows six" in said.out
    assert {n.split("/")[0] for n in folder.names("build")} == {"python"}


def test_a_language_that_does_not_hold_a_machine_says_why() -> None:
    """Of those that were asked for alone."""
    mechanism = load(MECHANISMS / "kin_gantry2.py")
    built = Built("", "", None, {"python": {}}, {})
    assert list(unwritten(built, languages(wanted=["python", "st", "c"]), mechanism)) == [
        "no block: it has 2 axes, and SoftMotion knows six",
        "no C: its calls hold 24 axes and 12 branches",
    ]
    assert not list(unwritten(built, languages(wanted=["python"]), mechanism))
