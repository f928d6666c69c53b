"""Sweeps: where a root near its fold turns a later angle that is nearly free, that angle is chosen and the earlier one follows.

Behind a two-root step for v a partial step takes u as the direction of (x, y), both linear in cos v and sin v. Where (x, y)
nearly vanishes and v is known to half of the digits, or not at all, u sweeps half a turn within what rounding leaves of v: no
first order of u by v is worth anything. But x sin u = y cos u is linear in cos v and sin v. So u is moved to where a later
step can reach, and v follows: cos v : sin v = -q : p with p, q what x sin u - y cos u holds of cos v and sin v, of the two
opposite v that for which (x, y) points along u and not against it. There are two such u, on both sides of the middle of the
arc, and the one is taken that costs less: what is left of v's own equation. Where p and q vanish any v gives this u, and v stays.
Where u is free behind v as well, the nearer v is taken: at half of the threshold, for what is nearer to it than rounding is not
known to be free, and a u that the step behind still takes from (x, y) must not point against it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from derive.algebra.normal_form import cosine, linear_coefficients, reduce_units, sine
from derive.equations.problem import Measure
from derive.ir.constants import (
    BOUNDARY,
    FREE_ANGLE,
    INSIDE,
)
from derive.ir.primitives import (
    Root,
    Select,
)
from derive.ir.program import (
    Let,
)
from derive.ir.symbols import (
    flag,
    real,
)
from derive.solver.feasible_arc import nearest_on_arc

Row = tuple[sp.Expr, sp.Expr]


@dataclass(frozen=True)
class Sweep:
    """A later angle that the root may turn by any amount."""

    angle: sp.Symbol
    """u"""
    length: sp.Symbol
    """|(x, y)|"""
    parts: tuple[sp.Symbol, sp.Symbol]
    """x, y"""
    x: Row
    """What x holds of cos v and sin v."""
    y: Row
    harmonic: Row
    """What the later step's value holds of cos u and sin u."""


def sweep_of(chain: Sequence[Let], value: sp.Expr, first: sp.Symbol, measures: Sequence[Measure]) -> Sweep | None:
    """The partial step whose angle turns with that of an earlier step, on the way to the value; None where there is none."""
    lets = {let.name: let for let in chain}
    for measure in measures:
        bound = lets.get(cosine(measure.angle)), lets.get(sine(measure.angle))
        if measure.value not in lets or bound[0] is None or bound[1] is None:
            continue
        parts = tuple(sp.fraction(b.value.args[1])[0] for b in bound if b is not None and isinstance(b.value, Select))
        if len(parts) != 2 or not all(p in lets for p in parts):
            continue
        rows = [linear_coefficients(_through(p, lets, first), (cosine(first), sine(first))) for p in parts]
        harmonic = _harmonic(value, lets, measure.angle)
        if harmonic is not None and all(r is not None and r[1] == 0 for r in rows):
            x, y = ((r[0][0], r[0][1]) for r in rows if r is not None)
            return Sweep(measure.angle, measure.value, (parts[0], parts[1]), x, y, harmonic)
    return None


def _through(value: sp.Expr, lets: Mapping[sp.Symbol, Let], first: sp.Symbol) -> sp.Expr:
    """A value through the cosine and sine of the first angle."""
    return _written_out(value, {n: s.value for n, s in lets.items() if n not in (cosine(first), sine(first))})


def _written_out(value: sp.Expr, definitions: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    known = {n: v for n, v in definitions.items() if not isinstance(v, Root | Select)}
    while value.free_symbols & known.keys():
        value = sp.expand(value.xreplace(known))
    return value


def _harmonic(value: sp.Expr, lets: Mapping[sp.Symbol, Let], angle: sp.Symbol) -> Row | None:
    """What a value holds of cos u and sin u, where it is linear in them and squares of sines and cosines are put together."""
    own = {cosine(angle), sine(angle)}
    angles = [a for n in lets if n.name.startswith("cos_") for a in [real(n.name.removeprefix("cos_"))] if sine(a) in lets]
    functions = {f(a) for a in angles for f in (cosine, sine)}
    rough = _written_out(value, {n: s.value for n, s in lets.items() if n not in functions})
    moving = set(own)
    for let in lets.values():
        if let.value.free_symbols & moving:
            moving.add(let.name)
    fine = _written_out(reduce_units(rough, angles), {n: lets[n].value for n in moving - own})
    linear = linear_coefficients(fine, (cosine(angle), sine(angle)))
    return None if linear is None or linear[0] == [0, 0] else (linear[0][0], linear[0][1])


WAYS = ("near", "mirrored")
"""u moves to the arc that is on its side of the centre, or to the other."""


def swept(
    sweep: Sweep, first: sp.Symbol, names: Mapping[sp.Symbol, sp.Expr], rates: Mapping[sp.Symbol, sp.Expr], word: str
) -> tuple[Let, ...]:
    """Where u moves, both ways, and v follows: `<way>_cos_<word>`, `<way>_sin_<word>`; `follows_<word>` where it must.

    names: of values before the motion; rates: their derivatives by v. `turn_<word>` is how far the first order turns v.
    """
    before = (names[cosine(sweep.angle)], names[sine(sweep.angle)])
    slopes = (sweep.harmonic[0].xreplace(dict(names)), sweep.harmonic[1].xreplace(dict(names)))
    target = f"{sweep.angle.name}_{word}"
    moved, mirrored = real(f"moved_{target}"), real(f"mirrored_{target}")
    return (
        _follows(sweep, names, rates, word),
        *nearest_on_arc(target, real(f"value_{word}"), (1 - INSIDE) * real(f"size_{word}"), slopes, before),
        *_followed(sweep, moved, (names[cosine(first)], names[sine(first)]), WAYS[0], word),
        Let(mirrored, 2 * real(f"centre_{target}") - moved, "the other way to the arc"),
        *_followed(sweep, mirrored, (names[cosine(first)], names[sine(first)]), WAYS[1], word),
    )


def _follows(sweep: Sweep, names: Mapping[sp.Symbol, sp.Expr], rates: Mapping[sp.Symbol, sp.Expr], word: str) -> Let:
    """Whether the turn is so far, or turns u so far, that the second order counts."""
    square = real(f"turn_{word}") ** 2
    dx, dy = (rates[part].xreplace(dict(names)) for part in sweep.parts)
    is_far = sp.Gt(square, BOUNDARY) | sp.Gt(square * (dx**2 + dy**2), BOUNDARY * names[sweep.length] ** 2)
    return Let(flag(f"follows_{word}"), is_far, f"whether it follows {sweep.angle.name}")


def _followed(sweep: Sweep, u: sp.Symbol, before: Row, way: str, word: str) -> tuple[Let, ...]:
    """v where u is given; before: its cosine and sine where it was, which decide where u is free."""
    cos_u, sin_u, p, q, along, radius, length, turned, side, cos_v, sin_v = (
        real(f"{way}_{name}_{word}")
        for name in (
            f"cos_{sweep.angle.name}", f"sin_{sweep.angle.name}", "p", "q", "along", "radius", "length", "towards", "side", "cos",
            "sin",
        )
    )  # fmt: skip
    (x1, x2), (y1, y2) = sweep.x, sweep.y
    is_long, one = sp.Gt(radius, BOUNDARY), sp.Integer(1)
    is_free, (cos_before, sin_before) = sp.Le(sp.Abs(along), FREE_ANGLE * radius / 2), before  # whatever rounding says later
    ahead = Select(is_free, p * sin_before - q * cos_before, along)
    return (
        Let(cos_u, sp.cos(u)),
        Let(sin_u, sp.sin(u)),
        Let(p, x1 * sin_u - y1 * cos_u),
        Let(q, x2 * sin_u - y2 * cos_u),
        Let(along, p * (x2 * cos_u + y2 * sin_u) - q * (x1 * cos_u + y1 * sin_u)),
        Let(radius, Root(p**2 + q**2)),
        Let(length, Select(is_long, radius, one)),
        Let(turned, ahead, "of two opposite ways"),
        Let(side, Select(sp.Lt(turned, 0), -one, one)),
        Let(cos_v, Select(is_long, -q * side / length, cos_before), "the earlier angle follows"),
        Let(sin_v, Select(is_long, p * side / length, sin_before), "it stays where every angle gives this one"),
    )
