"""`view`: what is refused before anything is derived."""

from pathlib import Path

import pytest

from derive.command.line import main

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
    """A body is that of one machine."""
    assert main(["view", *files, "--model", "A1=arm.glb"]) == 2
    assert "--model names a body of one machine" in capsys.readouterr().err
