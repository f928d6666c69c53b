"""Tables of Denavit-Hartenberg parameters, in TOML or CSV, by the standard or the modified convention.

Standard: Rz(theta) Tz(d) Tx(a) Rx(alpha), the joint before its row. Modified (Craig): Rx(alpha) Tx(a) Rz(theta) Tz(d),
the joint behind it. The value of a joint is added to theta (revolute) or to d (prismatic); a `fixed` row has none.
"""

from __future__ import annotations

import csv
import math
import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path

from derive.description.joints import Kind
from derive.importing.formats.documents import between, limit, number, rounding, shown, text_of
from derive.importing.robot import Axis, Moving, Place, Robot, Shifted, Step, Turned, UnreadableRobot

_SETTINGS: Mapping[str, tuple[str, ...]] = {
    "convention": ("standard", "modified"),
    "angles": ("degrees", "radians"),
    "lengths": ("mm", "m"),
}
_KINDS = {"revolute": Kind.ROTARY, "prismatic": Kind.LINEAR, "fixed": None}
_NUMBERS = ("theta", "d", "a", "alpha", "lower", "upper")
_ENTRIES = ("name", "type", *_NUMBERS, "coupling")
_IN_PI = re.compile(r"([+-]?)(?:([1-9]\d*)\*)?pi(?:/([1-9]\d*))?")
"""An angle in radians as people write it: pi/2, -3*pi/4."""
_METRES = {"mm": 1e-3, "m": 1.0}


@dataclass(frozen=True)
class Table:
    """The content of a table."""

    path: Path
    settings: Mapping[str, str]
    rows: tuple[Mapping[str, object], ...]
    scale: float
    """One unit of its lengths, in ours."""
    degree: float
    """One unit of its angles, in radians."""


def read_table(path: Path, base: str | None, tip: str | None, scale: float) -> Robot:
    """The chain of a table. scale: our unit in metres."""
    if base is not None or tip is not None:
        raise UnreadableRobot(f"{path}: a table has no links: leave --base and --tip out")
    settings, rows = (_toml if path.suffix.lower() == ".toml" else _csv)(path)
    for key, known in _SETTINGS.items():
        if settings.get(key) not in known:
            said = shown(settings[key]) if key in settings else "nothing"
            raise UnreadableRobot(f"{path}: says {said} for {key}: it must be {' or '.join(known)}")
    degree = math.pi / 180.0 if settings["angles"] == "degrees" else 1.0
    table = Table(path, settings, rows, _METRES[settings["lengths"]] * scale, degree)
    if not rows:
        raise UnreadableRobot(f"{path}: has no rows")
    kinds = {_name(table, index): _kind(table, index) for index in range(len(rows))}
    if len(kinds) < len(rows):
        raise UnreadableRobot(f"{path}: two rows have the same name")
    steps = tuple(step for index in range(len(rows)) for step in _steps(table, index, kinds))
    axes = tuple(_axis(table, index) for index in range(len(rows)) if _kind(table, index) is not None)
    source = f"{path.name} (DH table, {settings['convention']})"
    return Robot(settings.get("name", path.stem), source, "base", "flange", steps, axes)


def _toml(path: Path) -> tuple[dict[str, str], tuple[Mapping[str, object], ...]]:
    try:
        data = tomllib.loads(text_of(path), parse_float=Decimal)
    except ValueError as problem:  # of the syntax, or of an integer with thousands of digits
        raise UnreadableRobot(f"{path}: broken TOML: {problem}") from None
    rows = data.get("joints", [])
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise UnreadableRobot(f"{path}: its rows must be tables [[joints]]")
    settings = {key: _setting(key, _text(value)) for key, value in _lowered(path, data).items() if key != "joints"}
    return settings, tuple(_lowered(path, row) for row in rows)


def _lowered(path: Path, entries: Mapping[str, object]) -> dict[str, object]:
    """The entries by their names in small letters."""
    found = {key.strip().lower(): value for key, value in entries.items()}
    if len(found) < len(entries):
        raise UnreadableRobot(f"{path}: two entries differ in capital letters alone: {', '.join(map(shown, entries))}")
    return found


def _text(value: object) -> str:
    """A value of TOML as text; Python does not write an integer of thousands of digits."""
    try:
        return str(value)
    except ValueError:
        return "an integer of thousands of digits"


def _setting(key: str, value: str) -> str:
    """The value of a setting, whatever its capital letters; a name keeps them."""
    return value if key == "name" else value.lower()


def _csv(path: Path) -> tuple[dict[str, str], tuple[Mapping[str, object], ...]]:
    lines = [_unquoted(line.strip(" ")) for line in text_of(path).splitlines() if line.strip(" ,;\t")]
    settings = {}
    for line in lines:
        key, colon, value = line.strip("# ").partition(":")
        if line.startswith("#") and colon:
            settings[key.strip().lower()] = _setting(key.strip().lower(), value.strip(" ,;\t"))
    table = [line for line in lines if not line.startswith("#")]
    delimiter = max(",;\t", key=table[0].count) if table else ","
    try:
        found = list(csv.reader(table, delimiter=delimiter))
    except csv.Error as problem:
        raise UnreadableRobot(f"{path}: broken CSV: {problem}") from None
    if not found:
        return settings, ()
    header = [word.strip().lower() for word in found[0]]
    twice = [word for k, word in enumerate(header) if word in header[:k]]
    if twice:
        raise UnreadableRobot(f"{path}: two columns are called {shown(twice[0])}")
    for row in found[1:]:
        if len(row) != len(header):
            raise UnreadableRobot(
                f"{path}: the row {shown(row[0])} has {len(row)} cells, and the header has {len(header)}"
            )
    rows = [{k: c.strip() for k, c in zip(header, row, strict=True) if c.strip()} for row in found[1:]]
    return settings, tuple(rows)


def _unquoted(line: str) -> str:
    """A comment without the marks that a spreadsheet puts around its cell."""
    return line.replace('"', "") if line.startswith('"#') else line


def _name(table: Table, index: int) -> str:
    return _text(table.rows[index].get("name", f"A{index + 1}"))


def _kind(table: Table, index: int) -> Kind | None:
    row = table.rows[index]
    place = f"{table.path}: row {shown(_name(table, index))}"
    strange = [key for key in row if key not in _ENTRIES]
    if strange:
        raise UnreadableRobot(f"{place} has an unknown entry {shown(strange[0])}; there are {', '.join(_ENTRIES)}")
    stated = _text(row.get("type", "revolute")).lower()
    if stated not in _KINDS:
        raise UnreadableRobot(f"{place} has the unknown type {shown(stated)}; there are {', '.join(_KINDS)}")
    return _KINDS[stated]


def _number(table: Table, index: int, entry: str, default: float = 0.0) -> float:
    stated, place = _text(table.rows[index].get(entry, default)), f"row {shown(_name(table, index))}, {entry}"
    read = limit if entry in ("lower", "upper") else number
    in_pi = _IN_PI.fullmatch(stated.replace(" ", "")) if table.degree == 1.0 else None
    if in_pi is None:
        return read(table.path, stated, place)
    sign, *factors = in_pi.groups()
    multiple, divisor = (number(table.path, word or "1", place) for word in factors)
    return float(f"{sign}1") * multiple * math.pi / divisor


def _steps(table: Table, index: int, kinds: Mapping[str, Kind | None]) -> tuple[Step, ...]:
    theta, alpha = (_number(table, index, k) * table.degree for k in ("theta", "alpha"))
    d, a = (_number(table, index, k) * table.scale for k in ("d", "a"))
    turned: tuple[Place, ...] = (Turned(2, theta, _rounding(table, index, "theta")), Shifted((0.0, 0.0, d)))
    across: tuple[Place, ...] = (Shifted((a, 0.0, 0.0)), Turned(0, alpha, _rounding(table, index, "alpha")))
    name, kind = _name(table, index), _kind(table, index)
    moving = None if kind is None else Moving(kind, (0.0, 0.0, 1.0), _drives(table, index, kinds))
    if table.settings["convention"] == "modified":
        return (Step(name, (*across[::-1], *turned), moving),)
    return Step(name, turned, moving), Step(name, across)


def _rounding(table: Table, index: int, entry: str) -> float:
    """The largest distance of an angle from the exact one; zero in degrees, in which 15 is written exactly."""
    return rounding(_text(table.rows[index].get(entry, 0)), True) if table.settings["angles"] == "radians" else 0.0


def _drives(table: Table, index: int, kinds: Mapping[str, Kind | None]) -> tuple[tuple[str, float], ...]:
    """The axis of a row, and others that move its joint: `coupling = {A2 = -1}`, in CSV `A2:-1`."""
    name, stated = _name(table, index), table.rows[index].get("coupling", {})
    place = f"{table.path}: row {shown(name)}"
    if isinstance(stated, str):
        pairs: Sequence[tuple[str, str]] = [
            (axis.strip(), by.strip()) for axis, _, by in (word.partition(":") for word in stated.split())
        ]
    elif isinstance(stated, dict):
        pairs = [(str(axis), _text(by)) for axis, by in stated.items()]
    else:
        said = _text(stated) if isinstance(stated, list) else repr(stated)
        raise UnreadableRobot(f"{place}: its coupling {said[:40]} is not like {{A2 = -1}}")
    found = {name: 1.0}
    for axis, by in pairs:
        if kinds.get(axis) is None or kinds[axis] is not kinds[name]:
            raise UnreadableRobot(f"{place} is coupled to {shown(axis)}, which is no joint of its kind in the table")
        if axis in found:
            raise UnreadableRobot(f"{place} is coupled to {shown(axis)} twice: a joint turns with itself once")
        found[axis] = number(table.path, by, f"row {shown(name)}, coupling")
    return tuple((axis, by) for axis, by in found.items() if by != 0.0)


def _axis(table: Table, index: int) -> Axis:
    kind = _kind(table, index) or Kind.ROTARY
    unit = table.scale if kind is Kind.LINEAR else table.degree
    name, row = _name(table, index), table.rows[index]
    if "lower" not in row and "upper" not in row:
        return Axis(name, kind)
    low, high = (_number(table, index, end) for end in ("lower", "upper"))
    return Axis(name, kind, between(table.path, f"row {shown(name)}", low, high, unit))
