"""A start for the joint in a part of the circle, and from there the joint value at which a branch leaves least.

The starts of a part are its middle; its ends and further points where it is wide; and the points where a length that
turns an angle is shortest, and beside them, where the angle has turned by a sixth: next to them it turns fast. From a
start Newton's method goes on as long as the residual of the wanted branch becomes smaller, within the part.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select, ToReal
from derive.ir.program import Call, Iterate, Let, Output, Program
from derive.ir.symbols import TRIED, count, flag, real
from derive.kinematics.scan.programs import _roots_named as roots_named
from derive.kinematics.scan.slopes import slope_name, with_slopes
from tests.algebra.closure import Trial
from tests.algebra.parts import HIGH, LOW

NUMBER = count("start_number")
"""The number of a start, from 1; those at short lengths follow `POINTS`."""
POINTS = 9
_FRACTIONS = ("0.5", "0", "1", "0.25", "0.75", "0.125", "0.375", "0.625", "0.875")
"""Where the points stand in a part."""
_WIDTHS = (("1e-9", 1), ("1e-4", 3), ("1e-2", 5))
"""A part up to this width has only so many points."""
BESIDE = 3
"""The starts of a length: where it is shortest, then a little behind and before it."""
_ASIDE = sp.Float("1.7")
"""The tangent of 60 degrees."""
_NARROW = sp.Float("1e-6")
"""In a part up to this width no length is looked for."""
GRID, SECANTS, NEWTONS = 9, 12, 24
SETTLED, REMAINS = real("settled"), real("remains")
"""The joint value that is found, and the size of the residual there."""
_WHICH = count("which_length")
_ZERO, _ONE = sp.Integer(0), sp.Integer(1)


def points_of(width: sp.Expr) -> sp.Expr:
    """The number of points in a part."""
    number: sp.Expr = sp.Integer(POINTS)
    for most, points in reversed(_WIDTHS):
        number = Select(sp.Le(width, sp.Float(most)), sp.Integer(points), number)
    return number


def next_number(trial: Program, number: sp.Expr, width: sp.Expr) -> sp.Expr:
    """The number of the next start in a part, 0 where there is none."""
    lengths = lengths_of(trial)
    last = POINTS + BESIDE * lengths
    behind: sp.Expr = Select(sp.Gt(width, _NARROW), sp.Integer(POINTS + 1), _ZERO) if lengths else _ZERO
    at_lengths = Select(sp.Le(number, POINTS), behind, Select(sp.Lt(number, last), number + 1, _ZERO))
    return Select(sp.Lt(number, points_of(width)), number + 1, at_lengths)


def lengths_of(trial: Program) -> int:
    """The number of lengths that a trial tells."""
    return (len(trial.outputs) - 2) // 2


def try_program(trial: Trial) -> Program:
    """The program of a trial: the residual with its slope, and lengths that turn angles with half the slopes of their
    squares.
    """
    value = real("value")
    left = Let(value, trial.value, "residual of the closure")
    differentiated = with_slopes([*roots_named(trial.statements), left], TRIED)
    bound = {s.name for s in differentiated if isinstance(s, Let)}
    slope = {n: slope_name(n) if slope_name(n) in bound else _ZERO for n in (value, *trial.lengths)}
    outputs = [Output("remainder", value), Output("slope", slope[value])]
    for k, name in enumerate(trial.lengths, 1):
        outputs += [Output(f"length_{k}", name), Output(f"growth_{k}", name * slope[name])]
    program = normalise("try_joint", differentiated, outputs)
    return replace(
        program, summary="The residual of the closure at a trial, with its slope, and lengths that turn angles"
    )


def settle_program(trial: Program, arguments: Sequence[sp.Symbol]) -> Program:
    """The program that finds the joint value in a part. arguments: of a trial, besides the joint."""
    width = real("part_width")
    fraction: sp.Expr = sp.Float(_FRACTIONS[0])
    for k, share in enumerate(_FRACTIONS[1:], 2):
        fraction = Select(sp.Eq(NUMBER, k), sp.Float(share), fraction)
    at: sp.Expr = LOW + fraction * width
    body: list[Let | Call | Iterate] = [Let(width, HIGH - LOW)]
    if lengths := lengths_of(trial):
        is_there, which = sp.Gt(NUMBER, POINTS), flag("is_at_length")
        number: sp.Expr = sp.Integer(1)
        for k in range(2, lengths + 1):
            number = Select(sp.Gt(NUMBER, POINTS + BESIDE * (k - 1)), sp.Integer(k), number)
        shortest = _shortest_program(trial, arguments)
        given = {s: s for s in shortest.inputs if s in arguments or s in (LOW, HIGH)} | {_WHICH: number}
        outputs = tuple(real(o.name) for o in shortest.outputs)
        place, aside = outputs
        turn = sp.Add(*[_side(NUMBER, POINTS + BESIDE * k) for k in range(lengths)])
        body += [Let(which, is_there), Call(shortest, tuple(given.items()), outputs, wanted=which)]
        at = Select(which, _inside(place + turn * aside), at)
    start = real("start_of_steps")
    body += [Let(start, at), _steps(trial, arguments, start)]
    program = normalise(
        "settle_joint", body, [Output(SETTLED.name, real("best_now")), Output(REMAINS.name, real("least_now"))]
    )
    return replace(program, summary="The joint value next to a start at which the residual is smallest")


def _side(number: sp.Expr, before: int) -> sp.Expr:
    """1, -1 or 0: whether a start stands behind the place of a length, before it, or at it."""
    return Select(sp.Eq(number, before + 2), _ONE, Select(sp.Eq(number, before + 3), sp.Integer(-1), _ZERO))


def _inside(place: sp.Expr) -> sp.Expr:
    """The place, kept in the part."""
    return Select(sp.Lt(place, LOW), LOW, Select(sp.Gt(place, HIGH), HIGH, place))


def _trial(trial: Program, arguments: Sequence[sp.Symbol], at: sp.Expr, outputs: Sequence[str]) -> Call:
    given = tuple((s, at if s == TRIED else s) for s in trial.inputs if s == TRIED or s in arguments)
    return Call(trial, given, tuple(real(o) for o in outputs))


def _steps(trial: Program, arguments: Sequence[sp.Symbol], start: sp.Symbol) -> Iterate:
    """Newton's method, as long as the residual becomes smaller; a step that does not lower it is shortened."""
    place, best, least, way, share = map(real, ("place", "best_place", "least", "way", "share"))
    best_now, way_now, share_now = map(real, ("best_now", "way_now", "share_now"))
    size, is_less, number = real("size"), flag("is_less"), count("steps")
    slope, following = real("slope"), real("next_place")
    divisor = Select(sp.Gt(sp.Abs(slope), 0), slope, sp.Float("1e30"))
    step = (
        _trial(trial, arguments, place, ("remainder", "slope")),
        Let(size, sp.Abs(real("remainder"))),
        Let(is_less, sp.Lt(size, least)),
        Let(best_now, Select(is_less, place, best)),
        Let(real("least_now"), Select(is_less, size, least)),
        Let(way_now, Select(is_less, real("remainder") / divisor, way)),
        Let(share_now, Select(is_less, _ONE, share / 4)),
        Let(following, _inside(best_now - share_now * way_now)),
    )
    return Iterate(
        state=(place, best, least, way, share, number),
        start=(start, start, sp.Float("1e30"), _ZERO, _ONE, _ZERO),
        step=step,
        following=(following, best_now, real("least_now"), way_now, share_now, number + 1),
        done=sp.Or(
            sp.Ge(number, NEWTONS), sp.Le(sp.Abs(following - place), 0), sp.Le(HIGH - LOW, sp.Float(_WIDTHS[0][0]))
        ),
        limit=NEWTONS + 1,
        otherwise=None,
        note="Newton's method on the residual of the branch",
    )


def _shortest_program(trial: Program, arguments: Sequence[sp.Symbol]) -> Program:
    """The program that finds where in a part a length is shortest, and how far from there its angle turns by a sixth.

    The growth, half the slope of the squared length, vanishes there: from the best of some points on by secants.
    """
    place, best, least = map(real, ("place", "best_place", "least"))
    last, before, bend, number = real("last_place"), real("growth_before"), real("bend"), count("steps")
    length, growth, gap, way = map(real, ("length", "growth", "gap", "way"))
    is_less, best_now, bend_now = flag("is_less"), real("best_now"), real("bend_now")
    chosen = {n: _chosen(n, lengths_of(trial)) for n in ("length", "growth")}
    outputs = [o.name for o in trial.outputs if o.name not in ("remainder", "slope")]
    spread, following = (HIGH - LOW) / (GRID - 1), real("next_place")
    is_bent = sp.Gt(gap * way, 0)
    beside = Select(sp.Gt(best_now + spread / 4, HIGH), best_now - spread / 4, best_now + spread / 4)
    secant = _inside(place - growth / Select(sp.Gt(bend_now, 0), bend_now, _ONE))
    step = (
        _trial(trial, arguments, place, outputs),
        Let(length, chosen["length"]),
        Let(growth, chosen["growth"]),
        Let(is_less, sp.Lt(length, least)),
        Let(best_now, Select(is_less, place, best)),
        Let(gap, growth - before),
        Let(way, place - last),
        Let(bend_now, Select(sp.And(sp.Gt(number, GRID), is_bent), gap / Select(is_bent, way, _ONE), bend)),
        Let(
            following,
            Select(
                sp.Lt(number, GRID - 1),
                LOW + (ToReal(number) + 1) * spread,
                Select(sp.Lt(number, GRID), best_now, Select(sp.Eq(number, GRID), beside, secant)),
            ),
        ),
    )
    loop = Iterate(
        state=(place, best, least, last, before, bend, number),
        start=(LOW, LOW, sp.Float("1e30"), LOW, _ZERO, _ZERO, _ZERO),
        step=step,
        following=(following, best_now, Select(is_less, length, least), last + way, growth, bend_now, number + 1),
        done=sp.Ge(number, GRID + SECANTS),
        limit=GRID + SECANTS + 1,
        otherwise=None,
        note="where the length is shortest",
    )
    shortest = Select(is_less, length, least)
    aside = Select(sp.Gt(bend_now, 0), _ASIDE * shortest / Root(Select(sp.Gt(bend_now, 0), bend_now, _ONE)), _ZERO)
    program = normalise("find_shortest", (loop,), [Output("shortest_place", best_now), Output("aside", aside)])
    return replace(
        program, summary="Where a length that turns an angle is shortest, and how far beside it turns by a sixth"
    )


def _chosen(word: str, lengths: int) -> sp.Expr:
    found: sp.Expr = real(f"{word}_1")
    for k in range(2, lengths + 1):
        found = Select(sp.Eq(_WHICH, k), real(f"{word}_{k}"), found)
    return found
