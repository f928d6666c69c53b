"""Names that generated Structured Text may not declare; a description that leads to one of them is refused."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import lru_cache

from derive.description.mechanism import DescriptionError
from derive.emit.language import TEMPLATES
from derive.emit.plcopen.declaration import declaration_of
from derive.emit.plcopen.objects import Object

_FILE = TEMPLATES / "st" / "reserved.toml"
_REMEDY = "choose another name for the mechanism, parameter, joint or branch that it is made of"


@lru_cache
def _lists() -> dict[str, tuple[str, frozenset[str], tuple[str, ...]]]:
    """The lists of the file: the meaning of the names of a list, the names in small letters, and prefixes of names."""
    data = tomllib.loads(_FILE.read_text(encoding="utf-8"))
    return {
        key: (d["meaning"], frozenset(d["names"].lower().split()), tuple(p.lower() for p in d.get("prefixes", ())))
        for key, d in data.items()
    }


def reserved() -> frozenset[str]:
    """The words of the language and the macros, in small letters: no variable has such a name."""
    return _lists()["keywords"][1] | _lists()["macros"][1]


def clash(name: str) -> str | None:
    """The other meaning of a name, or `None`."""
    small = name.lower()
    for meaning, names, prefixes in _lists().values():
        if small in names or small.startswith(prefixes):
            return meaning
    return None


def refuse_clashes(files: Mapping[str, Sequence[Object]]) -> None:
    """Raise `DescriptionError` for an object or a variable whose name has another meaning, or is taken."""
    owners: dict[str, str] = {}
    for file, objects in files.items():
        for one in objects:
            first = owners.setdefault(one.name.lower(), file)
            if first != file:
                raise DescriptionError(f"{file}: the name {one.name} is taken by {first}: {_REMEDY}")
    for file, objects in files.items():
        for place, name in _declared(objects):
            meaning = clash(name) or ("an object of its own" if name.lower() in owners and place != name else None)
            if meaning is not None:
                raise DescriptionError(f"{file}: {place} declares {name}, which is {meaning}: {_REMEDY}")


def _declared(objects: Iterable[Object]) -> Iterator[tuple[str, str]]:
    """Pairs of the declaring object and the declared name, except the names of methods, which the contract gives."""
    for one in objects:
        yield one.name, one.name
        for part in one.parts():
            place = one.name if part is one else f"{one.name}.{part.name}"
            yield from ((place, name) for name in declaration_of(part.declaration).names())
