"""One run of the viewer in a browser, for all tests of this folder."""

from pathlib import Path

import pytest

from tests.generation import Generation
from tests.view.driver import BROWSER, available, driven
from tests.view.pages import Seen, catalogue_page, own_page

PICTURES = Path(__file__).parents[2] / "build" / "view"
"""The pictures of the last run, to be looked at."""


@pytest.fixture(scope="session")
def pages(generation: Generation, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """The page of the catalogue, and that of one machine."""
    folder = tmp_path_factory.mktemp("pages")
    return available(lambda: (catalogue_page(folder, generation.modules), own_page(folder)))


@pytest.fixture(scope="session")
def seen(pages: tuple[Path, Path]) -> Seen:
    found = available(lambda: driven(*pages, PICTURES))
    first = min(found["pictures"]["catalogue"], key=lambda marks: float(marks["first picture"]))["first picture"]
    text = f"the viewer was shown by {found['browser']}, its first picture after {first / 1000:.1f} s\n"
    BROWSER.write_text(text, encoding="utf-8")
    return found
