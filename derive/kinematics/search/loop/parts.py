"""One step around the circle, from an angle on which a wave does not vanish: on the step it does not vanish either.

By Taylor's formula, with a bound of the fifth derivative, the wave keeps its sign and stays above half of its rounding.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import sympy as sp

from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select, ToReal, larger
from derive.ir.program import Let, Output, Program
from derive.ir.symbols import count, flag, real
from derive.kinematics.search.programs import START
from derive.kinematics.search.wave import FIFTH, NOISE, names_of, turned

AHEAD_BY, DIRECTION = real("ahead_by"), count("direction")
"""Where the wave is looked at: so far from the start of the search, in this direction, 1 or -1."""
IS_ROUNDING, SAFE = flag("is_rounding"), real("safe_step")
"""Whether the wave is rounding there; the length of a step on which it does not vanish (radians)."""
_SHORTEST, _TRIES = sp.Float("1e-15"), 6
"""The shortest step; the lengths that are tried."""
_ZERO, _ONE = sp.Integer(0), sp.Integer(1)


def look_program(degree: int) -> Program:
    """The program that looks at the wave."""
    lets, c, s = turned(degree, START + ToReal(DIRECTION) * AHEAD_BY)
    body = [*lets, *_derivatives(degree, c, s), Let(IS_ROUNDING, sp.Le(sp.Abs(real("wave")), NOISE)), *_safe_step()]
    outputs = [Output(IS_ROUNDING.name, IS_ROUNDING), Output(SAFE.name, larger(real(f"safe_{_TRIES}"), _SHORTEST))]
    program = normalise("look_at_wave", body, outputs)
    return replace(
        program, summary="Whether the wave is rounding at an angle, and how far it does not vanish from there"
    )


def _derivatives(degree: int, c: list[sp.Expr], s: list[sp.Expr]) -> Iterator[Let]:
    """The wave and its first four derivatives in the direction, over their factorials."""
    names = names_of(degree)
    cosines, sines = names[: degree + 1], [_ZERO, *names[degree + 1 :]]
    pairs = [(real(f"even_{n}"), real(f"odd_{n}")) for n in range(degree + 1)]
    for n, (even, odd) in enumerate(pairs[1:], 1):
        yield from (Let(even, cosines[n] * c[n] + sines[n] * s[n]), Let(odd, sines[n] * c[n] - cosines[n] * s[n]))
    for power, name in enumerate(("wave", "slope", "bend", "third", "fourth")):
        factor = sp.Rational((1, 1, -1, -1, 1)[power], (1, 1, 2, 6, 24)[power])
        terms = [n**power * pairs[n][power % 2] for n in range(1, degree + 1)]
        value = sp.Add(*terms) * factor if power else sp.Add(cosines[0], *terms)
        yield Let(real(name), value * (ToReal(DIRECTION) if power % 2 else 1))


def _safe_step() -> Iterator[Let]:
    """The length of a step on which the wave does not vanish.

    On a step up to h, |W| is at least room - slope h - curve h², where the wave falls with this slope (or rises, if it
    is negative) and the curve grows with h. So what this allows is safe as far as it is no more than h. Lengths are
    tried between one that is safe and one that is too long.
    """
    sign, room = real("sign_of_wave"), real("room")
    yield Let(sign, Select(sp.Lt(real("wave"), 0), sp.Integer(-1), _ONE))
    yield Let(room, larger(sp.Abs(real("wave")) - NOISE / 2, _ZERO))
    slope, bend, third, fourth = (real(f"falls_{name}") for name in ("slope", "bend", "third", "fourth"))
    yield Let(slope, -sign * real("slope"))
    for name in (bend, third, fourth):
        yield Let(name, larger(-sign * real(name.name.removeprefix("falls_")), _ZERO))
    length, safe, long = _ONE, _ZERO, _ONE
    for k in range(1, 1 + _TRIES):
        curve, root, allowed, best = (real(f"{n}_{k}") for n in ("curve", "root", "allowed", "safe"))
        yield Let(curve, bend + length * (third + length * (fourth + length * FIFTH)))
        yield Let(root, Root(slope**2 + 4 * room * curve))
        # the positive zero of room - slope h - curve h², without a difference of equal numbers
        is_falling = sp.Gt(slope, 0)
        above = Select(is_falling, 2 * room, root - slope)
        below = Select(is_falling, slope + root, 2 * curve)
        is_short = sp.Gt(below * length, above)
        yield Let(allowed, Select(is_short, above / Select(is_short, below, _ONE), length))
        yield Let(best, larger(allowed, safe))
        if k < _TRIES:
            yield Let(real(f"long_{k}"), Select(is_short, length, long))
            long, safe = real(f"long_{k}"), best
            yield Let(real(f"length_{k}"), Root(safe * long))
            length = real(f"length_{k}")
