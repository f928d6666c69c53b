"""One run of the viewer in a browser, for all tests of this folder."""

from pathlib import Path

import pytest

from tests.generation import Generation
from tests.view.driver import BROWSER, available, driven
from tests.view.pages import Seen, catalogue_page, kept_modules, own_page

PICTURES = Path(__file__).parents[2] / "build" / "view"
"""The pictures of the last run, to be looked at."""


@pytest.fixture(scope="session")
def pages(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """The page of the catalogue, and that of one machine."""
    modules = kept_modules()
    if modules is None:
        generation: Generation = request.getfixturevalue("generation")
        modules = generation.modules
    folder = tmp_path_factory.mktemp("pages")
    return available(lambda: (catalogue_page(folder, modules), own_page(folder)))


@pytest.fixture(scope="session")
def seen(pages: tuple[Path, Path]) -> Seen:
    found = available(lambda: driven(*pages, PICTURES))
    first = min(found["pictures"]["catalogue"], key=lambda marks: float(marks["first picture"]))["first picture"]
    text = f"the viewer was shown by {found['browser']}, its first picture after {first / 1000:.1f} s\n"
    BROWSER.write_text(text, encoding="utf-8")
    return found
