"""The parts of a closed loop in a description: its rods, the planes that guide its plate, points of the plate, and
quantities with bounds or limits of their own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.description.errors import DescriptionError
from derive.description.quantity import Quantity
from derive.ir.symbols import COORDINATE_NAMES, ROTATION_ENTRIES, real

X, Y, Z = (Quantity(real(name)) for name in COORDINATE_NAMES)
"""The commanded position, for closures that are not a chain."""


ROTATION = sp.ImmutableMatrix(3, 3, ROTATION_ENTRIES)
"""The commanded rotation, for closures that follow the whole of it."""


@dataclass(frozen=True)
class Rod:
    """A rigid rod of a loop: its end on the base side (moved by joints), its end on the plate, its length."""

    name: str
    base: tuple[sp.Expr, ...]
    plate: tuple[sp.Expr, ...]
    length: sp.Expr
    base_cone: sp.Expr | None = None
    """The largest angle between the rod and its direction at the home pose, at its joint on the base (radians)."""
    plate_cone: sp.Expr | None = None
    """The largest angle between the rod and that direction at its joint on the plate (radians)."""
    only_pulls: bool = False
    """Whether it is a cable: see `Mechanism.load`."""
    ring: sp.Expr | None = None
    """The radius of a ring on which it ends: see `ring_rod`. `plate` is then the centre of the ring."""

    @property
    def key(self) -> str:
        """Its name in programs."""
        return self.name

    @property
    def equation(self) -> sp.Expr:
        """|end - base|^2 - length^2."""
        return sp.Add(*[(p - b) ** 2 for p, b in zip(self.end, self.base, strict=True)]) - self.length**2

    @property
    def end(self) -> tuple[sp.Expr, ...]:
        """Its end on the plate; on a ring the point that is nearest to its base."""
        if self.ring is None:
            return self.plate
        axis, between = ROTATION[:, 2], sp.Matrix(self.plate) - sp.Matrix(self.base)
        across = between - between.dot(axis) * axis
        return tuple(sp.Matrix(self.plate) - self.ring / sp.sqrt(across.dot(across)) * across)


@dataclass(frozen=True)
class Plane:
    """A plane in which a point of the plate stays: normal . point = offset. Joints may shift it."""

    name: str
    normal: tuple[sp.Expr, ...]
    """Made of numbers and parameters. A length other than one weighs the tolerance of the plane."""
    plate: tuple[sp.Expr, ...]
    offset: sp.Expr

    @property
    def turns_along(self) -> bool:
        """Whether its normal turns with the plate: it holds nothing, see `FREE_TWIST`."""
        return self == FREE_TWIST

    @property
    def key(self) -> str:
        """Its name in programs, which differs from those of the rods."""
        return f"guide_{self.name}"

    @property
    def equation(self) -> sp.Expr:
        """normal . point - offset."""
        return sp.Add(*[n * p for n, p in zip(self.normal, self.plate, strict=True)]) - self.offset


FREE_TWIST = Plane("free_twist", tuple(ROTATION[:, 1]), tuple(ROTATION[:, 0]), sp.Integer(0))
"""The twist of a platform whose legs do not feel it: the x axis of the plate is always at right angles to its y axis.
This holds nothing: forward kinematics gives the platform the twist of the least turn from its home orientation."""


@dataclass(frozen=True)
class Bound:
    """A quantity of joints and position whose absolute value has a bound (the swing of a ball joint)."""

    value: sp.Expr
    largest: sp.Expr
    meaning: str


@dataclass(frozen=True)
class Limited:
    """A quantity that is no axis, but has limits (the relative angle of an elbow, X of an H-gantry)."""

    name: str
    value: sp.Expr
    is_angle: bool
    meaning: str


def rod(
    name: str,
    base: Sequence[object],
    plate: Sequence[object],
    length: object,
    base_cone: sp.Expr | None = None,
    plate_cone: sp.Expr | None = None,
) -> Rod:
    """A rigid rod between a point that joints move and a point of the plate."""
    if len(base) != len(plate):
        raise DescriptionError(
            f"rod {name!r}: its ends have {len(base)} and {len(plate)} coordinates: give both in the plane, or both in "
            "space"
        )
    return Rod(
        name, tuple(map(sp.sympify, base)), tuple(map(sp.sympify, plate)), sp.sympify(length), base_cone, plate_cone
    )


def cable(name: str, anchor: Sequence[object], plate: Sequence[object], length: object) -> Rod:
    """A rod that only pulls: where `Mechanism.load` would make it push, the inverse refuses the pose."""
    return replace(rod(name, anchor, plate, length), only_pulls=True)


def ring_rod(name: str, base: Sequence[object], centre: Sequence[object], radius: object, length: object) -> Rod:
    """A rod that ends on a ring, which turns freely about the z axis of the plate: `ring_rod("1", BASE, on_plate(0, 0,
    HEIGHT), RADIUS, L1)`. The rod stays in a plane with that axis, so it does not feel a turn about it. A negative
    radius is that of a rod which passes the axis, and ends behind it.
    """
    return replace(rod(name, base, centre, length), ring=sp.sympify(radius))


def guide(name: str, normal: Sequence[object], plate: Sequence[object], offset: object = 0) -> Plane:
    """A plane in which a point of the plate stays: `guide("1", (0, 1, 0), on_plate(R, 0, 0))`; shifted by joints it
    lifts the plate: `guide("lift", (0, 0, 1), on_plate(0, 0, 0), S1 + HEIGHT)`. Without the position of the plate,
    as in `tuple(ROTATION * Matrix([R, 0, 0]))`, a direction of the plate stays in the plane.
    """
    if len(normal) != len(plate):
        raise DescriptionError(
            f"guide {name!r}: its normal and its point have {len(normal)} and {len(plate)} coordinates: give both in "
            "the plane, or both in space"
        )
    return Plane(name, tuple(map(sp.sympify, normal)), tuple(map(sp.sympify, plate)), sp.sympify(offset))


def on_plate(x: object, y: object, z: object | None = None) -> tuple[sp.Expr, ...]:
    """The position of a point of the plate, from its coordinates in the frame of the plate; without z, in the plane."""
    point = sp.Matrix([x, y] if z is None else [x, y, z])
    size = len(point)
    return tuple(sp.Matrix([X.symbol, Y.symbol, Z.symbol][:size]) + ROTATION[:size, :size] * point)


def bound(value: object, largest: object, meaning: str) -> Bound:
    """|value| must not exceed `largest`."""
    return Bound(sp.sympify(value), sp.sympify(largest), meaning)


def limited(name: str, value: object, meaning: str, *, angle: bool) -> Limited:
    """A quantity with limits of its own, in radians or lengths."""
    return Limited(name, sp.sympify(value), angle, meaning)
