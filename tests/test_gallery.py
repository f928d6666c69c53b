"""The gallery: every program runs, prints what docs/GALLERY.md shows, and draws the pictures that stand there."""

import ast
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
PAGE = (DOCS / "GALLERY.md").read_text(encoding="utf-8")
PROGRAMS = tuple(sorted(path.stem for path in (DOCS / "gallery").glob("*.py")))
HEADING = r"^## ([^\n]*)\n\n\[(\w+)\.py\]\(gallery/\2\.py\)\n\n"
SECTION = re.compile(HEADING + r"```python\n(.*?)```\n\n```text\n(.*?)```\n", re.MULTILINE | re.DOTALL)
SECTIONS = {name: (title, code, output) for title, name, code, output in SECTION.findall(PAGE)}


def test_the_page_shows_every_program() -> None:
    """Eleven programs, each once, and no picture that is not there."""
    assert len(PROGRAMS) == 11 and set(SECTIONS) == set(PROGRAMS) and PAGE.count("\n## ") == 11
    pictures = set(re.findall(r"\]\((gallery/pictures/\w+\.png)\)", PAGE))
    assert pictures == {f"gallery/pictures/{path.name}" for path in (DOCS / "gallery/pictures").iterdir()}


@pytest.mark.slow("dask")
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_prints_what_the_page_shows(name: str, tmp_path: Path) -> None:
    """In a process of its own, with its pictures in a temporary folder."""
    program = DOCS / f"gallery/{name}.py"
    title, code, output = SECTIONS[name]
    assert code == program.read_text(encoding="utf-8")
    assert (ast.get_docstring(ast.parse(code)) or "").startswith(f"{title}: ")
    done = subprocess.run(
        [sys.executable, str(program), str(tmp_path)],
        env={**os.environ, "PYTHONPATH": str(ROOT / "generated/python")},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == output
    drawn = {path.name for path in tmp_path.glob("*.png") if path.stat().st_size > 3000}
    assert drawn == {path.name for path in (DOCS / "gallery/pictures").glob(f"{name}.png")}
