"""The browser that shows the viewer, and what is said where there is none."""

import json
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import pytest

from derive.view.node import MissingTool, installed, node, run

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


ROOT = Path(__file__).parents[2]
PACKAGES = ROOT / ".view-tests"
"""Where npm puts the driver and the browser, once."""
BROWSER = ROOT / "build" / "view" / "browser.txt"
"""Which browser ran, in one line, or that none could be had; the summary of a test run prints it."""
SCRIPTS = ("browser.mjs", "drive.mjs", "follow.mjs", "frame.mjs", "meshes.mjs", "shown.mjs")


def prepared() -> Path:
    """The folder in which the scripts stand beside what they import. Raises `MissingTool`."""
    installed(Path(__file__).parent, PACKAGES)
    for name in SCRIPTS:
        shutil.copy(Path(__file__).with_name(name), PACKAGES / name)
    return PACKAGES


def driven(catalogue: Path, own: Path, folder: Path, which: str = "") -> dict[str, Any]:
    """What the browser has seen; pictures are written into the folder.

    which: "installed" or "npm", or nothing for the first browser that is there. Raises `MissingTool` where none is.
    """
    folder.mkdir(parents=True, exist_ok=True)
    prepared()
    result = folder / "seen.json"
    result.unlink(missing_ok=True)
    command = [node(), PACKAGES / "drive.mjs", catalogue, own, folder, result, *([which] if which else [])]
    done = run([str(part) for part in command], folder)
    assert result.is_file(), done.stderr
    found: dict[str, Any] = json.loads(result.read_text(encoding="utf-8"))
    if "missing" in found:
        raise MissingTool(f"no browser: {found['missing']}")
    return found
