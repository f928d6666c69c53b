"""The amplitude of a cos u + b sin u = e: h = |(a, b)| as a product, and its properties."""

from __future__ import annotations

from dataclasses import dataclass, replace

import sympy as sp

from derive.algebra.normal_form import cancelled, factors_of, reduce_units
from derive.algebra.rings import common_factor
from derive.equations.problem import Equation, Problem
from derive.ir.constants import DEGREE, FREE_ANGLE, SHORTEST_LINK
from derive.ir.primitives import Select
from derive.ir.program import Let, Require, Statement, Status
from derive.ir.reason import Why, about_joint
from derive.ir.symbols import cosine, real, sine
from derive.solver.subproblems.naming import Naming
from derive.solver.subproblems.one_equation.lateral import Row
from derive.solver.subproblems.one_equation.triangle import is_square, triangle_of, without_minus


@dataclass(frozen=True)
class Amplitude:
    """h as a product, the unit vector along (a, b), and e."""

    naming: Naming
    length: sp.Expr
    guard: tuple[Statement, ...]
    cos_unit: sp.Expr
    sin_unit: sp.Expr
    right: sp.Expr
    determinant: sp.Expr
    determinant_scale: sp.Expr
    factors: tuple[sp.Expr, sp.Expr] | None = None
    """h - e and h + e, where they can be computed with fewer rounding errors than by these differences; else None."""
    is_signed: bool = False
    """Whether h may be negative."""
    is_fixed: bool = False
    """Whether h never vanishes, so that it divides as it is."""
    shown_factors: sp.Expr | None = None
    """(h - e)(h + e) made of lengths, where the factors are not: the amount of the reason is computed from it."""
    aimable: sp.Basic | None = None
    """Whether h is long enough to determine the angle, where joints can make it vanish; else None."""
    left: sp.Expr = sp.Integer(0)
    """e where h is too short to be a divisor: e then has to vanish."""
    square: sp.Expr | None = None
    """The square of h, where it has no unit; else None."""


def amplitude_of(problem: Problem, equation: Equation, angle: sp.Symbol, row: Row) -> Amplitude:
    """The amplitude of (a, b, e)."""
    a, b, e = row
    naming = Naming(problem, equation.lets)
    determinant = a * sine(angle) - b * cosine(angle)
    shared = factors_of(common_factor(a, b))
    common = sp.Mul(*[f for f in shared if f.is_positive])  # dividing by it keeps every sign
    along, across = cancelled(a / common), cancelled(b / common)
    is_fixed = common.is_number or problem.is_never_zero(common)
    if along.is_number and across.is_number:
        size = sp.sqrt(along**2 + across**2)
        length = common * size
        return Amplitude(naming, length, (), along / size, across / size, e, determinant, length, is_fixed=is_fixed)
    if across == 0 and (problem.is_never_zero(along) or along.free_symbols <= {*problem.parameters}):
        return _along_the_coordinate(problem, naming, angle, (common, along), e)
    square = along**2 + across**2
    never_vanishes = any(problem.is_never_zero(part) for part in (along, across, square))
    along, across = naming.named(along, f"along_{angle.name}"), naming.named(across, f"across_{angle.name}")
    note = f"effective length of the arm that {angle.name} turns"
    effective = naming.length(f"effective_{angle.name}", along, across, note=note)
    written_out = problem.reduce(square.xreplace({let.name: let.value for let in equation.lets}))
    is_moved = _is_moved(problem, written_out)
    unit = sp.Integer(1) if _has_no_unit(problem, written_out) else problem.scale_of(equation)
    divisor, aimable = effective, None
    guard: tuple[Statement, ...] = ()
    if never_vanishes:
        scale = common * (unit if is_moved else effective)
    else:
        scale = equation.scales.get(angle, common * unit)
        divisor, aimable, guard = _vanishing(effective, (common, unit), angle, is_moved=is_moved)
    right, factors, shown_factors = _law_of_cosines(problem, equation, naming, angle, e, (common, square, divisor))
    units = (along / divisor, across / divisor)
    size, left = common * divisor, right.xreplace({divisor: effective})
    return Amplitude(
        naming,
        size,
        guard,
        *units,
        right,
        determinant,
        scale,
        factors,
        shown_factors=shown_factors,
        aimable=aimable,
        left=left,
        square=common**2 * square if _has_no_unit(problem, common**2 * written_out) else None,
    )


def _along_the_coordinate(
    problem: Problem, naming: Naming, angle: sp.Symbol, arm: tuple[sp.Expr, sp.Expr], e: sp.Expr
) -> Amplitude:
    """Where b is zero: h is a, of either sign, and sigma is the sign of the sine."""
    common, along = arm
    length, one, guard = common * along, sp.Integer(1), tuple[Statement, ...]()
    if not problem.is_never_zero(along):
        is_long = sp.Gt(sp.Abs(along), SHORTEST_LINK / 2)
        guard = (Require(is_long, Status.UNREACHABLE, reason=about_joint(angle, Why.TOO_SHORT)),)
    return Amplitude(
        naming,
        length,
        guard,
        one,
        sp.Integer(0),
        e,
        sine(angle),
        one,
        is_signed=not length.is_positive,
        is_fixed=not guard and (common.is_number or problem.is_never_zero(common)),
    )


def _is_moved(problem: Problem, square: sp.Expr) -> bool:
    """Whether joints of a chain that are known already change the effective length of the arm."""
    read = square.free_symbols
    return bool(problem.links) and any(read & {joint, cosine(joint), sine(joint)} for joint in problem.references)


def _has_no_unit(problem: Problem, square: sp.Expr) -> bool:
    """Whether a value is made of sines, cosines and entries of rotations alone."""
    turned = {f(angle) for angle in problem.units for f in (cosine, sine)}
    return set(square.free_symbols) <= {*turned, *problem.rotation, *problem.signs, DEGREE}


def _vanishing(
    effective: sp.Expr, sizes: tuple[sp.Expr, sp.Expr], angle: sp.Symbol, *, is_moved: bool
) -> tuple[sp.Symbol, sp.Basic | None, tuple[Statement, ...]]:
    """The effective length as a divisor, where it can vanish; the condition that it determines the angle, where joints
    make it vanish; the statements. An arm of parameters that is too short to be aimed is refused.
    """
    common, unit = sizes
    divisor = real(f"divisor_{angle.name}")
    aimable = sp.Gt(effective, FREE_ANGLE * unit if is_moved else SHORTEST_LINK * common / 2)
    let = Let(divisor, Select(aimable, effective, sp.Integer(1)))
    if is_moved:
        return divisor, aimable, (let,)
    return divisor, None, (Require(aimable, Status.UNREACHABLE, reason=about_joint(angle, Why.TOO_SHORT)), let)


def _law_of_cosines(
    problem: Problem,
    equation: Equation,
    naming: Naming,
    angle: sp.Symbol,
    right: sp.Expr,
    turned: tuple[sp.Expr, sp.Expr, sp.Expr],
) -> tuple[sp.Expr, tuple[sp.Expr, sp.Expr] | None, sp.Expr | None]:
    """Returns e; the factors h - e and h + e where a triangle is recognised; and their product in lengths where the
    factors are not made of lengths.

    In a triangle with the sides D and k and the third side of square M, h = 2 k D, and the factors are M - (D - k)^2
    and (D + k)^2 - M, or the reverse. D is a multiple of the effective length, and k the arm that turns. Expanded, the
    terms of D^2 and of M are far larger than their sum where the lengths of a machine differ.
    """
    triangle = triangle_of(problem, right, turned)
    if triangle is not None and not is_square(triangle.third):
        word = f"third_square_{angle.name}"
        third = naming.product(without_minus(triangle.third), word, "square of the third side of the triangle")
        triangle = replace(triangle, third=third)
    seen = from_origin(problem, equation, right, turned[0].as_coeff_Mul()[1])
    if seen is not None:
        named = naming.product(seen, f"scaled_cosine_{angle.name}", "cosine, times the scale, without cancellation")
        return named, None, None if triangle is None else sp.Mul(*triangle.factors)
    return (right, None, None) if triangle is None else (triangle.right, triangle.factors, None)


def from_origin(problem: Problem, equation: Equation, value: sp.Expr, arm: sp.Expr) -> sp.Expr | None:
    """The right side e of a law of cosines as its value at the origin plus an increment; None if its roots do not
    cancel to a multiple of the arm at the origin.

    Some machines state their lengths by the angles at which they stand at the origin, so that lengths are roots. Then
    the terms of e are larger than e by the ratio of rod and arm, and their sum loses as many digits. Let v be the known
    names that depend on the position, and v0 their values at the origin. For e of at most the second degree in v the
    trapezoidal rule is exact: e = e(v0) + sum (v - v0) (e_v(v) + e_v(v0)) / 2.
    """
    zero = {c: sp.Integer(0) for c in problem.position}
    moving = {c: c for c in problem.position} | {
        let.name: let.value for let in equation.lets if let.value.free_symbols & zero.keys()
    }
    names = [n for n in moving if n in value.free_symbols]
    if not problem.squares or not names or sp.Poly(value, *names).total_degree() > 2:
        return None
    origin = {n: moving[n].xreplace(zero) for n in names}
    written = reduce_units(value.xreplace(origin), problem.units, problem.signs)
    left = _through_squares(problem, written)
    if left == written or any(sp.cancel(term / arm).as_numer_denom()[1].has(arm) for term in sp.Add.make_args(left)):
        return None
    added = [(moving[n] - origin[n]) * _mean_rate(value, n, origin) for n in names]
    return sp.Add(sp.factor(left), *added)


def _mean_rate(value: sp.Expr, name: sp.Symbol, origin: dict[sp.Symbol, sp.Expr]) -> sp.Expr:
    """The mean of the derivatives at the origin and at the commanded position."""
    rate = sp.diff(value, name)
    return sp.expand((rate + rate.xreplace(origin)) / 2)


def _through_squares(problem: Problem, value: sp.Expr) -> sp.Expr:
    """The normal form with the squares of roots written out."""
    while True:
        after = value.replace(
            lambda n: isinstance(n, sp.Pow) and n.base in problem.squares and n.exp.is_Integer and n.exp >= 2,
            lambda n: problem.squares[n.base] ** (n.exp // 2) * n.base ** (n.exp % 2),
        )
        if after == value:
            return value
        value = reduce_units(after, problem.units, problem.signs)
