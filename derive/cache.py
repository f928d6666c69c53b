"""The results of earlier runs, kept by the content of everything on which they depend.

A key is a hash of the compiler's sources, templates and runtime, of the interpreter, the platform and every library
with its version, of the profile, and of a description: its text, and the mechanism to which the text evaluates,
whatever it imports. An entry is used only if its own hash is right, which covers its key and all of its bytes;
otherwise the mechanism is derived anew.
"""

from __future__ import annotations

import contextlib
import json
import os
import platform
import re
import sys
import tempfile
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache
from hashlib import sha256
from importlib import metadata
from pathlib import Path
from typing import Any

import sympy as sp

from derive.description.catalogue import MECHANISMS, Entry
from derive.emit.language import RUNTIME, TEMPLATES, files_in

ROOT = MECHANISMS.parents[1]
_KEPT = 400
"""The number of entries that are kept: those used last."""
_FORMAT = "softkin cache 1"


class Cache:
    """A folder of entries: plain data (what JSON holds) by key."""

    def __init__(self, folder: Path, *, fresh: bool = False) -> None:
        """The folder is created with the first entry. fresh: it finds nothing, and keeps what is written."""
        self.folder = folder
        self.fresh = fresh
        self.damaged: list[Path] = []
        """Entries that were found but had a wrong hash."""

    def read(self, key: str) -> Any | None:
        """The entry under a key; None if there is none, or only a damaged one."""
        path = self._path(key)
        if self.fresh:
            return None
        try:
            head, _, content = path.read_bytes().partition(b"\n")
        except OSError:
            return None
        if head != _seal(key, content):
            self.damaged.append(path)
            return None
        with contextlib.suppress(OSError):
            os.utime(path)
        return json.loads(content)

    def write(self, key: str, data: object) -> None:
        """Write plain data under a key; an entry is never half-written."""
        content = json.dumps(data).encode()
        self.folder.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=self.folder)
        with os.fdopen(handle, "wb") as file:
            file.write(_seal(key, content) + b"\n" + content)
        Path(name).replace(self._path(key))

    def tidy(self) -> None:
        """Remove the entries that were not used for longest, unless another process is just writing one."""
        with contextlib.suppress(FileNotFoundError):
            entries = sorted(self.folder.iterdir(), key=lambda path: path.stat().st_mtime)
            for path in entries[:-_KEPT]:
                path.unlink(missing_ok=True)

    def _path(self, key: str) -> Path:
        return self.folder / key


def key_of(*parts: str) -> str:
    """The key of parts in their order."""
    return sha256("".join(f"{len(part)}:{part}" for part in parts).encode()).hexdigest()


def entry_key(foundation: str, entry: Entry) -> str | None:
    """The key of one mechanism; None if its description holds an object that has no text."""
    path, mechanism = entry
    try:
        return key_of("mechanism", foundation, path.read_text(encoding="utf-8"), canonical(mechanism))
    except TypeError:
        return None


def foundation(profile: str | None, root: Path = ROOT) -> str:
    """The hash of everything that all mechanisms depend on: sources, templates, runtime, libraries, interpreter,
    platform, profile.
    """
    found = sha256(key_of(_FORMAT, sys.version, platform.platform(), repr(profile), *_libraries()).encode())
    for path in sorted(_sources(root)):
        found.update(key_of(str(path.relative_to(root)), sha256(path.read_bytes()).hexdigest()).encode())
    return found.hexdigest()


def canonical(value: object) -> str:
    """A text that is the same for two values only if they are equal in every part. Raises `TypeError` for an object
    without such a text.
    """
    if isinstance(value, sp.Basic | sp.MatrixBase):
        return str(sp.srepr(value))
    if isinstance(value, Enum) or value is None or isinstance(value, str | bool | int | float):
        return repr(value)
    if is_dataclass(value) and not isinstance(value, type):
        parts = ((f.name, canonical(getattr(value, f.name))) for f in fields(value))
        return f"{type(value).__qualname__}({', '.join(f'{name}={text}' for name, text in parts)})"
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{canonical(k)}: {canonical(v)}' for k, v in value.items())}}}"
    if isinstance(value, tuple | list):
        return f"({', '.join(map(canonical, value))})"
    raise TypeError(f"{type(value).__name__} has no canonical text")


def _sources(root: Path) -> Iterator[Path]:
    """The files of the compiler without its catalogue: each description has its own key."""
    for path in (root / "derive").rglob("*.py"):
        if path.parent != root / "derive" / "mechanisms" or path.name.startswith("_"):
            yield path
    for folder in (root / each.relative_to(ROOT) for each in (TEMPLATES, RUNTIME)):  # the viewer reads generated files
        yield from (path for path in files_in(folder) if folder / "view" not in path.parents)
    yield from root.glob("pyproject.toml")


@cache
def _libraries() -> tuple[str, ...]:
    """Every library that the compiler is built on, directly or not, with its version."""
    found: dict[str, str] = {}
    open_names = list(_required(_own_requirements()))
    while open_names:
        name = open_names.pop()
        if name not in found:
            try:
                found[name] = metadata.version(name)
            except metadata.PackageNotFoundError:
                found[name] = "none"  # for another platform
                continue
            open_names += _required(metadata.requires(name) or ())
    return tuple(f"{name} {found[name]}" for name in sorted(found))


def _own_requirements() -> Iterable[str]:
    """The requirements of the compiler: from the project file of a source tree, or from the metadata of a wheel."""
    project = ROOT / "pyproject.toml"
    if project.is_file():
        return list(tomllib.loads(project.read_text(encoding="utf-8"))["project"]["dependencies"])
    return metadata.requires("softkin-compiler") or ()


def _required(requirements: Iterable[str]) -> Iterator[str]:
    """The names of requirements, without those of extras."""
    for text in requirements:
        if not re.search(r";.*\bextra\b", text):
            yield re.split(r"[^A-Za-z0-9._-]", text, maxsplit=1)[0].lower()


def _seal(key: str, content: bytes) -> bytes:
    return sha256(key.encode() + b"\n" + content).hexdigest().encode()
