"""Five-axis machines: three slides and two turning axes, in any of the twelve orders, described by one function.

The frame is that of the workpiece. From it to the tool stand the axes of the table, the last one first and turned back,
then the slides, then the axes of the head.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import prod
from typing import Any

import sympy as sp

from derive.description.branches import branch
from derive.description.dimensions import Parameter, angle, distance, radians
from derive.description.errors import DescriptionError
from derive.description.joints import Joint, linear, rotary
from derive.description.mechanism import Mechanism, Task, Turning
from derive.geometry.frames import Chain, Rx, Ry, Rz, Tx, Ty, Tz

ORDERS = {
    "TableTable_AC": ("", "AC"), "TableTable_BC": ("", "BC"), "TableTable_AB": ("", "AB"), "TableTable_BA": ("", "BA"),
    "HeadTable_AC": ("A", "C"), "HeadTable_BC": ("B", "C"), "HeadTable_AB": ("A", "B"), "HeadTable_BA": ("B", "A"),
    "HeadHead_CA": ("CA", ""), "HeadHead_CB": ("CB", ""), "HeadHead_AB": ("AB", ""), "HeadHead_BA": ("BA", ""),
}  # fmt: skip
"""The axes of the head and those of the table. Of two axes in one place the first carries the second."""
_TURN, _SHIFT = {"A": Rx, "B": Ry, "C": Rz}, {"A": Tx, "B": Ty, "C": Tz}
_LINE = {"A": "X", "B": "Y", "C": "Z"}
"""The line along which an axis stands."""
_SENSE = {"A": "from Y to Z", "B": "from Z to X", "C": "from X to Y"}


@dataclass(frozen=True)
class _Axis:
    """A turning axis, with its inclination and the errors of its location: parameters by the letters of the lines."""

    joint: Joint
    nutation: Parameter | None
    places: dict[str, Parameter]
    tilts: dict[str, Parameter]

    @property
    def stand(self) -> Chain:
        """Where the axis stands on what carries it, by its errors."""
        tilts = _product(_TURN[other](radians(tilt)) for other, tilt in self.tilts.items())
        return _product(_SHIFT[other](shift) for other, shift in self.places.items()) * tilts

    @property
    def turned(self) -> Chain:
        """What carries the axis, to what the axis carries."""
        letter, inclined = self.joint.name, Chain(())
        if self.nutation is not None:
            up = sp.pi / 2 - radians(self.nutation)
            inclined = _TURN["B"](-up) if letter == "A" else _TURN["A"](up)
        return self.stand * inclined * _TURN[letter](self.joint) * _back(inclined)


def five_axes(
    name: str,
    *,
    head: str = "",
    table: str = "",
    nutating: bool = False,
    location_errors: bool = False,
    tool_vector: bool = False,
    **fields: Any,
) -> Mechanism:
    """The description of a five-axis machine, by the letters of the turning axes in its head and in its table.

    `table="AC"` is a table C on a trunnion A, `head="CB"` a head B on a fork C. If it is `nutating`, the trunnion, or
    the axis of the head next to the tool, is inclined to Z by a parameter. With `location_errors` each turning axis has
    parameters for the errors of its place and its direction, against what carries it, with the names of ISO 230-7,
    and the slides Y and Z have those of their squareness. With a `tool_vector` the tip may be beside the axis of the
    spindle: it has parameters x and y beside its length. `fields` are further fields of the `Mechanism`. Raises
    `DescriptionError` for any other order.
    """
    if (head, table) not in ORDERS.values():
        known = ", ".join(f"head={h!r} table={t!r}" for h, t in ORDERS.values())
        raise DescriptionError(f"head={head!r} table={table!r} is no order of five axes: take one of {known}")
    outer, inner = tuple(table[::-1] + head)
    nutation = angle("nutation", f"Axis {inner} against Z: 90 if it is not inclined", nominal=45.0, low=1.0, high=179.0)
    axes = {
        letter: _Axis(
            rotary(letter, _turning(letter, head, table)),
            nutation if nutating and letter == inner else None,
            *(_errors(letter) if location_errors else ({}, {})),
        )
        for letter in head + table
    }
    offsets = {p.name: p for p in _offsets(head, table)}
    beside = tuple(_beside()) if tool_vector else ()
    slides, squareness = _slides(head, table), _squareness() if location_errors else {}
    chain = _to_workpiece(table, axes, offsets) * Tx(slides[0])
    for letter, slide in zip("BC", slides[1:], strict=True):
        tilts = _product(_TURN[other](radians(tilt)) for other, tilt in squareness.get(letter, {}).items())
        chain *= tilts * _SHIFT[letter](slide) * _back(tilts)
    chain *= _to_tool(head, axes, offsets) * _product(_SHIFT[a](p) for a, p in zip("AB", beside, strict=False))
    tilt = (sp.sin if outer == "C" else sp.cos)(axes[inner].joint)
    if location_errors:
        tilt = _tilt(head, table, chain, axes)
    pole = f"tool_along_{outer.lower()}" + ("_or_farthest" if nutating else "")
    errors = [p for tilts in squareness.values() for p in tilts.values()]
    errors += [p for axis in axes.values() for p in (*axis.places.values(), *axis.tilts.values())]
    described = {
        "summary": _summary(head, table, nutating),
        "source": f"five-axis milling machines, {_where(head, table)}; axes as ISO 841 names them",
        "notes": _notes(table),
    }
    return Mechanism(
        name=name,
        parameters=(*offsets.values(), *beside, *([nutation] if nutating else []), *errors),
        joints=(*slides, *(axis.joint for axis in axes.values())),
        chain=chain,
        task=Task("xyz", Turning.DIRECTION),
        branches=(branch("tilt", tilt, positive=+1, negative=-1, margin=pole),),
        offset_interface=False,
        **described | fields,
    )


def _back(chain: Chain) -> Chain:
    return Chain(tuple(factor.inverse() for factor in reversed(chain.factors)))


def _to_workpiece(table: str, axes: dict[str, _Axis], offsets: dict[str, Parameter]) -> Chain:
    """From the workpiece to the machine: the table with its pivots, backwards."""
    if not table:
        return Chain(())
    chain = _back(axes[table[-1]].turned)
    if len(table) == 2:
        chain *= _product(_SHIFT[a](-offsets[_pivot(a)]) for a in "CBA" if a != table[0]) * _back(axes[table[0]].turned)
    return chain


def _to_tool(head: str, axes: dict[str, _Axis], offsets: dict[str, Parameter]) -> Chain:
    """From the slides to the tip of the tool."""
    if not head:
        return Tz(-offsets["tool_length"])
    inner = head[-1]
    side = _SHIFT[_across("C", inner)](offsets["head_offset"]) * Tz(-offsets["pivot_length"])
    if len(head) == 1:
        return axes[inner].turned * side
    return axes[head[0]].turned * _SHIFT[_across(*head)](offsets["fork_offset"]) * axes[inner].turned * side


def _product(frames: Iterable[Chain]) -> Chain:
    return prod(frames, start=Chain(()))


def _across(one: str, other: str) -> str:
    """The letter of the axis at right angles to two others."""
    return next(a for a in "ABC" if a not in (one, other))


def _tilt(head: str, table: str, chain: Chain, axes: dict[str, _Axis]) -> sp.Expr:
    """How fast the inner axis moves the tool against the outer one: both solutions meet where it is zero.

    Its sign is that of the sine or cosine that it is without errors.
    """
    outer, inner = tuple(table[::-1] + head)
    column = "ABC".index(outer)
    pole = sp.eye(3)[:, column] if table else axes[outer].stand.matrix()[:3, column]
    tool = chain.matrix()[:3, 2].subs(axes[outer].joint.symbol, 0)
    sense = -1 if inner in table else 1
    return {"A": sense, "B": -sense, "C": -1}[outer] * pole.dot(tool.diff(axes[inner].joint.symbol))


def _errors(letter: str) -> tuple[dict[str, Parameter], dict[str, Parameter]]:
    """The errors of the location of an axis, of its place and of its direction, by the letters of the other two."""
    others, axis = [a for a in "ABC" if a != letter], letter.lower()
    place = f"Error of the place of axis {letter} along"
    return (
        {a: distance(f"e{_LINE[a].lower()}0{axis}", f"{place} {_LINE[a]}", nominal=0.02) for a in others},
        {a: _tilt_error(a, letter, "axis") for a in others},
    )


def _squareness() -> dict[str, dict[str, Parameter]]:
    """The errors of the squareness of the slides Y (to X) and Z (to X and Y), by the letters of the lines."""
    return {
        letter: {a: _tilt_error(a, _LINE[letter], "slide") for a in others}
        for letter, others in (("B", "C"), ("C", "BA"))
    }


def _tilt_error(about: str, name: str, kind: str) -> Parameter:
    """The error of the direction of an axis or a slide, as a turn about a line."""
    meaning = f"Error of the direction of {kind} {name}: turn about {_LINE[about]}"
    return angle(f"e{about.lower()}0{name.lower()}", meaning, nominal=0.0, default=0.0)


def _pivot(letter: str) -> str:
    return f"pivot_{_LINE[letter].lower()}"


def _offsets(head: str, table: str) -> Iterator[Parameter]:
    """The lengths of the machine: a shift along its first axis is part of a slide's zero, and has no parameter."""
    if len(table) == 2:
        first, last = tuple(table)
        for other, nominal in zip((a for a in "ABC" if a != first), (40.0, -60.0), strict=True):
            place = "the surface of the table" if last == "C" else "the zero of the workpiece"
            to = place if other == last else f"axis {last}"
            meaning = f"Axis {first} to {to}, along {_LINE[other]}, at {first} = 0"
            yield distance(_pivot(other), meaning, nominal=nominal)
        yield distance("tool_length", "Gauge line of the spindle to the tip of the tool", nominal=120.0)
        return
    first, inner = head[0], head[-1]
    if len(head) == 2:
        along = _LINE[_across(*head)]
        yield distance("fork_offset", f"Axis {first} to axis {inner}, along {along}, at {first} = 0", nominal=25.0)
    along, lengths = _LINE[_across("C", inner)], ((35.0, 240.0) if table else (-15.0, 260.0))
    meaning = f"Axis {inner} to the axis of the spindle, along {along}, at {inner} = 0"
    yield distance("head_offset", meaning, nominal=lengths[0])
    meaning = f"Axis {inner} to the tip of the tool, along the spindle"
    yield distance("pivot_length", meaning, nominal=lengths[1])


def _beside() -> Iterator[Parameter]:
    """Where the tip of the tool is beside the axis of the spindle."""
    for line in "XY":
        meaning = f"Axis of the spindle to the tip of the tool, along {line} with the axes at zero"
        yield distance(f"tool_{line.lower()}", meaning, nominal=6.0)


def _slides(head: str, table: str) -> list[Joint]:
    against, zero = "", ""
    if head and table:
        against = ": the head against the table"
        place = "the surface of the table" if table == "C" else f"axis {table}"
        zero = f"; zero with axis {head} at {'the height of ' if table != 'C' else ''}{place}"
    elif table:
        against = ": the spindle against the trunnion"
        zero = f"; zero with the gauge line at the height of axis {table[0]}"
    texts = (f"Slide along X{against}", "Slide along Y", f"Slide along Z, up{zero}")
    return [linear(line, text) for line, text in zip("XYZ", texts, strict=True)]


def _turning(letter: str, head: str, table: str) -> str:
    line, sense = _LINE[letter], _SENSE[letter]
    if letter in head:
        if letter == head[-1]:
            return f"Head about {'the turned ' if len(head) == 2 else ''}{line}: positive turns it {sense}"
        return f"Fork about {line}: positive turns it {sense}"
    if letter == table[-1]:
        own = "its own " if len(table) == 2 else ""
        return f"Table about {own}{line}: positive turns the workpiece {sense}"
    return f"Trunnion about {line}: positive turns the table {sense}"


def _where(head: str, table: str) -> str:
    if head and table:
        return "one rotary axis in the head and one in the table"
    return f"both rotary axes in the {'head' if head else 'table'}"


def _summary(head: str, table: str, nutating: bool) -> str:
    kind = "an inclined" if nutating else "a tilting"
    if head and table:
        text = f"{kind} head over a rotary table: the frame is that of the workpiece."
    elif table:
        text = f"{kind} rotary table: the frame is that of the workpiece on the table."
    else:
        fork = "a fork head with an inclined axis" if nutating else "a fork head"
        text = f"{fork}: both rotary axes turn the tool, with the offsets between them."
    return f"Five-axis machine with {text}"


def _notes(table: str) -> tuple[str, ...]:
    tool = "The direction is that of the tool, from its tip to the spindle."
    if not table:
        return (tool,)
    last = table[-1]
    origin = f"where axis {last} leaves the table" if last == "C" else f"on axis {last}"
    return (
        f"Positions are in the frame of the workpiece: its origin is {origin}, and it turns with the table. {tool}",
    )
