"""The sources of a mechanism, compiled with a program that answers questions about it."""

import os
import re
import subprocess
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from derive.emit.c import package
from derive.emit.language import Part
from tests import outside
from tests.mechanisms import kinematics_of, named

COMPILER = os.environ.get("CC", "gcc")
STRICT = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-Wconversion")
SANITIZED = (
    "-O0",
    "-fsanitize=address,undefined,float-divide-by-zero,float-cast-overflow",
    "-fno-sanitize-recover=all",
)
DRIVER = Path(__file__).with_name("driver.c")


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


def compiled(part: Part, options: tuple[str, ...] = SANITIZED) -> Path:
    """The program of what is written. options: of the compiler."""
    return _linked(part, written(files_of(part)), options, _common(options))


def compiled_with_a_fault(part: Part, file: str, found: str, wrong: str, options: tuple[str, ...]) -> Path:
    """The same with a change of one place of one source, which must be there; the other source is as it was.

    file: the begin of the name of the source, or the name of a shared header; options: of the compiler.
    """
    texts = dict(files_of(part))
    path = next(path for path in texts if path == file or path.startswith(file) and path.endswith(".c"))
    changed = re.sub(found, wrong, texts[path])
    assert changed != texts[path], f"{path} does not hold {found}"
    folder = written(texts | {path: changed})
    calls, driver = _common(options)
    return _linked(part, folder, options, ("softkin.c" if path.startswith("softkin") else calls, driver))


def _linked(part: Part, folder: Path, options: tuple[str, ...], common: tuple[str, str]) -> Path:
    module = part["index"]["module"]
    tested = f"const softkin_mechanism *const tested = &{module}_mechanism;"
    (folder / "tested.c").write_text(f'#include "{module}.h"\nextern {tested.partition(" =")[0]};\n{tested}\n')
    compile_in(folder, *options, f"{module}.c", "tested.c", *common, "-lm", "-o", "driver")
    return folder / "driver"


@cache
def _common(options: tuple[str, ...]) -> tuple[str, str]:
    """The objects that all programs share: the calls, and the driver."""
    folder = written(package.files([]))
    compile_in(folder, *options, "-c", "softkin.c")
    compile_in(folder, *options, "-I.", "-c", str(DRIVER))
    return str(folder / "softkin.o"), str(folder / "driver.o")


def compile_in(folder: Path, *options: str) -> None:
    """Compile in a folder; every warning is an error. The environment's CC names another compiler, as clang."""
    assert not (said := refused_in(folder, *options)), said


def refused_in(folder: Path, *options: str) -> str:
    """What the compiler says where it refuses, else an empty text."""
    done = subprocess.run([COMPILER, *STRICT, *options], cwd=folder, capture_output=True, text=True, check=False)
    return done.stderr or "no word" if done.returncode else ""


def written(texts: Mapping[str, str]) -> Path:
    """A folder of files, which goes when the tests are over."""
    return outside.written(texts, outside.temporary("c"))


def files_of(part: Part) -> Mapping[str, str]:
    return package.files([part])
