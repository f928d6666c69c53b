"""Rods that meet in the tip, as a description: the places where they hang, in the axes, and their lengths."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import sympy as sp

from derive.description.joints import Kind
from derive.geometry.frames import Motion
from derive.geometry.vectors import Vector, dot, minus, triple
from derive.importing.arms.lines import ROUNDING, Arm, arm_of, projected
from derive.importing.arms.pieces import Piece, simple, turns
from derive.importing.arms.rounded import snapped_robot
from derive.importing.arms.snapping import SNAP, Snapped
from derive.importing.expressions import Dimension, amount_text, clean, dimension_of
from derive.importing.naming import LETTERS, axis_names, block_name
from derive.importing.report import Bounds, bounds
from derive.importing.robot import Array, Robot, Rods, UnreadableRobot
from derive.importing.writing import (
    WIDTH,
    Description,
    axis_line,
    dimension_line,
    distinct,
    docstring,
    head_lines,
    import_lines,
)

_SMALL = 1e-9
"""An indicator that is less, as a share of its lengths, tells no branches apart."""


@dataclass(frozen=True)
class Hanger:
    """The place where a rod hangs, as vector of expressions in its axis, and its dimensions."""

    axis: sp.Symbol
    place: Vector
    at_zero: float
    """The value of the axis as the file draws it."""
    dimensions: tuple[Dimension, ...]
    moved: tuple[Snapped, ...]
    bounds: Bounds

    @property
    def way(self) -> Vector:
        """The direction in which the axis moves that place, as long as it moves it."""
        return tuple(sp.diff(entry, self.axis) for entry in self.place)


@dataclass(frozen=True)
class Linkage:
    """Rods with their hangers, and the description of them."""

    robot: Robot
    rods: Rods
    description: Description
    hangers: tuple[Hanger, ...]
    lengths: tuple[Dimension, ...]

    @property
    def position(self) -> str:
        """The coordinates of the tip that the rods decide."""
        return "".join(c for k, c in enumerate(LETTERS) if k != self.rods.plane)

    @property
    def tip(self) -> Vector:
        """The tip as the description writes it."""
        return tuple(sp.Symbol(c.upper(), real=True) for c in self.position)

    @property
    def signs(self) -> tuple[int, ...]:
        """The signs of dot(way, rod) of each rod, then of the product of all rods, as the file draws them. None where
        it draws the rods apart, or where one of them is zero.
        """
        if self.rods.drawn is None:
            return ()
        rods = [minus(self.tip, h.place) for h in self.hangers]
        drawn = [value for k, value in enumerate(self.rods.drawn) if k != self.rods.plane]
        known = dict(zip(self.tip, drawn, strict=True)) | {h.axis: h.at_zero for h in self.hangers}
        known |= {sp.Symbol(d.variable, positive=True): d.value for d in self.description.dimensions}
        known |= {
            sp.Symbol(f"radians({d.variable})", real=True): np.radians(d.value)
            for d in self.description.dimensions
            if d.is_angle
        }
        pairs = [*((h.way, rod) for h, rod in zip(self.hangers, rods, strict=True)), rods]
        size = [sp.prod(sp.sqrt(dot(v, v)) for v in vectors) for vectors in pairs]
        shares = [
            float((found / scale).xreplace(known))
            for found, scale in zip([*(dot(*pair) for pair in pairs[:-1]), triple(rods)], size, strict=True)
        ]
        return tuple(int(np.sign(s)) for s in shares) if min(map(abs, shares)) > _SMALL else ()


def linkage(robot: Robot, rods: Rods, snap: float) -> Linkage:
    """The description of rods. snap: as for a chain, a share of the size of an arm, and of one radian."""
    axes = axis_names(robot)
    hangers = tuple(_hanger(robot, rods, number, axes[number], snap) for number in range(len(axes)))
    lengths = tuple(
        Dimension(f"rod_length_{k}", f"Rod {k}, {arm.rod}", clean(arm.length, arm.length), False)
        for k, arm in enumerate(rods.arms, 1)
    )
    dimensions = (*(d for h in hangers for d in h.dimensions), *lengths)
    return Linkage(robot, rods, Description(block_name(robot), axes, dimensions, (), ()), hangers, lengths)


def _hanger(robot: Robot, rods: Rods, number: int, name: str, snap: float) -> Hanger:
    axis, rod = robot.axes[number], rods.arms[number]
    one = replace(robot, steps=rod.steps, axes=(axis,), rods=None)
    put_back, rounded = snapped_robot(one, snap)
    raw, stated = arm_of(one), arm_of(put_back)
    arm = _placed(stated, rods.plane)
    off = float(np.linalg.norm(arm.lines[0].direction - stated.lines[0].direction))
    if off > max(stated.limit(0, snap), SNAP):
        raise UnreadableRobot(f"{axis.name!r} is not parallel to the other joints of its loop, by {off:.2g} (--snap)")
    chain = simple(arm, (name,), snap, about_z=False)
    squared = (Snapped(f"{name}: read as parallel to the other joints, off", off, True),) if off > ROUNDING else ()
    moved = (*rounded, *squared, *chain.moved)
    place, dimensions = _place(chain.pieces, number + 1, name, arm.size)
    place = tuple(entry for k, entry in enumerate(place) if k != rods.plane)
    if not any(entry.has(_real(name)) for entry in place):
        raise UnreadableRobot(f"rod {rod.rod!r} hangs on the axis of {axis.name!r}, which does not move its end")
    at_zero = -next(s.moving.offset for s in put_back.steps if s.moving is not None)
    return Hanger(_real(name), place, at_zero, dimensions, moved, bounds(moved, raw, 0.0))


def _placed(arm: Arm, plane: int | None) -> Arm:
    """The arm without heights above a plane, and with x of its end along the arm: its orientation means nothing."""
    line, tip = arm.lines[0], arm.tip.copy()
    if plane is not None:
        kept = np.arange(3) != plane
        tip[:3, 3] *= kept
        line = replace(line, point=line.point * kept, direction=_square(line.direction, plane, line.kind))
    reach = tip[:3, 3] - projected(line, tip[:3, 3])
    length = float(np.linalg.norm(reach))
    tip[:3, :3] = np.eye(3)
    if line.kind is Kind.ROTARY and length > _SMALL * arm.size:
        tip[:3, :3] = np.column_stack([reach / length, np.cross(line.direction, reach / length), line.direction])
    return replace(arm, lines=(line,), tip=tip)


def _square(direction: Array, plane: int, kind: Kind) -> Array:
    """The direction of a joint, exactly along the normal of the plane, or square to it."""
    along = np.arange(3) == plane
    exact = direction * (along if kind is Kind.ROTARY else ~along)
    return np.asarray(exact / np.linalg.norm(exact))


def _place(pieces: Sequence[Piece], number: int, axis: str, size: float) -> tuple[Vector, tuple[Dimension, ...]]:
    """The end of a chain, in its axis and its dimensions."""
    dimensions = distinct([_dimension(pieces, k, number, axis, size) for k in range(len(pieces))])
    place, turned = sp.zeros(3, 1), sp.eye(3)
    for piece, dimension in zip(pieces, dimensions, strict=True):
        amount = _amount(piece, axis, dimension)
        i, j = (piece.letter + 1) % 3, (piece.letter + 2) % 3
        if piece.motion is Motion.SHIFT:
            place += turned[:, piece.letter] * amount
        else:
            first, second = turned[:, i], turned[:, j]
            turned[:, i] = sp.cos(amount) * first + sp.sin(amount) * second
            turned[:, j] = sp.cos(amount) * second - sp.sin(amount) * first
    entries = tuple(sp.expand(entry) for entry in place)
    used = {str(s) for entry in entries for s in entry.free_symbols}
    return entries, tuple(d for d in dimensions if d is not None and used & {d.variable, f"radians({d.variable})"})


def _dimension(pieces: Sequence[Piece], at: int, number: int, axis: str, size: float) -> Dimension | None:
    """The parameter of a piece, named by what it is: the place of an axis, the length of its arm."""
    piece, letter = pieces[at], LETTERS[pieces[at].letter]
    plain = dimension_of(piece, turns(pieces, [axis]), size)
    if plain is None:
        return None
    is_turned = any(p.motion is Motion.TURN for p in pieces[:at])
    along = f"{'about ' if plain.is_angle else 'along -' if piece.constant < 0.0 else 'along '}{letter}"
    if plain.is_angle:
        word = "arm_angle" if piece.drives else f"base_turn_{letter}"
        meaning = f"Arm {axis} at zero, {along}" if piece.drives else f"Frame of axis {axis}, turned {along}"
    elif piece.place == 0:
        word, meaning = f"base_{letter}", f"Base to axis {axis}, {along}{' of its turned frame' if is_turned else ''}"
    elif piece.letter != next(p.letter for p in pieces if p.motion is Motion.TURN and p.drives):
        word, meaning = "arm_length", f"Arm {axis}, to the rod"
    else:
        word, meaning = f"arm_{letter}", f"Arm {axis}, {along} of its axis"
    return replace(plain, name=f"{word}_{number}", meaning=meaning)


def _amount(piece: Piece, axis: str, dimension: Dimension | None) -> sp.Expr:
    known: dict[str, object] = {axis: _real(axis), "pi": sp.pi, "radians": lambda a: _real(f"radians({a})")}
    if dimension is not None:
        known[dimension.variable] = sp.Symbol(dimension.variable, positive=True)
    return sp.sympify(amount_text(piece, (axis,), dimension), locals=known)


def _real(name: str) -> sp.Symbol:
    return sp.Symbol(name, real=True)


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
