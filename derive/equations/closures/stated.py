"""The closure of a mechanism that states its equations, its rods and its guides."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from derive.algebra.normal_form import is_compound, polynomial, reduce_units, split_known
from derive.description.mechanism import ROTATION, Mechanism, Rod
from derive.equations.closures.closure import FLANGE, Closure, arguments_of, named_equation
from derive.equations.closures.fixed_names import all_angles, heading_entries, signs_of, with_fixed_names
from derive.equations.problem import Equation
from derive.ir.primitives import Root, Select
from derive.ir.program import Let
from derive.ir.symbols import COORDINATE_NAMES, cosine, real, sine


def stated_closure(mechanism: Mechanism, offset: dict[str, sp.Symbol], known: str = "span") -> Closure:
    """The stated equations. With an offset they are written for the flange, whose orientation is then known.

    known: the name of the known part of a rod's vector: "span" where the joints are unknown, "pivot" where the position
    is unknown.
    """
    flange = dict(zip(COORDINATE_NAMES, FLANGE, strict=True))
    rotation = sp.eye(3) if mechanism.heading is None else sp.Matrix(3, 3, [*heading_entries().values()])
    shift = rotation * sp.Matrix([*offset.values()]) if offset else ()
    note = "position of the flange: the point less its offset"
    lets = tuple(Let(flange[c], real(c) - o, note) for c, o in zip(offset, shift, strict=True))
    table = {real(c): flange[c] for c in offset}
    wanted = {j.symbol for j in mechanism.joints} if known == "span" else set(map(real, COORDINATE_NAMES))
    equations = [
        named_equation(mechanism, _label(e, number), sp.sympify(e).xreplace(table))
        for number, e in enumerate(mechanism.closure, 1)
    ]
    equations += [
        named_equation(mechanism, f"guide {plane.name}", plane.equation)
        for plane in mechanism.guides
        if plane.equation.free_symbols & {j.symbol for j in mechanism.joints}
    ]
    rods = mechanism.rods if known == "span" else mechanism.holding_rods
    equations += [_rod_equation(mechanism, rod, table, (known, wanted)) for rod in rods]
    planes = tuple((c, offset.get(c, sp.Integer(0))) for c in COORDINATE_NAMES if c not in mechanism.motion.position)
    return Closure(tuple(equations), arguments_of(mechanism.equations), lets, planes)


def position_closure(mechanism: Mechanism) -> Closure:
    """The stated equations with the joints known and the position unknown."""
    return stated_closure(mechanism, {}, "pivot")


def _rod_equation(
    mechanism: Mechanism, rod: Rod, table: dict[sp.Symbol, sp.Symbol], sought: tuple[str, set[sp.Symbol]]
) -> Equation:
    """|plate - base|^2 = length^2, with one name for the known part of every coordinate."""
    word, wanted = sought
    unknown = {s for v in wanted for s in (v, sine(v), cosine(v))}
    lets: list[Let] = []
    total: sp.Expr = -(rod.length**2)
    if rod.ring is not None:
        between = [with_fixed_names(mechanism, plate - base) for plate, base in zip(rod.plate, rod.base, strict=True)]
        known = ring_span(mechanism, rod, between, ROTATION[:, 2])
        total += sp.Add(*[let.name**2 for let in known[-3:]])
        return Equation(f"rod {rod.name}", total, known, _rod_scales(mechanism, rod))
    for name, plate, base in zip(COORDINATE_NAMES, rod.plate, rod.base, strict=False):
        between = with_fixed_names(mechanism, (plate - base).xreplace(table))
        form = polynomial(between, all_angles(mechanism), signs_of(mechanism))
        moving, known = split_known(form, unknown)
        side = 1 if word == "span" else -1  # a span points from the base to the plate, a pivot is a point of the base
        known = side * known
        if is_compound(known):
            note = f"rod {rod.name}: {'known part of its vector' if word == 'span' else 'centre about which it swings'}"
            lets.append(Let(real(f"{word}_{rod.name}_{name}"), known, "" if lets else note))
            known = lets[-1].name
        total += (moving + side * known) ** 2
    expression = reduce_units(total, all_angles(mechanism), signs_of(mechanism))
    return Equation(f"rod {rod.name}", expression, tuple(lets), _rod_scales(mechanism, rod))


def ring_span(
    mechanism: Mechanism, rod: Rod, between: Sequence[sp.Expr], axis: Sequence[sp.Expr], word: str = "span"
) -> tuple[Let, ...]:
    """The vector of a rod that ends on a ring, in the last three statements.

    between: from its base to the centre of the ring; axis: that of the ring.
    """
    assert rod.ring is not None
    to_centre, across, to_ring = (
        [real(f"{what}_{rod.name}_{c}") for c in COORDINATE_NAMES] for what in ("to_centre", "across", word)
    )
    ahead, apart, share = (real(f"{what}_{rod.name}") for what in ("ahead", "off_axis", "ring_share"))
    radius = with_fixed_names(mechanism, rod.ring)
    first, *others = (Let(n, v) for n, v in zip(to_centre, between, strict=True))
    return (
        replace(first, note=f"rod {rod.name}: vector from its base to the centre of its ring"),
        *others,
        Let(ahead, sp.Add(*[c * a for c, a in zip(to_centre, axis, strict=True)])),
        *(Let(n, c - ahead * a) for n, c, a in zip(across, to_centre, axis, strict=True)),
        Let(apart, Root(sp.Add(*[n**2 for n in across])), "distance of its base from the axis of the ring"),
        Let(share, radius / Select(sp.Gt(apart, 0), apart, sp.Integer(1))),
        *(Let(n, c - share * a) for n, c, a in zip(to_ring, to_centre, across, strict=True)),
    )


def _rod_scales(mechanism: Mechanism, rod: Rod) -> dict[sp.Symbol, sp.Expr]:
    """2 * length * |derivative of the rod's vector| by a joint or by the position, where that is a constant."""
    scales: dict[sp.Symbol, sp.Expr] = {}
    for symbol in (*(j.symbol for j in mechanism.joints), *(real(c) for c in COORDINATE_NAMES)):
        rates = [sp.diff(p - b, symbol) for p, b in zip(rod.plate, rod.base, strict=True)]
        square = polynomial(
            with_fixed_names(mechanism, sum(r**2 for r in rates)), all_angles(mechanism), signs_of(mechanism)
        )
        if square != 0 and not square.free_symbols & set(_moving_symbols(mechanism)):
            scales[symbol] = 2 * rod.length * sp.sqrt(sp.factor(square))
    return scales


def _moving_symbols(mechanism: Mechanism) -> tuple[sp.Symbol, ...]:
    joints = [j.symbol for j in mechanism.joints]
    return (*joints, *(f(a) for a in joints for f in (sine, cosine)), *(real(c) for c in COORDINATE_NAMES))


def _label(equation: sp.Expr, number: int) -> str:
    held = [c for c in COORDINATE_NAMES if real(c) in sp.sympify(equation).free_symbols]
    return held[0] if len(held) == 1 else f"closure_{number}"
