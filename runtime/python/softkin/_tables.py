"""A machine as tables: its axes, its parameters and its branches, for the prompt and for notebooks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from softkin._frame import IDENTITY, Frame

if TYPE_CHECKING:
    from softkin._core import Mechanism

_UNSAID = ("check_limits", "warning_distance")
"""Parameters that are no part of the machine."""
_PICTURES = Path(__file__).with_name("_pictures")


class _Table(NamedTuple):
    head: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]


def text(robot: Mechanism) -> str:
    """The tables in columns, below the name of the machine."""
    return "\n\n".join([robot.NAME, *("\n".join(_lines(table)) for table in _tables(robot))])


def html(robot: Mechanism) -> str:
    """The tables as HTML, below the drawing of the machine, if there is one."""
    drawings = "".join(_drawing(name) for name in dict.fromkeys(part.NAME for part in _parts(robot)))
    return f"<div><b>{escape(robot.NAME)}</b>{drawings}{''.join(map(_marked, _tables(robot)))}</div>"


def _tables(robot: Mechanism) -> Iterator[_Table]:
    """The tables that have rows: axes, other limits, parameters, frames, branches and turns."""
    limits, known = robot.limits, {axis.name for axis in robot.AXES}
    axes = [(a.name, a.kind, _range(limits.get(a.name), a.unit), a.meaning) for a in robot.AXES]
    units = robot._parameter_units()
    others = [
        (name, "", _range(ends, units.get(f"lower_{name}", "")), "")
        for name, ends in limits.items()
        if ends and name not in known
    ]
    found = [
        _Table(("axis", "kind", "limits", "meaning"), axes + others),
        _Table(("parameter", "value", "meaning"), list(_parameters(robot))),
        _Table(("frame", "position", "A, B, C"), list(_frames(robot))),
        _Table(("configuration", "default", "names"), list(_bytes(robot))),
    ]
    return (table for table in found if table.rows)


def _range(ends: tuple[float | None, float | None] | None, unit: str) -> str:
    """The limits of an axis, in words."""
    lower, upper = ends or (None, None)
    if lower is None and upper is None:
        return "none"
    low = "from " + _number(lower) if upper is None and lower is not None else "" if lower is None else _number(lower)
    return " ".join(filter(None, [low, "" if upper is None else f"to {_number(upper)}", unit]))


def _number(value: float) -> str:
    return f"{value:.6g}"


def _parts(robot: Mechanism) -> Iterator[Mechanism]:
    """The machines of which it consists, each with parameters of its own."""
    inside = [getattr(robot, name, None) for name in ("bare", "position_part", "orientation_part")]
    if type(robot).PARAMETERS or not any(inside):
        part = getattr(robot, "part", None)
        yield from [robot] if type(robot).PARAMETERS or part is None else _parts(part)
    for one in inside:
        if one is not None:
            yield from _parts(one)


def _parameters(robot: Mechanism) -> Iterator[tuple[str, ...]]:
    """The parameters that are necessary, or differ from their default; limits stand beside the axes."""
    for part in _parts(robot):
        ends = {f"{word}_{key}" for key in _keys(part) for word in ("lower", "upper")}
        for p in part.PARAMETERS:
            value = part.parameters[p.name]
            if p.name not in (*ends, *_UNSAID) and value != p.default:
                shown = str(value) if isinstance(value, bool) else f"{_number(value)} {p.unit}".strip()
                yield p.name, shown, p.meaning


def _keys(part: Mechanism) -> tuple[str, ...]:
    """The last parts of the names of the limits; a machine in radians has those of the machine in degrees."""
    return tuple(getattr(part, "part", part).LIMIT_KEYS)


def _frames(robot: Mechanism) -> Iterator[tuple[str, ...]]:
    """The base and the tool of a machine that has them."""
    mounted = getattr(robot, "part", robot)
    for name in ("base", "tool"):
        frame = getattr(mounted, name, None)
        if isinstance(frame, Frame) and frame != Frame((0.0, 0.0, 0.0), IDENTITY):
            yield name, *(", ".join(map(_number, numbers)) for numbers in (frame.position, frame.euler))


def _bytes(robot: Mechanism) -> Iterator[tuple[str, ...]]:
    """The bytes of the configuration, with the names of the branches."""
    default = robot.names(robot.DEFAULT_CONFIGURATION)
    for byte in robot.CONFIGURATION:
        known = ", ".join(byte.branches) or "the number of the turn, 0 is automatic"
        yield byte.name, "automatic" if default[byte.name] == 0 else str(default[byte.name]), known


def _lines(table: _Table) -> Iterator[str]:
    """The rows with columns of equal width."""
    rows = [table.head, *table.rows]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        yield "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()


def _marked(table: _Table) -> str:
    head = "".join(f"<th>{escape(cell)}</th>" for cell in table.head)
    rows = ("".join(f"<td>{escape(cell)}</td>" for cell in row) for row in table.rows)
    return f"<table><tr>{head}</tr>{''.join(f'<tr>{row}</tr>' for row in rows)}</table>"


def _drawing(name: str) -> str:
    """The drawing of a machine of this package as SVG; nothing for any other one."""
    file = _PICTURES / f"{name}.svg"
    return f"<div>{file.read_text(encoding='utf-8')}</div>" if file.is_file() else ""
