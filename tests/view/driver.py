"""One run of `drive.mjs` in one browser, for all tests; npm brings the driver, and a browser where there is none."""

import json
import shutil
from pathlib import Path
from typing import Any

from derive.view.node import MissingTool, installed, node, run

ROOT = Path(__file__).parents[2]
PACKAGES = ROOT / ".view-tests"
"""Where npm puts the driver and the browser, once."""
BROWSER = ROOT / "build" / "view" / "browser.txt"
"""Which browser ran, in one line, or that none could be had; the summary of a test run prints it."""
SCRIPTS = ("browser.mjs", "drive.mjs", "follow.mjs", "frame.mjs", "shown.mjs")


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
