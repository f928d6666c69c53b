"""A platform that only turns about the origin, where one of its points is fixed.

Its equations contain the rotation alone, and its task commands no position. It is described as a platform whose point
at the origin stays in three planes: this is its bearing. Two directions that enclose a fixed angle, w of a joint and
R v of the platform, are the ends of a rod: w . R v = c says that |w - R v|^2 = |w|^2 + |v|^2 - 2 c.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

import sympy as sp

from derive.description.mechanism import Mechanism, Plane, Rod, guide, on_plate, rod
from derive.ir.symbols import COORDINATE_NAMES, ROTATION_ENTRIES, real

End = TypeVar("End", Rod, Plane)
_ORIGIN = tuple(real(c) for c in COORDINATE_NAMES)


def with_fixed_point(mechanism: Mechanism) -> Mechanism:
    """The mechanism with the planes that hold its point at the origin, if its equations only turn it."""
    read = {s for e in mechanism.equations for s in e.free_symbols}
    if not mechanism.is_platform or mechanism.task.position or read & {*_ORIGIN}:
        return mechanism
    taken = {r.key for r in mechanism.rods} | {p.name for p in mechanism.guides}
    ends = [_leg(mechanism, k, e, taken) for k, e in enumerate(mechanism.closure, 1)]
    legs = [end for end in ends if end is not None]
    planes = tuple(
        guide(f"centre_{c}", tuple(int(c == d) for d in COORDINATE_NAMES), on_plate(0, 0, 0)) for c in COORDINATE_NAMES
    )
    home = (*[sp.Integer(0)] * 3, *mechanism.home) if mechanism.home else ()
    return replace(
        mechanism,
        closure=tuple(e for e, end in zip(mechanism.closure, ends, strict=True) if end is None),
        rods=(*legs, *(_held(r) for r in mechanism.rods)),
        guides=(*planes, *(_held(g) for g in mechanism.guides)),
        home=home,
    )


def _held(leg: End) -> End:
    """A copy of the leg in which its point of the platform has its coordinates from the origin."""
    if len(leg.plate) != len(_ORIGIN):
        return leg
    return replace(leg, plate=tuple(p + c for p, c in zip(leg.plate, _ORIGIN, strict=True)))


def _leg(mechanism: Mechanism, number: int, equation: sp.Expr, taken: set[str]) -> Rod | None:
    """The rod between two directions, where the equation says that they enclose a fixed angle; else None."""
    try:
        form = sp.Poly(sp.expand(equation), *ROTATION_ENTRIES)
    except sp.PolynomialError:
        return None
    if form.total_degree() != 1:
        return None
    product = sp.Matrix(3, 3, [form.coeff_monomial(r) for r in ROTATION_ENTRIES])
    column = next(k for k in range(3) if any(v != 0 for v in product[:, k]))
    first = product[:, column]
    row = next(k for k in range(3) if first[k] != 0)
    own = [sp.simplify(product[row, k] / first[row]) for k in range(3)]
    joints = {j.symbol for j in mechanism.joints}
    size, rest = sp.simplify(first.dot(first)), form.coeff_monomial(1)
    is_product = all(sp.simplify(v) == 0 for v in product - first * sp.Matrix([own]))
    moved = {s for v in (*own, size, rest) for s in sp.sympify(v).free_symbols} & joints
    if not is_product or moved:
        return None
    length = sp.sqrt(sp.factor(sp.simplify(size + sum(v**2 for v in own) + 2 * rest)))
    name = str(number) if str(number) not in taken else f"closure_{number}"
    return rod(name, list(first), on_plate(*own), length)
