"""`softkin view`, `explain --html` and `report`: what they refuse, and pages for machines of the user's own."""

import re
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from derive.command.line import main
from derive.command.new import description
from tests.command.files import RAIL, SCARA, Folder


@pytest.mark.slow
def test_the_page_of_ones_own_machine(folder: Folder) -> None:
    """It is written and named; it holds what was measured, and the names of the machine's package."""
    path = folder.write("scara.py", SCARA)
    said = folder.run("explain", "--html", path)
    assert said.status == 0, said.err
    target = folder.path / "build/report/MyScara.html"
    assert "build/report/MyScara.html" in said.out and target.is_file()
    text = target.read_text(encoding="utf-8")
    ET.fromstring(text)
    assert "<h1>MyScara</h1>" in text and ": A2 ← trigonometric ← x² + y²" in text
    assert re.search(r"largest residual 1e-\d\d", text)
    assert '<a href="../scara.html">' in text  # which `softkin view scara.py` writes into build
    assert text.count("<figure") == 4  # the drawing, the elbow, two maps
    assert len(text.encode()) < 400_000


def test_a_folder_of_its_own(folder: Folder) -> None:
    """Several files, one of them wrong: the others have their pages; no page says that it is singular."""
    folder.write("machines/rail.py", RAIL)
    folder.write("machines/wrong.py", RAIL.replace("Ty(A2)", "Tz(A2)"))
    said = folder.run("report", "machines", "--out", "pages")
    assert said.status == 2 and "wrong.py" in said.err
    assert folder.names("pages") == {"Rail.html"}
    text = (folder.path / "pages/Rail.html").read_text(encoding="utf-8")
    assert "<p>None.</p>" in text and "every point is reached" in text.lower()
    assert "in the viewer" not in text  # which looks for pages in a folder called report alone


def test_the_pages_of_a_catalogue(folder: Folder) -> None:
    """Every machine of a folder, with an index; a name that is none is refused."""
    folder.write("machines/rail.py", RAIL)
    folder.write("machines/scara.py", description("scara.py", "MyScara"))
    said = folder.run("report", "--mechanisms", "machines", "--only", "Rail", "--out", "pages")
    assert said.status == 0, said.err
    assert folder.names("pages") == {"Rail.html", "index.html"}
    assert 'href="Rail.html"' in (folder.path / "pages/index.html").read_text(encoding="utf-8")
    assert "1 page, listed in pages/index.html" in said.out
    assert "in the viewer" not in (folder.path / "pages/Rail.html").read_text(encoding="utf-8")
    assert folder.run("report", "--mechanisms", "machines", "--only", "Rail").status == 0
    text = (folder.path / "build/report/Rail.html").read_text(encoding="utf-8")
    assert '<a href="../viewer.html#machine=Rail">' in text
    wrong = folder.run("report", "--mechanisms", "machines", "--only", "Nobody")
    assert wrong.status == 1 and "no mechanism is called 'Nobody'" in wrong.err


@pytest.mark.parametrize("way", [("--html",), ()])
def test_what_cannot_be_derived_is_told(folder: Folder, way: tuple[str, ...]) -> None:
    """A page says no more than the text does: the same refusal."""
    wrong = folder.write("wrong.py", RAIL.replace("Ty(A2)", "Tx(A2)"))
    said = folder.run("explain", *way, wrong)
    assert said.status == 2 and "wrong.py" in said.err
    assert not (folder.path / "build").exists()


REFUSED = {
    "without a body": (["arm.glb"], "write body=file.glb"),
    "a scale that is none": (["A1=arm.glb*1e"], "'1e' is no scale"),
    "another format": (["A1=arm.glb"], "is no binary glTF"),
    "no file": (["A1=leg.glb"], "leg.glb"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_a_mesh_is_refused(case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """One message names the option, and what to write."""
    meshes, words = REFUSED[case]
    (tmp_path / "arm.glb").write_bytes(b"solid")
    options = [part for mesh in meshes for part in ("--model", mesh.replace("=", f"={tmp_path}/"))]
    assert main(["view", str(tmp_path / "machine.py"), "--out", str(tmp_path), *options]) == 2
    told = capsys.readouterr().err
    assert told.startswith("error: ") and words in told


@pytest.mark.parametrize("files", [[], ["one.py", "two.py"]], ids=["the catalogue", "two machines"])
def test_a_mesh_belongs_to_one_machine(files: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["view", *files, "--model", "A1=arm.glb"]) == 2
    assert "--model names a body of one machine" in capsys.readouterr().err
