"""Where the unit circle meets a conic, in closed form: the roots of a quartic.

    a cos 2t + b sin 2t + d cos t + e sin t + g = 0

With t counted from half the phase of (a, b) it is r cos 2t + p cos t + q sin t + g = 0. Every conic through its
intersections with the circle is r (c² - s²) + p c + q s + g + l (c² + s² - 1) = 0, a pair of lines where

    (l² - r²) (l - g) + (l + r) q²/4 + (l - r) p²/4 = 0,

the resolvent cubic. This is not positive at l = -r and not negative at l = r, so a root lies in between. There the
factors of c² and s² have opposite signs, and both lines are real. Each meets the circle at two angles, touches it, or
passes it by. So no case is told apart, and no number is complex.

* The root of the cubic is found by its distance from the nearer end, so that this keeps all digits.
* The distances of the lines from the centre are sum and difference of two numbers, and their product is known: the
  smaller one is taken from the larger, as with the roots of a square equation.
* Without squares (a = b = 0) one of the lines is too far from the circle, and the other is the given one.
* A line that misses the circle by rounding touches it: a pair of roots is double, not complex.

Residuals are at rounding. The angle of a double root has half of the digits, that of a triple one a third, that of a
fourfold one a quarter. Where all coefficients vanish, every angle is a root, and none is told apart.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, Root, Select, Wrap, angle_of_cosine
from derive.ir.program import Iterate, Let, Output, Program, Statement, Status
from derive.ir.symbols import count, flag, real
from derive.kinematics.scan.parabola import parabola, step_of
from derive.kinematics.scan.waves import DEGREE_TWO, Wave, derivatives, wave_at

COEFFICIENTS = tuple(real(f"{n}_of_conic") for n in ("cos2", "sin2", "cos", "sin", "level"))
"""The arguments of the program: the factors of cos 2t, sin 2t, cos t and sin t, and the rest."""
ANGLES = tuple(real(f"angle_{k}") for k in range(1, 5))
MEETS = tuple(flag(f"meets_{k}") for k in range(1, 5))
"""Whether the conic meets the circle at the angle, or nearly."""
TOUCHES = sp.Float("1e-6")
"""A line whose distance from the centre is larger than one by no more than this touches the circle."""
LEAST = sp.Float("1e-200")
"""A conic without a coefficient above this is none: every angle is a root."""
_PASSES = 60
_EXACT = sp.Float("1e-16")
_ZERO, _ONE, _TWO = sp.Integer(0), sp.Integer(1), sp.Integer(2)
_LARGEST = real("largest")
_CONIC: Wave = dict(zip(DEGREE_TWO, map(real, ("cos2", "sin2", "cos1", "sin1", "level")), strict=True))
"""The conic over its largest coefficient."""
_R, _P, _Q = (real(n) for n in ("doubled", "along", "across"))
_SWAPPED = flag("swapped")
_G, _NEAR, _FAR = (real(n) for n in ("above", "near", "far"))
"""g, and the squares over 4 of p and q: seen from the end of the cubic that is nearer to its root."""
_SHARE = real("base")
"""The distance of the root from this end, over r: between 0 and 1."""


def conic_program() -> Program:
    """The program of the angles at which a conic meets the circle."""
    statements = (*_scaled(), *_turned(), *_resolvent(), *_distances(), *_lines(), *_meetings())
    return normalise("meet_circle", statements, [Output(n.name, n) for n in (*ANGLES, *MEETS)])


def _divisor(value: sp.Expr) -> sp.Expr:
    """The value, which is not negative; one where it is zero."""
    return Select(sp.Gt(value, 0), value, _ONE)


def _sign(value: sp.Expr) -> sp.Expr:
    return Select(sp.Ge(value, 0), _ONE, -_ONE)


def _scaled() -> Iterator[Let]:
    """The coefficients over the largest of them."""
    largest: sp.Expr = sp.Abs(COEFFICIENTS[0])
    for k, other in enumerate(COEFFICIENTS[1:], 1):
        name = _LARGEST if other == COEFFICIENTS[-1] else real(f"largest_{k}")
        yield Let(name, Select(sp.Ge(largest, sp.Abs(other)), largest, sp.Abs(other)))
        largest = name
    is_one = sp.Gt(_LARGEST, LEAST)
    for name, value in zip(_CONIC.values(), COEFFICIENTS, strict=True):
        yield Let(name, Select(is_one, value / Select(is_one, _LARGEST, _ONE), _ZERO))


def _turned() -> Iterator[Let]:
    """The conic with the angle counted from half the phase of its squares."""
    a, b, d, e, _ = _CONIC.values()
    larger, smaller, c, s = (real(n) for n in ("larger", "smaller", "cos_phase", "sin_phase"))
    yield Let(_R, Root(a**2 + b**2))
    half = Root((_R + sp.Abs(a)) / (2 * _divisor(_R)))
    yield Let(larger, Select(sp.Gt(_R, 0), half, _ONE), "of cosine and sine of half the phase the one with more digits")
    yield Let(smaller, b / (2 * _divisor(_R) * larger))
    yield Let(c, Select(sp.Ge(a, 0), larger, smaller))
    yield Let(s, Select(sp.Ge(a, 0), smaller, larger))
    yield Let(_P, d * c + e * s)
    yield Let(_Q, e * c - d * s)


def _cubic(v: sp.Expr) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """The resolvent at this distance from the nearer end; its slope; and the size of its terms."""
    rest = _G - _R + _R * v
    value = _R * v * (2 - v) * rest + (2 - v) * _NEAR - v * _FAR
    slope = 2 * _R * (1 - v) * rest + _R**2 * v * (2 - v) - _NEAR - _FAR
    size = _R * v * (2 - v) * (sp.Abs(_G - _R) + _R * v) + (2 - v) * _NEAR + v * _FAR
    return value, slope, size


def _resolvent() -> Iterator[Statement]:
    """The root of the resolvent."""
    g = _CONIC[0]
    yield Let(_SWAPPED, sp.Ge(_R * g + _Q**2 / 4 - _P**2 / 4, 0), "which end is nearer to the root")
    yield Let(_G, Select(_SWAPPED, -g, g))
    yield Let(_NEAR, Select(_SWAPPED, _P**2, _Q**2) / 4)
    yield Let(_FAR, Select(_SWAPPED, _Q**2, _P**2) / 4)
    low, high, passes = real("low"), real("high"), count("passes")
    better, size, at, middle = (real(n) for n in ("better", "size", "at", "middle"))
    at_low, at_high, at_guess, at_middle = (real(f"cubic_at_{n}") for n in ("low", "high", "guess", "middle"))
    guess, slope, is_low = real("guess"), real("slope"), flag("is_low")
    higher, lower, next_low, next_high = (real(n) for n in ("higher", "lower", "next_low", "next_high"))
    yield Iterate(
        state=(low, high, passes),
        start=(_ZERO, _ONE, _ZERO),
        step=(
            Let(at_low, _cubic(low)[0]),
            Let(at_high, _cubic(high)[0]),
            Let(is_low, sp.Le(sp.Abs(at_low), sp.Abs(at_high))),
            Let(_SHARE, Select(is_low, low, high)),
            Let(better, Select(is_low, at_low, at_high)),
            Let(slope, _cubic(_SHARE)[1]),
            Let(size, _cubic(_SHARE)[2]),
            Let(at, _SHARE - better / Select(sp.Gt(sp.Abs(slope), 0), slope, _ONE)),
            Let(guess, Select(sp.And(sp.Gt(at, low), sp.Lt(at, high)), at, _SHARE), "by Newton's method"),
            Let(middle, (low + high) / 2),
            Let(at_guess, _cubic(guess)[0]),
            Let(at_middle, _cubic(middle)[0]),
            Let(higher, Select(sp.Ge(at_middle, 0), middle, low)),
            Let(next_low, Select(sp.And(sp.Ge(at_guess, 0), sp.Gt(guess, higher)), guess, higher)),
            Let(lower, Select(sp.Le(at_middle, 0), middle, high)),
            Let(next_high, Select(sp.And(sp.Le(at_guess, 0), sp.Lt(guess, lower)), guess, lower)),
        ),
        following=(next_low, next_high, passes + 1),
        done=sp.Or(sp.Le(sp.Abs(better), _EXACT * size), sp.Ge(passes, _PASSES)),
        limit=_PASSES + 1,
        otherwise=Status.UNREACHABLE,
        note="the root of the resolvent cubic between its ends",
    )


def _distances() -> Iterator[Let]:
    """Sum and difference of two numbers are the distances of both lines, times twice r."""
    big, small, gap, direct, mended = (real(n) for n in ("big", "small", "gap", "direct", "mended"))
    yield Let(big, Select(_SWAPPED, -_Q, _P) / Root(2 * (2 - _SHARE)))
    yield Let(small, Select(_SWAPPED, -_P, _Q))
    yield Let(gap, _G - _R * (1 - _SHARE), "the product of both distances, times twice r")
    yield Let(direct, small / _divisor(Root(2 * _SHARE)))
    yield Let(mended, _sign(small) * Root(big**2 - 2 * _R * gap))
    misses = sp.Abs(big**2 - direct**2 - 2 * _R * gap), 2 * _R * sp.Abs(mended * Root(2 * _SHARE) - small)
    yield Let(real("other"), Select(sp.Lt(misses[1], misses[0]), mended, direct))


def _lines() -> Iterator[Let]:
    """The distances of both lines from the centre, and half the angle between their normals."""
    big, other, gap = real("big"), real("other"), real("gap")
    total, outer, inner, is_together = real("total"), real("outer"), real("inner"), flag("is_together")
    first, second = sp.And(sp.Ge(big, 0), sp.Ge(other, 0)), sp.And(sp.Lt(big, 0), sp.Lt(other, 0))
    difference = (sp.Abs(big) - sp.Abs(other)) / (2 * _divisor(_R))
    quotient = Select(sp.Gt(total, 0), gap / _divisor(total), _TWO)
    is_direct = sp.Lt(total**2, 2 * _R * (sp.Abs(_G) + _R))
    yield Let(total, sp.Abs(big) + sp.Abs(other))
    yield Let(outer, Select(sp.Gt(_R, 0), total / (2 * _divisor(_R)), _TWO))
    yield Let(
        inner, Select(is_direct, difference, quotient), "the smaller distance, by the way that loses fewer digits"
    )
    yield Let(is_together, sp.Or(first, second))
    yield Let(real("distance_1"), _sign(big) * Select(is_together, outer, inner))
    yield Let(real("distance_2"), _sign(big) * Select(is_together, inner, outer))
    yield Let(real("lean"), Atan2(Root(_SHARE), Root(2 - _SHARE)), "half the angle between the normals of the lines")
    yield Let(real("phase"), Atan2(real("sin_phase"), real("cos_phase")))


def _meetings() -> Iterator[Let]:
    """The angles at which the lines meet the circle, refined at the conic itself."""
    for line, side in ((1, -1), (2, 1)):
        distance, bound, half = (real(f"{n}_{line}") for n in ("distance", "bound", "half"))
        yield Let(bound, Select(sp.Ge(distance, 1), _ONE, Select(sp.Le(distance, -1), -_ONE, distance)))
        yield Let(half, angle_of_cosine(-bound))
        for number, turn in ((2 * line - 1, 1), (2 * line, -1)):
            about, begun, closer = (real(f"{n}_{number}") for n in ("about", "begun", "closer"))
            yield Let(about, Wrap(side * real("lean") + turn * half))
            yield Let(begun, Wrap(Select(_SWAPPED, sp.pi / 2 - about, about) + real("phase")))
            yield from _refined(begun, closer, f"{number}_1")
            yield from _refined(closer, ANGLES[number - 1], f"{number}_2")
            meets = sp.And(sp.Le(sp.Abs(distance), 1 + TOUCHES), sp.Gt(_LARGEST, LEAST))
            yield Let(MEETS[number - 1], meets)


def _refined(start: sp.Symbol, name: sp.Symbol, word: str) -> Iterator[Let]:
    """A step towards the root of the conic."""
    c, s, end = real(f"cosine_{word}"), real(f"sine_{word}"), start + step_of(word)
    yield from (Let(c, sp.cos(start)), Let(s, sp.sin(start)))
    there = wave_at(_CONIC, sp.cos(end), sp.sin(end))
    yield from parabola(start, name, word, derivatives(_CONIC, c, s), there, _ONE)
