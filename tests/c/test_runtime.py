"""The C of the runtime compiles where it stands, each file alone, with the headers that the compiler writes."""

import subprocess
from pathlib import Path

import pytest

from derive.emit.language import RUNTIME
from tests.c.programs import COMPILER, STRICT
from tests.native.build import SOURCES, headers

FOLDERS = (RUNTIME / "c", RUNTIME / "native")


FILES = [path for folder in FOLDERS for path in sorted(folder.glob("*.[ch]"))]
EXTENSIONS = [path for path in FILES if "Python.h" in path.read_text(encoding="utf-8")]
"""They need the headers of Python, as the core itself does: `python -m tests.native` says where there are none."""
ASKED = FILES if Path(headers(), "Python.h").is_file() else [path for path in FILES if path not in EXTENSIONS]


@pytest.mark.parametrize("path", ASKED, ids=str)
def test_it_compiles_alone(path: Path) -> None:
    """No warning, and no name that another file would have to bring."""
    folders = [f"-I{folder}" for folder in (*FOLDERS, SOURCES, headers())]
    subprocess.run([COMPILER, *STRICT, *folders, "-fsyntax-only", "-x", "c", path], check=True)
