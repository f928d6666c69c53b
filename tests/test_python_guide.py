"""The listings of the guide to the Python package: executed, with the output that the text shows."""

import doctest
from pathlib import Path

DOCS = Path(__file__).resolve().parents[1] / "docs"


def test_the_listings_show_what_happens() -> None:
    """Every statement runs, one after the other, and prints what stands below it."""
    found = doctest.testfile(str(DOCS / "PYTHON.md"), module_relative=False, optionflags=doctest.ELLIPSIS)
    assert found.attempted > 75 and found.failed == 0
