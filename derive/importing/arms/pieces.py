"""The chain of an arm in its simple form: turns and shifts along x, y and z, one after the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from derive.description.joints import Kind
from derive.geometry.frames import Motion
from derive.importing.arms.headings import Heading, headings, orientation, product
from derive.importing.arms.lines import ROUNDING, Arm
from derive.importing.arms.points import points
from derive.importing.arms.snapping import SNAP, Snapped
from derive.importing.robot import Array, about


@dataclass(frozen=True)
class Piece:
    """A turn about, or a shift along, x, y or z: by multiples of axis values plus a constant (radians or lengths)."""

    motion: Motion
    letter: int
    drives: tuple[tuple[int, float], ...]
    constant: float
    place: int
    """The number of the line of the arm before which it stands; the number of lines where it stands before the tip."""

    def matrix(self, values: Sequence[float]) -> Array:
        """The homogeneous 4 x 4 matrix at axis values."""
        amount = self.constant + sum(values[k] * multiplier for k, multiplier in self.drives)
        matrix = np.eye(4)
        if self.motion is Motion.SHIFT:
            matrix[self.letter, 3] = amount
        else:
            matrix[:3, :3] = about(np.eye(3)[self.letter], amount)
        return matrix


@dataclass(frozen=True)
class Simple:
    """An arm in its simple form, and the changes that this took."""

    pieces: tuple[Piece, ...]
    moved: tuple[Snapped, ...]

    def forward(self, values: Sequence[float]) -> Array:
        """The pose of the tip (4 x 4) at axis values (radians and lengths)."""
        frame = np.eye(4)
        for piece in self.pieces:
            frame = frame @ piece.matrix(values)
        return frame


def simple(arm: Arm, names: Sequence[str], limit: float) -> Simple:
    """The chain with the fewest shifts. limit: a share of the size (lengths), and of one radian (angles)."""
    narrow = min(limit, SNAP)  # what is left are offsets of joints, and turns of the base and the tip
    ways, turned = headings(arm, names, narrow)
    straight = replace(
        arm,
        lines=tuple(
            replace(line, direction=w.sign * w.frame[:, w.letter]) for line, w in zip(arm.lines, ways, strict=True)
        ),
    )
    last = ways[-1].frame if ways else np.eye(3)
    turns, amount = orientation(last.T @ arm.tip[:3, :3], narrow)
    moved = [*turned, *([Snapped("tip: its orientation", amount, True)] if amount > 10 * ROUNDING else [])]
    smallest = max(limit * arm.size, arm.rounding)
    targets = [*points(straight, ways, last @ product(turns), smallest), arm.tip[:3, 3]]
    pieces: list[Piece] = []
    frame, here = np.eye(3), np.zeros(3)
    for place, target in enumerate(targets):
        is_tip = place == len(ways)
        way = Heading(turns, frame @ product(turns), 0, 1) if is_tip else ways[place]
        before = ways[place - 1].letter if place else None
        shifted, there = _way(frame, way, target - here, smallest, place, before)
        pieces += shifted
        here = here + there
        off = _off(straight, place, here, target)
        if off > 10 * arm.rounding:
            moved.append(Snapped(f"{'tip' if is_tip else names[place]}: its position", off, False))
        if not is_tip:
            pieces.append(_motion(arm, way, place))
        frame = way.frame
    return Simple(_merged(pieces), tuple(moved))


def _way(
    frame: Array, way: Heading, between: Array, smallest: float, place: int, letter: int | None
) -> tuple[list[Piece], Array]:
    """The shifts and turns to the next line, the shifts where they are fewest; and how far they lead.

    letter: that of the joint before, which absorbs a first turn about the same letter.
    """
    turned = [Piece(Motion.TURN, axis, (), angle, place) for axis, angle in way.turns]
    choices = []
    for own in (frame, way.frame):
        amounts = own.T @ between
        amounts = np.where(np.abs(amounts) > smallest, amounts, 0.0)
        pieces = [Piece(Motion.SHIFT, k, (), float(a), place) for k, a in enumerate(amounts) if a != 0.0]
        choices.append((pieces, own @ amounts))
    first, second = choices
    is_taken_up = bool(turned) and turned[0].letter == letter
    if len(second[0]) < len(first[0]) + is_taken_up:
        return [*turned, *second[0]], second[1]
    return [*first[0], *turned], first[1]


def _off(arm: Arm, place: int, here: Array, target: Array) -> float:
    """The distance by which a line or the tip has been moved."""
    if place == len(arm.lines):
        return float(np.linalg.norm(here - target))
    line = arm.lines[place]
    if line.kind is Kind.LINEAR:
        return 0.0
    return float(np.linalg.norm(np.cross(here - line.point, line.direction)))


def _motion(arm: Arm, way: Heading, place: int) -> Piece:
    line = arm.lines[place]
    drives = tuple((axis, way.sign * multiplier) for axis, multiplier in line.drives)
    return Piece(Motion.TURN if line.kind is Kind.ROTARY else Motion.SHIFT, way.letter, drives, 0.0, place)


def _merged(pieces: Sequence[Piece]) -> tuple[Piece, ...]:
    """The pieces with neighbouring turns about one letter merged: bars that keep a link parallel, joint offsets."""
    found: list[Piece] = []
    for piece in pieces:
        last = found[-1] if found else None
        is_same = last is not None and last.motion is piece.motion is Motion.TURN and last.letter == piece.letter
        if last is not None and is_same:
            found[-1] = replace(last, drives=_sum(last, piece), constant=last.constant + piece.constant)
        else:
            found.append(piece)
    return tuple(p for p in found if p.drives or p.constant != 0.0)


def _sum(first: Piece, second: Piece) -> tuple[tuple[int, float], ...]:
    total: dict[int, float] = {}
    for axis, multiplier in (*first.drives, *second.drives):
        total[axis] = total.get(axis, 0.0) + multiplier
    return tuple((axis, multiplier) for axis, multiplier in total.items() if multiplier != 0.0)
