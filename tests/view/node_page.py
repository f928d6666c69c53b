"""The parts of the page that need no browser, beside the modules of a machine: `model.mjs` asks them."""

import shutil
from pathlib import Path

from derive.emit.language import RUNTIME, Part
from tests.javascript.modules import written

ASKED = Path(__file__).with_name("model.mjs")


def page_module(part: Part) -> Path:
    """The module that asks the page of one machine."""
    machines = written(part).parent
    folder = machines / "page"
    shutil.copytree(RUNTIME / "view", folder, ignore=shutil.ignore_patterns("package*"))
    (folder / "machines").symlink_to(machines, target_is_directory=True)
    (folder / "package.json").write_text('{"type": "module"}', encoding="utf-8")
    return Path(shutil.copy(ASKED, folder))
