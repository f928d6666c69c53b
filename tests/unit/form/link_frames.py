"""The same chain as robot files write it, with link frames at any places, and as tables of Denavit and Hartenberg do.

What is free in a frame or a row is chosen at random: places on axes, letters and senses of axes, further frames.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from random import Random

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.description.amounts import in_radians, number_in, with_exact_angles, without_decimals
from derive.description.mechanism import Mechanism
from derive.geometry.frames import Chain, Factor, Motion

Array = NDArray[np.object_]
_EXACT, _SAME = 1e-14, 1e-10


@dataclass(frozen=True)
class Pose:
    """A fixed frame: its orientation, and its place, whose coordinates may have names."""

    rotation: Array
    place: Array

    def __matmul__(self, other: Pose) -> Pose:
        return Pose(_clean(self.rotation @ other.rotation), _expanded(self.place + self.rotation @ other.place))

    @property
    def inverse(self) -> Pose:
        return Pose(self.rotation.T, _expanded(-self.rotation.T @ self.place))


def turn(axis: int, cosine: sp.Expr, sine: sp.Expr) -> Pose:
    matrix, (i, j) = _ONE.copy(), ((axis + 1) % 3, (axis + 2) % 3)
    matrix[i, i] = matrix[j, j] = cosine
    matrix[j, i], matrix[i, j] = sine, -sine
    return Pose(_clean(matrix), _ONE[0] * 0)


def shift(axis: int, amount: sp.Expr) -> Pose:
    return Pose(_ONE, _ONE[axis] * amount)


def _clean(numbers: Array) -> Array:
    """The numbers, with integers for decimals that are some but for rounding."""
    return np.array([_number(n) for n in numbers.flat]).reshape(numbers.shape)


def _number(number: sp.Expr) -> sp.Expr:
    near = round(float(number))
    return sp.Integer(near) if abs(float(number) - near) < _EXACT else number


def _expanded(place: Array) -> Array:
    return np.array([sp.expand(c) for c in place])


_ONE = np.array([[sp.Integer(int(i == k)) for k in range(3)] for i in range(3)])
NOWHERE = shift(0, sp.Integer(0))
"""The frame in front of a chain."""


@dataclass(frozen=True)
class Link:
    """A fixed frame, and what moves behind it."""

    fixed: Pose
    moving: Factor


@dataclass(frozen=True)
class Parts:
    """A chain as links, the frame behind the last of them, and the flips at the end."""

    links: tuple[Link, ...]
    last: Pose
    flips: tuple[Factor, ...]
    reach: float
    """The power of ten next to the sum of the lengths."""


def parts_of(mechanism: Mechanism) -> Parts:
    """The parts of a chain. The angle of a parameter moves."""
    own = with_exact_angles(mechanism).chain
    assert own is not None
    joints, nominal = {j.symbol for j in mechanism.joints}, {p.symbol: p.nominal for p in mechanism.parameters}
    fixed, found, reach = NOWHERE, list[Link](), 0.0
    for factor in (f for f in own.factors if f.motion is not Motion.FLIP):
        if factor.motion is Motion.SHIFT:
            still = sp.Integer(0) if factor.amount.free_symbols & joints else factor.amount
            fixed = fixed @ shift(factor.axis, without_decimals(still))
            reach += abs(float(still.subs(nominal)))
        else:
            still = number_in(factor.amount)
            angle = in_radians(still)
            fixed = fixed @ turn(factor.axis, sp.Float(np.cos(angle)), sp.Float(np.sin(angle)))
        if (rest := sp.expand(factor.amount - still)) != 0:
            found.append(Link(fixed, Factor(factor.motion, factor.axis, rest)))
            fixed = NOWHERE
    flips = tuple(f for f in own.factors if f.motion is Motion.FLIP)
    return Parts(tuple(found), fixed, flips, 10.0 ** np.ceil(np.log10(reach or 100.0)))


@dataclass(frozen=True)
class Choices:
    """What is chosen at random, for a machine of this size."""

    rng: Random
    reach: float

    def turn(self, axis: int) -> Pose:
        angle = self.rng.uniform(-np.pi, np.pi)
        oblique = sp.Float(np.cos(angle)), sp.Float(np.sin(angle))
        return turn(axis, *self.rng.choice((oblique, (sp.Integer(0), sp.Integer(1)))))

    def length(self) -> sp.Expr:
        return sp.Rational(str(round(self.rng.uniform(-0.1, 0.1), 4))) * sp.nsimplify(self.reach)

    def sign(self) -> int:
        return self.rng.choice((1, -1))

    def place(self) -> Pose:
        return Pose(_ONE, np.array([self.length() for _ in range(3)])) @ self.turn(0) @ self.turn(1) @ self.turn(2)

    def letter(self, axis: int) -> tuple[int, int, Pose]:
        """Another letter for an axis, its sign, and the frame in which the axis has that letter."""
        letter, sign, frame = self.rng.randrange(3), self.sign(), self.turn(axis)
        if letter != axis:
            frame = frame @ turn(3 - letter - axis, sp.Integer(0), sp.Integer(sign))
            sign = int(frame.rotation[axis, letter])
        elif sign < 0:
            frame = frame @ turn((axis + 1) % 3, sp.Integer(-1), sp.Integer(0))
        return letter, sign, frame

    def frame(self, pose: Pose) -> list[Factor]:
        """A frame as a robot file has it: x, y, z, then yaw, pitch, roll; half of the times by way of another."""
        if self.rng.random() < 0.5:
            between = self.place()
            return [*self.plain(pose @ between), *self.plain(between.inverse)]
        return self.plain(pose)

    def plain(self, pose: Pose) -> list[Factor]:
        r = pose.rotation.astype(float)
        level = float(np.hypot(r[0, 0], r[1, 0]))
        is_upright = level < _SAME
        yaw = np.arctan2(-r[0, 1], r[1, 1]) if is_upright else np.arctan2(r[1, 0], r[0, 0])
        roll = 0.0 if is_upright else np.arctan2(r[2, 1], r[2, 2])
        angles = zip((2, 1, 0), (yaw, np.arctan2(-r[2, 0], level), roll), strict=True)
        turns = (turned_by(k, np.cos(a), np.sin(a)) for k, a in angles)
        return [*map(self.shifted, range(3), pose.place), *turns]

    def shifted(self, axis: int, amount: sp.Expr) -> Factor:
        """A shift without what is rounding of zero: it has as many digits as a file."""
        terms = (t.as_coeff_Mul() for t in sp.Add.make_args(sp.expand(amount)))
        sizes = ((c, v, self.reach if v == 1 else 1.0) for c, v in terms)
        return Factor(Motion.SHIFT, axis, sp.Add(*(c * v for c, v, size in sizes if abs(c) > _EXACT * size)))


def turned_by(axis: int, cosine: sp.Expr, sine: sp.Expr) -> Factor:
    angle = float(np.arctan2(float(sine), float(cosine)))
    quarters = round(angle / (np.pi / 2))
    is_right = abs(angle - quarters * np.pi / 2) < _EXACT
    return Factor(Motion.TURN, axis, quarters * sp.pi / 2 if is_right else sp.Float(angle))


def in_link_frames(mechanism: Mechanism, seed: int) -> Chain:
    """Every joint in a frame of its own, at any place on its axis and in any orientation about it, about any letter;
    links have further frames, anywhere.
    """
    parts = parts_of(mechanism)
    choices, found, before = Choices(Random(seed), parts.reach), list[Factor](), NOWHERE
    for link in parts.links:
        letter, sign, lettered = choices.letter(link.moving.axis)
        own = shift(link.moving.axis, choices.length()) @ lettered
        found += choices.frame(before @ link.fixed @ own)
        found.append(Factor(link.moving.motion, letter, sign * link.moving.amount))
        before = own.inverse
    return _chain(found, choices.frame(before @ parts.last), parts)


def by_table(mechanism: Mechanism, seed: int) -> Chain:
    """The chain by a table, standard or modified: every joint turns about, or slides along, a z of its own, and x is
    along the common perpendicular with the next.
    """
    parts = parts_of(mechanism)
    choices, found, there = Choices(Random(seed), parts.reach), list[Factor](), NOWHERE
    here, is_modified = there, seed % 2 == 0
    for number, link in enumerate(parts.links):
        there, sign = there @ link.fixed, choices.sign()
        direction = sign * there.rotation[:, link.moving.axis]  # in the frame of the base
        if number == 0:
            here = Pose(_with_z(direction), there.place) @ shift(2, choices.length())
            found += choices.plain(here)
        else:
            place = here.place if link.moving.motion is Motion.SHIFT else there.place
            for row in _rows(here.inverse @ Pose(_with_z(direction), place), choices):
                found += _written(row, choices, is_modified)
                here = here @ row.pose
        found.append(Factor(link.moving.motion, 2, sign * link.moving.amount))
    return _chain(found, choices.plain(here.inverse @ there @ parts.last), parts)


def _chain(found: Sequence[Factor], last: Sequence[Factor], parts: Parts) -> Chain:
    return Chain((*(f for f in (*found, *last) if f.amount != 0), *parts.flips))


@dataclass(frozen=True)
class Row:
    """A row of a table: cosine and sine of a turn about z, a shift along it, a shift along x, a turn about that."""

    about_z: tuple[sp.Expr, sp.Expr]
    up: sp.Expr
    along: sp.Expr
    about_x: tuple[sp.Expr, sp.Expr]

    @property
    def pose(self) -> Pose:
        return turn(2, *self.about_z) @ shift(2, self.up) @ shift(0, self.along) @ turn(0, *self.about_x)


_STRAIGHT, _ACROSS = (sp.Integer(1), sp.Integer(0)), (sp.Integer(0), sp.Integer(1))


def _rows(axis: Pose, choices: Choices) -> Iterator[Row]:
    """The row that leads to an axis, the z of a frame; two if it is parallel to z, and what is between them is a sum of
    lengths in two directions.
    """
    (a, b, cosine), (x, y, z) = axis.rotation[:, 2], axis.place
    if a != 0 or b != 0:
        sine = choices.sign() * sp.sqrt(a**2 + b**2)
        x_axis = (_number(-b / sine), _number(a / sine))
        up = sp.expand(z - cosine / sine**2 * (a * x + b * y))
        yield Row(x_axis, up, sp.expand(x_axis[0] * x + x_axis[1] * y), (cosine, sine))
        return
    about_x, up = (cosine, sp.Integer(0)), choices.length()
    if x.is_number and y.is_number and (x != 0 or y != 0):
        length = sp.sqrt(x**2 + y**2)
        yield Row((x / length, y / length), up, length, about_x)
    else:
        yield Row(_STRAIGHT, up, x, _STRAIGHT)
        yield Row(_ACROSS, sp.Integer(0), y, about_x)


def _written(row: Row, choices: Choices, is_modified: bool) -> Iterator[Factor]:
    yield from (turned_by(2, *row.about_z), choices.shifted(2, row.up))
    about_x = (choices.shifted(0, row.along), turned_by(0, *row.about_x))
    yield from reversed(about_x) if is_modified else about_x


def _with_z(direction: Array) -> Array:
    x = sp.Matrix(_ONE[int(np.argmin(np.abs(direction.astype(float))))]).cross(sp.Matrix(direction))
    x /= x.norm()
    y = sp.Matrix(direction).cross(x)
    return _clean(np.array([*x, *y, *direction]).reshape(3, 3).T)
