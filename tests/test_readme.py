"""The pages: what the README shows of generated code stands in the generated files, and all links lead somewhere."""

import re
from pathlib import Path

import pytest
from softkin import catalogue

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
