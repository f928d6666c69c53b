"""The native core of the Python package: the C of its machines, and what joins it with their classes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from hashlib import sha256
from typing import Any

from jinja2 import Environment

from derive.emit.c import package as c
from derive.emit.c.layout import page
from derive.emit.language import GENERATED, environment
from derive.kinematics.kinematics import Kinematics

FOLDER = "native"
"""Beside the package: what stands here is compiled, and never imported."""
_SHARED = ("batches.c", "batches.h", "machine.c")
_DIGITS = 16


def key(kin: Kinematics) -> str:
    """What a class and its C have in common: the module with a digest of the C. Empty where there is none."""
    found = c.part(kin)
    return "" if found is None else f"{found['index']['module']} {_digest(found['files'])}"


def sources(kin: Kinematics) -> dict[str, str]:
    """Header and source of the machine: path → text."""
    found = c.part(kin)
    return {} if found is None else {f"{FOLDER}/{path}": text for path, text in found["files"].items()}


def extension(package: str) -> str:
    """The name of the extension: it stands beside the package, so that it can be built anywhere."""
    return f"_{package}_native"


def shared(listed: Sequence[Mapping[str, Any]], package: str) -> dict[str, str]:
    """The files of the core that hold no machine. listed: what the lists of the package say of each machine."""
    known = {
        "extension": extension(package),
        "sources": digest_of_shared(),
        "keys": [(entry["key"], entry["key"].split()[0]) for entry in listed if entry["key"]],
    }
    found = {f"{FOLDER}/{path}": text for path, text in c.shared().items()}
    for path in (*_SHARED, "machines.c", "machines.h"):
        found[f"{FOLDER}/{path}"] = page(_templates().get_template(f"{path}.j2").render(known))
    return found


def digest_of_shared() -> str:
    """The digest of what all machines share in C: structures, calls, and the object of Python."""
    own = {path: _templates().get_template(f"{path}.j2").render() for path in _SHARED}
    return _digest({**c.shared(), **own})


@cache
def _templates() -> Environment:
    found = environment(FOLDER)
    found.globals |= {"generated": GENERATED}
    return found


def _digest(files: Mapping[str, str]) -> str:
    text = "\0".join(part for path in sorted(files) for part in (path, files[path]))
    return sha256(text.encode()).hexdigest()[:_DIGITS]
