"""Search: one joint tried around the circle, the others solved at each trial, until what is left of the closure vanishes.

From the reference outwards on either side, in steps that grow to half a degree: between two trials where the residual changes
its sign in the wanted direction a root is closed in, by turns with a secant and by halving. A jump of the residual is no
root: what is left there does not vanish. The first root of the wanted branch is the nearest to the reference; with a rank that
many are passed over. Where the residual vanishes at the reference without crossing zero there, in a singular pose, the
reference is the root. Bounded, without memory, the same for whatever motion.

A scan is no proof: two roots between neighbouring trials are missed. The witness measures how often.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from derive.program import (
    BOUNDARY,
    LARGEST_CROSSING,
    LEAST_CROSSING,
    REFINEMENTS,
    SCAN_GROWTH,
    SCAN_PASSES,
    SCAN_ROOT,
    SCAN_STEP,
    Iterate,
    Let,
    Select,
    Statement,
    Status,
    real,
    symbols_of,
)

_FIRST = SCAN_STEP / SCAN_GROWTH**8
"""The steps grow from here: a root at the reference itself is found however fast the residual changes."""

TRIED = real("tried")
ACCEPTED = real("accepted")
RANK = real("rank")
"""How many roots of the wanted branch are passed over: an input of the programs that have it."""
_STATE = (
    *("tried", "radius", "inner", "side", "closing", "halve"),
    *("low", "low_value", "high", "high_value"),
    *("ahead", "behind", "touching"),
)
_NEARLY = sp.Rational(15, 16)
_YES, _NO, _HALF = sp.Integer(1), sp.Integer(0), sp.Rational(1, 2)


@dataclass(frozen=True)
class Trial:
    """One trial: statements that solve the other joints at `TRIED`, and what they leave."""

    statements: tuple[Statement, ...]
    value: sp.Expr
    """What must vanish, a number without a unit."""
    fits: sp.Basic
    """Whether the trial lies on the wanted branch."""


def search_loop(trial: Trial, start: sp.Expr, crossing: sp.Symbol, idle: sp.Basic, is_ranked: bool) -> Iterate:
    """The loop; where `idle` holds it ends at once. `crossing`: +1 where the residual is to rise, -1 where it is to fall."""
    names = (*_STATE, "passed") if is_ranked else _STATE
    wanted = _needs(trial, (trial.value, trial.fits))
    moves = _moves(trial, start, crossing, is_ranked)
    initial = {"tried": start, "side": _YES}
    return Iterate(
        state=tuple(map(real, names)),
        start=tuple(initial.get(name, _NO) for name in names),
        step=(*wanted, *moves),
        following=tuple(real(f"next_{name}") for name in names),
        done=sp.Or(idle, sp.Gt(ACCEPTED, _HALF), sp.Gt(real("radius"), sp.pi + SCAN_STEP + SCAN_STEP / 2)),
        limit=SCAN_PASSES,
        otherwise=Status.UNREACHABLE,
        note="search along the joint, from its reference outwards",
    )


def _needs(trial: Trial, values: Sequence[sp.Basic]) -> tuple[Let, ...]:
    """The statements that the values depend on, in order."""
    wanted = {s for v in values for s in symbols_of(v)}
    found: list[Let] = []
    for s in reversed(trial.statements):
        if isinstance(s, Let) and s.name in wanted:
            found.append(s)
            wanted |= symbols_of(s.value)
    return tuple(reversed(found))


def _moves(trial: Trial, start: sp.Expr, crossing: sp.Symbol, is_ranked: bool) -> tuple[Let, ...]:
    """What one pass decides: `next_…` is the state that follows."""
    value, scanning, first, ends = map(real, ("value", "scanning", "first", "ends"))
    closing, side, radius, inner = map(real, ("closing", "side", "radius", "inner"))
    is_scanning, is_first = (sp.Gt(s, _HALF) for s in (scanning, first))
    next_side, next_radius, touches = real("next_side"), real("next_radius"), sp.Gt(real("next_touching"), _HALF)
    outwards = sp.And(sp.Gt(ends, _HALF), sp.Or(is_first, sp.Lt(side, 0)), sp.Lt(real("touching"), _HALF))
    turns = sp.And(sp.Gt(ends, _HALF), sp.Lt(real("next_touching"), _HALF))
    grown = Select(is_first, _FIRST, Select(sp.Lt(radius, SCAN_STEP * _NEARLY), SCAN_GROWTH * radius, radius + SCAN_STEP))
    moves = (
        Let(value, trial.value, "what is left of the closure"),
        Let(scanning, Select(sp.Gt(closing, _HALF), _NO, _YES), "or a root is being closed in"),
        Let(first, Select(sp.Gt(radius, 0), _NO, _YES)),
        *_crossing(crossing),
        *_closing(trial, start),
        *_acceptance(trial, is_ranked),
        *_touching(),
        Let(next_side, Select(turns, Select(is_first, _YES, -side), side), "the other side, or one step out"),
        Let(next_radius, Select(outwards, grown, radius)),
        Let(real("next_inner"), Select(outwards, radius, inner)),
        Let(real("outer"), start + next_side * next_radius),
        Let(real("next_tried"), Select(touches, start, Select(sp.Gt(ends, _HALF), real("outer"), real("guess")))),
    )
    passing = sp.And(is_scanning, sp.Lt(real("touching"), _HALF))
    outer = sp.And(passing, sp.Or(is_first, sp.Gt(side, 0)))
    inner = sp.And(passing, sp.Or(is_first, sp.Lt(side, 0)))
    remembered = (
        Let(real("next_ahead"), Select(outer, value, real("ahead"))),
        Let(real("next_behind"), Select(inner, value, real("behind"))),
    )
    return (*moves, *remembered)


def _touching() -> tuple[Let, ...]:
    """After the first step on both sides: whether the residual vanishes at the reference and does not cross zero there."""
    value, ahead, behind = real("value"), real("ahead"), real("behind")
    at_first = sp.And(sp.Lt(real("side"), 0), sp.Gt(real("radius"), 0), sp.Le(real("inner"), 0))
    is_new = sp.And(sp.Gt(real("scanning"), _HALF), sp.Lt(real("touching"), _HALF), sp.Lt(real("crosses"), _HALF))
    apart = real("apart")
    simple = sp.And(sp.Lt(ahead * value, 0), sp.Gt(apart, LEAST_CROSSING), sp.Lt(apart, LARGEST_CROSSING))
    found = sp.And(at_first, is_new, sp.Le(sp.Abs(behind), BOUNDARY))
    return (
        Let(apart, sp.Abs(ahead - value)),
        Let(real("simple"), Select(simple, _YES, _NO), "a root that is crossed"),
        Let(real("next_touching"), Select(sp.And(found, sp.Lt(real("simple"), _HALF)), _YES, _NO), "look at the reference again"),
    )


def _crossing(crossing: sp.Symbol) -> tuple[Let, ...]:
    """Whether the residual crosses zero in the wanted direction since the last trial on this side."""
    previous, outward, arrived = map(real, ("previous", "outward", "arrived"))
    value, side = real("value"), real("side")
    ahead = sp.Gt(side, 0)
    rises = sp.Or(
        sp.And(ahead, sp.Le(outward, 0), sp.Gt(arrived, 0)), sp.And(sp.Lt(side, 0), sp.Lt(outward, 0), sp.Ge(arrived, 0))
    )
    scanned = sp.And(sp.Gt(real("scanning"), _HALF), sp.Lt(real("first"), _HALF), sp.Lt(real("touching"), _HALF))
    return (
        Let(previous, Select(ahead, real("ahead"), real("behind"))),
        Let(outward, crossing * side * previous),
        Let(arrived, crossing * side * value),
        Let(real("crosses"), Select(sp.And(scanned, rises), _YES, _NO), "a root lies in between"),
    )


def _closing(trial: Trial, start: sp.Expr) -> tuple[Let, ...]:
    """Close in: the bracket after this trial, whether it is done, and the next guess."""
    value, closing, tried, side = map(real, ("value", "closing", "tried", "side"))
    low, low_value, high, high_value = map(real, ("low", "low_value", "high", "high_value"))
    next_low, next_low_value, next_high, next_high_value = (
        real(f"next_{n}") for n in ("low", "low_value", "high", "high_value")
    )
    is_scanning = sp.Gt(real("scanning"), _HALF)
    on_low = sp.Gt(real("on_low"), _HALF)
    settled = sp.And(sp.Not(is_scanning), sp.Or(sp.Le(sp.Abs(value), SCAN_ROOT), sp.Ge(closing, REFINEMENTS)))
    goes_on = sp.Or(
        sp.And(is_scanning, sp.Gt(real("crosses"), _HALF)), sp.And(sp.Not(is_scanning), sp.Lt(real("settled"), _HALF))
    )
    slope, divisor = real("secant_slope"), real("secant_divisor")
    secant = next_high - next_high_value * (next_high - next_low) / divisor
    return (
        Let(real("settled"), Select(settled, _YES, _NO)),
        Let(real("ends"), Select(goes_on, _NO, _YES), "go on to the next trial"),
        Let(real("next_closing"), Select(goes_on, closing + 1, _NO)),
        Let(real("on_low"), Select(sp.Gt(low_value * value, 0), _YES, _NO)),
        Let(next_low, Select(is_scanning, start + side * real("inner"), Select(on_low, tried, low))),
        Let(next_low_value, Select(is_scanning, real("previous"), Select(on_low, value, low_value))),
        Let(next_high, Select(is_scanning, tried, Select(on_low, high, tried))),
        Let(next_high_value, Select(is_scanning, value, Select(on_low, high_value, value))),
        Let(real("next_halve"), Select(sp.And(goes_on, sp.Lt(real("halve"), _HALF)), _YES, _NO)),
        Let(slope, next_high_value - next_low_value),
        Let(divisor, Select(sp.Gt(sp.Abs(slope), 0), slope, _YES)),
        Let(real("guess"), Select(sp.Gt(real("halve"), _HALF), (next_low + next_high) / 2, secant)),
    )


def _acceptance(trial: Trial, is_ranked: bool) -> tuple[Let, ...]:
    """Whether the trial is the root that is looked for."""
    ended = sp.Or(sp.Gt(real("settled"), _HALF), sp.Gt(real("touching"), _HALF))
    vanishes = Select(sp.And(ended, sp.Le(sp.Abs(real("value")), BOUNDARY), trial.fits), _YES, _NO)
    if not is_ranked:
        return (Let(ACCEPTED, vanishes),)
    root, passed = real("root"), real("passed")
    return (
        Let(root, vanishes),
        Let(ACCEPTED, Select(sp.And(sp.Gt(root, _HALF), sp.Gt(passed, RANK - _HALF)), _YES, _NO)),
        Let(real("next_passed"), passed + root),
    )
