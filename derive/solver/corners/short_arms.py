"""Short arms: where the two roots of a step nearly meet, its angle is turned, within rounding, until the arm of a later
step is long enough.

A two-root step takes the sine of its angle v as a root. Near zero the root has half of the digits. A later step solves
a cos u + b sin u = e, which needs an arm (a, b) as long as e. Where v turns the arm, its length has half of the digits,
too. A nearly straight elbow makes the arm vanish that the joint before it turns. There, and wherever the
later step is at its own boundary, the pose would be refused. So v turns by the least t with |(a, b) + (a', b') t| =
|e + e' t|, a quadratic equation, if the residual of v's own equation stays within rounding. Where the arm is long
enough, or the roots are far apart, v stays.

`folds` does the same for steps with a lateral offset, whose triangle is known by both legs, where v changes e alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from derive.equations.problem import Legs, StepDeterminant, Swing
from derive.ir.constants import BOUNDARY
from derive.ir.passes import depending_on, needed_lets
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Statement, rewritten
from derive.ir.symbols import cosine, real, sine
from derive.solver.corners.feasible_arc import WITHIN_ITS_BOUND, in_order
from derive.solver.corners.folds import Later, rate_along, rates_of, taken, turned, with_motion

Row = tuple[sp.Expr, sp.Expr, sp.Expr]


def with_arms_long_enough(
    statements: Sequence[Statement], determinants: Sequence[StepDeterminant], scale: sp.Expr
) -> tuple[Statement, ...]:
    """The derivation with the angle of every two-root step near its fold turned until the arms of later steps reach."""
    found = list(statements)
    for step in determinants:
        legs: Legs | None = None
        for later in determinants:
            if later.arm is None or later.factors is None or later is step or step.swing is None:
                continue
            chain = _chain(found, step.step, (*later.arm, *later.factors))
            if chain is None:
                continue
            if legs is None:
                found, legs = _with_legs(found, step, step.swing, scale)
            a, b, e = later.arm
            word = f"{step.step.name}_for_{later.step.name}"
            turning = Later(later.step, word, step.step, legs, Root(a**2 + b**2), e, chain, scale)
            found = in_order(with_motion(found, turning, _motion(turning, later.arm, later.factors, step)))
    return tuple(found)


def _chain(statements: Sequence[Statement], angle: sp.Symbol, values: Sequence[sp.Expr]) -> tuple[Let, ...] | None:
    """The statements by which a later arm, and what it has to reach, follow from an angle; None where the angle does
    not turn the arm.
    """
    own = {cosine(angle), sine(angle)}
    dependent = depending_on(statements, own)
    if not any(value.free_symbols & (dependent.keys() | own) for value in values):
        return None
    return needed_lets(dependent.values(), values)


def _with_legs(
    statements: Sequence[Statement], step: StepDeterminant, swing: Swing, scale: sp.Expr
) -> tuple[list[Statement], Legs]:
    """The statements with the triangle of a swing, as long as the machine, bound in front of the angle."""
    angle = step.step
    ahead, square, beside = (real(f"{word}_{angle.name}") for word in ("ahead", "ahead_squared", "beside"))
    own = {cosine(angle): real(f"cos_swing_{angle.name}"), sine(angle): real(f"sin_swing_{angle.name}")}
    is_own = swing.cos == cosine(angle)
    seen = swing.renamed(own) if is_own else swing
    root = next(s.value for s in statements if isinstance(s, Let) and s.name == swing.sin)
    lets: tuple[Statement, ...] = (
        Let(
            square,
            (scale * root.xreplace({step.sigma: sp.Integer(1)})) ** 2,
            "the triangle of the swing, as long as the machine",
        ),
        Let(ahead, scale * seen.sin),
        Let(beside, scale * seen.cos),
    )
    found: list[Statement] = []
    is_open = False
    for s in statements:
        names = {s.name} if isinstance(s, Let) else set()
        is_open = is_open or (is_own and cosine(angle) in names)
        if not is_own and cosine(angle) in names:
            found += lets
        renamed = rewritten(s, lambda e: e.xreplace(own)) if is_open else s
        found.append(
            replace(renamed, name=own[s.name]) if is_open and isinstance(s, Let) and s.name in own else renamed
        )
        if is_own and sine(angle) in names:
            found += (*lets, *(Let(name, value) for name, value in own.items()))
            is_open = False
    along, across = scale * seen.along, scale * seen.across
    return found, Legs(ahead, square, beside, scale, along, across)


def _motion(later: Later, arm: Row, factors: tuple[sp.Expr, sp.Expr], step: StepDeterminant) -> tuple[Let, ...]:
    """The angle behind the turn, computed from where it was."""
    lets, names, rates = rates_of(later)
    words = ("arm_x", "arm_y", "end", "arm_x_rate", "arm_y_rate", "end_rate", "less", "more")
    x, y, end, x_rate, y_rate, end_rate, less, more = (later.name(word) for word in words)
    length, value, size, missing, linear, square, way, divisor, turn = (
        later.name(word) for word in ("arm", "value", "size", "missing", "linear", "square", "way", "divisor", "turn")
    )
    is_gone = sp.Gt(more + less, 4 * length)  # the later step divides by one where its arm has vanished
    keeps = sp.Ge(step.sigma * later.legs.beside, 0)  # an arm that has vanished: the turn to the side of its branch
    return (
        *lets,
        *(Let(n, v.xreplace(names)) for n, v in zip((x, y, end, less, more), (*arm, *factors), strict=True)),
        *(Let(n, rate_along(v, rates).xreplace(names)) for n, v in zip((x_rate, y_rate, end_rate), arm, strict=True)),
        Let(length, Root(x**2 + y**2)),
        Let(value, Select(is_gone, 2 * end, more - less), WITHIN_ITS_BOUND.format(later.step)),
        Let(size, Select(is_gone, 2 * length, (1 + BOUNDARY / 4) * (more + less))),
        Let(missing, Select(is_gone, (sp.Abs(end) - length) * (sp.Abs(end) + length), -less * more)),
        Let(linear, x * x_rate + y * y_rate - end * end_rate),
        Let(square, x_rate**2 + y_rate**2 - end_rate**2),
        Let(way, Select(sp.Gt(sp.Abs(linear), 0), Select(sp.Gt(linear, 0), 1, -1), Select(keeps, 1, -1))),
        Let(divisor, linear + way * Root(linear**2 + square * missing)),
        Let(
            turn,
            Select(sp.Gt(sp.Abs(divisor), 0), missing / Select(sp.Gt(sp.Abs(divisor), 0), divisor, 1), 0),
            f"turn of {later.angle.name} that makes the arm of {later.step.name} long enough",
        ),
        *_within_digits(later, turned(later, turn), step.swing),
        *taken(later, is_swept=False),
    )


def _within_digits(later: Later, lets: tuple[Let, ...], swing: Swing | None) -> tuple[Let, ...]:
    """The turn; its cost counts the change of the squared sine, too, as a share of its terms, where they are known."""
    if swing is None or swing.terms is None:
        return lets
    terms, cost = later.name("terms"), later.name("turned_cost")
    ahead, before = later.name("turned_ahead"), later.before(later.legs.root)
    share = sp.Abs((ahead - before) * (ahead + before)) / (later.scale * Select(sp.Gt(terms, 0), terms, sp.Integer(1)))
    return (
        Let(terms, swing.terms),
        *(replace(let, value=let.value + share) if let.name == cost else let for let in lets),
    )
