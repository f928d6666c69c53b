"""The listings of the guides to the Python package: executed, with the output that the text shows."""

from __future__ import annotations

import doctest
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parents[1] / "docs"


@pytest.mark.parametrize("page", ["PYTHON_ROBOT.md"])
def test_the_listings_show_what_happens(page: str) -> None:
    """Every statement runs, and prints what stands below it."""
    found = doctest.testfile(str(DOCS / page), module_relative=False)
    assert found.attempted > 10 and found.failed == 0
