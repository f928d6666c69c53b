"""The pages: what they show of generated code and of programs, what their listings print, and where links lead."""

import ast
import doctest
import os
import re
import sys
from pathlib import Path

import pytest
from softkin import catalogue

from tests.outside import output_of

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
SHORT = 150
"""The most lines of the README: its doors are on the first screen, and the rest is in docs/."""
PAGES = sorted(
    [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / "generated").rglob("*.md")],
    key=lambda path: path.as_posix(),
)


def plain(text: str) -> str:
    """The text without layout and comments, in lower case."""
    return re.sub(r"\s+", "", re.sub(r"//[^\n]*", "", text)).lower()


def test_the_block_in_the_readme_is_the_block_that_comes_out() -> None:
    (shown,) = re.findall(r"```iecst\n(.*?)```", README, re.DOTALL)
    block = plain((ROOT / "generated/st/scara/Kin_Scara4_ZCcoupled_Type1.st").read_text(encoding="utf-8"))
    parts = [plain(part) for part in shown.split("…")]
    assert len(parts) == 2
    for part in parts:
        assert part in block


def test_the_readme_is_short_and_leads_to_every_page() -> None:
    """Every guide is one link away, and the number of machines is that of the catalogue."""
    assert len(README.splitlines()) <= SHORT
    assert not [path.name for path in (ROOT / "docs").glob("*.md") if f"](docs/{path.name})" not in README]
    assert f"[{len(catalogue())} machines](docs/MECHANISMS.md)" in README


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_links_lead_somewhere(page: Path) -> None:
    """Every link of a page leads to a file that exists, and to a heading that exists in it."""
    for target in re.findall(r"\]\(([^)\s]+)\)", prose(page)):
        file, _, anchor = target.partition("#")
        if not file.startswith("https:"):
            where = (page.parent / file).resolve() if file else page
            assert where.exists(), target
            assert not anchor or anchor in {_anchor(h) for h in re.findall(r"^#+ (.*)$", prose(where), re.MULTILINE)}


def prose(page: Path) -> str:
    """A page without its listings."""
    return re.sub(
        r"```.*?```|`[^`\n]*`",
        lambda found: re.sub(r"[^\w\s]", "", found[0]),
        page.read_text(encoding="utf-8"),
        flags=re.DOTALL,
    )


def _anchor(heading: str) -> str:
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


DOCS = ROOT / "docs"


@pytest.mark.parametrize(("guide", "listings"), [("PYTHON.md", 77), ("CALIBRATION.md", 20)])
def test_the_listings_show_what_happens(guide: str, listings: int) -> None:
    """Every statement runs, one after the other, and prints what stands below it."""
    found = doctest.testfile(str(DOCS / guide), module_relative=False, optionflags=doctest.ELLIPSIS)
    assert found.attempted > listings and found.failed == 0


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
    env = {**os.environ, "PYTHONPATH": str(ROOT / "generated/python")}
    assert output_of([sys.executable, program, tmp_path], env=env, cwd=tmp_path, timeout=300) == output
    drawn = {path.name for path in tmp_path.glob("*.png") if path.stat().st_size > 3000}
    assert drawn == {path.name for path in (DOCS / "gallery/pictures").glob(f"{name}.png")}


COMPARED = (ROOT / "docs/COMPARE.md").read_text(encoding="utf-8")


def test_the_page_has_the_versions_that_are_measured() -> None:
    """For both arms, and in the list of what others do; the package itself on both cores."""
    pinned = "".join((ROOT / "bench" / name).read_text(encoding="utf-8") for name in ("requirements.txt", "peers.txt"))
    versions = dict(re.findall(r"^([\w-]+)==(\S+)$", pinned, re.MULTILINE))
    for package in ("eaik", "ssik", "roboticstoolbox-python", "pin", "ikpy"):
        assert COMPARED.count(f" | {package} {versions[package]} | ") == 2
        assert re.search(rf"^\| \[{package}\]\(\S+\)[^|]* {re.escape(versions[package])} \|", COMPARED, re.MULTILINE)
    assert all(COMPARED.count(f"| softkin | `inverse_all`, {core} |") == 2 for core in ("python", "native"))
