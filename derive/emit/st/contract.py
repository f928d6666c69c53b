"""The SoftMotion contract, read from its data file: interfaces, signatures and spellings."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import groupby
from pathlib import Path
from typing import Any

from derive.emit.language import TEMPLATES

_FILE = TEMPLATES / "st" / "softmotion.toml"
_SCOPE = re.compile(r"(VAR\w*(?: CONSTANT)?) ")


@dataclass(frozen=True)
class Parameter:
    """A parameter of a method, in the order of its declaration."""

    scope: str
    name: str
    type: str


@dataclass(frozen=True)
class Signature:
    """A method: its name, what it returns ("" for nothing) and its parameters."""

    name: str
    returns: str
    parameters: tuple[Parameter, ...]
    access: str = "PUBLIC"
    """Empty in an interface, whose methods are public without a word."""

    def head(self) -> str:
        """The declaration of the method, without its local variables."""
        returns = f" : {self.returns}" if self.returns else ""
        lines = [f"{' '.join(filter(None, ('METHOD', self.access, self.name)))}{returns}"]
        for scope, parameters in groupby(self.parameters, key=lambda p: p.scope):
            lines += [scope, *(f"  {p.name} : {p.type};" for p in parameters), "END_VAR"]
        return "\n".join(lines)


@dataclass(frozen=True)
class Interface:
    """An interface: those that it extends, and the methods that it adds."""

    name: str
    since: tuple[int, ...]
    """The version of the oldest library whose documentation lists the interface."""
    extends: tuple[str, ...]
    properties: Mapping[str, str]
    methods: Mapping[str, Signature]


@dataclass(frozen=True)
class Constant:
    """A global constant that stands for an enumerator of a library."""

    name: str
    type: str
    value: str
    meaning: str
    """The meaning of the enumerator, with a remark where no document names it."""


@dataclass(frozen=True)
class Group:
    """Constants of one type, under a title."""

    title: str
    constants: tuple[Constant, ...]


@dataclass(frozen=True)
class Contract:
    """Everything that is known of SoftMotion."""

    interfaces: Mapping[str, Interface]
    own: Mapping[str, Signature]
    """The methods of the interface of our own."""
    supplied: Mapping[str, Signature]
    """The protected methods that every geometry supplies to the base block."""
    supplied_for: Mapping[str, frozenset[str]]
    """The supplied methods that only a block with one of certain public methods needs, each with these."""
    supplied_turning: frozenset[str]
    """The supplied and overridable methods that only a block with a turning flange needs."""
    overridable: Mapping[str, Signature]
    """The protected methods of the base block that a geometry overrides where they are not right for it."""
    overridable_for: Mapping[str, frozenset[str]]
    """The overridable methods that only a block with one of certain public methods may override, each with these."""
    offered: Mapping[str, Signature]
    """The protected methods of the base block that those of a geometry call."""
    private: Mapping[str, Signature]
    """The private methods of the base block."""
    is_flat: bool
    """Whether every block has the variables and methods of the base block itself, and extends none."""
    omits: frozenset[str]
    transformations: tuple[str, ...]
    """Of a controller without SoftMotion: the interface of a machine with three axes and no turn, and of others."""
    names: tuple[Group, ...]
    """The list of global constants."""
    spelling: Mapping[str, Mapping[str, Any]]
    """The other tables of the file: types, functions and others. In those of errors and enumerators each is spelled as
    the constant of the list that stands for it."""

    @property
    def own_interface(self) -> str | None:
        """The name of the interface of our own; None if the profile leaves it out."""
        name: str = self.spelling["own_interface"]["name"]
        return None if name in self.omits else name

    @property
    def signatures(self) -> dict[str, Signature]:
        """Every method by name."""
        found = {**self.own, **self.supplied, **self.overridable, **self.offered}
        for interface in self.interfaces.values():
            found.update(interface.methods)
        return found

    def available(self, name: str) -> str | None:
        """The interface or, where the profile lacks it, the nearest predecessor that the profile has. None for a
        controller without SoftMotion.
        """
        if self.transformations:
            return None
        if name not in self.omits:
            return name
        bases = [self.available(base) for base in self.interfaces[name].extends]
        return next((b for b in bases if b is not None and b != "MC_KIN_REF_SM3"), None)

    def closure(self, names: Sequence[str]) -> Iterator[Interface]:
        """The interfaces of these names and all they extend."""
        for name in names:
            yield self.interfaces[name]
            yield from self.closure(self.interfaces[name].extends)


def load(profile: str | None = None, file: Path = _FILE) -> Contract:
    """The contract for a profile, for that which the file names as its default if `None`.

    profile: names of profiles, joined by `+`: the oldest of their libraries, and what any of them leaves out.

    Raises `ValueError` for a profile that the file does not have.
    """
    return _loaded(profile, file.read_text(encoding="utf-8"))


@cache
def _loaded(profile: str | None, text: str) -> Contract:
    data = tomllib.loads(text)
    chosen = _chosen(profile or data["profile"], data["profiles"])
    for one in chosen:
        data = _merged(data, one.get("tables", {}))
    types: Mapping[str, str] = data["types"]
    interfaces = {key: _interface(key, table, types) for key, table in data.pop("interfaces").items()}
    newest = min(_version(one["library"]) for one in chosen)
    newer = {interface.name for interface in interfaces.values() if interface.since > newest}
    omits = frozenset(newer).union(*(one["omits"] for one in chosen))
    omits |= {name for one in chosen if "keeps" in one for name in (*interfaces, data["own_interface"]["name"])
              if name not in one["keeps"]}  # fmt: skip
    tables = data.pop("names")
    listed = tables.pop("list")
    own = {key for one in chosen for key in one.get("tables", {}).get("types", {})}
    groups = {key: _constants(table, types, own) for key, table in tables.items()}
    data |= {key: {k: f"{listed}.{c.name}" for k, c in inside.items()} for key, inside in groups.items()}
    supplied, overridable = data.pop("supplied"), data.pop("overridable")
    names = tuple(Group(tables[key]["title"], tuple(inside.values())) for key, inside in groups.items())
    return Contract(
        interfaces,
        _signatures(data.pop("own"), types),
        _signatures(supplied, types, "PROTECTED"),
        _needing(supplied),
        frozenset(key for key, table in (supplied | overridable).items() if "turning" in table),
        _signatures(overridable, types, "PROTECTED"),
        _needing(overridable),
        _signatures(data.pop("offered"), types, "PROTECTED"),
        _signatures(data.pop("private"), types, "PRIVATE"),
        any(one.get("flat", False) for one in chosen),
        omits,
        tuple(name for one in chosen for name in one.get("transformations", ())),
        names,
        data,
    )


def _chosen(names: str, profiles: Mapping[str, Mapping[str, Any]]) -> tuple[Mapping[str, Any], ...]:
    for name in names.split("+"):
        if name not in profiles:
            raise ValueError(f"no profile is called {name!r}; there are {', '.join(profiles)}")
    return tuple(profiles[name] for name in names.split("+"))


def _merged(table: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """The table with entries of another one, tables inside it alike."""
    given = {k: _merged(table.get(k, {}), new) if isinstance(new, dict) else new for k, new in changes.items()}
    return {**table, **given}


def _needing(methods: Mapping[str, Mapping[str, Any]]) -> dict[str, frozenset[str]]:
    return {key: frozenset(table["of"]) for key, table in methods.items() if "of" in table}


def _constants(table: Mapping[str, Any], types: Mapping[str, str], own: Collection[str]) -> dict[str, Constant]:
    """The constants of a group by the name under which templates know them. own: types that a profile brings along, and
    whose enumerators these are.
    """
    stated = table["type"]
    kind = types.get(stated, stated)
    entries = {key: entry for key, entry in table.items() if key not in ("title", "type")}
    return {
        key: Constant(
            entry["name"],
            kind,
            entry["value"] if kind == "BOOL" else f"{kind}.{entry['name' if stated in own else 'value']}",
            entry["meaning"]
            + ("" if entry.get("documented", True) else "; not documented")
            + (f": if missing, {entry['instead']}" if "instead" in entry else ""),
        )
        for key, entry in entries.items()
    }


def _interface(name: str, table: Mapping[str, Any], types: Mapping[str, str]) -> Interface:
    methods = _signatures(table.get("methods", {}), types)
    return Interface(name, _version(table["since"]), tuple(table["extends"]), table.get("properties", {}), methods)


def _version(text: str) -> tuple[int, ...]:
    return tuple(map(int, text.split(".")))


def _signatures(methods: Mapping[str, Any], types: Mapping[str, str], access: str = "PUBLIC") -> dict[str, Signature]:
    stated = {name: m if isinstance(m, list) else m["signature"] for name, m in methods.items()}
    return {name: _signature(name, one, types, access) for name, one in stated.items()}


def _signature(name: str, stated: Sequence[str], types: Mapping[str, str], access: str) -> Signature:
    """A signature as the file states it: `["error", "VAR_IN_OUT CONSTANT a : axes; b : REAL", "VAR_OUTPUT c : INT"]`.
    types: the spelling of those that are entries of the file.
    """
    returns, *groups = stated
    parameters: list[Parameter] = []
    for group in groups:
        _, scope, text = _SCOPE.split(group)
        for one in text.split("; "):
            own, kind = one.split(" : ")
            parameters.append(Parameter(scope, own, types.get(kind, kind)))
    return Signature(name, types.get(returns, returns), tuple(parameters), access)
