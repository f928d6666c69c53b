"""The drawn parts of a machine at any pose: a program computes numbers, and the parts say what each number means.

For a chain these are the amounts of its factors. For a loop they are points and directions, from the equations of the
ends of its bars, as in `loop`: the circle of a crank by its centre and an end, the line of a rail by its direction.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
import sympy as sp

from derive.description.mechanism import DescriptionError, Joint, Mechanism, X, Y, Z
from derive.drawing.belts import layout_of
from derive.drawing.loop import bars_of, is_held_by_parallelograms
from derive.drawing.pins import pins_of
from derive.equations.axes import joint_lets
from derive.equations.choices import with_choices
from derive.geometry.frames import Chain
from derive.geometry.pose import pose_of
from derive.ir.passes import normalise
from derive.ir.program import Output, Program
from derive.kinematics.kinematics import Kinematics

_TCP: tuple[sp.Expr, ...] = (X.symbol, Y.symbol, Z.symbol)
Entries = tuple[sp.Expr, ...]


@dataclass(frozen=True)
class Parts:
    """The parts of a machine."""

    program: Program
    """axis_*, x y z, r11 … r33 → its outputs, all numbers."""
    names: tuple[tuple[str, ...], ...]
    """The outputs: for a chain the amount of every factor and its derivative by its last joint, for a loop the
    coordinates of every vector."""
    shape: dict[str, Any]
    """Plain data; a whole number is the place of an amount or of a vector in `names`."""


def parts_of(kinematics: Kinematics) -> Parts:
    """The parts. Raises `DescriptionError` if nothing that is drawn moves with a joint."""
    mechanism = kinematics.mechanism
    values = _Values()
    shape = _chain(mechanism, values) if mechanism.chain is not None else _loop(mechanism, values)
    return _named(kinematics, values, shape)


def _named(kinematics: Kinematics, values: _Values, shape: dict[str, Any]) -> Parts:
    """The parts, with a program that computes the values."""
    names = tuple(tuple(f"part_{i}_{k}" for k in range(len(value))) for i, value in enumerate(values.found))
    outputs = [
        Output(name, sp.sympify(entry))
        for row, value in zip(names, values.found, strict=True)
        for name, entry in zip(row, value, strict=True)
    ]
    program = normalise("parts", joint_lets(kinematics.mechanism), outputs)
    return Parts(with_choices(program, kinematics.parameters), names, shape)


def links_of(kinematics: Kinematics) -> Parts:
    """The links of a chain whose joints loops move, with levers and rods: every line is a rod of the shape."""
    values, drawn = _Values(), _chain(kinematics.mechanism, pins := _Values())
    chain = kinematics.mechanism.drawn or kinematics.mechanism.chain
    assert chain is not None
    poses = [pose_of(Chain(chain.factors[:k])) for k in range(len(chain.factors) + 1)]
    rods = []

    def line(start: Sequence[sp.Expr], end: Sequence[sp.Expr], joints: Sequence[str]) -> None:
        rods.append({"start": values.point(start), "end": values.point(end), "joints": joints})

    for factor, before, behind in zip(drawn["factors"], poses, poses[1:], strict=False):
        line(before.position, behind.position, factor["joints"])
    for loop in drawn.get("loops", ()):
        here = poses[loop["at"]]
        ends = [[here.position + here.rotation * sp.Matrix(pins.found[k]) for k in loop[w]] for w in ("start", "tip")]
        for points in ends:
            for start, end in zip(points, points[1:], strict=False):
                line(start, end, ())
        line(ends[0][-1], ends[1][-1], loop["joints"])
    shape = {"rods": rods, "cranks": [], "rails": [], "carried": [], "plate": []}
    return _named(kinematics, values, shape)


Line: TypeAlias = tuple[int, int, str]
"""The places of its ends, and the axes that drive it; the place of the tool is -1."""


def wire_frame_of(kinematics: Kinematics) -> tuple[Parts, tuple[Line, ...]]:
    """The points of a machine at any pose, and the lines between them: the links of a chain, or the parts of a loop.

    Raises `DescriptionError` if nothing that is drawn moves with a joint.
    """
    parts = (parts_of if kinematics.mechanism.chain is None else links_of)(kinematics)
    return parts, tuple(line for line in lines_of(parts.shape) if line[0] != line[1])


def lines_of(shape: Mapping[str, Any]) -> tuple[Line, ...]:
    """The lines of a loop: arms (a point for one that bars draw), ways of carriages, rods, and the plate as a star."""
    cranks = shape["cranks"]
    arms = [(c["centre"], end if c["isHeld"] else c["centre"], c["joint"]) for c in cranks for end in c["ends"]]
    ways = [(rail["origin"], rail["at"], rail["joint"]) for rail in shape["rails"]]
    rods = [(rod["start"], rod["end"], " ".join(rod["joints"])) for rod in shape["rods"]]
    carried = " ".join(part["joint"] for part in shape["carried"])
    return (*arms, *ways, *rods, *((place, -1, carried) for place in shape["plate"]))


@dataclass
class _Values:
    """Values, each with its place."""

    found: list[Entries] = field(default_factory=list)

    def place(self, entries: Sequence[sp.Expr]) -> int:
        """The place of a value; equal ones have the same."""
        value = tuple(entries)
        if value not in self.found:
            self.found.append(value)
        return self.found.index(value)

    def point(self, entries: Sequence[sp.Expr]) -> int:
        """The place of a vector; one in the plane lies at z = 0."""
        return self.place((*entries, *[sp.Integer(0)] * (3 - len(entries))))


def _chain(mechanism: Mechanism, values: _Values) -> dict[str, Any]:
    chain = mechanism.drawn or mechanism.chain
    assert chain is not None
    factors = []
    for factor in chain.factors:
        moving = [j for j in mechanism.joints if j.symbol in factor.amount.free_symbols]
        rate = sp.diff(factor.amount, moving[-1].symbol) if moving else sp.Integer(1)
        names, at = [j.name for j in moving], values.place((factor.amount, rate))
        factors.append({"motion": factor.motion.value, "axis": factor.axis, "joints": names, "amount": at})
    shape: dict[str, Any] = {"kind": "chain", "factors": factors}
    loops = [part for joint in mechanism.joints for part in _loops_of(joint, factors, values)]
    return shape | ({"loops": loops} if loops else {}) | ({"belt": _belt(mechanism, chain)} if mechanism.belt else {})


def _belt(mechanism: Mechanism, chain: Chain) -> dict[str, Any]:
    """The layout of the belt, and the numbers of the two factors that its drives share."""
    assert mechanism.belt is not None
    drives = {j.name: j.symbol for j in mechanism.joints}
    shared = [k for k, f in enumerate(chain.factors) if len(f.amount.free_symbols & {*drives.values()}) > 1][:2]
    nominal = {p.symbol: p.nominal for p in mechanism.parameters}
    slopes = {
        name: np.array([float(sp.diff(chain.factors[k].amount, drive).xreplace(nominal)) for k in shared])
        for name, drive in drives.items()
    }
    return layout_of(mechanism.belt, {name: way for name, way in slopes.items() if way.any()}) | {"slides": shared}


def _loops_of(joint: Joint, factors: Sequence[Mapping[str, Any]], values: _Values) -> Iterator[dict[str, Any]]:
    """The cylinder, or the crank with its rod, and the lever of every loop that moves a joint.

    "at" is the number of the factor in front of which the loop stands, "start" and "tip" are its pins.
    """
    for number, loop in enumerate(joint.loops):
        beside = next(set(f["joints"]) for f in factors if joint.name in f["joints"])
        at = next(k for k, f in enumerate(factors) if beside & set(f["joints"]))
        pins = {"start": pins_of(loop.start), "tip": pins_of(loop.tip)}
        named = {word: [values.point(p) for p in some] for word, some in pins.items()}
        driven = joint.name if number == 0 and not loop.turns[1] else ""
        said = {"name": f"rod of {loop.name}", "joints": [joint.name], "at": at, "cylinder": driven}
        yield said | named | {"isFirst": number == 0}


def _loop(mechanism: Mechanism, values: _Values) -> dict[str, Any]:
    bars, joints = bars_of(mechanism), {j.symbol for j in mechanism.joints}
    rods: list[dict[str, Any]] = []
    for bar in bars:
        drives = [j.name for j in mechanism.joints if j.symbol in bar.length.free_symbols]
        ends = {"start": values.point(bar.base), "end": values.point(bar.plate)}
        rods.append({"name": bar.name, **ends, "joints": drives, "isCable": bar.only_pulls})
    held: list[int] = []
    shape: dict[str, Any] = {
        "kind": "loop", "isParallel": is_held_by_parallelograms(mechanism), "rods": rods, "cranks": [], "rails": [],
        "carried": [],
    }  # fmt: skip
    for joint in mechanism.joints:
        if any(joint.symbol in bar.length.free_symbols for bar in bars):
            continue
        kind, part = _driven(mechanism, joint, values, held)
        shape[kind].append(part)
    plate = [bar.plate for bar in bars if _is_on_plate(bar.plate, joints)]
    held += [values.point(b.base) for b in bars if not sp.Matrix(b.base).free_symbols & (joints | set(_TCP))]
    return shape | {"plate": [values.point(p) for p in dict.fromkeys(plate)], "base": list(dict.fromkeys(held))}


def _is_on_plate(entries: Entries, joints: set[sp.Basic]) -> bool:
    """Whether an end moves with the pose alone."""
    symbols = sp.Matrix(entries).free_symbols
    return bool(symbols & set(_TCP)) and not symbols & joints


def _driven(mechanism: Mechanism, joint: Joint, values: _Values, held: list[int]) -> tuple[str, dict[str, Any]]:
    """The crank or rail by which a joint moves the ends of bars, or its motion of the tool."""
    ends, is_held = _moved_by(mechanism, joint)
    if not ends:
        return "carried", {"joint": joint.name, **_carried(mechanism, joint)}
    if not joint.is_angle:
        rate = values.point([sp.diff(e, joint.symbol) for e in ends[0]])
        origin = values.point([e.xreplace({joint.symbol: sp.Integer(0)}) for e in ends[0]])
        held.append(origin)
        found = {"joint": joint.name, "at": values.point(ends[0]), "direction": rate, "origin": origin}
        return "rails", found
    centres, quarters = [_centre(joint, e) for e in ends], [_turned(joint, e, sp.pi / 2) for e in ends]
    centre = tuple(sp.Add(*column) / len(ends) for column in zip(*centres, strict=True))
    if is_held:
        held.append(values.point(centre))
    return "cranks", {
        "joint": joint.name,
        "isHeld": is_held,
        "centre": values.point(centre),
        "ends": [values.point(e) for e in ends],
        "quarter": values.point(quarters[0]),
        "around": values.point(centres[0]),
        "foot": values.point(centre if is_held else next(b.base for b in bars_of(mechanism) if b.plate == ends[0])),
    }


def _moved_by(mechanism: Mechanism, joint: Joint) -> tuple[list[Entries], bool]:
    """The ends of bars that a joint moves, and whether a crank holds them: base ends, else the first plate end."""
    bars = bars_of(mechanism)
    based = [b.base for b in bars if joint.symbol in sp.Matrix(b.base).free_symbols]
    on_plate = [b.plate for b in bars if joint.symbol in sp.Matrix(b.plate).free_symbols]
    first = next((b for b in bars if joint.symbol in sp.Matrix([*b.base, *b.plate]).free_symbols), None)
    return (based, True) if first is not None and first.base in based else (on_plate[:1], False)


def _carried(mechanism: Mechanism, joint: Joint) -> dict[str, Any]:
    """A joint that moves no bar: it turns the tool about z, or shifts it by a stated equation."""
    rate = sp.sympify(mechanism.heading or 0).coeff(joint.symbol)
    if rate != 0:
        return {"kind": "turn", "axis": [0, 0, float(rate)]}
    for equation in mechanism.closure:
        slides = [j for j in mechanism.joints if not j.is_angle and j.symbol in equation.free_symbols]
        moved = [c for c in _TCP if c in equation.free_symbols]
        slopes = [-sp.diff(equation, joint.symbol) / sp.diff(equation, c) for c in moved]
        if slides == [joint] and slopes and all(s.is_number for s in slopes):
            known = dict(zip(moved, slopes, strict=True))
            return {"kind": "slide", "axis": [float(known.get(c, 0)) for c in _TCP]}
    raise DescriptionError(f"nothing that is drawn moves with joint {joint.name!r}: name its bars")


def _turned(joint: Joint, entries: Entries, angle: sp.Expr) -> Entries:
    return tuple(e.xreplace({joint.symbol: joint.symbol + angle}) for e in entries)


def _centre(joint: Joint, entries: Entries) -> Entries:
    """The centre of the circle on which a joint moves a point."""
    return tuple((e + o) / 2 for e, o in zip(entries, _turned(joint, entries, sp.pi), strict=True))
