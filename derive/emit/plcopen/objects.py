"""The objects of a text as CODESYS holds them: each has a declaration and an implementation, and a block has members.

All output forms are made of one text: the `.st` files show these objects with a ruler above every part; PLCopenXML and
the import script hold the same parts.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from derive.kept import kept_by_identity

_OPENING = re.compile(
    r"(FUNCTION_BLOCK|FUNCTION|PROGRAM|INTERFACE|TYPE|VAR_GLOBAL|METHOD|PROPERTY|GET)\b"
    r"(?: PUBLIC| PRIVATE| PROTECTED| CONSTANT)? *(\w*)"
)
_HOLDERS = ("FUNCTION_BLOCK", "PROGRAM", "INTERFACE", "PROPERTY")
_WHOLE = {"TYPE": "END_TYPE", "VAR_GLOBAL": "END_VAR"}
"""The objects that are a declaration alone, with the line that ends it."""
_RULER_WIDTH = 110
_BESIDE = "  // ===="
"""The ruler beside a line that one does not paste."""


@dataclass(frozen=True)
class Object:
    """An object or a member of an object: a method, a property, or the getter of a property (named Get)."""

    kind: str
    name: str
    declaration: str
    implementation: str
    members: tuple[Object, ...] = ()

    def parts(self) -> Iterator[Object]:
        """The object and its members, each followed by its own members."""
        yield self
        for member in self.members:
            yield from member.parts()


def objects_of(text: str, list_name: str = "") -> tuple[Object, ...]:
    """The objects of a text in their order. A list of global constants has no name in its text: it gets the one given.

    Raises `ValueError` for an object without an end, and for text outside of all objects.
    """
    return tuple(_Reader(text, list_name).objects())


def as_text(objects: Sequence[Object]) -> str:
    """The objects as text, with a ruler above every part that has its own editor in CODESYS."""
    return "\n\n".join("\n".join(_lines(one, one.name)) for one in objects) + "\n"


class _Reader:
    def __init__(self, text: str, list_name: str) -> None:
        self._lines = iter(text.split("\n"))
        self._list_name = list_name

    def objects(self) -> Iterator[Object]:
        own: list[str] = []
        is_comment = False
        for line in self._lines:
            own.append(line)
            if not is_comment and _OPENING.match(line):
                yield self._object(own)
                own = []
            elif not is_comment and line and not line.startswith(("//", "(*", "{")):
                raise ValueError(f"{line!r} stands in no object")
            is_comment = "*)" not in line and (is_comment or line.startswith("(*"))

    def _object(self, own: list[str]) -> Object:
        """The object that the last of these lines opens; the lines above it are its comment and its pragmas."""
        opening = own[-1]
        kind, name = _opened(opening)
        end = _WHOLE.get(kind, f"END_{kind}")
        if kind == "VAR_GLOBAL" and not self._list_name:
            raise ValueError(f"{opening!r} stands in no object that has a name")
        members: list[Object] = []
        for line in self._lines:
            if line == end:
                return _made(kind, name or self._list_name, [*own, line] if kind in _WHOLE else own, members)
            own.append(line)
            if kind in _HOLDERS and _OPENING.match(line):
                lead = _lead(own)
                del own[len(own) - len(lead) :]
                members.append(self._object(lead))
        raise ValueError(f"{opening!r} has no {end}")


def _opened(line: str) -> tuple[str, str]:
    found = _OPENING.match(line)
    assert found is not None
    return found.group(1), found.group(2) or ("Get" if found.group(1) == "GET" else "")


def _lead(lines: Sequence[str]) -> list[str]:
    """The last line, which opens a member, with the comments and pragmas directly above it."""
    start = len(lines) - 1
    while start > 0 and lines[start - 1].startswith(("//", "{")):
        start -= 1
    return list(lines[start:])


def _made(kind: str, name: str, lines: Sequence[str], members: Sequence[Object]) -> Object:
    """The object of these lines. Its declaration ends with the last section of variables, or with its head."""
    last = max(at for at, line in enumerate(lines) if line in ("END_VAR", "END_TYPE") or _OPENING.match(line))
    start = 1 if kind == "GET" else 0
    declaration = "\n".join(lines[start : last + 1]).strip("\n")
    return Object(kind, name, declaration, "\n".join(lines[last + 1 :]).strip("\n"), tuple(members))


def _lines(one: Object, path: str) -> Iterator[str]:
    """Rulers and parts. A ruler without a name stands beside what one does not paste: GET and the closing lines."""
    if one.declaration:
        yield _ruler(f" {one.kind} {path}: declaration ")
        yield one.declaration
    for member in one.members:
        # The ruler of a getter has the name of the property.
        yield from (
            ("GET" + _BESIDE, *_lines(member, path))
            if member.kind == "GET"
            else ("", *_lines(member, f"{path}.{member.name}"))
        )
    if one.implementation:
        yield _ruler(f" {one.kind} {path}: implementation ")
        yield one.implementation
    closing = "" if one.kind in _WHOLE else f"END_{one.kind}"
    is_part = bool(one.implementation) or not one.members
    yield from () if not closing and not is_part else (_closed(closing, is_part),)


def _closed(closing: str, is_part: bool) -> str:
    """A closing line, with the ruler that ends the part above it."""
    return closing + _BESIDE if closing and is_part else closing or _ruler()


def _ruler(title: str = "") -> str:
    return f"// ===={title}".ljust(_RULER_WIDTH, "=")


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


def uses(objects: Sequence[Object], names: frozenset[str]) -> bool:
    """Whether the code of some objects has one of these names."""
    return not names.isdisjoint(_words(objects))


@kept_by_identity(1000)
def _words(objects: Sequence[Object]) -> set[str]:
    """The words of the code, except those in comments and strings."""
    texts = [text for one in objects for part in one.parts() for text in (part.declaration, part.implementation)]
    return {word for text in texts for word in _WORD.findall(_SILENT.sub("", text))}
