"""The modules of a mechanism, written into a folder for this run."""

import atexit
import shutil
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from tempfile import mkdtemp

from derive.emit.javascript import package
from derive.emit.language import Part
from tests.mechanisms import kinematics_of, named


@cache
def module_of(name: str) -> Path:
    """The module of a mechanism of the catalogue."""
    return written(part_of(name))


@cache
def part_of(name: str) -> Part:
    """What is written of a mechanism."""
    return package.part(kinematics_of(named(name)))


def written(part: Part, change: Callable[[str, str], str] = lambda path, text: text) -> Path:
    """The module of what is written. change: path and text of a file → its text."""
    folder = Path(mkdtemp(prefix="javascript-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    for path, text in files_of(part).items():
        (folder / path).parent.mkdir(exist_ok=True)
        (folder / path).write_text(change(path, text), encoding="utf-8")
    return folder / f"{part['index']['module']}.js"


def files_of(part: Part) -> Mapping[str, str]:
    """All files of one machine."""
    return package.files([part])
