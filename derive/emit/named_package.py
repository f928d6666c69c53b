"""The package under another name: a machine of the user's own stands beside an installed `softkin`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from derive.emit.language import Part
from derive.emit.python import package as python
from derive.emit.python.layout import formatted
from derive.kinematics.kinematics import Kinematics

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
