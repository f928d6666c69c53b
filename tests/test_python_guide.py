"""The listings of the guides to the Python package and to calibration: executed, with the output that they show."""

import doctest
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parents[1] / "docs"


@pytest.mark.parametrize(("guide", "listings"), [("PYTHON.md", 75), ("CALIBRATION.md", 20)])
def test_the_listings_show_what_happens(guide: str, listings: int) -> None:
    """Every statement runs, one after the other, and prints what stands below it."""
    found = doctest.testfile(str(DOCS / guide), module_relative=False, optionflags=doctest.ELLIPSIS)
    assert found.attempted > listings and found.failed == 0
