"""Names that generated Structured Text may not declare, and the refusal of those that a description led to."""

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
    """Every list of the file: what its names are, the names in small letters, and prefixes of names."""
    data = tomllib.loads(_FILE.read_text(encoding="utf-8"))
    return {
        key: (d["meaning"], frozenset(d["names"].lower().split()), tuple(p.lower() for p in d.get("prefixes", ())))
        for key, d in data.items()
    }


def reserved() -> frozenset[str]:
    """Words of the language and macros, in small letters: no variable is spelled like one."""
    return _lists()["keywords"][1] | _lists()["macros"][1]


def clash(name: str) -> str | None:
    """What else a name means, or `None`."""
    small = name.lower()
    for meaning, names, prefixes in _lists().values():
        if small in names or small.startswith(prefixes):
            return meaning
    return None


def refuse_clashes(files: Mapping[str, Sequence[Object]]) -> None:
    """Raise `DescriptionError` for an object or a variable with a name that means something else, or that is taken."""
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
    """The object that declares, and the name. The names of methods are those of the contract."""
    for one in objects:
        yield one.name, one.name
        for part in one.parts():
            place = one.name if part is one else f"{one.name}.{part.name}"
            yield from ((place, name) for name in declaration_of(part.declaration).names())
