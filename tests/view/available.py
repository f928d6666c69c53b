"""What npm brings for the tests of the viewer: a fault in CI where it can bring nothing, else nothing is shown."""

import os
from collections.abc import Callable
from typing import TypeVar

import pytest

from derive.view.node import MissingTool
from tests.view.driver import BROWSER

T = TypeVar("T")
_LONGEST = 200
"""Letters of the line that says why nothing is shown."""


def available(work: Callable[[], T]) -> T:
    """The result of work that a browser, or what the viewer is made of, is needed for."""
    try:
        return work()
    except MissingTool as problem:
        BROWSER.parent.mkdir(parents=True, exist_ok=True)
        BROWSER.write_text(f"the viewer was not shown: {' '.join(str(problem).split())[:_LONGEST]}\n", encoding="utf-8")
        if os.environ.get("CI"):
            raise
        pytest.skip("no browser could be had")
