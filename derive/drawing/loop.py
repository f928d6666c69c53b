"""The scene of a closed loop: its bars, and the cranks, rails and legs that follow from the equations of their ends.

An end of a bar that depends on a rotary joint moves on a circle: the centre is the joint, and the radius is the crank.
An end that depends on a linear joint moves on a line, the rail. A bar whose length is a joint is a leg of variable
length.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import sympy as sp

from derive.description.mechanism import ROTATION, DescriptionError, Joint, Mechanism, Rod, X, Y, Z
from derive.drawing.labels import Naming, Values, axis_name, vector_at
from derive.drawing.scene import Arc, Body, Dimension, Frame, Point, Scene, Segment, Slide, Spot, Turn, point
from derive.ir.interpret import Array, evaluate
from derive.kept import kept_by_identity

_EXACT, _ROUNDED = 1e-7, 1e-6
"""The tolerance of lengths, as a share of them, and the error from six decimals of the drawn frame, which counts for a
machine in metres."""
_HALF_WIDTH = 0.06
"""Half of the drawn width of a parallelogram over the length of its rods."""
_TCP = (X.symbol, Y.symbol, Z.symbol)

Entries = tuple[sp.Expr, ...]


def bars_of(mechanism: Mechanism) -> tuple[Rod, ...]:
    """The bars that are drawn: those of the description, else its rods."""
    return mechanism.bars or tuple(replace(r, plate=r.end, ring=None) if r.ring else r for r in mechanism.rods)


@kept_by_identity(10)
def is_held_by_parallelograms(mechanism: Mechanism) -> bool:
    """Whether three rods, each on a drive of its own, hold a plate in space that keeps its orientation: every rod then
    stands for a parallelogram.
    """
    drives = {j.symbol for j in mechanism.joints}
    rods = [sp.Matrix([*b.base, *b.plate]).free_symbols for b in bars_of(mechanism)]
    own = [drives & sp.Matrix(b.base).free_symbols for b in bars_of(mechanism)]
    return (
        mechanism.task.position == "xyz"
        and len(rods) == 3
        and all(set(_TCP) <= read and not read & set(ROTATION) for read in rods)
        and all(len(one) == 1 for one in own)
        and len(set().union(*own)) == 3
    )


def loop_scene(mechanism: Mechanism, values: Values, tool: Frame) -> Scene:
    """The scene at one pose; `values` has parameters, joint values and the pose of the plate by name."""
    builder = _Builder(mechanism, values, Naming(mechanism, values))
    for bar in bars_of(mechanism):
        builder.bar(bar)
    for joint in mechanism.joints:
        builder.joint(joint)
    builder.plate()
    builder.base()
    return Scene(
        tuple(builder.segments),
        tuple(builder.turns),
        tuple(builder.slides),
        tuple(builder.dimensions),
        tuple(builder.spots),
        tuple(point(g) for g in builder.grounds),
        tool,
        tuple(builder.hidden),
        tuple(builder.arcs),
    )


@dataclass
class _Builder:
    mechanism: Mechanism
    values: Values
    naming: Naming
    segments: list[Segment] = field(default_factory=list)
    turns: list[Turn] = field(default_factory=list)
    slides: list[Slide] = field(default_factory=list)
    dimensions: list[Dimension] = field(default_factory=list)
    spots: list[Spot] = field(default_factory=list)
    hidden: list[sp.Expr] = field(default_factory=list)
    arcs: list[Arc] = field(default_factory=list)
    grounds: list[Array] = field(default_factory=list)
    _held: list[tuple[Entries, Array]] = field(default_factory=list)
    """The fixed points: grounds, and the beginnings of rails."""

    def bar(self, bar: Rod) -> None:
        """A bar between its ends. It must have the length that the description states."""
        start, end = vector_at(bar.base, self.values), vector_at(bar.plate, self.values)
        stated, drawn = float(evaluate(bar.length, self.values)), float(np.linalg.norm(end - start))
        if abs(stated - drawn) > _ROUNDED + _EXACT * max(abs(stated), drawn):
            raise DescriptionError(
                f"bar {bar.name!r} is {stated:g} long, but its ends are {drawn:g} apart in the drawn pose"
            )
        self.segments.append(Segment(point(start), point(end), Body.ROD, self._across(bar, start, end)))
        if not bar.length.free_symbols & self._joints():
            self._dimension(start, end, lambda v: float(evaluate(bar.length, v)))

    def _across(self, bar: Rod, start: Array, end: Array) -> Point | None:
        """Half of the width of the parallelogram that a rod stands for, where such rods hold a plate that does not
        turn: along the axis of the crank, or horizontal and at right angles to the rod's rail.
        """
        if not is_held_by_parallelograms(self.mechanism):
            return None
        (joint,) = [j for j in self.mechanism.joints if j.symbol in sp.Matrix(bar.base).free_symbols]
        if joint.is_angle:
            axis = _circle(joint, bar.base, self.values)[2]
        else:
            here, there = (vector_at(bar.base, {**self.values, joint.symbol.name: np.asarray(v)}) for v in (0.0, 1.0))
            axis = np.cross(there - here, end - start)
        joint_radius = float(np.linalg.norm(end - vector_at(_TCP, self.values)))
        half = _HALF_WIDTH * float(np.linalg.norm(end - start))
        return point(axis / np.linalg.norm(axis) * (min(half, 0.7 * joint_radius) if joint_radius > _EXACT else half))

    def joint(self, joint: Joint) -> None:
        """The crank, rail or leg by which a joint moves the ends of bars."""
        for bar in bars_of(self.mechanism):
            if joint.symbol in bar.length.free_symbols:
                start, end = vector_at(bar.base, self.values), vector_at(bar.plate, self.values)
                axis = (end - start) / np.linalg.norm(end - start)
                self.slides.append(Slide(axis_name(joint), point((start + end) / 2), point(axis), has_rail=False))
                return
        if not any(joint.symbol in sp.Matrix([*b.base, *b.plate]).free_symbols for b in bars_of(self.mechanism)):
            self._carried(joint)
            return
        ends = self._moved_by(joint)
        if joint.is_angle:
            self._crank(joint, ends)
        else:
            self._rail(joint, ends)

    def _carried(self, joint: Joint) -> None:
        """A joint that moves no bar: it turns the tool about z, or shifts it by a stated equation."""
        tool = point(vector_at(_TCP, self.values))
        heading = sp.sympify(self.mechanism.heading or 0)
        for equation in self.mechanism.closure:
            slides = [j for j in self.mechanism.joints if not j.is_angle and j.symbol in equation.free_symbols]
            shift = np.array([_rate(equation, joint, c, self.values) for c in _TCP])
            if slides == [joint] and np.any(shift):
                self.slides.append(Slide(axis_name(joint), tool, point(shift / np.linalg.norm(shift))))
                return
        if joint.symbol not in heading.free_symbols:
            raise DescriptionError(f"nothing that is drawn moves with joint {joint.name!r}: name its bars")
        self.turns.append(Turn(axis_name(joint), tool, (0.0, 0.0, float(heading.coeff(joint.symbol)))))

    def _moved_by(self, joint: Joint) -> list[tuple[Entries, bool]]:
        """The ends of bars that depend on the joint, and whether a crank holds them: base ends, else the first plate
        end.
        """
        bars = bars_of(self.mechanism)
        for bar in bars:
            if joint.symbol in sp.Matrix(bar.base).free_symbols:
                return [(b.base, True) for b in bars if joint.symbol in sp.Matrix(b.base).free_symbols]
            if joint.symbol in sp.Matrix(bar.plate).free_symbols:
                return [(bar.plate, False)]
        raise DescriptionError(f"nothing that is drawn moves with joint {joint.name!r}: name its bars")

    def _rail(self, joint: Joint, ends: list[tuple[Entries, bool]]) -> None:
        (entries, _), *_ = ends
        here, there = (vector_at(entries, {**self.values, joint.symbol.name: np.asarray(v)}) for v in (0.0, 1.0))
        self.slides.append(Slide(axis_name(joint), point(vector_at(entries, self.values)), point(there - here)))
        rate = tuple(sp.diff(e, joint.symbol) for e in _padded(entries))
        steep = np.array([0.0, 0.0, np.sign(there[2] - here[2])])
        self._angle(lambda v: float(np.degrees(np.arccos(abs(vector_at(rate, v)[2])))), here, steep, there - here)
        self._hold(tuple(e.xreplace({joint.symbol: sp.Integer(0)}) for e in entries), is_ground=False)

    def _crank(self, joint: Joint, ends: list[tuple[Entries, bool]]) -> None:
        """The crank, from the centre of the circle to the middle between the ends, and the cross
        bar that joins these.
        """
        circles = [_circle(joint, entries, self.values) for entries, _ in ends]
        centre = np.mean([c for c, _, _ in circles], axis=0)
        arm = np.mean([a for _, a, _ in circles], axis=0)
        axis = circles[0][2]
        at_zero = _circle(joint, ends[0][0], {**self.values, joint.symbol.name: np.asarray(0.0)})[1]
        moved = abs(float(self.values[joint.symbol.name])) > _EXACT
        entries, on_crank = ends[0]
        if not on_crank:
            centre = self._on_axis(centre, axis, entries)
        zero = point(at_zero) if moved else None
        self.turns.append(Turn(axis_name(joint), point(centre), point(axis), point(arm), zero))
        if on_crank:
            self.segments.append(Segment(point(centre), point(centre + arm), Body.LINK))
            self._dimension(centre, centre + arm, lambda v: float(np.linalg.norm(_circle(joint, entries, v)[1])))
            self._hold(_centre_of(joint, [e for e, _ in ends]))
        if len(ends) > 1:
            self._cross_bar([e for e, _ in ends])

    def _on_axis(self, centre: Array, axis: Array, entries: Entries) -> Array:
        """The foot on the axis of the other end of the bar."""
        other = next(vector_at(b.base, self.values) for b in bars_of(self.mechanism) if b.plate == entries)
        return np.asarray(centre + ((other - centre) @ axis) * axis)

    def _cross_bar(self, ends: Sequence[Entries]) -> None:
        first, last = (vector_at(e, self.values) for e in (ends[0], ends[-1]))
        self.segments.append(Segment(point(first), point(last), Body.LINK))
        apart = tuple(b - a for a, b in zip(ends[0], ends[-1], strict=True))
        self._dimension(first, last, lambda v: float(np.linalg.norm(vector_at(apart, v))))

    def plate(self) -> None:
        """The plate: from the TCP to the ends of bars that move with the pose alone."""
        ends: dict[tuple[float, ...], Entries] = {}
        for bar in bars_of(self.mechanism):
            symbols = sp.Matrix(bar.plate).free_symbols
            if symbols & set(_TCP) and not symbols & self._joints():
                ends.setdefault(tuple(np.round(vector_at(bar.plate, self.values), 6)), bar.plate)
        tcp = vector_at(_TCP, self.values)
        points = [vector_at(e, self.values) for e in ends.values()]
        for entries, at in zip(ends.values(), points, strict=True):
            offset = _padded(tuple(e - c for e, c in zip(_unturned(entries), _TCP, strict=False)))
            self._given(offset, tcp, at)
        if len(points) > 1:
            around = points if len(points) > 2 else points[:1]
            pairs = zip(around, (*points[1:], points[0]), strict=False)
            self.segments += [Segment(point(a), point(b), Body.PLATE) for a, b in pairs]
        self.segments += [Segment(point(tcp), point(p), Body.PLATE) for p in points if np.linalg.norm(p - tcp) > _EXACT]

    def base(self) -> None:
        """The fixed points: centres of cranks, beginnings of rails, fixed ends of bars."""
        for bar in bars_of(self.mechanism):
            if not sp.Matrix(bar.base).free_symbols & (self._joints() | set(_TCP)):
                self._hold(bar.base)
        for entries, at in self._held:
            self._given(_padded(entries), np.zeros(3), at)
            self._azimuth(_padded(entries), at)
        points = [at for _, at in self._held]
        if len(points) > 2 or len(self.grounds) > 1:
            pairs = list(zip(points, (*points[1:], points[0]), strict=True))
            self.segments += [
                Segment(point(a), point(b), Body.BASE) for a, b in pairs[: len(points) if len(points) > 2 else 1]
            ]

    def _azimuth(self, entries: Entries, at: Array) -> None:
        """The polar angle of a point, from X."""

        def azimuth(values: Values) -> float:
            x, y, _ = vector_at(entries, values)
            return float(np.degrees(np.arctan2(y, x)))

        if np.linalg.norm(at[:2]) > _EXACT:
            self._angle(azimuth, np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([at[0], at[1], 0.0]))

    def _angle(self, measure: Callable[[Values], float], at: Array, start: Array, end: Array) -> None:
        name = self.naming.angle(measure)
        if name is None or any(arc.label == name for arc in self.arcs):
            return
        if np.linalg.norm(end / np.linalg.norm(end) - start) <= _EXACT:
            self.hidden.append(name)
        else:
            self.arcs.append(Arc(name, point(at), point(start), point(end / np.linalg.norm(end))))

    def _hold(self, entries: Entries, *, is_ground: bool = True) -> None:
        at = vector_at(entries, self.values)
        if not any(np.linalg.norm(at - other) < _EXACT for _, other in self._held):
            self._held.append((entries, at))
            self.grounds += [at] if is_ground else []

    def _given(self, offset: Entries, start: Array, end: Array) -> None:
        """The dimensions of a point seen from another: one length, two at a right angle, or coordinates."""
        if self._dimension(start, end, lambda v: float(np.linalg.norm(vector_at(offset, v)))):
            return
        corner = np.array([end[0], end[1], start[2]])
        level = np.array([start[0], start[1], end[2]])
        if self._dimension(level, end, lambda v: float(np.linalg.norm(vector_at(offset, v)[:2]))):
            self._dimension(start, level, lambda v: float(vector_at(offset, v)[2]))
            return
        entries = [lambda v, i=i: float(vector_at(offset, v)[i]) for i in range(3)]
        names = self.naming.coordinates(entries)
        if names is not None:
            self.spots.append(Spot(names, point(end)))
        elif self._dimension(start, corner, lambda v: float(np.linalg.norm(vector_at(offset, v)[:2]))):
            self._dimension(corner, end, lambda v: float(vector_at(offset, v)[2]))

    def _dimension(self, start: Array, end: Array, measure: Callable[[Values], float]) -> bool:
        """A dimension, where the length has a label; each label is shown once."""
        name = self.naming.length(measure)
        if name is None or name == 0:
            return name is not None
        if np.linalg.norm(end - start) <= _EXACT:
            self.hidden += [] if name in self.hidden else [name]
        elif all(d.label != name for d in self.dimensions):
            self.dimensions.append(Dimension(name, point(start), point(end)))
        return True

    def _joints(self) -> set[sp.Basic]:
        return {j.symbol for j in self.mechanism.joints}


def _rate(equation: sp.Expr, joint: Joint, coordinate: sp.Symbol, values: Values) -> float:
    """The derivative of the coordinate by the joint, from one equation."""
    slope = float(evaluate(sp.diff(equation, coordinate), values))
    return -float(evaluate(sp.diff(equation, joint.symbol), values)) / slope if slope else 0.0


def _circle(joint: Joint, entries: Entries, values: Values) -> tuple[Array, Array, Array]:
    """Centre, arm and axis of the circle on which a joint moves a point."""
    angle = float(values[joint.symbol.name])
    quarters = [vector_at(entries, {**values, joint.symbol.name: np.asarray(angle + k * np.pi / 2)}) for k in range(4)]
    centre, other = (quarters[0] + quarters[2]) / 2, (quarters[1] + quarters[3]) / 2
    arm, across = quarters[0] - centre, quarters[1] - centre
    normal = np.cross(arm, across)
    square = float(arm @ arm)
    bent = max(np.max(np.abs(centre - other)), abs(np.linalg.norm(normal) - square) / (1.0 + np.sqrt(square)))
    if bent > _EXACT * (1.0 + np.sqrt(square)) or square == 0:
        raise DescriptionError(f"joint {joint.name!r} does not move the end of its bar on a circle")
    return centre, arm, normal / square


def _centre_of(joint: Joint, ends: Sequence[Entries]) -> Entries:
    """The centre of the circle as expressions, for the middle between the ends that the crank holds."""
    found = []
    for coordinates in zip(*ends, strict=True):
        halves = [e.xreplace({joint.symbol: joint.symbol + k * sp.pi}) for e in coordinates for k in (0, 1)]
        found.append(sp.Add(*halves) / len(halves))
    return tuple(found)


def _unturned(entries: Entries) -> Entries:
    return tuple(e.xreplace(dict(zip(ROTATION, sp.eye(3), strict=True))) for e in entries)


def _padded(entries: Entries) -> Entries:
    return (*entries, *[sp.Integer(0)] * (3 - len(entries)))
