"""The scene of a chain at given joint values, composed from its base."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import sympy as sp

from derive.description.joints import Loop
from derive.description.mechanism import DescriptionError, Joint, Mechanism
from derive.drawing.belts import belt_of
from derive.drawing.labels import Values, axis_name, interface, lengths_of, plain
from derive.drawing.pins import pins_of
from derive.drawing.scene import Belt, Body, Dimension, Frame, Point, Scene, Segment, Slide, Turn, point
from derive.geometry.frames import Factor, Motion
from derive.geometry.pose import pose_of
from derive.ir.interpret import Array, evaluate

BELT_SIZE = 100.0
"""The size at which a frame without lengths is drawn."""
_PARALLEL, _EXACT = 0.999, 1e-6


def chain_scene(mechanism: Mechanism, values: Values, tool: Frame) -> Scene:
    """The scene of the chain of a mechanism; `values` has its parameters and joint values by name.

    Raises `DescriptionError` if the chain does not end at the tool that forward kinematics computed.
    """
    chain = mechanism.drawn or mechanism.chain
    assert chain is not None
    walker = _Walker(mechanism, values)
    for factor in chain.factors:
        walker.pass_over(factor)
    walker.finish_body(None)
    walker.draw_loops()
    apart = float(np.linalg.norm(walker.position - np.array(tool.position)))
    if apart > _EXACT * (1.0 + float(np.linalg.norm(walker.position))):
        raise DescriptionError(f"the chain ends {apart:g} away from where forward kinematics has the tool")
    return Scene(
        segments=tuple(walker.segments),
        turns=tuple(walker.turns),
        slides=(*walker.slides, *_drives(mechanism, values, walker)),
        dimensions=tuple(walker.dimensions),
        spots=(),
        grounds=((0.0, 0.0, 0.0),),
        tool=tool,
        hidden=tuple(walker.hidden),
        loops=tuple(_loops(mechanism)),
        belt=_belt(mechanism, walker),
    )


def _belt(mechanism: Mechanism, walker: _Walker) -> Belt | None:
    """The belt of a machine that states its layout: along the first two slides, which its drives move together."""
    if mechanism.belt is None:
        return None
    shared = [np.array(s.axis) for s in walker.slides if not s.has_arrow]
    if len(shared) != 2:
        raise DescriptionError(f"a belt in {mechanism.belt} layout moves two slides, and here {len(shared)}")
    drives = {axis_name(j): np.add(*moves) for j, moves in walker.moves.items() if len(moves) == 2}
    return belt_of(mechanism.belt, BELT_SIZE, shared, drives)


@dataclass
class _Walker:
    mechanism: Mechanism
    values: Values
    position: Array = field(default_factory=lambda: np.zeros(3))
    rotation: Array = field(default_factory=lambda: np.eye(3))
    segments: list[Segment] = field(default_factory=list)
    turns: list[Turn] = field(default_factory=list)
    slides: list[Slide] = field(default_factory=list)
    dimensions: list[Dimension] = field(default_factory=list)
    hidden: list[sp.Expr] = field(default_factory=list)
    frames: list[tuple[set[Joint], Array, Array]] = field(default_factory=list)
    """The joints of every moving factor, and the frame in front of it: position and rotation."""
    moves: dict[Joint, list[Array]] = field(default_factory=dict)
    """By joint: the vectors by which a unit of the joint moves its shifts."""
    _shifts: list[tuple[Array, sp.Expr]] = field(default_factory=list)
    """The shifts of the current body, with their labels."""
    _start: Array = field(default_factory=lambda: np.zeros(3))
    _last_axis: Array | None = None
    _parallel: tuple[Array, sp.Expr] | None = None
    """The axis of the last turns, as far as they are parallel, and the sum of these."""

    def pass_over(self, factor: Factor) -> None:
        """Compose the scene with one more factor."""
        moving = [j for j in self.mechanism.joints if j.symbol in factor.amount.free_symbols]
        self.frames.append(({*moving}, self.position, self.rotation))
        direction = self.rotation[:, factor.axis]
        amount = float(evaluate(factor.amount, self.values))
        if factor.motion is Motion.SHIFT:
            self._shift(factor, direction, amount, moving)
        else:
            if moving:
                self.finish_body(direction)
                amount_told = self._driven(factor.amount, direction)
                driving = [j for j in moving if j.symbol in amount_told.free_symbols] or moving
                rate = float(evaluate(sp.diff(amount_told, driving[0].symbol), self.values))
                sense = -1 if rate < 0 else 1
                label = interface(self.mechanism, sense * _unsigned(self.mechanism, amount_told))
                self.turns.append(Turn(label, point(self.position), point(sense * direction)))
                self._last_axis = direction
            angle = np.pi * amount if factor.motion is Motion.FLIP else amount
            self.rotation = self.rotation @ _turned(factor.axis, angle)

    def _driven(self, amount: sp.Expr, direction: Array) -> sp.Expr:
        """The angle that drives the body behind a turn: the turn itself, or the sum of the parallel turns up to it.

        It is the sum where at most one joint is left in it: bars from the base then give the body its direction.
        """
        if self._parallel is None or abs(self._parallel[0] @ direction) < 1.0 - _EXACT:
            self._parallel = direction, sp.sympify(amount)
            return sp.sympify(amount)
        first, turned = self._parallel
        alike = int(np.sign(first @ direction))
        total = sp.expand(alike * turned + amount)
        self._parallel = direction, total
        joints = {j.symbol for j in self.mechanism.joints}
        left, own = total.free_symbols & joints, amount.free_symbols & joints
        return total if not left or (len(left) == 1 < len(own)) else sp.sympify(amount)

    def _shift(self, factor: Factor, direction: Array, amount: float, moving: list[Joint]) -> None:
        if not moving:
            self._shifts.append((direction * amount, _unsigned(self.mechanism, factor.amount)))
            self.position = self.position + direction * amount
            return
        self.finish_body(direction)
        rates = {j: float(evaluate(sp.diff(factor.amount, j.symbol), self.values)) for j in moving}
        linear = [j for j in moving if not j.is_angle]
        for joint in linear:
            self.moves.setdefault(joint, []).append(rates[joint] * direction)
        alone = len(linear) == 1
        sense = np.sign(rates[linear[0]]) if alone else 1.0
        slide = Slide(self._label(factor), point(self.position), point(sense * direction), has_arrow=alone)
        self.slides.append(slide)
        if amount:
            self.segments.append(Segment(point(self.position), point(self.position + direction * amount), Body.LINK))
        self.position = self._start = self.position + direction * amount
        self._last_axis = direction

    def finish_body(self, axis: Array | None) -> None:
        """Draw the body that ends here: first along the joint in front, last along the next joint, as machines are
        built.
        """
        at = self._start
        self._point_turns()
        for shift, label in sorted(self._shifts, key=lambda s: _place(s[0], self._last_axis, axis)):
            if not np.any(shift):
                self.hidden += [plain(label)] if label.free_symbols else []
                continue
            self.segments.append(Segment(point(at), point(at + shift), Body.LINK))
            label = -label if label.could_extract_minus_sign() else label
            negative = float(evaluate(label, self.values)) < 0
            self.dimensions.append(Dimension(plain(label), point(at), point(at + shift), negative))
            at = at + shift
        self._shifts, self._start = [], self.position

    def _point_turns(self) -> None:
        """Give the last joints the direction of the body that ends here."""
        total = self.position - self._start
        for index, turn in enumerate(self.turns):
            across = total - (total @ np.array(turn.axis)) * np.array(turn.axis)
            if turn.toward is None and np.linalg.norm(across) > 1e-9:
                self.turns[index] = replace(turn, toward=point(across))

    def draw_loops(self) -> None:
        """Draw the cylinders, cranks and rods of the loops that move joints."""
        for joint in (j for j in self.mechanism.joints if j.loops):
            beside = next(moving for moving, _, _ in self.frames if joint in moving)
            position, rotation = next((p, r) for moving, p, r in self.frames if moving & beside)
            for number, loop in enumerate(joint.loops):
                pins = [pins_of(chain) for chain in (loop.start, loop.tip)]
                ends = [[position + rotation @ self._at(pin) for pin in some] for some in pins]
                start, tip = ends[0][-1], ends[1][-1]
                self.segments.append(Segment(point(start), point(tip), Body.ROD))
                for some in ends:
                    pairs = zip(some, some[1:], strict=False)
                    self.segments += [Segment(point(a), point(b), Body.LINK) for a, b in pairs if np.any(a != b)]
                if number == 0:
                    self._actuator(joint, loop, rotation, ends)

    def _actuator(self, joint: Joint, loop: Loop, rotation: Array, ends: list[list[Array]]) -> None:
        """The label of the actuator: a turn at the pin of a crank, an arrow along a cylinder or a slide."""
        label, start, tip = sp.Symbol(joint.name), ends[0][-1], ends[1][-1]
        if loop.turns[1]:
            turn = next(f for f in loop.start.factors if loop.by in f.amount.free_symbols)
            centre = ends[0][0] if len(ends[0]) > 1 else start
            self.turns.append(Turn(label, point(centre), point(rotation[:, turn.axis]), point(start - centre)))
            return
        moved = np.array([float(evaluate(v.diff(loop.by), self.values)) for v in pose_of(loop.start).position])
        along = rotation @ moved if np.any(moved) else (tip - start) / np.linalg.norm(tip - start)
        at = start if np.any(moved) else (start + tip) / 2
        self.slides.append(Slide(label, point(at), point(along), has_rail=bool(np.any(moved))))

    def _at(self, position: Sequence[sp.Expr]) -> Array:
        return np.array([float(evaluate(sp.sympify(v), self.values)) for v in position])

    def _label(self, factor: Factor) -> sp.Expr:
        return interface(self.mechanism, _unsigned(self.mechanism, factor.amount))


def _drives(mechanism: Mechanism, values: Values, walker: _Walker) -> list[Slide]:
    """The direction in which a drive moves the tool, where it moves several shifts or shares one."""
    arrows = {s.label for s in walker.slides if s.has_arrow}
    found = []
    for joint, moves in walker.moves.items():
        if not any(axis_name(joint) in label.free_symbols for label in arrows):
            total = sum(moves[1:], moves[0])
            unit: Point = point(total / np.linalg.norm(total))
            found.append(Slide(axis_name(joint), point(walker.position), unit, has_rail=False))
    return found


def _loops(mechanism: Mechanism) -> Iterator[tuple[sp.Expr, tuple[sp.Expr, ...]]]:
    """What every loop moves, and the lengths that it has and no loop before it: there are too many to draw."""
    left = list(lengths_of(mechanism))
    for loop in (loop for joint in mechanism.joints for loop in joint.loops):
        read = loop.vector.free_symbols | sp.sympify(loop.length).free_symbols
        own = [p for p in left if p.symbol in read]
        left = [p for p in left if p not in own]
        yield sp.Symbol(loop.name), tuple(plain(p.symbol) for p in own)


def _unsigned(mechanism: Mechanism, amount: sp.Expr) -> sp.Expr:
    """The amount without the parameters that are only a sign: arrows show the direction."""
    signs = {p.symbol: sp.Integer(1) for p in mechanism.parameters if p.role.value == "sign"}
    return sp.sympify(amount).xreplace(signs)


def _place(shift: Array, last: Array | None, following: Array | None) -> int:
    if last is not None and abs(shift @ last) > _PARALLEL * np.linalg.norm(shift):
        return 0
    return 2 if following is not None and abs(shift @ following) > _PARALLEL * np.linalg.norm(shift) else 1


def _turned(axis: int, angle: float) -> Array:
    rotation = np.eye(3)
    first, second = (axis + 1) % 3, (axis + 2) % 3
    rotation[first, first] = rotation[second, second] = np.cos(angle)
    rotation[first, second], rotation[second, first] = -np.sin(angle), np.sin(angle)
    return rotation
