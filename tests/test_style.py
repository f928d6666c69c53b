"""The source is clean by the tools that the project is written with; ARCHITECTURE.md and the docstrings of the folders
name what there is.
"""

import ast
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from derive.emit.python.layout import WIDTH

ROOT = Path(__file__).resolve().parents[1]
IMPORT_LINTER = "from importlinter.cli import lint_imports_command as lint; lint(['--no-cache'])"
TOOLS = {
    "ruff": ("-m", "ruff", "check", "--no-cache", "."),
    "ruff format": ("-m", "ruff", "format", "--check", "--no-cache", "derive", "runtime", "tests", "bench", "prove"),
    "mypy": ("-m", "mypy", "--strict", "derive", "prove", "generated/python/softkin"),
    "directions of imports": ("-c", IMPORT_LINTER),
}
ROOM = 16
"""A folder with more modules than this, its `__init__` counted, holds more than one idea; the catalogue may grow."""
MAP = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
SCREEN = 80
"""The most lines of the map: a newcomer reads it without stopping."""
LISTED = re.compile(r"^([a-z_]\w*/?): \S", re.MULTILINE)
"""A line of a docstring that says what a module holds, or a folder."""
LENGTH = 350
"""A file with more lines than this holds more than one idea."""


@pytest.mark.slow("mypy")
@pytest.mark.parametrize("tool", TOOLS)
def test_clean(tool: str) -> None:
    done = subprocess.run([sys.executable, *TOOLS[tool]], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_no_generated_line_is_wider_than_a_page() -> None:
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
    missing = [room.name for room in rooms() if f"`{room.name}/`" not in MAP]
    assert not missing, f"ARCHITECTURE.md has no row for {missing}"


def test_the_map_is_one_screen() -> None:
    """ARCHITECTURE.md stays short: what is to be said of one module stands in the docstring of its folder."""
    lines = MAP.splitlines()
    assert len(lines) <= SCREEN
    assert not [line for line in lines if len(line) > WIDTH]


def test_the_rows_of_the_map_are_in_the_order_of_imports() -> None:
    """No folder may import one of a lower row."""
    linter = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]
    upward = [re.findall(r"\w+", layer) for layer in reversed(linter["contracts"][0]["layers"])]
    height = {name: place for place, layer in enumerate(upward) for name in layer}
    rows = re.findall(r"^\| `(\w+)/", MAP, re.MULTILINE)
    assert rows == sorted(rows, key=lambda name: height[name])


def test_the_map_names_what_there_is() -> None:
    """Every file and every folder that ARCHITECTURE.md quotes is in the project, by the end of its path."""
    quoted = re.findall(r"`([\w/]+(?:\.\w+|/))`", MAP)
    assert not [path for path in quoted if not is_in_the_project(path)]


def is_in_the_project(path: str) -> bool:
    """Whether it is a path, or the end of one below the folders that the map describes."""
    below = (
        p for top in ("derive", "docs", "generated", "runtime", "tests") for p in (ROOT / top).rglob(Path(path).name)
    )
    return (ROOT / path).exists() or any(found.as_posix().endswith(f"/{path.rstrip('/')}") for found in below)


INDEXED = [room.relative_to(ROOT) for room in (ROOT / "derive", *rooms()) if room.name != "mechanisms"]


@pytest.mark.parametrize("room", INDEXED, ids=str)
def test_a_folder_lists_its_modules(room: Path) -> None:
    """The docstring of a folder has a line for each of its modules and folders, and for nothing else."""
    text = ast.get_docstring(ast.parse((ROOT / room / "__init__.py").read_text(encoding="utf-8"))) or ""
    listed = LISTED.findall(text)
    modules = {path.stem for path in (ROOT / room).glob("*.py")} - {"__init__"}
    folders = {f"{path.name}/" for path in rooms() if path.parent == ROOT / room != ROOT / "derive"}
    unlisted, strange = (modules | folders) - set(listed), set(listed) - modules - folders
    assert not unlisted, f"{room}/__init__.py has no line for {sorted(unlisted)}"
    assert not strange, f"{room}/__init__.py lists what is not there: {sorted(strange)}"
    assert len(listed) == len(set(listed)), "something is listed twice"


@pytest.mark.parametrize("room", INDEXED, ids=str)
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
