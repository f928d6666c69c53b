"""The modules of a mechanism, written into a folder for this run."""

from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path

from derive.emit.javascript import package
from derive.emit.language import Part
from tests import outside
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
    texts = {path: change(path, text) for path, text in files_of(part).items()}
    return outside.written(texts, outside.temporary("javascript")) / f"{part['index']['module']}.js"


def files_of(part: Part) -> Mapping[str, str]:
    return package.files([part])
