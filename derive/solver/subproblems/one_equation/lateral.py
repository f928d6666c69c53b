"""Lateral:  a cos u + b sin u = e  with a commanded point (a, b), which an arm with the lateral offset e must reach.

This is Paden and Kahan's subproblem 4 with a point that moves. Two roots: let h = |(a, b)| be the distance of the point
from the axis of u, and s = sigma sqrt((h - e)(h + e)) how far ahead of the axis the point is. Then cos u = (a e - b s)
/ h^2 and sin u = (b e + a s) / h^2. The radicand stays a product. Determinant a sin u - b cos u = s: sigma is its sign.
Guard: |e| <= h, else the point is closer to the axis than the lateral offset is long. Degenerate case: the point is on
the axis, h = 0. It cannot be reached unless e is zero too, and then u is free. So h is the conditioning where e is
zero.
"""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from derive.equations.problem import Binding, Conditioning, Equation, Legs, Problem, StepDeterminant
from derive.ir.constants import BOUNDARY, FREE_ANGLE, ROUNDING
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Require, Statement, Status
from derive.ir.symbols import cosine, real, sine
from derive.solver.subproblems.direction import AT_THE_SINGULARITY, direction, free_angle
from derive.solver.subproblems.naming import Naming
from derive.solver.subproblems.shortfall import out_of_reach

Row = tuple[sp.Expr, sp.Expr, sp.Expr]
_AHEAD = "how far ahead of the axis the point is; negative: behind it"


def aimed_at_point(problem: Problem, equation: Equation, angle: sp.Symbol, row: Row) -> Binding:
    """The two angles at which an arm reaches a commanded point."""
    a, b, e = row
    naming = Naming(problem, equation.lets)
    along, across = naming.named(a, f"point_x_{angle.name}"), naming.named(b, f"point_y_{angle.name}")
    distance = naming.length(
        f"distance_{angle.name}", along, across, note=f"distance of the point from the axis of {angle.name}"
    )
    scale = equation.scales.get(angle, problem.scale)
    determinant = StepDeterminant(angle, a * sine(angle) - b * cosine(angle), scale)
    note = f"rotation by {angle.name} that points the arm at the point"
    if e == 0:
        one_way = _only_way(problem, determinant.value)
        way = determinant.sigma if one_way is None else one_way
        ahead = Let(real(f"ahead_{angle.name}"), way * distance, _AHEAD)
        known = direction(
            problem, angle, along=-way * across, across=way * along, conditioning=distance, note=note, is_length=True
        )
        conditioning = Conditioning(angle, distance, problem.scale)
        legs = Legs(ahead.name, distance**2, sp.Integer(0), distance, along, across)
        with_legs = replace(determinant, legs=legs) if one_way is None else None
        return Binding("lateral", (angle,), (*naming.lets, ahead, *known), with_legs, conditioning)
    beside = naming.named(e, f"beside_{angle.name}", "lateral offset of the arm")
    return _beside(problem, angle, naming, (along, across, beside, distance), determinant, note)


def _only_way(problem: Problem, determinant: sp.Expr) -> sp.Expr | None:
    """The sign of the determinant where an equation makes it equal or opposite to a positive length; else None."""
    for equation in problem.equations:
        for sign in (sp.Integer(1), sp.Integer(-1)):
            if problem.is_positive(problem.reduce(equation.expression - sign * determinant)):
                return sign * -1
    return None


def _beside(
    problem: Problem,
    angle: sp.Symbol,
    naming: Naming,
    row: tuple[sp.Expr, sp.Expr, sp.Expr, sp.Expr],
    determinant: StepDeterminant,
    note: str,
) -> Binding:
    along, across, beside, distance = row
    words = ("ahead", "ahead_squared", "divisor", "rounding")
    ahead, square, divisor, rounding = (real(f"{word}_{angle.name}") for word in words)
    shortest = FREE_ANGLE * problem.scale
    reason = out_of_reach(angle, (distance - beside) * (distance + beside), naming.lets)
    determined = sp.Gt(distance, shortest)
    cos_free, sin_free = free_angle(problem, angle)
    cos_value = (along * beside - across * ahead) / divisor
    sin_value = (across * beside + along * ahead) / divisor
    statements: tuple[Statement, ...] = (
        *naming.lets,
        Let(rounding, (ROUNDING * problem.scale) ** 2, "rounding error of a squared length"),
        Let(square, (distance - beside) * (distance + beside), "Pythagoras: square of the distance ahead of the axis"),
        Require(sp.Ge(square, -BOUNDARY * distance**2 - rounding), Status.UNREACHABLE, reason=reason),
        Let(ahead, determinant.sigma * Root(square), _AHEAD),
        Let(divisor, Select(determined, distance**2, sp.Integer(1))),
        Let(cosine(angle), Select(determined, cos_value, cos_free), f"{note}; {AT_THE_SINGULARITY}"),
        Let(sine(angle), Select(determined, sin_value, sin_free)),
    )
    legs = Legs(ahead, square, beside, distance, along, across)
    return Binding("lateral", (angle,), statements, replace(determinant, legs=legs), cosine_alone=True)
