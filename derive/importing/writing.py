"""A description as text, as a careful person would write it, to be read, edited and derived."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from textwrap import wrap

import numpy as np
import sympy as sp

from derive.description.errors import printable
from derive.description.joints import Kind
from derive.geometry.frames import Motion
from derive.importing.arms.lines import Arm
from derive.importing.arms.pieces import Simple, turns
from derive.importing.arms.tasks import Followed
from derive.importing.branches import Named, branches
from derive.importing.expressions import Dimension, amount_text, dimension_of, factor_text, is_half_turn
from derive.importing.naming import axis_names, block_name
from derive.importing.robot import Axis, Robot, UnreadableRobot

WIDTH = 120
"""Of the lines of a description."""
FAR = 1e6
"""A limit beyond this many degrees or units of length counts as no limit."""
_FRAMES = ("Rx", "Ry", "Rz", "Tx", "Ty", "Tz", "flip_x")


@dataclass(frozen=True)
class Description:
    """The parts of a description: its names, and the text of its chain."""

    name: str
    axes: tuple[str, ...]
    dimensions: tuple[Dimension, ...]
    factors: tuple[str, ...]
    branches: tuple[Named, ...]


def description_of(robot: Robot, arm: Arm, chain: Simple, task: Followed) -> Description:
    """The names and texts of a chain."""
    axes = axis_names(robot)
    places = turns(chain.pieces, axes)
    dimensions = distinct([dimension_of(piece, places, arm.size) for piece in chain.pieces])
    flips = task.turning == "ABOUT_Z"
    if flips:
        _refuse_leaning(chain, len(places))
    factors = tuple(factor_text(p, axes, d, flips) for p, d in zip(chain.pieces, dimensions, strict=True))
    symbols: dict[str, object] = {name: sp.Symbol(name, real=True) for name in axes}
    symbols |= {d.variable: sp.Symbol(d.variable, positive=True) for d in dimensions if d is not None}
    symbols |= {"pi": sp.pi, "radians": lambda angle: sp.Symbol(f"radians({angle})", real=True)}
    texts = [amount_text(p, axes, d) for p, d in zip(chain.pieces, dimensions, strict=True)]
    amounts = [sp.sympify(text, locals=symbols) for text in texts]
    found = branches(chain.pieces, amounts, task)
    return Description(block_name(robot), axes, tuple(d for d in dimensions if d is not None), factors, found)


def _refuse_leaning(chain: Simple, tip: int) -> None:
    """Refuse a chain that turns its tip about z if the tip's z axis is not along that turn, which is commanded."""
    turns = [p for p in chain.pieces if p.place == tip and p.motion is Motion.TURN and not p.drives]
    if any(p.letter != 2 and not is_half_turn(p) for p in turns):
        raise UnreadableRobot(
            "its tip turns about z of the base, and its own z axis is not along that: choose a --tip whose z axis is"
        )


def distinct(dimensions: Sequence[Dimension | None]) -> list[Dimension | None]:
    """The dimensions with names that differ: two turns between the same axes may be about the same letter."""
    found: list[Dimension | None] = []
    for one in dimensions:
        count = sum(d is not None and one is not None and d.meaning == one.meaning for d in found)
        found.append(replace(one, name=f"{one.name}_{count + 1}") if one is not None and count else one)
    return found


def written(robot: Robot, description: Description, task: Followed, unit: str, notes: Sequence[str]) -> str:
    """The text of the mechanism file."""
    body = [
        docstring(robot, description, unit, notes),
        "",
        *_imports(description, task, robot),
        "",
        *(dimension_line(d) for d in description.dimensions),
        *(axis_line(n, a) for n, a in zip(description.axes, robot.axes, strict=True)),
        "",
        *_mechanism(robot, description, task),
        "",
    ]
    return "\n".join(body)


def docstring(robot: Robot, description: Description, unit: str, notes: Sequence[str]) -> str:
    """What the description is of, and what was left out."""
    about = f"{description.name}: {robot.base} to {robot.tip} of {robot.source}. Lengths in {unit}, angles in degrees."
    texts = [line for text in (about, *notes) for line in wrap(plain(text), WIDTH - 4)]
    return (
        '"""'
        + "\n".join([texts[0], "", *texts[1:]] if len(texts) > 1 else texts)
        + ('\n"""' if len(texts) > 1 else '"""')
    )


def plain(text: str) -> str:
    """Text of a file as a part of one line, without characters that would end a string."""
    return re.sub(r'["\\\s]+', " ", printable(text)).strip()


def _imports(description: Description, task: Followed, robot: Robot) -> list[str]:
    indicators = " ".join(str(b.indicator) for b in description.branches)
    chain = " ".join(description.factors)
    functions = [f for f in ("cos", "sin", "sqrt") if f"{f}(" in indicators]
    functions += ["pi"] if re.search(r"\bpi\b", f"{indicators} {chain}") else []
    frames = [f for f in _FRAMES if f"{f}(" in chain]
    names = {"Mechanism", "Task", "Turning", "Vendor"} - ({"Turning"} if task.turning == "NONE" else set())
    names |= {"branch"} if description.branches else set()
    names |= {"angle", "radians"} if any(d.is_angle for d in description.dimensions) else set()
    names |= {"length"} if any(not d.is_angle for d in description.dimensions) else set()
    names |= {"linear" if a.kind is Kind.LINEAR else "rotary" for a in robot.axes}
    ordered = sorted(names, key=lambda n: (n[0].islower(), n))
    lines = [f"from sympy import {', '.join(sorted(functions))}", ""] if functions else []
    return [*lines, f"from derive.frames import {', '.join(frames)}", *import_lines("derive.mechanism", ordered)]


def import_lines(module: str, names: list[str]) -> list[str]:
    """An import of names."""
    line = f"from {module} import {', '.join(names)}"
    if len(line) <= WIDTH:
        return [line]
    return [f"from {module} import (", *(f"    {name}," for name in names), ")"]


def dimension_line(dimension: Dimension) -> str:
    """A parameter of the description."""
    kind = "angle" if dimension.is_angle else "length"
    value = repr(float(dimension.value))
    return _call(
        f"{dimension.variable} = {kind}",
        [f'"{dimension.name}"', f'"{plain(dimension.meaning)}"', f"nominal={value}", f"default={value}"],
    )


def axis_line(name: str, axis: Axis) -> str:
    """A joint of the description."""
    kind = "linear" if axis.kind is Kind.LINEAR else "rotary"
    arguments = [f'"{name}"', f'"{plain(axis.name)}"']
    if axis.limits is not None and limits_of(axis) != (-FAR, FAR):
        low, high = limits_of(axis)
        arguments.append(f"limits=({low!r}, {high!r})")
    return _call(f"{name} = {kind}", arguments)


def limits_of(axis: Axis) -> tuple[float, float]:
    """The limits in the units of the interface, rounded to 1e-6: a file writes pi/2 as 1.570796325."""
    assert axis.limits is not None
    unit = 1.0 if axis.kind is Kind.LINEAR else 180.0 / np.pi
    low, high = (min(max(round(float(end * unit), 6) + 0.0, -FAR), FAR) for end in axis.limits)
    return low, high


def _call(function: str, arguments: list[str]) -> str:
    line = f"{function}({', '.join(arguments)})"
    if len(line) <= WIDTH:
        return line
    return f"{function}(\n    {', '.join(arguments)}\n)"


def _mechanism(robot: Robot, description: Description, task: Followed) -> list[str]:
    chain = f"    chain={' * '.join(description.factors)},"
    if len(chain) > WIDTH:
        chain = "    chain=" + "\n    * ".join(description.factors) + ","
    held = [description.axes[k] for k in task.held]
    turning = "" if task.turning == "NONE" else f", Turning.{task.turning}"
    return [
        *head_lines(robot, description),
        chain,
        f'    task=Task("{task.position}"{turning}),',
        *_branches(description.branches),
        *(tuple_lines("held", held) if held else ()),
        "    offset_interface=False,",
        ")",
    ]


def head_lines(robot: Robot, description: Description) -> list[str]:
    """The mechanism, up to its joints."""
    count = len(description.axes)
    return [
        "MECHANISM = Mechanism(",
        f'    name="{description.name}",',
        "    vendor=Vendor.TEXTBOOK,",
        '    family="imported",',
        f'    source="{plain(robot.source)}",',
        f'    summary="{plain(robot.name)} with {count} ax{"i" if count == 1 else "e"}s.",',
        *tuple_lines("parameters", [d.variable for d in description.dimensions]),
        *tuple_lines("joints", list(description.axes)),
    ]


def tuple_lines(word: str, names: list[str]) -> list[str]:
    """An argument that is a tuple of names."""
    line = f"    {word}=({', '.join(names)}{',' if len(names) == 1 else ''}),"
    if len(line) <= WIDTH:
        return [line]
    return [f"    {word}=(", *(f"        {name}," for name in names), "    ),"]


def _branches(found: Sequence[Named]) -> list[str]:
    if not found:
        return []
    rows = []
    for one in found:
        first, second = one.names
        rows.append(f'        branch("{one.name}", {one.indicator}, {first}=+1, {second}=-1),')
    return ["    branches=(", *rows, "    ),"]
