"""The trials in a part of the circle: where a length is shortest, and where the residual of a branch vanishes.

Both are steps of one loop, each with one trial. The shortest length is sought from some points of the part by secants
of the growth, half the slope of the squared length; the residual vanishes by Newton's method.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import sympy as sp

from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select, ToReal, larger
from derive.ir.program import Let, Output, Program
from derive.ir.symbols import TRIED, count, flag, real
from derive.kinematics.search.loop.rounds import KEEPS
from derive.kinematics.search.loop.starts import inside
from derive.kinematics.search.programs import Trial, roots_named
from derive.kinematics.search.slopes import slope_name, with_slopes

AT, TRIALS, BEST = real("at"), count("trials"), real("best")
"""How far ahead of the start of the search the next trial is; the number of trials; the best place so far."""
BEST_NOW, LEAST_NOW = real("best_now"), real("least_now")
REMAINDER, RATE, ROOM, GROWTH = map(real, ("remainder", "rate", "room_of_trial", "growth"))
SETTLED = real("settled")
"""Where Newton's method ends."""
WAY_NOW, NEWTON_NEXT, BEND_NOW, SHORTEST_NEXT = map(real, ("way_now", "newton_place", "bend_now", "shortening_place"))
_LEAST, _WAY, _MOST_ROOM = real("least"), real("way"), real("most_room")
_LAST, _BEFORE, _BEND = real("last"), real("growth_before"), real("bend")
_ASIDE = sp.Float("1.7")
"""The tangent of 60 degrees."""
_GRID, _SECANTS, _NEWTONS = 5, 6, 5
"""Points and secants for the shortest length; steps of Newton's method."""
_STILL = sp.Float("1e-10")
"""A step of this length (radians) ends the method: the steps on the closure follow."""
_ZERO, _ONE, _MOST = sp.Integer(0), sp.Integer(1), sp.Float("1e30")


def lengths_of(trial: Program) -> int:
    """The number of lengths that a trial tells."""
    return sum(o.name.startswith("length_") for o in trial.outputs)


def try_program(trial: Trial) -> Program:
    """The program of a trial: the residual with its slope, and lengths that turn angles with half the slopes of their
    squares.
    """
    value = real("value")
    left = Let(value, trial.value, "residual of the closure")
    differentiated = with_slopes([*roots_named(trial.statements), left], TRIED)
    bound = {s.name for s in differentiated if isinstance(s, Let)}
    slope = {n: slope_name(n) if slope_name(n) in bound else _ZERO for n in (value, *trial.lengths)}
    outputs = [Output(REMAINDER.name, value), Output(RATE.name, slope[value]), Output(ROOM.name, trial.room)]
    outputs += [Output(KEEPS.name, trial.keeps)] if trial.lengths else []
    for k, name in enumerate(trial.lengths, 1):
        outputs += [Output(f"length_{k}", name), Output(f"growth_{k}", name * slope[name])]
    program = normalise("try_joint", differentiated, outputs)
    return replace(
        program, summary="The residual of the closure at a trial, with its slope, and lengths that turn angles"
    )


def trials_begun(place: sp.Expr) -> dict[sp.Symbol, sp.Expr]:
    """The state of the trials at their first one."""
    zeros = dict.fromkeys((TRIALS, _WAY, _BEFORE, _BEND), _ZERO)
    return {AT: place, BEST: place, _LAST: place, _LEAST: _MOST, _MOST_ROOM: _ZERO, **zeros}


def better(is_shortest: sp.Basic, length: sp.Expr, may_leave: sp.Basic) -> Iterator[Let]:
    """Whether a trial is the best so far: where the length is shortest, or where the least remains. may_leave: whether
    it may go beyond the end of reach, where a residual of what is nearest may vanish, too.
    """
    size, is_less = real("size"), flag("is_less")
    yield Let(size, Select(is_shortest, length, sp.Abs(REMAINDER)))
    stays = sp.Or(sp.Le(_MOST_ROOM, 0), sp.Gt(ROOM, 0), is_shortest, may_leave)
    yield Let(is_less, sp.And(sp.Lt(size, _LEAST), stays))
    yield Let(BEST_NOW, Select(is_less, AT, BEST))
    yield Let(LEAST_NOW, Select(is_less, size, _LEAST))


def newton_step(ends: tuple[sp.Expr, sp.Expr], direction: sp.Expr, is_point: sp.Basic) -> Iterator[Let]:
    """The step of Newton's method; one that does not lower the residual is shortened.

    A part that is a point has its only trial in the middle, and settles where the step leads: a straight wrist is told
    from one that is bent by half the width of the part, of which rounding would choose the side.
    """
    is_steep = sp.Gt(sp.Abs(RATE), 0)
    newton = direction * REMAINDER / Select(is_steep, RATE, _MOST)
    yield Let(WAY_NOW, Select(flag("is_less"), newton, _WAY / 4))
    yield Let(NEWTON_NEXT, inside(BEST_NOW - WAY_NOW, ends))
    stands = sp.Or(is_point, sp.Le(sp.Abs(NEWTON_NEXT - AT), _STILL))
    yield Let(SETTLED, Select(sp.And(flag("is_less"), stands), NEWTON_NEXT, BEST_NOW))


def newton_is_done(is_point: sp.Basic) -> sp.Basic:
    """Whether Newton's method ends: a part that is a point has one trial."""
    return sp.Or(sp.Ge(TRIALS, _NEWTONS), sp.Le(sp.Abs(NEWTON_NEXT - AT), _STILL), is_point)


def shortest_step(ends: tuple[sp.Expr, sp.Expr], growth: sp.Expr) -> Iterator[Let]:
    """The next trial towards the shortest length: points of the part, the best of them, one beside it, secants."""
    low, high = ends
    gap, way, bend, spread = real("gap"), real("way_of_trial"), BEND_NOW, real("spread")
    yield Let(GROWTH, growth)
    yield Let(gap, GROWTH - _BEFORE)
    yield Let(way, AT - _LAST)
    is_bent = sp.And(sp.Gt(TRIALS, _GRID), sp.Gt(gap * way, 0))
    yield Let(bend, Select(is_bent, gap / Select(is_bent, way, _ONE), _BEND))
    yield Let(spread, (high - low) / (_GRID - 1))
    aside = Select(sp.Gt(BEST_NOW + spread / 4, high), BEST_NOW - spread / 4, BEST_NOW + spread / 4)
    secant = inside(AT - GROWTH / Select(sp.Gt(bend, 0), bend, _ONE), ends)
    behind = Select(sp.Lt(TRIALS, _GRID), BEST_NOW, Select(sp.Eq(TRIALS, _GRID), aside, secant))
    yield Let(SHORTEST_NEXT, Select(sp.Lt(TRIALS, _GRID - 1), low + (ToReal(TRIALS) + 1) * spread, behind))


def shortest_is_done() -> sp.Basic:
    """Whether the place of the shortest length is found."""
    return sp.Ge(TRIALS, _GRID + _SECANTS)


def turned_by_a_sixth() -> sp.Expr:
    """How far from the place of the shortest length its angle has turned by 60 degrees."""
    is_bent = sp.Gt(BEND_NOW, 0)
    return Select(is_bent, _ASIDE * LEAST_NOW / Root(Select(is_bent, BEND_NOW, _ONE)), _ZERO)


def trials_go_on(is_shortest: sp.Basic) -> dict[sp.Symbol, sp.Expr]:
    """The state behind a trial."""
    return {
        AT: Select(is_shortest, SHORTEST_NEXT, NEWTON_NEXT),
        TRIALS: TRIALS + 1,
        BEST: BEST_NOW,
        _LEAST: LEAST_NOW,
        _MOST_ROOM: larger(_MOST_ROOM, ROOM),
        _WAY: WAY_NOW,
        _LAST: AT,
        _BEFORE: GROWTH,
        _BEND: BEND_NOW,
    }
