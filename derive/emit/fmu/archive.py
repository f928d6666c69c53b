"""An FMU as one file: description, sources, and the compiled library, if there is a compiler."""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from derive.faults import GenerationError

FLAGS = ("-std=c99", "-O2", "-Wall", "-Wextra", "-fPIC", "-shared", "-ffp-contract=off", "-fvisibility=hidden")
_SYSTEMS = {"linux": ("linux", ".so"), "darwin": ("darwin", ".dylib"), "win32": ("windows", ".dll")}
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
    with TemporaryDirectory() as folder:
        sources = [path for path in texts if path.endswith((".c", ".h"))]
        for path in sources:
            place = Path(folder, path)
            place.parent.mkdir(exist_ok=True)
            place.write_text(texts[path], encoding="utf-8")
        library = Path(folder, f"{module}{end}")
        command = [compiler, *FLAGS, "-o", str(library), *(p for p in sorted(sources) if p.endswith(".c")), "-lm"]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            first = (done.stderr.strip().splitlines() or ["it said nothing"])[0]
            raise GenerationError(f"{module}.fmu: {compiler} does not compile its sources: {first}")
        return {f"binaries/{machine}-{system}/{library.name}": library.read_bytes()}
