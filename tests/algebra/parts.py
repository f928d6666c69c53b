"""The parts of the circle in which a wave may be zero, one after the other.

From an angle at which the wave W is not rounding, the next step passes no zero: by Taylor's formula, with a bound of
the fifth derivative, |W| stays above half of the rounding. Where W is rounding a part begins. It ends where W is more
again, looked at in distances that double; one that is wide is followed by another.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import sympy as sp

from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select, larger
from derive.ir.program import Iterate, Let, Output, Program
from derive.ir.symbols import count, flag, real
from tests.algebra.wave import NOISE, names_of, turned

AT, END, LOW, HIGH, IS_PART, STEPS = (
    real("at"),
    real("end"),
    real("low"),
    real("high"),
    flag("is_part"),
    count("steps_left"),
)
"""Where the next part is looked for, up to which angle; its ends, if there is one; the steps that are left."""
MOST_STEPS = 1000
"""The steps around the circle, at most."""
_FIRST, _LONGEST, _SHORTEST = sp.Float("1e-13"), sp.Rational(1, 2), sp.Float("1e-15")
_TRIES = 6
"""The lengths of a step that are tried."""
_ZERO, _ONE, _TWO = sp.Integer(0), sp.Integer(1), sp.Integer(2)


def part_program(degree: int) -> Program:
    """The program that finds the next part."""
    place, width, left = real("place"), real("width"), count("steps_still_left")
    angle, value, is_rounding, is_over = real("angle"), real("wave"), flag("is_rounding"), flag("is_over")
    lets, c, s = turned(degree, angle)
    bound = Let(real("bound_of_fifth"), _fifth(degree))
    ends = sp.Or(sp.Not(is_rounding), sp.Ge(width, _LONGEST))
    step = [
        Let(angle, place + width),
        *lets,
        *_derivatives(degree, c, s),
        Let(is_rounding, sp.Le(sp.Abs(value), NOISE)),
        *_safe_step(),
        Let(real("way"), Select(sp.Or(sp.Gt(width, 0), is_rounding), _ZERO, larger(real("safe_step"), _SHORTEST))),
        Let(is_over, sp.Or(sp.And(sp.Gt(width, 0), ends), sp.And(sp.Le(width, 0), sp.Ge(place, END)))),
    ]
    wider = Select(sp.Gt(width, 0), _TWO * width, Select(is_rounding, _FIRST, _ZERO))
    loop = Iterate(
        state=(place, width, left),
        start=(AT, _ZERO, STEPS),
        step=tuple(step),
        following=(
            place + real("way"),
            wider,
            left - 1,
        ),
        done=sp.Or(is_over, sp.Le(left, 0)),
        limit=MOST_STEPS + 2,
        otherwise=None,
        note="steps around the circle that pass no zero of the wave",
    )
    found = Let(IS_PART, sp.And(sp.Gt(width, 0), is_over))
    outputs = [
        Output(LOW.name, Select(IS_PART, place, END)),
        Output(HIGH.name, Select(IS_PART, angle, END)),
        Output(IS_PART.name, IS_PART),
        Output(left.name, left),
    ]
    program = normalise("find_part", (bound, loop, found), outputs)
    return replace(program, summary="The next part of the circle in which the wave may be zero")


def _fifth(degree: int) -> sp.Expr:
    """The bound of the fifth derivative, over 5!."""
    names = names_of(degree)
    orders = [*range(degree + 1), *range(1, degree + 1)]
    return sp.Add(*[sp.Float(n**5 / 120) * sp.Abs(name) for n, name in zip(orders, names, strict=True) if n])


def _derivatives(degree: int, c: list[sp.Expr], s: list[sp.Expr]) -> Iterator[Let]:
    """The wave and its first four derivatives, over their factorials."""
    names = names_of(degree)
    cosines, sines = names[: degree + 1], [_ZERO, *names[degree + 1 :]]
    pairs = [(real(f"even_{n}"), real(f"odd_{n}")) for n in range(degree + 1)]
    for n, (even, odd) in enumerate(pairs[1:], 1):
        yield from (Let(even, cosines[n] * c[n] + sines[n] * s[n]), Let(odd, sines[n] * c[n] - cosines[n] * s[n]))
    for power, name in enumerate(("wave", "slope", "bend", "third", "fourth")):
        factor = sp.Rational((1, 1, -1, -1, 1)[power], (1, 1, 2, 6, 24)[power])
        terms = [n**power * pairs[n][power % 2] for n in range(1, degree + 1)]
        yield Let(real(name), sp.Add(*terms) * factor if power else sp.Add(cosines[0], *terms))


def _safe_step() -> Iterator[Let]:
    """The length of a step on which the wave does not vanish.

    On a step up to h, |W| falls by no more than slope h + curve h², with a curve that grows with h. So what this allows
    is safe as far as it is no more than h. Lengths are tried between one that is safe and one that is too long.
    """
    sign, room = real("sign_of_wave"), real("room")
    yield Let(sign, Select(sp.Lt(real("wave"), 0), sp.Integer(-1), _ONE))
    yield Let(room, larger(sp.Abs(real("wave")) - NOISE / 2, _ZERO))
    falls = [real(f"falls_{name}") for name in ("slope", "bend", "third", "fourth")]
    for name in falls:
        yield Let(name, larger(-sign * real(name.name.removeprefix("falls_")), _ZERO))
    slope, bend, third, fourth = falls
    length, safe, long, best = _ONE, _ZERO, _ONE, real("safe_1")
    for k in range(1, 1 + _TRIES):
        curve, divisor, allowed, best = (real(f"{n}_{k}") for n in ("curve", "divisor", "allowed", "safe"))
        yield Let(curve, bend + length * (third + length * (fourth + length * real("bound_of_fifth"))))
        yield Let(divisor, slope + Root(slope**2 + 4 * room * curve))
        is_short = sp.Gt(divisor * length, 2 * room)
        yield Let(allowed, Select(is_short, 2 * room / Select(is_short, divisor, _ONE), length))
        yield Let(best, larger(allowed, safe))
        if k < _TRIES:
            yield Let(real(f"long_{k}"), Select(is_short, length, long))
            long, safe = real(f"long_{k}"), best
            yield Let(real(f"length_{k}"), Root(safe * long))
            length = real(f"length_{k}")
    yield Let(real("safe_step"), best)
