"""`softkin derive … --language` writes the folder of that language, and leaves what stands beside it."""

from pathlib import Path

import pytest

from derive.command.line import main
from derive.description.catalogue import MECHANISMS
from tests.c import programs
from tests.javascript import modules
from tests.linuxcnc import module

SHARED_BY_C = {"softkin.c", "softkin.h", "softkin_constants.h", "softkin_rotation.h"}
WRITTEN = {
    "c": lambda name: programs.files_of(programs.part_of(name)),
    "javascript": lambda name: modules.files_of(modules.part_of(name)),
    "linuxcnc": lambda name: module.part_of(name)["files"],
}


@pytest.mark.parametrize("language", WRITTEN)
def test_it_is_written_alone(language: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """All files, as the language makes them, and no other."""
    beside = tmp_path / "mine.txt"
    beside.write_text("mine")
    assert main(["derive", str(MECHANISMS / "kin_caxis.py"), "--out", str(tmp_path), "--language", language]) == 0
    assert {path.name for path in tmp_path.iterdir()} == {"mine.txt", language} and beside.read_text() == "mine"
    files = [path for path in (tmp_path / language).rglob("*") if path.is_file()]
    found = {path.relative_to(tmp_path / language).as_posix(): path.read_text(encoding="utf-8") for path in files}
    assert found == dict(WRITTEN[language]("Kin_CAxis"))
    assert language != "c" or set(found) == {"caxis.c", "caxis.h", *SHARED_BY_C}
    capsys.readouterr()
