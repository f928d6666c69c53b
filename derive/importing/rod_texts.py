"""Rods that meet in the tip as the text of a description, and the report of them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from derive.description.joints import Kind
from derive.geometry.vectors import Vector
from derive.importing.rods import Linkage
from derive.importing.writing import WIDTH, axis_line, dimension_line, docstring, head_lines, import_lines

_WORDS = {Kind.ROTARY: ("elbow", "stretched"), Kind.LINEAR: ("carriage", "square")}
"""The name of a branch, and of the singularity at which both of its solutions meet."""


def rods_written(linkage: Linkage, unit: str) -> str:
    """The text of the mechanism file."""
    robot, description = linkage.robot, linkage.description
    body = [*_geometry(linkage), "", *_mechanism(linkage)]
    lines = [
        docstring(robot, description, unit, robot.notes),
        "",
        *_imports(linkage, "\n".join(body)),
        "",
        *(dimension_line(d) for d in description.dimensions),
        *(axis_line(n, a) for n, a in zip(description.axes, robot.axes, strict=True)),
        "",
        *body,
        "",
    ]
    return "\n".join(lines)


def _imports(linkage: Linkage, body: str) -> Iterator[str]:
    functions = [f for f in ("cos", "pi", "sin", "sqrt") if re.search(rf"\b{f}\b", body)]
    if functions:
        yield f"from sympy import {', '.join(functions)}"
        yield ""
    names = {"Mechanism", "Task", "Vendor", "rod", "length", *(c.upper() for c in linkage.position)}
    names |= {"linear" if a.kind is Kind.LINEAR else "rotary" for a in linkage.robot.axes}
    names |= {"angle", "radians"} if any(d.is_angle for d in linkage.description.dimensions) else set()
    names |= {"assembly", "branch"} if linkage.signs else set()
    yield from import_lines("derive.mechanism", sorted(names, key=lambda n: (n[0].islower(), n)))
    yield from import_lines(
        "derive.vectors", [f for f in ("cross", "dot", "minus", "triple", "vector") if f"{f}(" in body]
    )


def _geometry(linkage: Linkage) -> Iterator[str]:
    """The tip, the ends of arms; and for branches the rods, and the ways in which axes move those ends."""
    yield from _vector("TCP", linkage.tip)
    numbers = range(1, len(linkage.hangers) + 1)
    for k, hanger in zip(numbers, linkage.hangers, strict=True):
        yield from _vector(_end(linkage, k), hanger.place)
    if linkage.signs:
        yield "# The velocities of these ends, while an axis moves by one radian, or one unit of length, per second."
        for k, hanger in zip(numbers, linkage.hangers, strict=True):
            yield from _vector(f"WAY_{k}", hanger.way)
        rods = ", ".join(f"minus(TCP, {_end(linkage, k)})" for k in numbers)
        yield f"{_rods(linkage)} = {rods}"


def _vector(name: str, entries: Vector) -> list[str]:
    texts = [re.sub(r"(\.\d+?)0+\b", r"\1", str(entry)) for entry in entries]
    line = f"{name} = vector({', '.join(texts)})"
    return [line] if len(line) <= WIDTH else [f"{name} = vector(", *(f"    {text}," for text in texts), ")"]


def _end(linkage: Linkage, k: int) -> str:
    return f"{_WORDS[linkage.robot.axes[k - 1].kind][0].upper()}_{k}"


def _rods(linkage: Linkage) -> str:
    return ", ".join(f"ROD_{k}" for k in range(1, len(linkage.hangers) + 1))


def _mechanism(linkage: Linkage) -> Iterator[str]:
    yield from head_lines(linkage.robot, linkage.description)
    yield "    rods=("
    for k, size in enumerate(linkage.lengths, 1):
        yield f'        rod("{k}", {_end(linkage, k)}, TCP, {size.variable}),'
    yield "    ),"
    yield f'    task=Task("{linkage.position}"),'
    if linkage.signs:
        yield from _branches(linkage, linkage.signs)
    yield "    offset_interface=False,"
    yield ")"


def _branches(linkage: Linkage, signs: Sequence[int]) -> Iterator[str]:
    """Branches whose first name is the side on which the file draws the machine."""
    yield "    branches=("
    for k, (axis, sign) in enumerate(zip(linkage.robot.axes, signs[:-1], strict=True), 1):
        word, margin = _WORDS[axis.kind]
        sides = f"drawn={sign:+d}, other={-sign:+d}"
        yield f'        branch("{word}_{k}", dot(WAY_{k}, ROD_{k}), margin="{margin}_{k}", {sides}),'
    yield "    ),"
    in_plane = linkage.rods.plane is not None
    product = f"cross({_rods(linkage)})" if in_plane else f"triple(({_rods(linkage)}))"
    margin = "rods_aligned" if in_plane else "rods_coplanar"
    yield f'    assembly=assembly("tcp", {product}, margin="{margin}", drawn={signs[-1]:+d}, other={-signs[-1]:+d}),'


def rods_report(linkage: Linkage, unit: str) -> Iterator[str]:
    """The head of the report: axes, task, branches and rods."""
    robot, description = linkage.robot, linkage.description
    yield f"{description.name}: {robot.base} to {robot.tip} of {robot.source}, lengths in {unit}."
    pairs = [f"{own} is {axis.name}" for own, axis in zip(description.axes, robot.axes, strict=True)]
    yield f"Axes: {', '.join(pairs)}."
    yield f"Task: {', '.join(linkage.position)}; no rotation."
    if linkage.signs:
        names = [f"{_WORDS[axis.kind][0]}_{k}" for k, axis in enumerate(robot.axes, 1)]
        yield f"Branches: {', '.join(names)}, and assembly modes (tcp); the first side of each is that of the file."
    else:
        why = "draws the rods apart" if linkage.rods.drawn is None else "draws a singular pose"
        yield f"Branches: none is named, because the file {why}; the derivation names its own."
    for k, (arm, size, axis) in enumerate(zip(linkage.rods.arms, linkage.lengths, description.axes, strict=True), 1):
        yield f"Rod {k} is {arm.rod}, from what {axis} moves to the tip: {size.value:.6g} {unit}."
