"""The site that `make docs` builds: every link leads somewhere, nothing comes from a network, its programs run."""

import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import pytest
import softkin

from tests.outside import output_of

pytestmark = pytest.mark.slow
ROOT = Path(__file__).resolve().parents[1]


class Page(HTMLParser):
    """The places of a page that can be linked to, its links, and the files that it loads."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.ids: set[str] = set()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        self.ids |= {given[name] for name in ("id", "name") if name in given}
        if tag == "a":
            self.links += [given["href"]] if "href" in given else []
        else:
            self.loaded += [given[name] for name in ("src", "href") if name in given]


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[Path, Page]:
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, str(ROOT / "docs/site/build.py"), str(folder)]
    paths = {"PYTHONPATH": f"{ROOT}:{ROOT / 'generated/python'}", "PATH": ""}
    output_of(command, cwd=ROOT, env=paths)
    return {path: Page(path) for path in sorted((folder / "html").rglob("*.html"))}


def test_no_link_of_the_site_is_broken(pages: dict[Path, Page]) -> None:
    """Every link leads to a file of the site, and to a place that is in it; pages load files of the site alone."""
    assert sum(len(page.links) for page in pages.values()) > 5000
    broken = []
    for path, page in pages.items():
        for target in {*page.links, *page.loaded}:
            file, _, place = unquote(re.sub(r"\?v=\w+$", "", target)).partition("#")
            if re.match(r"https?:", target) and target not in page.loaded:
                continue
            where = (path.parent / file).resolve() if file else path
            if not where.is_file() or (place and where in pages and place not in pages[where].ids):
                broken.append(f"{path.name}: {target}")
    assert not broken, broken


def test_every_machine_has_a_page_whose_call_runs(pages: dict[Path, Page]) -> None:
    """The page of a machine shows its drawing, leads to its files, and makes a machine with the nominal dimensions."""
    found = {path.stem: path for path in pages if path.parent.name == "machines"}
    assert set(found) == {*softkin.catalogue(), "index"}
    for name, cls in softkin.catalogue().items():
        text = found[name].read_text(encoding="utf-8")
        (program,) = re.findall(
            r'highlight-python notranslate"><div class="highlight"><pre>(.*?)</pre>', text, re.DOTALL
        )
        made: dict[str, object] = {}
        exec(re.sub(r"<[^>]*>", "", program), made)
        assert type(made["robot"]) is cls
        assert all(f'id="{title}"' in text for title in ("parameters", "singularities", "files"))
        assert ".svg" in text and f"{cls.__module__.rpartition('.')[2]}.py" in text


def test_the_reference_has_every_public_name(pages: dict[Path, Page]) -> None:
    """Classes, their methods, functions, and the words of a description."""
    reference = next(page for path, page in pages.items() if path.name == "api.html")
    wanted = {"Mechanism.inverse", "Mechanism.path", "Frame.from_rpy", "Coupled", "Mounted", "calibrate", "load"}
    assert {f"softkin.{name}" for name in wanted} | {"derive.mechanism.rotary"} <= reference.ids
