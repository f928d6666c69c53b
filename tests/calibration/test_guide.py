"""The guide to calibration: its listings, executed, with the output that the text shows."""

import doctest

from tests.test_python_guide import DOCS


def test_the_listings_show_what_happens() -> None:
    """Every statement runs, one after the other, and prints what stands below it."""
    found = doctest.testfile(str(DOCS / "CALIBRATION.md"), module_relative=False, optionflags=doctest.ELLIPSIS)
    assert found.attempted > 20 and found.failed == 0
