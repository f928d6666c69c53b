"""What the system refuses is told in one sentence with the file and what to do, and what was there stays."""

import errno
import os
from pathlib import Path
from typing import Any

import pytest

from derive.command import own
from derive.command.line import main

WANTED = "is a file, where a folder is needed: name another one"


@pytest.fixture(autouse=True)
def derived(monkeypatch: pytest.MonkeyPatch) -> None:
    """Files of a machine, without a derivation."""
    monkeypatch.setattr(own, "_derived", lambda *_: {"python/arm/arm.py": b"1", "st/own/Arm.st": b"2"})


@pytest.mark.parametrize("out", ["file", "file/inside", "file/further/inside"])
def test_an_output_folder_that_is_a_file(out: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The file is named, and is as it was; so of the folder of a new description."""
    (tmp_path / "file").write_text("mine")
    for command in (["derive", "arm.py", "--out", str(tmp_path / out)], ["new", str(tmp_path / "file" / "arm.py")]):
        assert main(command) == 2
        said = capsys.readouterr().err
        assert said.startswith(f"error: {tmp_path / 'file'}") and WANTED in said and "Errno" not in said
    assert (tmp_path / "file").read_text() == "mine"


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EACCES, errno.EROFS, errno.EIO])
def test_a_disk_that_takes_nothing(
    number: int, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Full, without permission, read-only, broken: one sentence; the output of the run before is complete."""
    out = tmp_path / "out"
    assert main(["derive", "arm.py", "--out", str(out)]) == 0
    monkeypatch.setattr(own, "_derived", lambda *_: {"python/arm/arm.py": b"3", "st/own/Arm.st": b"4"})

    def refuse(path: Path, *_: Any) -> int:
        raise OSError(number, os.strerror(number), str(path) if number != errno.ENOSPC else None)

    monkeypatch.setattr(Path, "write_bytes", refuse)
    assert main(["derive", "arm.py", "--out", str(out)]) == 2
    said = capsys.readouterr().err
    assert said.startswith("error: ") and said.count("\n") == 1 and "Errno" not in said and "mistake" not in said
    assert (number == errno.ENOSPC) == ("no space is left on the disk" in said)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out"]
    assert (out / "python/arm/arm.py").read_bytes() + (out / "st/own/Arm.st").read_bytes() == b"12"


def test_a_description_with_a_byte_that_is_0(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "arm.py"
    path.write_bytes(b"# one\n# two\nx = 1\0\n")
    assert main(["explain", str(path)]) == 2
    assert f"{path}:3: the line holds a byte that is 0" in capsys.readouterr().err
