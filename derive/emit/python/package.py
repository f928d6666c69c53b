"""Python: the package `softkin`, which has a runtime and one module for each mechanism."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from derive.emit import native
from derive.emit.language import Part, runtime
from derive.emit.python import package as python
from derive.emit.python.entries import inputs
from derive.emit.python.layout import formatted
from derive.emit.python.mechanism_modules import in_order, index, modules
from derive.emit.python.runtime import NAME, templates
from derive.kinematics.kinematics import Kinematics

name, title, bound = NAME, "Python", ""
PACKAGE = "softkin"
"""The package of the catalogue."""
_ARRANGED = (
    "README.md",
    "pyproject.toml",
    "setup.py",
    "softkin/__init__.py",
    "softkin/_array_rotation.py",
    "softkin/_constants.py",
    "softkin/_rotation.py",
)
"""The files that the compiler writes; all others are the runtime as it stands."""
_EXPORTS = (
    "Axis", "Calibrated", "Calibration", "Configuration", "ConfigurationByte", "Coupled", "Diagnosis", "Frame",
    "FrameLike", "KinematicsError", "Mechanism", "Mounted", "OrientationImage", "Parameter", "Rotation", "Singularity",
    "Solution", "Status", "__version__", "calibrate", "catalogue", "core", "load", "orthonormalize", "propose",
)  # fmt: skip


def part(kinematics: Kinematics) -> Part:
    """The files of one mechanism, and its entries in the lists."""
    found = {"index": index(kinematics), "files": modules(kinematics) | native.sources(kinematics)}
    given = inputs(kinematics)
    return {**found, "notes": list(given.notes), "inputs": dict(given.names)}


def drawing(part: Part) -> str:
    """The file of the drawing of a mechanism, which a notebook shows."""
    return f"{PACKAGE}/_pictures/{part['index']['name']}.svg"


def files(parts: Sequence[Part]) -> dict[str, str]:
    """All files of the package: path → text."""
    return formatted(texts(parts, PACKAGE))


def texts(parts: Sequence[Part], package: str) -> dict[str, str]:
    """All files before their layout, for a package of any name; modules import each other from `softkin`."""
    listed = [part["index"] for part in parts]
    listed.sort(key=lambda entry: entry["module"])
    exports = in_order({*_EXPORTS, *(entry["class_name"] for entry in listed)})
    known = {
        "package": package,
        "index": listed,
        "exports": exports,
        "extension": native.extension(package),
        "sources": native.digest_of_shared(),
    }
    files = {path: templates().get_template(f"{path}.j2").render(known) for path in _ARRANGED}
    files |= runtime(NAME)
    for part in parts:
        files |= part["files"]
    return files | native.shared(listed, package)


_IMPORT = re.compile(rf"^( *(?:from|import) ){python.PACKAGE}\b", re.MULTILINE)
"""The lines inside the package that name it."""


@dataclass(frozen=True)
class NamedPackage:
    """The language Python, in a package with a name of its own."""

    package: str
    name: ClassVar[str] = python.name
    title: ClassVar[str] = python.title
    bound: ClassVar[str] = python.bound

    def part(self, kinematics: Kinematics) -> Part:
        """The files of one mechanism, and its entries in the lists."""
        return python.part(kinematics)

    def drawing(self, part: Part) -> str:
        """The file of the drawing of a mechanism."""
        return self._path(python.drawing(part))

    def files(self, parts: Sequence[Part]) -> dict[str, str]:
        """All files of the package: path → text."""
        found = python.texts(parts, self.package)
        return formatted({self._path(path): self._text(path, text) for path, text in found.items()})

    def _path(self, path: str) -> str:
        folder, slash, rest = path.partition("/")
        return f"{self.package}/{rest}" if slash and folder == python.PACKAGE else path

    def _text(self, path: str, text: str) -> str:
        return _IMPORT.sub(rf"\g<1>{self.package}", text) if path.endswith(".py") else text
