"""The files that a file needs: those with the objects that its code names, and the files that those need."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from derive.emit.plcopen.objects import Object
from derive.kept import kept_by_identity

_SILENT = re.compile(r"\(\*.*?\*\)|//[^\n]*|'[^'\n]*'", re.DOTALL)
_WORD = re.compile(r"[A-Za-z_]\w*")


def needed(path: str, files: Mapping[str, Sequence[Object]]) -> tuple[str, ...]:
    """The paths of a file and of all files that it uses, directly or indirectly, sorted."""
    homes = {one.name: home for home, objects in files.items() for one in objects}
    found: set[str] = set()
    open_paths = [path]
    while open_paths:
        current = open_paths.pop()
        if current not in found:
            found.add(current)
            open_paths += sorted({homes[word] for word in _words(files[current]) if word in homes})
    return tuple(sorted(found))


@kept_by_identity(1000)
def _words(objects: Sequence[Object]) -> set[str]:
    """The words of the code, except those in comments and strings."""
    texts = [text for one in objects for part in one.parts() for text in (part.declaration, part.implementation)]
    return {word for text in texts for word in _WORD.findall(_SILENT.sub("", text))}
