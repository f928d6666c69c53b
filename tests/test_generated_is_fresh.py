"""`generated/` is what a fresh generation gives: byte for byte, whatever the order of hashing, without orphans."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from derive.__main__ import OUTPUT
from derive.output import differences


@pytest.mark.slow
def test_generated_is_fresh(tmp_path: Path) -> None:
    """In the order of hashing of one seed; `make generate` and `make check` each have one that nobody chose."""
    output = tmp_path / "generated"
    command = [sys.executable, "-m", "derive", "generate", "--fresh", "--output", str(output)]
    environment = {**os.environ, "PYTHONHASHSEED": "1"}
    done = subprocess.run(command, cwd=OUTPUT.parent, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    files = {str(p.relative_to(output)): p.read_bytes() for p in output.rglob("*") if p.is_file()}
    assert any(name.startswith("python") for name in files)
    assert any(name.startswith("st") for name in files)
    assert list(differences(OUTPUT, files)) == []
