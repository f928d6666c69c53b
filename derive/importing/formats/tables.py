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
from derive.importing.formats.documents import number, rounding, text_of
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
            said = f"{settings[key]!r}" if key in settings else "nothing"
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
    except tomllib.TOMLDecodeError as problem:
        raise UnreadableRobot(f"{path}: broken TOML: {problem}") from None
    rows = data.get("joints", [])
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise UnreadableRobot(f"{path}: its rows must be tables [[joints]]")
    return {k.lower(): _setting(k, str(v)) for k, v in data.items() if k != "joints"}, tuple(
        {k.lower(): value for k, value in row.items()} for row in rows
    )


def _setting(key: str, value: str) -> str:
    """The value of a setting, whatever its capital letters; a name keeps them."""
    return value if key.lower() == "name" else value.lower()


def _csv(path: Path) -> tuple[dict[str, str], tuple[Mapping[str, object], ...]]:
    lines = [_unquoted(line.strip(" ")) for line in text_of(path).splitlines() if line.strip(" ,;\t")]
    settings = {}
    for line in lines:
        key, colon, value = line.strip("# ").partition(":")
        if line.startswith("#") and colon:
            settings[key.strip().lower()] = _setting(key.strip(), value.strip(" ,;\t"))
    table = [line for line in lines if not line.startswith("#")]
    delimiter = max(",;\t", key=table[0].count) if table else ","
    found = list(csv.reader(table, delimiter=delimiter))
    if not found:
        return settings, ()
    header = [word.strip().lower() for word in found[0]]
    for row in found[1:]:
        if len(row) != len(header):
            raise UnreadableRobot(f"{path}: the row {row[0]!r} has {len(row)} cells, and the header has {len(header)}")
    rows = [{k: c.strip() for k, c in zip(header, row, strict=True) if c.strip()} for row in found[1:]]
    return settings, tuple(rows)


def _unquoted(line: str) -> str:
    """A comment without the marks that a spreadsheet puts around its cell."""
    return line.replace('"', "") if line.startswith('"#') else line


def _name(table: Table, index: int) -> str:
    return str(table.rows[index].get("name", f"A{index + 1}"))


def _kind(table: Table, index: int) -> Kind | None:
    row = table.rows[index]
    place = f"{table.path}: row {_name(table, index)!r}"
    strange = [key for key in row if key not in _ENTRIES]
    if strange:
        raise UnreadableRobot(f"{place} has an unknown entry {strange[0]!r}; there are {', '.join(_ENTRIES)}")
    stated = str(row.get("type", "revolute")).lower()
    if stated not in _KINDS:
        raise UnreadableRobot(f"{place} has the unknown type {stated!r}; there are {', '.join(_KINDS)}")
    return _KINDS[stated]


def _number(table: Table, index: int, entry: str, default: float = 0.0) -> float:
    stated = str(table.rows[index].get(entry, default))
    in_pi = _IN_PI.fullmatch(stated.replace(" ", "")) if table.degree == 1.0 else None
    if in_pi is not None:
        sign, multiple, divisor = in_pi.groups()
        return float(f"{sign}1") * int(multiple or 1) * math.pi / int(divisor or 1)
    return number(table.path, stated, f"row {_name(table, index)!r}, {entry}")


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
    return rounding(str(table.rows[index].get(entry, 0))) if table.settings["angles"] == "radians" else 0.0


def _drives(table: Table, index: int, kinds: Mapping[str, Kind | None]) -> tuple[tuple[str, float], ...]:
    """The axis of a row, and others that move its joint: `coupling = {A2 = -1}`, in CSV `A2:-1`."""
    name, stated = _name(table, index), table.rows[index].get("coupling", {})
    place = f"{table.path}: row {name!r}"
    if isinstance(stated, str):
        pairs: Sequence[tuple[str, str]] = [
            (axis.strip(), by.strip()) for axis, _, by in (word.partition(":") for word in stated.split())
        ]
    elif isinstance(stated, dict):
        pairs = [(str(axis), str(by)) for axis, by in stated.items()]
    else:
        raise UnreadableRobot(f"{place}: its coupling {stated!r} is not like {{A2 = -1}}")
    found = [(name, 1.0)]
    for axis, by in pairs:
        if kinds.get(axis) is None or kinds[axis] is not kinds[name]:
            raise UnreadableRobot(f"{place} is coupled to {axis!r}, which is no joint of its kind in the table")
        found.append((axis, number(table.path, by, f"row {name!r}, coupling")))
    return tuple(found)


def _axis(table: Table, index: int) -> Axis:
    kind = _kind(table, index) or Kind.ROTARY
    unit = table.scale if kind is Kind.LINEAR else table.degree
    name, row = _name(table, index), table.rows[index]
    if "lower" not in row and "upper" not in row:
        return Axis(name, kind)
    low, high = (_number(table, index, end) for end in ("lower", "upper"))
    if low > high:
        raise UnreadableRobot(f"{table.path}: row {name!r}: its lower limit {low:g} is above its upper limit {high:g}")
    return Axis(name, kind, (low * unit, high * unit) if low < high else None)
