"""The joints of an arm and the frames between them, in a circle: the commanded pose leads from the flange to the base.

base F1 J1 … J6 F2 = pose   →   J1 … J6 (F2 pose^-1 F1) = 1
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import sympy as sp

from derive.description.mechanism import Joint, Mechanism, Turning
from derive.equations.trigonometry import named_trigonometry
from derive.geometry.frames import Factor, Motion
from derive.ir.program import Let
from derive.ir.symbols import COORDINATE_NAMES, ROTATION_ENTRIES, SCALE, cosine, real, sine
from derive.kinematics.search.elimination.line import Move, rotation, shift, turn
from derive.kinematics.search.elimination.oblique import Oblique, gathered, turned_to
from derive.kinematics.search.programs import GOAL

JOINTS = 6


@dataclass(frozen=True)
class Place:
    """A joint in the ring: its axis, and whether it moves in the sense of this axis (1) or against it (-1)."""

    joint: Joint
    axis: int
    sense: int

    @property
    def unknowns(self) -> tuple[sp.Expr, sp.Expr]:
        """What its motion is linear in, besides 1: cosine and sine; of a slide the shift over the scale, squared."""
        if self.joint.is_angle:
            return cosine(self.joint.symbol), sine(self.joint.symbol)
        along = self.joint.symbol / SCALE
        return along, along**2

    @property
    def move(self) -> Move:
        """Its motion, with factors 1 and `unknowns`."""
        found = (
            turn(self.axis, sp.Integer(1), sp.Integer(1)) if self.joint.is_angle else shift(self.axis, sp.Integer(1))
        )
        odd = 2 if self.joint.is_angle else 1
        parts = tuple(p * self.sense if k == odd else p for k, p in enumerate(found.parts))
        return Move(parts, (sp.Integer(1), *self.unknowns))

    @property
    def inverse(self) -> Place:
        """The inverse motion."""
        return replace(self, sense=-self.sense)


@dataclass(frozen=True)
class Fixed:
    """A motion of a frame that no searched joint makes, and its inverse."""

    move: Move
    back: Move
    is_pose: bool = False

    @property
    def inverse(self) -> Fixed:
        """The inverse motion."""
        return replace(self, move=self.back, back=self.move)


@dataclass(frozen=True)
class Ring:
    """Joints, and behind each of them the frames that lead to the next one; with the statements that these read."""

    places: tuple[Place, ...]
    links: tuple[tuple[Fixed, ...], ...]
    lets: tuple[Let, ...]

    def begun_at(self, first: int) -> Ring:
        """The ring, begun at another joint."""
        return Ring((*self.places[first:], *self.places[:first]), (*self.links[first:], *self.links[:first]), self.lets)

    @property
    def reversed(self) -> Ring:
        """The ring the other way around."""
        links = (*reversed(self.links[:-1]), self.links[-1])
        return Ring(
            tuple(p.inverse for p in reversed(self.places)),
            tuple(tuple(f.inverse for f in reversed(link)) for link in links),
            self.lets,
        )

    def has_pose(self, link: int) -> bool:
        """Whether the commanded pose stands behind a joint."""
        return any(f.is_pose for f in self.links[link])


def ring_of(mechanism: Mechanism) -> Ring | None:
    """The ring of an arm; None for a mechanism that is no arm with six joints, each in one factor of its chain, or a
    slide that goes one way.
    """
    chain, joints = mechanism.chain, mechanism.solved_joints
    is_whole = mechanism.task.turning is Turning.FULL and mechanism.task.position == "".join(COORDINATE_NAMES)
    if chain is None or not is_whole or len(joints) != JOINTS:
        return None
    lets: dict[sp.Symbol, Let] = {}
    places: list[Place] = []
    links: list[list[Fixed]] = [[]]
    slides = [j.symbol for j in joints if not j.is_angle]
    for factor in gathered(chain.factors, slides, {j.symbol for j in joints}):
        if isinstance(factor, Oblique):
            slide, before, behind = _oblique(mechanism, factor, lets)
            places.append(slide)
            links[-1] += before
            links.append(behind)
            continue
        moving = [j for j in joints if j.symbol in factor.amount.free_symbols]
        moved = [place for j in moving if (place := _place(factor, j)) is not None]
        if len(moving) > 1 or len(moved) < len(moving):
            return None
        rest = sp.expand(factor.amount - sp.Add(*(p.sense * p.joint.symbol for p in moved)))
        if rest != 0:
            links[-1].append(_fixed(mechanism, replace(factor, amount=rest), lets))
        if moved:
            places += moved
            links.append([])
    if len({p.joint.name for p in places}) != JOINTS or len(places) != JOINTS:
        return None
    first, *others, last = links
    found = (*map(tuple, others), (*last, *_pose(), *first))
    return Ring(tuple(places), found, tuple(lets.values()))


def _oblique(
    mechanism: Mechanism, slide: Oblique, lets: dict[sp.Symbol, Let]
) -> tuple[Place, list[Fixed], list[Fixed]]:
    """A slide along any direction: its place, the frames in front of it, and those that lead back."""
    joint = next(j for j in mechanism.solved_joints if j.symbol == slide.slide)
    found, direction = named_trigonometry(mechanism, list(slide.direction))
    read = set().union(*(v.free_symbols for v in direction))
    lets.update({let.name: let for let in found if let.name in read})
    turned, before = turned_to(*direction), list[Fixed]()
    for k, (axis, *values) in enumerate(turned.turns, 1):
        names = [real(f"{word}_{k}_to_{joint.key}") for word in ("cosine", "sine")]
        lets.update({name: Let(name, value) for name, value in zip(names, values, strict=True)})
        before.append(Fixed(turn(axis, *names), turn(axis, names[0], -names[1])))
    return Place(joint, turned.axis, 1), before, [f.inverse for f in reversed(before)]


def _place(factor: Factor, joint: Joint) -> Place | None:
    """A joint by its factor; None where this does not move as the joint itself does."""
    sense = sp.expand(factor.amount).coeff(joint.symbol)
    rest = sp.expand(factor.amount - sense * joint.symbol)
    if sense not in (1, -1) or joint.symbol in rest.free_symbols or joint.is_angle != (factor.motion is Motion.TURN):
        return None
    return Place(joint, factor.axis, int(sense))


def _fixed(mechanism: Mechanism, factor: Factor, lets: dict[sp.Symbol, Let]) -> Fixed:
    """A frame that no solved joint moves; the statements of the cosines and sines that it reads are added."""
    axis, amount = factor.axis, factor.amount
    if factor.motion is Motion.SHIFT:
        return Fixed(shift(axis, amount / SCALE), shift(axis, -amount / SCALE))
    if factor.motion is Motion.FLIP:
        half = turn(axis, 1 - 2 * amount, sp.Integer(0))
        return Fixed(half, half)
    found, (cosine_of, sine_of) = named_trigonometry(mechanism, [sp.cos(amount), sp.sin(amount)])
    read = cosine_of.free_symbols | sine_of.free_symbols  # a turn by a held joint and an angle names all joints
    lets.update({let.name: let for let in found if let.name in read})
    return Fixed(turn(axis, cosine_of, sine_of), turn(axis, cosine_of, -sine_of))


def _pose() -> Iterator[Fixed]:
    """The inverse of the commanded pose: its rotation back, then its shift back."""
    entries = [GOAL[r] for r in ROTATION_ENTRIES]
    across = [entries[3 * j + i] for i in range(3) for j in range(3)]
    yield Fixed(rotation(across), rotation(entries), is_pose=True)
    for axis, name in enumerate(COORDINATE_NAMES):
        amount = GOAL[real(name)] / SCALE
        yield Fixed(shift(axis, -amount), shift(axis, amount), is_pose=True)
