"""Sweeps: where an angle near its fold turns a later angle that is nearly free, the later one is chosen and the earlier
follows.

After a two-root step for v, another step takes u as the polar angle of (x, y), both linear in cos v and sin v. Where
(x, y) nearly vanishes, and v is known to half of its digits or not at all, u sweeps half a turn while v changes by
rounding: the derivative of u by v says nothing. But x sin u = y cos u is linear in cos v and sin v. So u is moved to
where a later step has a solution, and v follows from p cos v + q sin v = 0, the coefficients of x sin u - y cos u: cos
v : sin v = -q : p. Of the two opposite v the one is taken for which (x, y) points along u. There are two such u, one on
each side of the centre of the feasible arc; the one is taken that leaves the smaller residual of v's own equation.
Where p and q vanish every v gives this u, and v stays. Where u is free behind v as well, the v nearer to where it was
is taken. This is decided at half of the threshold: within rounding of the threshold the next step may still take u from
(x, y), and must not then find it pointing the other way.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from derive.algebra.normal_form import linear_coefficients, reduce_units
from derive.equations.problem import Conditioning
from derive.ir.constants import BOUNDARY, FREE_ANGLE, INSIDE
from derive.ir.primitives import Root, Select
from derive.ir.program import Let
from derive.ir.symbols import angle_of, cosine, flag, real, sine
from derive.solver.corners.feasible_arc import nearest_on_arc

Row = tuple[sp.Expr, sp.Expr]


@dataclass(frozen=True)
class Sweep:
    """A later angle that a small change of the earlier one may turn by any amount."""

    angle: sp.Symbol
    """u"""
    length: sp.Symbol
    """|(x, y)|"""
    parts: tuple[sp.Symbol, sp.Symbol]
    """x, y"""
    x: Row
    """The coefficients of cos v and sin v in x."""
    y: Row
    harmonic: Row
    """The coefficients of cos u and sin u in the value of the later step."""


def sweep_of(
    chain: Sequence[Let], value: sp.Expr, first: sp.Symbol, conditionings: Sequence[Conditioning]
) -> Sweep | None:
    """The step whose angle may be free by which a value depends on an earlier angle; None where there is none."""
    lets = {let.name: let for let in chain}
    for conditioning in conditionings:
        bound = lets.get(cosine(conditioning.angle)), lets.get(sine(conditioning.angle))
        if conditioning.value not in lets or bound[0] is None or bound[1] is None:
            continue
        parts = tuple(sp.fraction(b.value.args[1])[0] for b in bound if b is not None and isinstance(b.value, Select))
        if len(parts) != 2 or not all(p in lets for p in parts):
            continue
        rows = [linear_coefficients(_through(p, lets, first), (cosine(first), sine(first))) for p in parts]
        harmonic = _harmonic(value, lets, conditioning.angle)
        if harmonic is not None and all(r is not None and r[1] == 0 for r in rows):
            x, y = ((r[0][0], r[0][1]) for r in rows if r is not None)
            return Sweep(conditioning.angle, conditioning.value, (parts[0], parts[1]), x, y, harmonic)
    return None


def _through(value: sp.Expr, lets: Mapping[sp.Symbol, Let], first: sp.Symbol) -> sp.Expr:
    """A value as an expression of the cosine and sine of the first angle."""
    return _written_out(value, {n: s.value for n, s in lets.items() if n not in (cosine(first), sine(first))})


def _written_out(value: sp.Expr, definitions: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    known = {n: v for n, v in definitions.items() if not isinstance(v, Root | Select)}
    while value.free_symbols & known.keys():
        value = sp.expand(value.xreplace(known))
    return value


def _harmonic(value: sp.Expr, lets: Mapping[sp.Symbol, Let], angle: sp.Symbol) -> Row | None:
    """The coefficients of cos u and sin u in a value, where its normal form is linear in them; else None."""
    own = {cosine(angle), sine(angle)}
    angles = [a for a in map(angle_of, lets) if a is not None and sine(a) in lets]
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
"""u moves to the arc on its side of the centre, or to the other one, the mirror image."""


def swept(
    sweep: Sweep, first: sp.Symbol, names: Mapping[sp.Symbol, sp.Expr], rates: Mapping[sp.Symbol, sp.Expr], word: str
) -> tuple[Let, ...]:
    """u moved in both ways, and v that follows: `<way>_cos_<word>`, `<way>_sin_<word>`; `follows_<word>`: whether it
    must.

    names: those of the values before the motion; rates: their derivatives by v. `turn_<word>` is the turn of v to first
    order.
    """
    before = (names[cosine(sweep.angle)], names[sine(sweep.angle)])
    derivatives = (sweep.harmonic[0].xreplace(dict(names)), sweep.harmonic[1].xreplace(dict(names)))
    target = f"{sweep.angle.name}_{word}"
    moved, mirrored = real(f"moved_{target}"), real(f"mirrored_{target}")
    return (
        *nearest_on_arc(target, real(f"value_{word}"), (1 - INSIDE) * real(f"size_{word}"), derivatives, before),
        _follows(sweep, names, rates, word),
        *_followed(sweep, moved, (names[cosine(first)], names[sine(first)]), WAYS[0], word),
        Let(mirrored, 2 * real(f"centre_{target}") - moved, "mirror image on the other arc"),
        *_followed(sweep, mirrored, (names[cosine(first)], names[sine(first)]), WAYS[1], word),
    )


def _follows(sweep: Sweep, names: Mapping[sp.Symbol, sp.Expr], rates: Mapping[sp.Symbol, sp.Expr], word: str) -> Let:
    """Whether v turns so far, or u with it, that the second order in the value of the later step is more than rounding:
    half of the amplitude of its harmonic in u, times the square of the turn of u.
    """
    square, swing, size = real(f"turn_{word}") ** 2, real(f"swing_{sweep.angle.name}_{word}"), real(f"size_{word}")
    dx, dy = (rates[part].xreplace(dict(names)) for part in sweep.parts)
    bound = BOUNDARY / 2 * size * names[sweep.length] ** 2
    is_far = sp.Gt(square, BOUNDARY) | sp.Gt(swing * square * (dx**2 + dy**2), bound)
    return Let(
        flag(f"follows_{word}"),
        is_far,
        f"whether the first order is not enough: then {sweep.angle.name} is chosen first",
    )


def _followed(sweep: Sweep, u: sp.Symbol, before: Row, way: str, word: str) -> tuple[Let, ...]:
    """v where u is given. before: the cosine and sine of v where it was; where u is free the nearer v is taken."""
    cos_u, sin_u, p, q, along, radius, length, turned, side, cos_v, sin_v = (
        real(f"{way}_{name}_{word}")
        for name in (
            f"cos_{sweep.angle.name}", f"sin_{sweep.angle.name}", "p", "q", "along", "radius", "length", "towards",
            "side", "cos",
            "sin",
        )
    )  # fmt: skip
    (x1, x2), (y1, y2) = sweep.x, sweep.y
    is_long, one = sp.Gt(radius, BOUNDARY), sp.Integer(1)
    is_free, (cos_before, sin_before) = sp.Le(sp.Abs(along), FREE_ANGLE * radius / 2), before  # see above
    ahead = Select(is_free, p * sin_before - q * cos_before, along)
    return (
        Let(cos_u, sp.cos(u)),
        Let(sin_u, sp.sin(u)),
        Let(p, x1 * sin_u - y1 * cos_u),
        Let(q, x2 * sin_u - y2 * cos_u),
        Let(along, p * (x2 * cos_u + y2 * sin_u) - q * (x1 * cos_u + y1 * sin_u)),
        Let(radius, Root(p**2 + q**2)),
        Let(length, Select(is_long, radius, one)),
        Let(turned, ahead, "positive where the vector points along the later angle"),
        Let(side, Select(sp.Lt(turned, 0), -one, one)),
        Let(cos_v, Select(is_long, -q * side / length, cos_before), "the earlier angle follows"),
        Let(sin_v, Select(is_long, p * side / length, sin_before), "it stays where it has no effect"),
    )
