"""The pages that the browser opens: the whole catalogue, and a machine of a user with a mesh of its own."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

from derive.cache import Cache, foundation
from derive.command.catalogue import OUTPUT
from derive.command.view import PACKAGES, content_of
from derive.emit.javascript import package as javascript
from derive.pipeline import work_of
from derive.view.page import page
from tests.mechanisms import catalogue
from tests.view.glb import triangle


def kept_modules() -> Mapping[str, bytes] | None:
    """The modules of the catalogue as `make generate` kept them; None where one of them has to be derived."""
    work = work_of(catalogue(), Cache(Path(f"{OUTPUT}.cache")), foundation(None))
    if work.missing:
        return None
    parts = [kept.parts[javascript.name] for kept in work.kept if kept is not None]
    return {name: text.encode() for name, text in javascript.files(parts).items()}


def catalogue_page(folder: Path, modules: Mapping[str, bytes]) -> Path:
    """The page of the catalogue."""
    files = {name: data for name, data in sorted(modules.items()) if name.endswith(".js")}
    path = folder / "softkin.html"
    path.write_text(page(content_of(catalogue(), files), PACKAGES), encoding="utf-8")
    return path


def own_page(folder: Path) -> Path:
    """The page of the machine that `softkin new` describes, as the command line makes it; A2 is a mesh in metres."""
    (folder / "own.glb").write_bytes(triangle())
    _run(folder, "new", "my_machine.py")
    _run(folder, "view", "my_machine.py", "--out", "pages", "--model", "A2=own.glb*1000")
    return folder / "pages" / "my_machine.html"


def _run(folder: Path, *arguments: str) -> None:
    command = [sys.executable, "-m", "derive", *arguments]
    environment = {"PYTHONPATH": str(OUTPUT.parent), "PATH": "", "HOME": str(folder)}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
