"""The C of the runtime compiles where it stands, each file alone, with the headers that the compiler writes."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from derive.emit.language import RUNTIME
from tests.c.programs import COMPILER, STRICT
from tests.native.build import SOURCES, headers

FOLDERS = (RUNTIME / "c", RUNTIME / "native")


@pytest.mark.parametrize("path", [path for folder in FOLDERS for path in sorted(folder.glob("*.[ch]"))], ids=str)
def test_it_compiles_alone(path: Path) -> None:
    """No warning, and no name that another file would have to bring."""
    if "Python.h" in path.read_text(encoding="utf-8") and not Path(headers(), "Python.h").is_file():
        pytest.skip("there is no Python.h")
    folders = [f"-I{folder}" for folder in (*FOLDERS, SOURCES, headers())]
    subprocess.run([COMPILER, *STRICT, *folders, "-fsyntax-only", "-x", "c", path], check=True)
