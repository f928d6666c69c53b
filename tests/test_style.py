"""The source is clean by the tools that the project is written with."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from derive.emit.python.layout import WIDTH

ROOT = Path(__file__).resolve().parents[1]
IMPORT_LINTER = "from importlinter.cli import lint_imports_command as lint; lint(['--no-cache'])"
TOOLS = {
    "ruff": ("-m", "ruff", "check", "--no-cache", "."),
    "ruff format": ("-m", "ruff", "format", "--check", "--no-cache", "derive", "tests", "bench", "prove"),
    "mypy": ("-m", "mypy", "--strict", "derive", "prove"),
    "mypy of the generated package": ("-m", "mypy", "--strict", "generated/python/softkin"),
    "directions of imports": ("-c", IMPORT_LINTER),
}
ROOM = 16
"""A folder with more modules than this, its `__init__` counted, holds more than one idea; the catalogue may grow."""
LENGTH = 350
"""A file with more lines than this holds more than one idea."""


@pytest.mark.parametrize("tool", TOOLS)
def test_clean(tool: str) -> None:
    """The tool finds nothing to complain about."""
    done = subprocess.run([sys.executable, *TOOLS[tool]], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_no_generated_line_is_wider_than_a_page() -> None:
    """No line of generated Python is longer than 120 columns."""
    wide = [
        f"{path.name}:{number}"
        for path in sorted((ROOT / "generated/python").rglob("*.py"))
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if len(line) > WIDTH
    ]
    assert not wide, wide


def rooms() -> list[Path]:
    """Every folder of the compiler that holds modules."""
    return sorted({path.parent for path in (ROOT / "derive").rglob("*.py")} - {ROOT / "derive"})


def test_the_map_names_every_folder() -> None:
    """ARCHITECTURE.md has a row for every folder of the compiler."""
    map_ = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    missing = [room.name for room in rooms() if f"`{room.name}/`" not in map_]
    assert not missing, f"ARCHITECTURE.md has no row for {missing}"


@pytest.mark.parametrize("room", [room.relative_to(ROOT) for room in rooms() if room.name != "mechanisms"], ids=str)
def test_a_folder_holds_one_idea(room: Path) -> None:
    """No folder holds more modules than a reader can survey."""
    assert len(list((ROOT / room).glob("*.py"))) <= ROOM


@pytest.mark.parametrize("folder", ["derive", "tests"])
def test_a_file_holds_one_idea(folder: str) -> None:
    """No module of the compiler or of its tests is longer than a reader can survey."""
    lengths = {path: len(path.read_text(encoding="utf-8").splitlines()) for path in (ROOT / folder).rglob("*.py")}
    long = [f"{path.relative_to(ROOT)}: {length}" for path, length in sorted(lengths.items()) if length > LENGTH]
    assert lengths and not long, long


def test_tests_are_shared_out_by_group(request: pytest.FixtureRequest) -> None:
    """What runs them in several processes knows the groups of `conftest`: it then writes them behind the names."""
    assert "@" in request.node.nodeid or not hasattr(request.config, "workerinput")
