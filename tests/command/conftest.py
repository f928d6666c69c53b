"""The folder of a user, in which commands run."""

from pathlib import Path

import pytest

from tests.command.files import Folder


@pytest.fixture
def folder(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Folder:
    """An empty folder, which is the one in which commands run."""
    monkeypatch.chdir(tmp_path)
    return Folder(tmp_path, capsys)
