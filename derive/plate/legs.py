"""The legs of a platform at a pose: names, vectors, and the rows of the matrix A in A (v, w) = -e.

The length error of rod i is e = |span| - length. Let a be the arm from the origin of the plate to the rod's joint, and
u the unit vector along the rod. Then e' = [u, a x u] (v, w): a row of A is the line of the rod in Pluecker coordinates.
It has only those in which the platform moves: in a plane the components x and y of u, and z of its moment. Moments are
divided by the platform's radius, so that det A has no unit.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import repeat

import sympy as sp

from derive.description.mechanism import DescriptionError, Mechanism, Plane, Rod, Turning, on_plate
from derive.equations.closures.fixed_names import with_fixed_names
from derive.equations.closures.stated import ring_span
from derive.ir.constants import SHORTEST_LINK
from derive.ir.primitives import Root, Select
from derive.ir.program import Let
from derive.ir.symbols import COORDINATE_NAMES, HEADING, ROTATION_ENTRIES, SCALE, cosine, real, sine
from derive.plate.turns import ANGLES, least_turn

RADIUS = real("platform_radius")
MARGIN = "rods_dependent"

Vector = tuple[sp.Expr, ...]
Leg = Rod | Plane
"""A leg holds the platform: a rod, or a plane, which acts like a rod of infinite length."""
NORMAL = "normal"
"""The word for the vector of a plane."""


def rotation_axes(mechanism: Mechanism) -> tuple[str, ...]:
    """The axes about which the platform turns."""
    return COORDINATE_NAMES if mechanism.motion.turning is Turning.FULL else ("z",)


def angles(mechanism: Mechanism) -> tuple[str, ...]:
    """The angles of the platform's rotation from the start of an iteration."""
    return ANGLES if mechanism.motion.turning is Turning.FULL else ("yaw",)


def home_angles(mechanism: Mechanism) -> tuple[str, ...]:
    """The angles of the platform's home pose."""
    words = ANGLES if mechanism.motion.turning is Turning.FULL else (HEADING.name,)
    return tuple(f"home_{word}" for word in words)


def position_of(mechanism: Mechanism) -> Vector:
    """The position of the platform: zero if the task commands none."""
    return tuple(real(c) if c in mechanism.motion.position else sp.Integer(0) for c in COORDINATE_NAMES)


def rotation_of(mechanism: Mechanism) -> sp.Matrix:
    """The rotation of the platform, in the names of its entries, or of the cosine and sine of its heading."""
    if mechanism.motion.turning is Turning.FULL:
        return sp.Matrix(3, 3, ROTATION_ENTRIES)
    return about_z(cosine(HEADING), sine(HEADING))


def about_z(cos_value: sp.Expr, sin_value: sp.Expr) -> sp.Matrix:
    """A rotation about z."""
    return sp.Matrix([[cos_value, -sin_value, 0], [sin_value, cos_value, 0], [0, 0, 1]])


def legs_of(mechanism: Mechanism) -> tuple[Leg, ...]:
    """The legs that hold the platform: the rods, then the planes."""
    return (*mechanism.holding_rods, *mechanism.guides)


def names(word: str, leg: Leg) -> tuple[sp.Symbol, ...]:
    """The names of the components of a leg's vector: `span_1_x` and so on; in a plane it has two."""
    return tuple(real(f"{word}_{leg.key}_{c}") for c in COORDINATE_NAMES[: len(leg.plate)])


def leg_symbol(word: str, leg: Leg) -> sp.Symbol:
    """The name of a leg's number: `length_1`."""
    return real(f"{word}_{leg.key}")


def vector_word(mechanism: Mechanism, rod: Rod) -> str:
    """The word in the names of a rod's vector: "span"; where joints move the base end, "rod", for "span" is then the
    known part of the vector.
    """
    return "rod" if is_driven(mechanism, rod.base) else "span"


def is_driven(mechanism: Mechanism, values: Iterable[sp.Expr]) -> bool:
    """Whether joints move any of the values."""
    joints = {j.symbol for j in mechanism.joints}
    return any(v.free_symbols & joints for v in values)


def point_of(leg: Leg) -> Vector:
    """The leg's joint in the frame of the plate."""
    point = tuple(sp.diff(leg.plate[0], entry) for entry in ROTATION_ENTRIES[: len(leg.plate)])
    moved = map(real, COORDINATE_NAMES) if is_direction(leg) else repeat(sp.Integer(0))
    if any(sp.expand(a + m - b) != 0 for a, b, m in zip(leg.plate, on_plate(*point), moved, strict=False)):
        what, end = ("rod", "its end") if isinstance(leg, Rod) else ("guide", "its point")
        raise DescriptionError(f"{what} {leg.name!r}: {end} must be a point of the plate")
    return point


def is_direction(leg: Leg) -> bool:
    """Whether a guide holds a direction of the plate, R v, wherever the plate is, and not a point of it, x + R v."""
    return isinstance(leg, Plane) and not sp.Matrix(leg.plate).free_symbols & {*map(real, COORDINATE_NAMES)}


def arm_names(word: str, leg: Leg) -> tuple[sp.Symbol, ...]:
    """The names of the vector from the origin of the plate to the leg's joint there; to the centre of its ring."""
    return names(word if isinstance(leg, Plane) or leg.ring is None else f"{word}_to_ring", leg)


def turned(rotation: sp.Matrix, point: Sequence[sp.Expr], called: Sequence[sp.Symbol]) -> tuple[Let, ...]:
    """The product of a rotation and a point, bound to the names `called`."""
    size = len(point)
    return tuple(Let(n, v) for n, v in zip(called, rotation[:size, :size] * sp.Matrix(list(point)), strict=True))


def by_angles(words: Sequence[str] = ANGLES) -> sp.Matrix:
    """Rz(yaw) Ry(pitch) Rx(roll), or Rz of a single angle, in the names of the cosines and sines."""
    if len(words) == 1:
        return about_z(real(f"cos_{words[0]}"), real(f"sin_{words[0]}"))
    (cr, cp, cy), (sr, sp_, sy) = (tuple(real(f"{f}_{w}") for w in words) for f in ("cos", "sin"))
    return sp.Matrix(
        [
            [cy * cp, cy * sp_ * sr - sy * cr, cy * sp_ * cr + sy * sr],
            [sy * cp, sy * sp_ * sr + cy * cr, sy * sp_ * cr - cy * sr],
            [-sp_, cp * sr, cp * cr],
        ]
    )


def span(
    mechanism: Mechanism, rod: Rod, pose: tuple[Sequence[sp.Expr], sp.Matrix], base: Sequence[sp.Expr], arm: str = "arm"
) -> tuple[Let, ...]:
    """The vector from the joint on the base to the joint on the plate. arm: the word in the names of its arm, which are
    bound; on a ring they are bound here.
    """
    (position, rotation), word = pose, vector_word(mechanism, rod)
    between = [p + a - b for p, a, b in zip(position, arm_names(arm, rod), base, strict=False)]
    if rod.ring is not None:
        lets = ring_span(mechanism, rod, between, rotation[:, 2], word)
        ends = zip(names(arm, rod), names(word, rod), base, position, strict=True)
        return (*lets, *(Let(n, s + b - p) for n, s, b, p in ends))
    lets = tuple(Let(n, v) for n, v in zip(names(word, rod), between, strict=True))
    return with_note(lets, f"leg {rod.name}: vector from its joint on the base to its joint on the platform")


def length(rod: Rod, word: str = "span") -> Let:
    """The length of the span."""
    return Let(leg_symbol("length", rod), Root(sp.Add(*[c**2 for c in names(word, rod)])))


def row(
    mechanism: Mechanism, rod: Rod, arm: Sequence[sp.Expr], measured: sp.Expr, word: str = "span"
) -> tuple[Let, ...]:
    """A row of A: the unit vector along a span of known length, and its moment about the origin of the plate."""
    along, one = names("along", rod), divisor(rod, measured)
    lets = (
        one,
        *(Let(a, s / one.name) for a, s in zip(along, names(word, rod), strict=True)),
        *_moment(mechanism, rod, arm, along),
    )
    return with_note(lets, f"leg {rod.name} as a line: unit vector, and its moment about the platform's origin")


def span_moment(mechanism: Mechanism, rod: Rod, arm: Sequence[sp.Expr], word: str = "span") -> tuple[Let, ...]:
    """The moment in a row of A, times the length of the leg, so that no division is needed."""
    return with_note(
        _moment(mechanism, rod, arm, names(word, rod)),
        f"leg {rod.name}: the moment of its span about the platform's origin",
    )


def plane_row(
    mechanism: Mechanism, plane: Plane, arm: Sequence[sp.Expr], rotation: sp.Matrix, *, named: bool = True
) -> tuple[Let, ...]:
    """A row of A for a plane: its normal, and the normal's moment about the origin of the plate.

    rotation: that of the plate; named: whether angles and roots of the machine have names.
    """
    if plane.turns_along:
        return least_turn(plane.name, rotation[:, 2], moments(mechanism, plane))
    normal = names(NORMAL, plane)
    values = (with_fixed_names(mechanism, v) if named else v for v in plane.normal)
    lets = (*(Let(n, v) for n, v in zip(normal, values, strict=True)), *_moment(mechanism, plane, arm, normal))
    return with_note(lets, f"guide {plane.name}: its normal, and the moment of this about the platform's origin")


def _moment(mechanism: Mechanism, leg: Leg, arm: Sequence[sp.Expr], vector: Sequence[sp.Expr]) -> tuple[Let, ...]:
    padded = [sp.Matrix([*v, *[0] * (3 - len(v))]) for v in (arm, vector)]
    moment = dict(zip(COORDINATE_NAMES, padded[0].cross(padded[1]) / RADIUS, strict=True))
    return tuple(Let(n, moment[c]) for n, c in zip(moments(mechanism, leg), rotation_axes(mechanism), strict=True))


def moments(mechanism: Mechanism, leg: Leg) -> tuple[sp.Symbol, ...]:
    """The names of the moments in a row of A."""
    return tuple(real(f"moment_{leg.key}_{c}") for c in rotation_axes(mechanism))


def divisor(rod: Rod, measured: sp.Expr) -> Let:
    """The length of a leg; 1 where the leg is too short to have a direction."""
    return Let(leg_symbol("divisor", rod), Select(sp.Gt(measured, SHORTEST_LINK * SCALE), measured, sp.Integer(1)))


def with_note(lets: Iterable[Let], note: str) -> tuple[Let, ...]:
    """The statements, the first of them with a note."""
    first, *others = lets
    return (replace(first, note=note), *others)


def rows(mechanism: Mechanism, vectors: Sequence[str] | None = None) -> tuple[sp.Expr, ...]:
    """The names of the entries of A, by rows. With the words of the rods' vectors each row is multiplied by the
    length of its leg.
    """
    words = [*(vectors or ["along"] * len(mechanism.holding_rods)), *[NORMAL] * len(mechanism.guides)]
    return tuple(
        entry
        for leg, word in zip(legs_of(mechanism), words, strict=True)
        for entry in (*_shifts(mechanism, () if is_direction(leg) else names(word, leg)), *moments(mechanism, leg))
    )


def _shifts(mechanism: Mechanism, vector: Sequence[sp.Symbol]) -> tuple[sp.Expr, ...]:
    """The components of a vector along the coordinates of the position: a leg in a plane has none along z."""
    width = len(mechanism.motion.position)
    return (*vector[:width], *[sp.Integer(0)] * (width - len(vector)))
