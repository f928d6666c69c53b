"""An FMU as one file: description, sources, and the compiled library, if there is a compiler."""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from functools import cache
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from derive.faults import GenerationError

FLAGS = ("-std=c99", "-O2", "-Wall", "-Wextra", "-fPIC", "-ffp-contract=off", "-fvisibility=hidden")
_SYSTEMS = {"linux": ("linux", ".so"), "darwin": ("darwin", ".dylib"), "win32": ("windows", ".dll")}
_CORE = ("softkin.c", "softkin.h", "softkin_constants.h", "softkin_rotation.h")
_DATE = (1980, 1, 1, 0, 0, 0)
"""The same for every file: the same machine is the same archive."""


def archive(module: str, texts: Mapping[str, str]) -> bytes:
    """The archive of the texts of a machine. Raises `GenerationError` if the compiler refuses the sources."""
    files = {path: text.encode() for path, text in texts.items()} | _library(module, texts)
    stream = BytesIO()
    with ZipFile(stream, "w", ZIP_DEFLATED) as made:
        for path in sorted(files):
            made.writestr(ZipInfo(path, _DATE), files[path], ZIP_DEFLATED)
    return stream.getvalue()


def _library(module: str, texts: Mapping[str, str]) -> dict[str, bytes]:
    """The library at its path; nothing without a compiler: then whoever imports the FMU compiles its sources."""
    compiler = shutil.which(os.environ.get("CC") or "cc") or shutil.which("gcc")
    if compiler is None or sys.platform not in _SYSTEMS:
        return {}
    system, end = _SYSTEMS[sys.platform]
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(platform.machine().lower(), platform.machine().lower())
    sources = {path: text for path, text in texts.items() if path.endswith((".c", ".h"))}
    core = tuple((path, text) for path, text in sources.items() if Path(path).name in _CORE)
    own = {path: text for path, text in sources.items() if path.endswith(".h") or (path, text) not in core}
    try:
        library = _compiled((compiler, *FLAGS, "-shared"), own, _core((compiler, *FLAGS, "-c"), core))
    except GenerationError as refused:
        raise GenerationError(f"{module}.fmu: {refused}") from None
    return {f"binaries/{machine}-{system}/{module}{end}": library}


@cache
def _core(command: tuple[str, ...], sources: tuple[tuple[str, str], ...]) -> bytes:
    """The object of what all machines share: it is compiled once for all that are written."""
    return _compiled(command, dict(sources))


def _compiled(command: Sequence[str], sources: Mapping[str, str], core: bytes | None = None) -> bytes:
    """What a compiler makes of sources, and of the object of the core if there is one."""
    with TemporaryDirectory() as folder:
        for path, text in sources.items():
            Path(folder, path).parent.mkdir(exist_ok=True)
            Path(folder, path).write_text(text, encoding="utf-8")
        parts = [path for path in sorted(sources) if path.endswith(".c")]
        if core is not None:
            Path(folder, "core.o").write_bytes(core)
            parts += ["core.o", "-lm"]
        done = subprocess.run([*command, "-o", "made", *parts], cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            first = (done.stderr.strip().splitlines() or ["it said nothing"])[0]
            raise GenerationError(f"{command[0]} does not compile its sources: {first}")
        return Path(folder, "made").read_bytes()
