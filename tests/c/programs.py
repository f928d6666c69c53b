"""The sources of a mechanism, compiled with a program that answers questions about it."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from tempfile import mkdtemp

from derive.emit.c import package
from derive.emit.language import Part
from tests.mechanisms import kinematics_of, named

STRICT = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-Wconversion")
SANITIZED = (
    "-O1",
    "-fsanitize=address,undefined,float-divide-by-zero,float-cast-overflow",
    "-fno-sanitize-recover=all",
)
DRIVER = Path(__file__).with_name("driver.c")
Change = Callable[[str, str], str]


def _as_it_is(path: str, text: str) -> str:
    return text


@cache
def program_of(name: str) -> Path:
    """The program of a mechanism of the catalogue."""
    return compiled(part_of(name))


@cache
def part_of(name: str) -> Part:
    """What is written of a mechanism."""
    part = package.part(kinematics_of(named(name)))
    assert part is not None
    return part


def compiled(part: Part, change: Change = _as_it_is) -> Path:
    """The program of what is written. change: path and text of a file → its text."""
    folder = written(files_of(part), change)
    module = part["index"]["module"]
    tested = f'#include "{module}.h"\nextern const softkin_mechanism *const tested;\n'
    (folder / "tested.c").write_text(f"{tested}const softkin_mechanism *const tested = &{module}_mechanism;\n")
    is_common = change is _as_it_is
    common = _common() if is_common else (str(folder / "softkin.c"), str(_common()[1]))
    gcc(folder, *SANITIZED, f"{module}.c", "tested.c", *common, "-lm", "-o", "driver")
    return folder / "driver"


@cache
def _common() -> tuple[str, str]:
    """The objects that all programs share: the calls, and the driver."""
    folder = written(package.files([]))
    gcc(folder, *SANITIZED, "-c", "softkin.c")
    gcc(folder, *SANITIZED, "-I.", "-c", str(DRIVER))
    return str(folder / "softkin.o"), str(folder / "driver.o")


def gcc(folder: Path, *options: str) -> None:
    """Compile in a folder; every warning is an error."""
    done = subprocess.run(["gcc", *STRICT, *options], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def written(texts: Mapping[str, str], change: Change = _as_it_is) -> Path:
    """A folder of files."""
    folder = Path(mkdtemp(prefix="c-"))
    _FOLDERS.append(folder)
    for path, text in texts.items():
        (folder / path).write_text(change(path, text), encoding="utf-8")
    return folder


def planted(file: str, found: str, wrong: str) -> Change:
    """The change of one place of one file, which must be there."""

    def change(path: str, text: str) -> str:
        if not path.startswith(file) or not path.endswith(".c"):
            return text
        changed = re.sub(found, wrong, text)
        assert changed != text, f"{path} does not hold {found}"
        return changed

    return change


def files_of(part: Part) -> Mapping[str, str]:
    """All files of one machine."""
    return package.files([part])


_FOLDERS: list[Path] = []


def remove() -> None:
    """Remove all folders."""
    while _FOLDERS:
        shutil.rmtree(_FOLDERS.pop(), ignore_errors=True)
