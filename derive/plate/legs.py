"""The legs of a platform at a pose: names, vectors, and the rows of the matrix A in A (v, w) = -e.

The length error of rod i is e = |span| - length. Let a be the arm from the origin of the plate to the rod's joint, and
u the unit vector along the rod. Then e' = [u, a x u] (v, w): a row of A is the rod as a line, in Pluecker coordinates.
Moments are divided by the platform's radius, so that det A has no unit.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import sympy as sp

from derive.description.mechanism import (
    DescriptionError,
    Mechanism,
    Rod,
    on_plate,
)
from derive.ir.constants import (
    SHORTEST_LINK,
)
from derive.ir.primitives import (
    Root,
    Select,
)
from derive.ir.program import (
    Let,
)
from derive.ir.symbols import (
    COORDINATE_NAMES,
    ROTATION_ENTRIES,
    SCALE,
    real,
)

RADIUS = real("platform_radius")
MARGIN = "rods_dependent"
ANGLES = ("roll", "pitch", "yaw")

Vector = tuple[sp.Expr, ...]


def names(word: str, rod: Rod) -> tuple[sp.Symbol, ...]:
    """The names of the components of a rod's vector: `span_1_x` and so on."""
    return tuple(real(f"{word}_{rod.name}_{c}") for c in COORDINATE_NAMES)


def of(word: str, rod: Rod) -> sp.Symbol:
    """The name of a rod's number: `length_1`."""
    return real(f"{word}_{rod.name}")


def point_of(rod: Rod) -> Vector:
    """The rod's joint in the frame of the plate."""
    point = tuple(sp.diff(rod.plate[0], entry) for entry in ROTATION_ENTRIES[:3])
    if any(sp.expand(a - b) != 0 for a, b in zip(rod.plate, on_plate(*point), strict=True)):
        raise DescriptionError(f"rod {rod.name!r}: its end must be a point of the plate")
    return point


def turned(rotation: Sequence[sp.Expr], point: Sequence[sp.Expr], called: Sequence[sp.Symbol]) -> tuple[Let, ...]:
    """The product of a rotation, given by rows, and a point, bound to the names `called`."""
    matrix = sp.Matrix(3, 3, list(rotation))
    return tuple(Let(n, v) for n, v in zip(called, matrix * sp.Matrix(list(point)), strict=True))


def by_angles(words: Sequence[str] = ANGLES) -> sp.Matrix:
    """Rz(yaw) Ry(pitch) Rx(roll), in the names of the cosines and sines."""
    (cr, cp, cy), (sr, sp_, sy) = (tuple(real(f"{f}_{w}") for w in words) for f in ("cos", "sin"))
    return sp.Matrix(
        [
            [cy * cp, cy * sp_ * sr - sy * cr, cy * sp_ * cr + sy * sr],
            [sy * cp, sy * sp_ * sr + cy * cr, sy * sp_ * cr - cy * sr],
            [-sp_, cp * sr, cp * cr],
        ]
    )


def span(rod: Rod, position: Sequence[sp.Expr], arm: Sequence[sp.Expr], base: Sequence[sp.Expr]) -> tuple[Let, ...]:
    """The vector from the joint on the base to the joint on the plate."""
    lets = (Let(n, p + a - b) for n, p, a, b in zip(names("span", rod), position, arm, base, strict=True))
    return with_note(lets, f"leg {rod.name}: vector from its joint on the base to its joint on the platform")


def length(rod: Rod) -> Let:
    """The length of the span."""
    return Let(of("length", rod), Root(sp.Add(*[c**2 for c in names("span", rod)])))


def row(rod: Rod, arm: Sequence[sp.Expr], measured: sp.Expr) -> tuple[Let, ...]:
    """A row of A: the unit vector along a span of known length, and its moment about the origin of the plate."""
    along, one = names("along", rod), divisor(rod, measured)
    lets = (
        one,
        *(Let(a, s / one.name) for a, s in zip(along, names("span", rod), strict=True)),
        *_moment(rod, arm, along),
    )
    return with_note(lets, f"leg {rod.name} as a line: unit vector, and its moment about the platform's origin")


def span_moment(rod: Rod, arm: Sequence[sp.Expr]) -> tuple[Let, ...]:
    """The moment in a row of A, times the length of the leg: nothing is divided."""
    return with_note(
        _moment(rod, arm, names("span", rod)), f"leg {rod.name}: the moment of its span about the platform's origin"
    )


def _moment(rod: Rod, arm: Sequence[sp.Expr], vector: Sequence[sp.Expr]) -> tuple[Let, ...]:
    moment = sp.Matrix(list(arm)).cross(sp.Matrix(list(vector))) / RADIUS
    return tuple(Let(n, v) for n, v in zip(names("moment", rod), moment, strict=True))


def divisor(rod: Rod, measured: sp.Expr) -> Let:
    """The length of a leg; 1 where the leg is too short to have a direction."""
    return Let(of("divisor", rod), Select(sp.Gt(measured, SHORTEST_LINK * SCALE), measured, sp.Integer(1)))


def with_note(lets: Iterable[Let], note: str) -> tuple[Let, ...]:
    """The statements, the first of them with a note."""
    first, *others = lets
    return (replace(first, note=note), *others)


def rows(mechanism: Mechanism, vector: str = "along") -> tuple[sp.Symbol, ...]:
    """The names of the entries of A, by rows. With the vector "span" each row is multiplied by the
    length of its leg.
    """
    return tuple(entry for rod in mechanism.rods for word in (vector, "moment") for entry in names(word, rod))
