"""Trigonometric:  a cos u + b sin u = e.

Paden and Kahan's subproblem 4; where e is made of three sides of a triangle, the law of cosines (their subproblem 3).
Two roots. Let h = |(a, b)|, C = e / h and S = sigma sqrt((h - e)(h + e)) / h, the cosine and sine of the angle between
u and the direction of (a, b). Then cos u = (a C - b S) / h and sin u = (b C + a S) / h. The factors h - e and h + e
stay products: expanded they lose half the digits. Where h is a root, C and S come from these factors alone,
whose ratio is the square of the tangent of half the angle: so C^2 + S^2 = 1 to rounding, whatever digits e has lost.
Where h is a product of lengths of the machine, so is the sum 2 h of the factors, and nothing is divided. Determinant
a sin u - b cos u = h S: sigma is its sign. Guard: |C| <= 1 but for rounding, else there is no solution. Where |C| is 1
both roots meet (degenerate case). Where joints can make h vanish, u is free there, and e must vanish, too. Where h is
made of parameters and commanded values alone, a pose with h below 1e-9 of the length that it is compared with is
refused: u then has no arm to turn.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from derive.algebra.normal_form import linear_coefficients
from derive.equations.problem import Binding, Equation, Problem, StepDeterminant, sign_of
from derive.ir.constants import BOUNDARY, FREE_ANGLE, ROUNDING_OF_SUMS
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Require, Statement, Status
from derive.ir.symbols import BOUND_OF, cosine, real, sine
from derive.solver.subproblems.direction import free_angle
from derive.solver.subproblems.one_equation.amplitude import Amplitude, amplitude_of
from derive.solver.subproblems.one_equation.lateral import Row, aimed_at_point
from derive.solver.subproblems.one_equation.other_leg import held_by_leg, other_leg, with_leg
from derive.solver.subproblems.one_equation.small_entries import is_bounded, with_small_entries
from derive.solver.subproblems.one_equation.triangle import in_lengths
from derive.solver.subproblems.shortfall import out_of_reach

_ADDITION = "addition theorem: plus the angle of the direction from which the cosine is measured"


def trigonometric(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """Every angle that one equation determines up to a sign."""
    for equation, angle, row, is_aimed in _rows(problem, equations):
        if is_aimed:
            yield aimed_at_point(problem, equation, angle, row)
        else:
            yield _solve(problem, equation, angle, amplitude_of(problem, equation, angle, row))


def lateral(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """The angles of `trigonometric` that aim an arm at a commanded point; the others come from a cosine alone."""
    for equation, angle, row, is_aimed in _rows(problem, equations):
        if is_aimed:
            yield aimed_at_point(problem, equation, angle, row)


def _rows(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[tuple[Equation, sp.Symbol, Row, bool]]:
    """Every equation with one angle, the angle, (a, b, e), and whether a or b is commanded while e is not."""
    for equation in equations:
        unknowns = problem.unknowns_of(equation.expression)
        if len(unknowns) != 1 or unknowns[0] not in problem.angles or unknowns[0] in equation.expression.free_symbols:
            continue
        angle = unknowns[0]
        linear = linear_coefficients(equation.expression, (cosine(angle), sine(angle)))
        if linear is None:
            continue
        (a, b), rest = linear
        flip = -1 if (a if a != 0 else b).could_extract_minus_sign() else 1
        is_aimed = any(_is_commanded(problem, equation, v) for v in (a, b))
        row = (flip * a, flip * b, -flip * rest)
        yield equation, angle, row, is_aimed and not _is_commanded(problem, equation, rest)


def _is_commanded(problem: Problem, equation: Equation, coefficient: sp.Expr) -> bool:
    """Whether a coefficient changes with the commanded position."""
    written_out = coefficient
    for let in reversed(equation.lets):  # names in the value of a later one are bound by earlier ones
        written_out = written_out.xreplace({let.name: let.value})
    return bool(problem.reduce(written_out).free_symbols & {real(c) for c in ("x", "y", "z")})


def _solve(problem: Problem, equation: Equation, angle: sp.Symbol, amplitude: Amplitude) -> Binding:
    sigma = sign_of(angle)
    turned = (amplitude.cos_unit, amplitude.sin_unit) != (1, 0)
    words = ("one_less_cos", "one_plus_cos", "sine_square", "sum", "divisor_of_cos")
    less_cos, plus_cos, square, twice, divisor = (real(f"{word}_{angle.name}") for word in words)
    cos_name = real(f"cos_swing_{angle.name}") if turned else cosine(angle)
    sin_name = real(f"sin_swing_{angle.name}") if turned else sine(angle)
    length, right = amplitude.length, amplitude.right
    size = sp.Abs if amplitude.is_signed else sp.Add
    less, more = amplitude.factors or (in_lengths(length - right), in_lengths(length + right))
    named = (less, more)
    holds: sp.Basic | None = None if is_bounded(equation.column, named) else sp.true
    (less, more), column = with_small_entries(problem, equation, (less, more), amplitude.square)
    uncounted = int(sp.count_ops([less, more]) - sp.count_ops(list(named)))
    larger, leg = tuple[Let, ...](), None
    if amplitude.aimable is not None:  # joints change the arm, which may lie along the coordinate
        leg = other_leg(problem, equation, angle, amplitude.determinant, amplitude.naming.lets)
    if leg is not None:
        (less, more), larger, column = with_leg(angle, (length, right), leg)
        uncounted, holds = 0, held_by_leg(leg, length, problem.scale)
    scale: tuple[Let, ...] = (
        Let(twice, less_cos + plus_cos, "sum of both, twice the scale: cosine² + sine² is then 1"),
        Let(divisor, Select(sp.Gt(size(twice), 0), twice, sp.Integer(1))),
    )
    below: sp.Expr = divisor
    if amplitude.is_fixed:
        scale, below = (), 2 * length
    statements: list[Statement] = [
        *(let for let in amplitude.naming.lets if let not in column),
        *column,
        *amplitude.guard,
        *larger,
        Let(less_cos, less, f"law of cosines for {angle.name} ({equation.label}): 1 - cosine, times a scale"),
        Let(plus_cos, more, "1 + cosine, times the scale"),
        *scale,
        *_cosine(problem, (equation, angle), amplitude, cos_name, (plus_cos - less_cos) / below, named, holds),
        Let(square, less_cos * plus_cos, "sine squared, times the squared scale"),
        Let(sin_name, 2 * sigma * Root(square) / size(below)),
        *(_turned(problem, equation, angle, amplitude, (cos_name, sin_name)) if turned else ()),
    ]
    determinant = StepDeterminant(angle, amplitude.determinant, amplitude.determinant_scale)
    return Binding(
        "trigonometric",
        (angle,),
        tuple(statements),
        determinant,
        cosine_alone=True,
        uncounted=uncounted,
        yields_to_a_sum=True,
    )


def _cosine(
    problem: Problem,
    solved: tuple[Equation, sp.Symbol],
    amplitude: Amplitude,
    name: sp.Symbol,
    value: sp.Expr,
    factors: tuple[sp.Expr, sp.Expr],
    holds: sp.Basic | None,
) -> tuple[Statement, ...]:
    """The cosine of the swing, and the condition that it exists. Near the place where the arm vanishes, rounding of the
    equation may move the cosine beyond one: there it is set to one. solved: the equation, and the angle in it. holds:
    the condition that the other leg exists; None if the value is always a cosine, as an entry of a rotation is.
    """
    if holds is None:
        return (Let(name, value),)
    equation, angle = solved
    shown = sp.Mul(*factors) if amplitude.shown_factors is None else amplitude.shown_factors
    known = (*amplitude.naming.lets, *(s for s in amplitude.guard if isinstance(s, Let)))
    reason = out_of_reach(angle, shown, known)
    if amplitude.aimable is None:
        most: tuple[Let, ...] = ()
        bound: sp.Expr = 1 + BOUNDARY / 2
        if amplitude.is_fixed and equation.is_length:  # a constant: a short link on a long one rounds more than this
            unit, what = (problem.scale**2, "squared lengths") if equation.is_squared else (problem.scale, "lengths")
            rounded, bound = bound + ROUNDING_OF_SUMS * unit / amplitude.length, real(f"{BOUND_OF}{name.name}")
            most = (Let(bound, rounded, f"largest cosine within reach: 1, and the rounding of {what}"),)
        return *most, Let(name, value), Require(sp.Le(sp.Abs(name), bound), Status.UNREACHABLE, reason=reason)
    ratio, size = real(f"ratio_of_{angle.name}"), amplitude.determinant_scale
    near = sp.Le(sp.Abs(ratio), 1 + BOUNDARY / 2 * (1 + size / amplitude.length))
    vanishes = sp.Le(sp.Abs(amplitude.left), FREE_ANGLE * size)
    is_met = sp.Or(sp.And(amplitude.aimable, near, holds), sp.And(sp.Not(amplitude.aimable), vanishes))
    within = Select(sp.Gt(ratio, 1), sp.Integer(1), Select(sp.Lt(ratio, -1), sp.Integer(-1), ratio))
    return Let(ratio, value), Require(is_met, Status.UNREACHABLE, reason=reason), Let(name, within)


def _turned(
    problem: Problem, equation: Equation, angle: sp.Symbol, amplitude: Amplitude, swing: tuple[sp.Symbol, sp.Symbol]
) -> Iterator[Let]:
    """Cosine and sine of the angle from those of the swing. Without an arm they come from the two equations between
    which a length was eliminated, else from the reference.
    """
    along, across = amplitude.cos_unit, amplitude.sin_unit
    cos_name, sin_name = swing
    values = (along * cos_name - across * sin_name, across * cos_name + along * sin_name)
    free = free_angle(problem, angle)
    if amplitude.aimable is not None:
        lets, free = determined_apart(problem, equation, angle, free)
        yield from lets
    notes = (_ADDITION, "")
    for function, value, otherwise, note in zip((cosine, sine), values, free, notes, strict=True):
        chosen = value if amplitude.aimable is None else Select(amplitude.aimable, value, otherwise)
        yield Let(function(angle), chosen, note)


Pair = tuple[sp.Expr, sp.Expr]


def determined_apart(
    problem: Problem, equation: Equation, angle: sp.Symbol, free: Pair
) -> tuple[tuple[Let, ...], Pair]:
    """Cosine and sine of the angle where the equation says nothing, and the statements that bind the names in them.

    It is the difference of two equations, and says nothing if both coefficients of the eliminated length vanish: where
    one slide is parallel to another. There the two equations are a pair for the angle u: a1 cos u + b1 sin u = e1,
    a2 cos u + b2 sin u = e2. Where they do not determine the angle, either, the results are `free`.
    """
    read = [linear_coefficients(e, (cosine(angle), sine(angle))) for e in equation.apart]
    rows = [row for row in read if row is not None]
    if len(rows) != 2:
        return (), free
    ((a1, b1), c1), ((a2, b2), c2) = rows
    if any(problem.unknowns_of(v) for v in (a1, b1, c1, a2, b2, c2)):
        return (), free
    size = problem.reduce(a1 * b2 - a2 * b1)
    if size == 0:
        return (), free
    determinant, along, across, length, divisor = (
        real(f"{word}_{angle.name}_apart") for word in ("determinant", "along", "across", "length", "divisor")
    )
    is_known = sp.And(sp.Gt(sp.Abs(determinant), FREE_ANGLE * problem.scale**2), sp.Gt(length, 0))
    lets = (
        Let(determinant, size, "where the slide drops out of both equations these are a pair"),
        Let(along, (b1 * c2 - b2 * c1) * determinant),
        Let(across, (a2 * c1 - a1 * c2) * determinant),
        Let(length, Root(along**2 + across**2)),
        Let(divisor, Select(is_known, length, sp.Integer(1))),
    )
    cos_free, sin_free = free
    return lets, (Select(is_known, along / divisor, cos_free), Select(is_known, across / divisor, sin_free))
