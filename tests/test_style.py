"""The source is clean by the tools that the project is written with."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
TOOLS = {
    "ruff": ("ruff", "check", "--no-cache", "."),
    "mypy": ("mypy", "--strict", "derive"),
    "mypy of the generated package": ("mypy", "--strict", "generated/python/softkin"),
}


@pytest.mark.parametrize("tool", TOOLS)
def test_clean(tool: str) -> None:
    done = subprocess.run([sys.executable, "-m", *TOOLS[tool]], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
