"""Vectors and rotations of couplings, bases and tools: their entries are numbers, or arrays with an entry a row."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, hypot, pi

from softkin._constants import SAME_ROTATION
from softkin._types import Reals, Rotation, Vector


def plus(first: Vector, second: Vector, sign: float = 1.0) -> Vector:
    """The sum of two vectors, or their difference for a sign of -1."""
    return first[0] + sign * second[0], first[1] + sign * second[1], first[2] + sign * second[2]


def turned(rotation: Rotation, vector: Reals) -> Vector:
    """The product of a rotation and a vector."""
    x, y, z = vector
    a, b, c = rotation
    return a[0] * x + a[1] * y + a[2] * z, b[0] * x + b[1] * y + b[2] * z, c[0] * x + c[1] * y + c[2] * z


def product(first: Rotation, second: Rotation) -> Rotation:
    """The product of two rotations."""
    a, b, c = (turned(first, column) for column in zip(*second, strict=True))
    return (a[0], b[0], c[0]), (a[1], b[1], c[1]), (a[2], b[2], c[2])


def transposed(rotation: Rotation) -> Rotation:
    """The inverse of a rotation: its rows are the columns."""
    (a, b, c), (d, e, f), (g, h, i) = rotation
    return (a, d, g), (b, e, h), (c, f, i)


def seen_from(base: Rotation, rotation: Rotation) -> Rotation:
    """A rotation expressed in the frame of another rotation."""
    return product(transposed(base), rotation)


def turn_between(first: Rotation, second: Rotation) -> float:
    """The angle between two rotations, as a share of a full turn; 0 where they differ by rounding.

    The cross products of the columns add up to twice its sine, the scalar products to one and twice its cosine.
    """
    (a, b, c), (d, e, f) = first, second
    sine = hypot(dot(b, f) - dot(c, e), dot(c, d) - dot(a, f), dot(a, e) - dot(b, d))
    angle = atan2(sine, dot(a, d) + dot(b, e) + dot(c, f) - 1.0)
    return angle / (2.0 * pi) if angle > SAME_ROTATION else 0.0


def moved(twist: Reals, arm: Vector) -> Reals:
    """The twist of a body, moved to the end of an arm that is fixed to the body."""
    x, y, z, about_x, about_y, about_z = twist
    x = x + (about_y * arm[2] - about_z * arm[1])
    y = y + (about_z * arm[0] - about_x * arm[2])
    z = z + (about_x * arm[1] - about_y * arm[0])
    return x, y, z, about_x, about_y, about_z


def dot(first: Sequence[float], second: Sequence[float]) -> float:
    """The scalar product."""
    return first[0] * second[0] + first[1] * second[1] + first[2] * second[2]


def cross(first: Vector, second: Vector) -> Vector:
    """The vector product."""
    (a, b, c), (x, y, z) = first, second
    return b * z - c * y, c * x - a * z, a * y - b * x


def times(vector: Vector, factor: float) -> Vector:
    """A vector times a number."""
    return vector[0] * factor, vector[1] * factor, vector[2] * factor


def at_end(bias: Reals, spin: Vector, arm: Vector) -> Reals:
    """The acceleration of a body that turns with a spin, moved to the end of an arm that is fixed to the body."""
    place, turn = (bias[0], bias[1], bias[2]), (bias[3], bias[4], bias[5])
    return (*plus(plus(place, cross(turn, arm)), cross(spin, cross(spin, arm))), *turn)


def rates(rows: Sequence[Reals], speeds: Reals) -> Vector:
    """Three rows of a Jacobian times the speeds of the axes."""
    x, y, z = (sum([entry * speed for entry, speed in zip(row, speeds, strict=True)], 0.0) for row in rows)
    return x, y, z


def turned_twist(rotation: Rotation, twist: Reals) -> Reals:
    """Both halves of a twist, or of its rate, turned."""
    return (*turned(rotation, twist[:3]), *turned(rotation, twist[3:]))


def on_flange(
    carried: Reals, spin: Vector, flange: Rotation, end: Vector, own: tuple[Sequence[Reals], Reals, Reals]
) -> Reals:
    """The acceleration of an end point that moves on a flange.

    carried, spin: of the flange; end: seen from it; own: the rows of the twist on the flange, the speeds of the axes,
    and the acceleration at constant ones. What moves on a flange that turns gets twice the vector product of both in
    addition, what turns there gets it once.
    """
    rows, speeds, bias = own
    shift, turn = (cross(spin, turned(flange, rates(half, speeds))) for half in (rows[:3], rows[3:]))
    added = (*times(shift, 2.0), *turn)
    whole = zip(at_end(carried, spin, turned(flange, end)), added, turned_twist(flange, bias), strict=True)
    return tuple(a + b + c for a, b, c in whole)
