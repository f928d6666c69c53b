"""The cones of a rod's joints: the largest angle between a rod and its direction at the home pose.

Let u be the unit vector along the rod in the frame of the base, and R^T u the same in the frame of the plate. At the
home pose these are u0 and R0^T u0, the axes of the two cones. A joint swings by the angle between the rod and the axis
of its cone. The span along that axis is compared with the length of the rod times the least cosine, so that no unit
vector is needed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import sympy as sp

from derive.description.mechanism import Mechanism, Rod
from derive.ir.constants import BOUNDARY, DEGREE
from derive.ir.primitives import Select, angle_of_cosine
from derive.ir.program import Let, Output, Require, Statement, Status
from derive.ir.reason import Unit, Why, about_leg
from derive.ir.symbols import real
from derive.plate.legs import leg_symbol, names, rotation_of, turned, vector_word

_HOME, _SEEN, _TURNED = "home_along", "plate_axis", "cone_axis"
"""Words for the rod's direction at home: in the frame of the base, in that of the plate, and turned with the plate."""
_BEYOND = {"base": Why.BEYOND_BASE_CONE, "plate": Why.BEYOND_PLATE_CONE}


def cone_axes(mechanism: Mechanism, home_rotation: sp.Matrix) -> tuple[Let, ...]:
    """The axes of the cones on the plate, in its frame. Those on the base are the rods' directions at the home pose."""
    back = home_rotation.T
    rods = (rod for rod in mechanism.holding_rods if rod.plate_cone is not None)
    return tuple(let for rod in rods for let in turned(back, names("along", rod), names(_SEEN, rod)))


def cone_constants(mechanism: Mechanism) -> Iterator[Output]:
    """The axes of all cones as outputs, for other programs."""
    for rod in mechanism.holding_rods:
        for cone, axis, source in ((rod.base_cone, _HOME, "along"), (rod.plate_cone, _SEEN, _SEEN)):
            if cone is not None:
                yield from (Output(n.name, s) for n, s in zip(names(axis, rod), names(source, rod), strict=True))


def cone_checks(mechanism: Mechanism) -> tuple[Statement, ...]:
    """The conditions on the directions of the rods at a solved pose."""
    on_base = [(rod, rod.base_cone) for rod in mechanism.holding_rods if rod.base_cone is not None]
    on_plate = [(rod, rod.plate_cone) for rod in mechanism.holding_rods if rod.plate_cone is not None]
    rotation = rotation_of(mechanism)
    taken = (let for rod, _ in on_plate for let in turned(rotation, names(_SEEN, rod), names(_TURNED, rod)))
    vectors = {rod.name: names(vector_word(mechanism, rod), rod) for rod in mechanism.holding_rods}
    return (*_inside("base", on_base, vectors, _HOME), *taken, *_inside("plate", on_plate, vectors, _TURNED))


def _inside(
    side: str, cones: Sequence[tuple[Rod, sp.Expr]], vectors: Mapping[str, Sequence[sp.Symbol]], axis: str
) -> Iterator[Statement]:
    """The conditions that every rod is inside its cone. The boundary belongs to the cone; 180 degrees are no bound."""
    widths = list(dict.fromkeys(cone for _, cone in cones))
    least = {cone: real(f"least_cos_{side}" + (f"_{k}" if len(widths) > 1 else "")) for k, cone in enumerate(widths, 1)}
    for cone, name in least.items():
        narrow = sp.Gt(sp.cos(cone), BOUNDARY - 1)
        yield Let(
            name, Select(narrow, sp.cos(cone) - BOUNDARY, sp.Integer(-2)), f"least cosine of a leg's lean on the {side}"
        )
    for rod, cone in cones:
        ahead = leg_symbol(f"along_{side}_cone", rod)
        note = f"leg {rod.name}: how far it reaches along the axis of its cone on the {side}"
        yield Let(ahead, sp.Add(*[a * b for a, b in zip(vectors[rod.name], names(axis, rod), strict=True)]), note)
        beyond = angle_of_cosine(ahead, rod.length) - angle_of_cosine(least[cone])
        reason = about_leg(rod.name, _BEYOND[side], beyond / DEGREE, Unit.ANGLE)
        yield Require(sp.Ge(ahead, least[cone] * rod.length), Status.UNREACHABLE, reason=reason)
