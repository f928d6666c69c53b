"""The settings of a live connection: the machine, its nodes, the source; from JSON and from the command line.

The format of the JSON is that of docs/LIVE.md.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from derive.controller.addresses import Address, address_of, refuse_secrets
from derive.controller.channels import Channel, checked_scale, in_order, of_argument, of_entry
from derive.controller.machine import Machine, machine_of
from derive.controller.reading import read_json
from derive.controller.refusal import Refused

RATE, STALE_AFTER, SPEED = 50.0, 1.0, 1.0
"""Updates a second; seconds after which a value is stale; the speed of a replayed table relative to its recording."""
_ENTRIES = frozenset({"machine", "description", "package", "axes", "source"})
_NUMBERS = {"rate": (RATE, 1000.0), "stale_after": (STALE_AFTER, 3600.0), "speed": (SPEED, 1000.0)}
"""The numbers of a source: default and upper end; all are more than 0."""
_OF_SOURCE = frozenset({"address", "loop", "time", "ca", *_NUMBERS})


@dataclass(frozen=True)
class Security:
    """How the identity of the controller is checked, and how this client identifies itself."""

    ca: Path | None = None
    """The certificate of the authority, or of the controller itself; None for those that the system trusts."""
    is_unchecked: bool = False
    """Whether any certificate is accepted."""
    is_unencrypted: bool = False
    """Whether OPC UA is read without encryption, and without a password."""
    logs_in: bool = False
    identity: Path = Path("~/.softkin")
    """The folder of this client's own OPC UA certificate and key."""


@dataclass(frozen=True)
class Settings:
    """The machine that is shown, and the source of its values."""

    machine: Machine
    channels: tuple[Channel, ...]
    address: Address
    security: Security
    rate: float = RATE
    stale_after: float = STALE_AFTER
    speed: float = SPEED
    is_loop: bool = False
    time: Channel | None = None
    """The column of a table that holds the time, with the factor to seconds; None for the first column of that kind."""


def settings_of(
    path: Path, nodes: Sequence[str] = (), source: Mapping[str, Any] | None = None, security: Security | None = None
) -> Settings:
    """The settings of a JSON file, with those that the command line replaces.

    nodes: each as `A1=node*scale`; source: its address, and its other entries by their names in the JSON. Raises
    `Refused` with what is wrong.
    """
    given = _read(path)
    folder = path.parent
    machine = machine_of(
        given.get("machine", {}), *(_path(given.get(name), folder, name) for name in ("description", "package"))
    )
    entry = given.get("source", {})
    from_file = {"address": entry} if isinstance(entry, str) else entry
    if not isinstance(from_file, Mapping) or not set(from_file) <= _OF_SOURCE:
        what = sorted(set(from_file) - _OF_SOURCE)[0] if isinstance(from_file, Mapping) else type(from_file).__name__
        raise Refused(f"{path}: source is an address, or an object of {', '.join(sorted(_OF_SOURCE))}; not {what!r}")
    from_command = {name: value for name, value in (source or {}).items() if value is not None}
    address = _address(from_command, from_file, folder)
    merged = {**from_file, **from_command}
    axes = given.get("axes", {})
    if not isinstance(axes, Mapping):
        raise Refused(f'{path}: axes is an object, {{"A1": node, ...}}, not {axes!r}')
    channels = [of_entry(str(axis), node, str(path)) for axis, node in axes.items()] + [of_argument(n) for n in nodes]
    kept = security or Security()
    ca = kept.ca or _path(from_file.get("ca"), folder, "ca")
    return Settings(
        machine=machine,
        channels=in_order(channels, machine.axis_names, named=address.is_named),
        address=address,
        security=Security(ca, kept.is_unchecked, kept.is_unencrypted, kept.logs_in, kept.identity),
        is_loop=_flag(merged.get("loop", False), path),
        time=_time(merged.get("time"), path),
        **{name: _number(name, merged.get(name, _NUMBERS[name][0]), path) for name in _NUMBERS},
    )


def _read(path: Path) -> dict[str, Any]:
    """The entries of the file; those of a machine alone, as `to_json` writes it, become its entry "machine"."""
    try:
        text = path.read_text(encoding="utf-8")
        given = read_json(text, object_pairs_hook=_once, parse_float=_finite, parse_constant=_finite)
    except OSError as problem:
        raise Refused(f"{path}: {problem.strerror or problem}") from None
    except ValueError as problem:
        raise Refused(f"{path}: no JSON: {problem}") from None
    if not isinstance(given, dict):
        raise Refused(f"{path}: an object of JSON, not {type(given).__name__}")
    refuse_secrets(given, str(path))
    if "mechanism" in given:
        return {"machine": given}
    unknown = sorted(set(given) - _ENTRIES)
    if unknown:
        raise Refused(f"{path}: there is no entry {unknown[0]!r}: the entries are {', '.join(sorted(_ENTRIES))}")
    return given


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """An object of JSON in which every name stands once."""
    found: dict[str, Any] = {}
    for name, value in pairs:
        if name in found:
            raise ValueError(f"the entry {name!r} stands twice")
        found[name] = value
    return found


def _finite(text: str) -> float:
    """A number that JSON can hold: neither NaN nor infinite."""
    if not math.isfinite(float(text)):
        raise ValueError(f"{text} is no finite number")
    return float(text)


def _address(from_command: Mapping[str, Any], from_file: Mapping[str, Any], folder: Path) -> Address:
    """The source: a path of the command line starts where the command runs, one of the JSON beside the JSON."""
    for entries, start in ((from_command, Path()), (from_file, folder)):
        if isinstance(entries.get("address"), str):
            return address_of(entries["address"], start)
    raise Refused("where do the values come from? --source opc.tcp://host:4840, https://host, recording.csv, or -")


def _path(given: object, folder: Path, name: str) -> Path | None:
    if given is None or isinstance(given, str):
        return folder / given if given else None
    raise Refused(f"{name} is the path of a file, not {given!r}")


def _number(name: str, given: object, path: Path) -> float:
    most = _NUMBERS[name][1]
    if isinstance(given, bool) or not isinstance(given, int | float) or not 0 < given <= most:
        raise Refused(f"{path}: {name} is a number more than 0 and at most {most:g}, not {given!r}")
    return float(given)


def _flag(given: object, path: Path) -> bool:
    if not isinstance(given, bool):
        raise Refused(f"{path}: loop is true or false, not {given!r}")
    return given


def _time(given: object, path: Path) -> Channel | None:
    """The time column: its name, `name*scale`, or an object with `node` and `scale`."""
    if given is None:
        return None
    if isinstance(given, str):
        return of_argument(f"time={given}")
    if isinstance(given, Mapping) and isinstance(given.get("node"), str) and set(given) <= {"node", "scale"}:
        return Channel("time", given["node"], checked_scale(given.get("scale", 1.0), f"{path}: time"))
    raise Refused(f'{path}: time is a column, or {{"node": ..., "scale": ...}}, not {given!r}')
