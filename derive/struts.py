"""Machines whose struts or cables change their lengths and meet in one point."""

from __future__ import annotations

from collections.abc import Sequence

from derive.description.branches import assembly
from derive.description.dimensions import Constraint, coordinate
from derive.description.joints import linear
from derive.description.loops import rod
from derive.description.mechanism import Mechanism, Task, Vendor, X, Y, Z
from derive.geometry.vectors import cross, dot, minus, triple, vector

_ON_A_LINE = 1e-12
"""The square of the sine between two sides of the triangle of the anchors, at or below which they are on a line."""


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
        rods=tuple(rod(str(k), end, point, axis) for k, (end, axis) in enumerate(zip(fixed, axes, strict=True), 1)),
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
