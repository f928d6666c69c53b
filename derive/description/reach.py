"""Arms that reach a common point, and struts or cables of variable length: those that meet in one, and what a
description may say of surplus ones, of a load, and of coordinates that nobody commands.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import sympy as sp

from derive.description.branches import assembly
from derive.description.dimensions import Constraint, coordinate
from derive.description.joints import Joint, linear
from derive.description.loops import cable, rod
from derive.description.mechanism import Mechanism, Task, Turning, Vendor, X, Y, Z
from derive.geometry.vectors import Vector, cross, dot, minus, triple, vector
from derive.ir.program import Let
from derive.ir.symbols import COORDINATE_NAMES, real

_PAIRS = ((1, 2), (1, 3), (2, 3))
_ON_A_LINE = 1e-12
"""The square of the sine between two sides of the triangle of the anchors, at or below which they are on a line."""


def discs_meet(centres: Sequence[Vector], radii: Sequence[sp.Expr], message: str) -> tuple[Constraint, ...]:
    """The conditions that three discs in the plane, the ranges of three arms seen from above, have a point in common.

    centres: x and y; radii: not negative; message: the condition in words. Every two discs must intersect. Then all
    three do, unless the radical centre (the point with equal powers to the circles) lies in the triangle of the centres
    and outside the discs. If the centres lie on a line there is no radical centre, and the pairs decide.
    """
    corners = tuple(vector(*(real(f"reach_{c}_{i}") for c in "xy")) for i in (1, 2, 3))
    reaches = tuple(real(f"reach_{i}") for i in (1, 2, 3))
    steps: list[Let] = []
    for corner, centre, reach, radius in zip(corners, centres, reaches, radii, strict=True):
        steps += [*_named(corner, centre), Let(reach, sp.sympify(radius))]
    steps[0] = Let(steps[0].name, steps[0].value, "what every arm reaches, seen from above: a disc")
    sides = tuple(_vector(f"side_{i}{j}") for i, j in _PAIRS)
    for side, (i, j) in zip(sides, _PAIRS, strict=True):
        steps += _named(side, minus(corners[j - 1], corners[i - 1]))
    reached = ((reaches[i - 1] + reaches[j - 1]) ** 2 for i, j in _PAIRS)
    pairs = (sp.Le(dot(side, side), square) for side, square in zip(sides, reached, strict=True))
    return Constraint(sp.And(*pairs), message, tuple(steps)), _all_three(sides[0], sides[1], reaches, message)


def _all_three(second: Vector, third: Vector, reaches: Sequence[sp.Symbol], message: str) -> Constraint:
    """The condition on three discs that intersect in pairs, in coordinates from the first centre."""
    power_2, power_3, area = real("power_2"), real("power_3"), real("corner_area")
    centre = _vector("equal_power")  # times 2 * area, seen from the first corner
    weight_2, weight_3 = real("weight_2"), real("weight_3")  # barycentric, of the centre, times 2 * area²
    steps = (
        Let(area, cross(second, third)),
        Let(power_2, dot(second, second) + reaches[0] ** 2 - reaches[1] ** 2),
        Let(power_3, dot(third, third) + reaches[0] ** 2 - reaches[2] ** 2),
        *_named(centre, vector(power_2 * third[1] - power_3 * second[1], power_3 * second[0] - power_2 * third[0])),
        Let(weight_2, cross(centre, third)),
        Let(weight_3, cross(second, centre)),
    )
    is_outside = sp.Or(sp.Lt(weight_2, 0), sp.Lt(weight_3, 0), sp.Gt(weight_2 + weight_3, 2 * area**2))
    is_reached = sp.Le(dot(centre, centre), 4 * area**2 * reaches[0] ** 2)
    return Constraint(sp.Or(is_outside, is_reached), message, steps)


def _vector(name: str) -> Vector:
    return vector(*(real(f"{name}_{c}") for c in "xy"))


def _named(names: Vector, values: Vector) -> tuple[Let, ...]:
    return tuple(Let(real(str(name)), value) for name, value in zip(names, values, strict=True))


def three_to_a_point(
    name: str,
    *,
    what: str,
    anchors: Sequence[tuple[float, float, float]],
    nominal: float,
    hangs: bool,
    source: str,
    summary: str,
) -> Mechanism:
    """Three struts or cables that meet in one point.

    what: what changes its length, "strut" or "cable"; anchors: nominal places of their fixed ends; nominal: their
    lengths; hangs: the point is below the anchors.
    """
    places = [
        tuple(coordinate(f"{what}_{k}_{c}", f"{c.upper()} of the anchor of {what} {k}", nominal=v) for c, v in point)
        for k, point in enumerate((zip("xyz", place, strict=True) for place in anchors), 1)
    ]
    axes = tuple(
        linear(f"L{k}", f"Length of {what} {k}", domain=(0.0, 1e9), nominal=nominal) for k in range(1, len(places) + 1)
    )
    fixed, point = [vector(*place) for place in places], vector(X, Y, Z)
    sides = [minus(end, fixed[0]) for end in fixed[1:]]
    squares, across = [dot(side, side) for side in sides], dot(*sides)
    modes = {"below": -1, "above": +1} if hangs else {"above": +1, "below": -1}
    return Mechanism(
        name=name,
        vendor=Vendor.TEXTBOOK,
        family="parallel",
        source=source,
        summary=summary,
        parameters=tuple(p for place in places for p in place),
        joints=axes,
        rods=tuple(
            (cable if what == "cable" else rod)(str(k), end, point, axis)
            for k, (end, axis) in enumerate(zip(fixed, axes, strict=True), 1)
        ),
        task=Task("xyz"),
        positive=axes,
        assembly=assembly(
            "point",
            triple([minus(point, end) for end in fixed]),
            margin=f"{what}s_coplanar",
            handedness=cross(*sides),
            **modes,
        ),
        constraints=(
            Constraint(
                squares[0] * squares[1] - across**2 > _ON_A_LINE * squares[0] * squares[1],
                "the anchors must not lie on a line",
            ),
        ),
        notes=(
            "The point is above or below the plane of the anchors. Where that plane is vertical, above is the side "
            f"from which the {what}s 1, 2 and 3 go round clockwise.",
        ),
    )


def is_own_length(mechanism: Mechanism, joint: Joint) -> bool:
    """Whether one rod alone reads a joint, and no other joint: in its length, not in its ends. The rod has no cones."""
    joints, symbol = {j.symbol for j in mechanism.joints}, joint.symbol
    own = [rod for rod in mechanism.rods if joints & rod.equation.free_symbols == {symbol}]
    if len(own) != 1 or own[0].base_cone is not None or own[0].plate_cone is not None:
        return False  # a cone is about the leg at the home pose, which holding rods alone have
    if sum(symbol in e.free_symbols for e in mechanism.equations) != 1:
        return False
    at_ends = {s for v in (*own[0].base, *own[0].plate) for s in v.free_symbols}
    return symbol not in at_ends and symbol not in sp.diff(own[0].length, symbol).free_symbols


def wrong_surplus(mechanism: Mechanism) -> Iterator[str]:
    """What is wrong with the surplus joints that are stated."""
    for joint in mechanism.surplus:
        if joint.name not in {j.name for j in mechanism.joints}:
            yield f"surplus names {joint.name!r}, which is no joint of this mechanism"
        elif not is_own_length(mechanism, joint):
            yield f"surplus joint {joint.name!r} must be the length of one rod without cones, and occur nowhere else"


def wrong_load(mechanism: Mechanism) -> Iterator[str]:
    """What is wrong with the load."""
    if not mechanism.load:
        return
    if not mechanism.cables:
        yield "load= is for rods that only pull: state them by cable(...)"
    elif len(mechanism.load) != len(mechanism.cables[0].plate):
        width = len(mechanism.cables[0].plate)
        yield f"load= has {len(mechanism.load)} coordinates, and the ends of the cables have {width}"


def wrong_passive(mechanism: Mechanism) -> Iterator[str]:
    """What is wrong with the coordinates that joints move and nobody commands."""
    task = mechanism.task
    others = "".join(c for c in COORDINATE_NAMES if c not in task.position and c in task.passive)
    is_posed = mechanism.chain is not None and task.position and task.turning in (Turning.NONE, Turning.ABOUT_Z)
    if task.passive and (task.passive != others or not is_posed):
        yield (
            f"passive={task.passive!r} must be coordinates that are not commanded, in the order x, y, z, of a chain "
            "whose task is a position, with Turning.ABOUT_Z at most"
        )
