"""The root of the residual P + Q w on one side, next to an angle at which the conic P² = Q² D meets the circle.

Where Q is small, both sides have nearly the same root: the conic has a double one, with half of its digits. The
residual of one side has a simple root there, with all digits.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import sympy as sp

from derive.ir.primitives import Root, Select
from derive.ir.program import Let, rewritten
from derive.ir.symbols import TRIED, real
from derive.kinematics.scan.parabola import ROUNDING, parabola, step_of
from derive.kinematics.scan.programs import Trial
from derive.kinematics.scan.quartic import Quartic
from derive.kinematics.scan.waves import derivatives, size_of, wave_at

_STEPS = 4
_FARTHEST = sp.Float("1e-12")
"""No root is moved farther than this."""
_ZERO, _ONE = sp.Integer(0), sp.Integer(1)


def on_own_side(trial: Trial, quartic: Quartic) -> Trial:
    """The trial at the root of its side that is next to the joint value that is tried."""
    if not quartic.has_sides:
        return trial
    bound = {s.name for s in trial.statements}
    before = [s for s in quartic.statements if s.name not in bound]
    joint: sp.Symbol = TRIED
    for number in range(1, _STEPS + 1):
        closer = real(f"refined_{number}")
        before += _step(quartic, joint, closer, str(number))
        joint = closer
    within = real("within_reach")
    before += _within_reach(quartic, joint, within)
    moved = (rewritten(s, lambda e: e.xreplace({TRIED: within})) for s in trial.statements)
    return replace(trial, statements=(*before, *(s for s in moved if isinstance(s, Let))))


def _step(quartic: Quartic, start: sp.Symbol, name: sp.Symbol, word: str) -> Iterator[Let]:
    """A step towards the root."""
    c, s, root, rate = (real(f"{n}_{word}") for n in ("cosine", "sine", "root", "rate"))
    radicand, rise, bend = derivatives(quartic.square, c, s)
    is_long, twice = sp.Gt(root, 0), Select(sp.Gt(root, 0), 2 * root, _ONE)
    yield from (Let(c, sp.cos(start)), Let(s, sp.sin(start)), Let(root, Root(radicand)))
    yield Let(rate, Select(is_long, rise / twice, _ZERO))
    roots = (root, rate, Select(is_long, (bend - 2 * rate**2) / twice, _ZERO))
    plain = derivatives(quartic.plain, c, s)
    value, slope, bent = (p + quartic.factor * w for p, w in zip(plain, roots, strict=True))
    end = start + step_of(word)
    ahead, aside = sp.cos(end), sp.sin(end)
    there = wave_at(quartic.plain, ahead, aside) + quartic.factor * Root(wave_at(quartic.square, ahead, aside))
    yield from parabola(start, name, word, (value, slope, bent), there, quartic.terms)


def _within_reach(quartic: Quartic, joint: sp.Symbol, name: sp.Symbol) -> Iterator[Let]:
    """The joint, moved to where D is positive if it is rounding: a later step may take a direction from w."""
    c, s, radicand, rate, missing = (real(f"{n}_at_root") for n in ("cosine", "sine", "radicand", "rate", "missing"))
    value, slope, _ = derivatives(quartic.square, c, s)
    yield from (Let(c, sp.cos(joint)), Let(s, sp.sin(joint)), Let(radicand, value), Let(rate, slope))
    yield Let(missing, ROUNDING * size_of(quartic.square) - radicand)
    is_moved = sp.And(sp.Gt(missing, 0), sp.Le(missing, _FARTHEST * sp.Abs(rate)))
    yield Let(name, joint + Select(is_moved, missing / Select(is_moved, rate, _ONE), _ZERO))
