"""Trigonometric:  a cos u + b sin u = e.

Paden and Kahan's subproblem 4; where e is made of three sides of a triangle, the law of cosines (their subproblem 3).
Two roots. Let h = |(a, b)|, C = e / h and S = sigma sqrt((h - e)(h + e)) / h, the cosine and sine of the angle between
u and the direction of (a, b). Then cos u = (a C - b S) / h and sin u = (b C + a S) / h. The factors h - e and h + e
stay products: expanded they lose half the digits. Where h is a root, C and S come from these factors alone,
whose ratio is the square of the tangent of half the angle: so C^2 + S^2 = 1 to rounding, whatever digits e has lost.
Where h is a product of lengths of the machine, their sum 2 h is one, too, and nothing is divided. Determinant a sin u -
b cos u = h S: sigma is its sign. Guard: |C| <= 1 but for rounding, else there is no solution. Where it is 1 both roots
meet (degenerate case). Where joints can make h vanish, u is free there: e must vanish, too. Where h is made of
parameters and commanded values alone, a pose is refused whose h is below 1e-9 of the length that it is compared with:
the arm then has no length that u could turn.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache

import sympy as sp

from derive.algebra.normal_form import cancelled, factored, linear_coefficients, reduce_units
from derive.equations.problem import Binding, Equation, Problem, StepDeterminant, Swing, sign_of
from derive.ir.constants import (
    BOUNDARY,
    DEGREE,
    FREE_ANGLE,
    SHORTEST_LINK,
)
from derive.ir.primitives import (
    Root,
    Select,
)
from derive.ir.program import (
    Let,
    Require,
    Statement,
    Status,
)
from derive.ir.reason import Why, about_joint
from derive.ir.symbols import (
    cosine,
    real,
    sine,
)
from derive.solver.subproblems.apart import determined_apart
from derive.solver.subproblems.direction import free_angle
from derive.solver.subproblems.lateral import Row, aimed_at_point
from derive.solver.subproblems.naming import Naming
from derive.solver.subproblems.origin import from_origin
from derive.solver.subproblems.other_leg import other_leg, with_leg
from derive.solver.subproblems.shortfall import out_of_reach
from derive.solver.subproblems.small_entries import with_small_entries

_ADDITION = "addition theorem: plus the angle of the direction from which the cosine is measured"


def trigonometric(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """Every angle that one equation determines up to a sign."""
    for equation, angle, (a, b, e), is_aimed in _rows(problem, equations):
        if is_aimed:
            yield _with_arm(aimed_at_point(problem, equation, angle, (a, b, e)), (a, b, e))
        else:
            yield _with_arm(_solve(problem, equation, angle, _amplitude(problem, equation, angle, a, b, e)), (a, b, e))


def lateral(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """Those of these angles that aim an arm at a commanded point; the others give a cosine alone."""
    for equation, angle, row, is_aimed in _rows(problem, equations):
        if is_aimed:
            yield _with_arm(aimed_at_point(problem, equation, angle, row), row)


def _with_arm(binding: Binding, row: Row) -> Binding:
    """The step with its equation, for steps before it that may have to turn its arm."""
    if binding.determinant is None:
        return binding
    return replace(binding, determinant=replace(binding.determinant, arm=row))


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


@dataclass(frozen=True)
class _Amplitude:
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
    told: sp.Expr | None = None
    """(h - e)(h + e) made of lengths, where the factors are not: what is missing is read off it."""
    aimable: sp.Basic | None = None
    """Whether h is long enough to determine the angle, where joints can make it vanish; else None."""
    left: sp.Expr = sp.Integer(0)
    """e where h is too short to be divided by: then it has to vanish."""


def _amplitude(
    problem: Problem, equation: Equation, angle: sp.Symbol, a: sp.Expr, b: sp.Expr, e: sp.Expr
) -> _Amplitude:
    naming = Naming(problem, equation.lets)
    determinant = a * sine(angle) - b * cosine(angle)
    shared = sp.Mul.make_args(sp.factor(sp.gcd(a, b)))
    common = sp.Mul(*[f for f in shared if f.is_positive])  # it divides, and keeps every sign
    along, across = cancelled(a / common), cancelled(b / common)
    is_fixed = common.is_number or problem.is_never_zero(common)
    if along.is_number and across.is_number:
        size = sp.sqrt(along**2 + across**2)
        length = common * size
        return _Amplitude(naming, length, (), along / size, across / size, e, determinant, length, is_fixed=is_fixed)
    if across == 0 and (problem.is_never_zero(along) or along.free_symbols <= {*problem.parameters}):
        return _along_the_coordinate(problem, naming, angle, (common, along), e)
    square = along**2 + across**2
    along, across = naming.named(along, f"along_{angle.name}"), naming.named(across, f"across_{angle.name}")
    note = f"effective length of the arm that {angle.name} turns"
    effective = naming.length(f"effective_{angle.name}", along, across, note=note)
    written_out = problem.reduce(square.xreplace({let.name: let.value for let in equation.lets}))
    is_moved = _is_moved(problem, written_out)
    unit = sp.Integer(1) if _has_no_unit(problem, written_out) else problem.scale_of(equation)
    divisor, aimable = effective, None
    guard: tuple[Statement, ...] = ()
    if problem.is_never_zero(square):
        scale = common * (unit if is_moved else effective)
    else:
        scale = equation.scales.get(angle, common * unit)
        divisor, aimable, guard = _vanishing(effective, (common, unit), angle, is_moved=is_moved)
    right, factors, told = _law_of_cosines(problem, equation, naming, angle, e, (common, square, divisor))
    units = (along / divisor, across / divisor)
    size, left = common * divisor, right.xreplace({divisor: effective})
    return _Amplitude(
        naming, size, guard, *units, right, determinant, scale, factors, told=told, aimable=aimable, left=left
    )


def _along_the_coordinate(
    problem: Problem, naming: Naming, angle: sp.Symbol, arm: tuple[sp.Expr, sp.Expr], e: sp.Expr
) -> _Amplitude:
    """Where b is zero: h is a, of either sign, and sigma is the sign of the sine."""
    common, along = arm
    length, one, guard = common * along, sp.Integer(1), tuple[Statement, ...]()
    if not problem.is_never_zero(along):
        is_long = sp.Gt(sp.Abs(along), SHORTEST_LINK / 2)
        guard = (Require(is_long, Status.UNREACHABLE, reason=about_joint(angle, Why.TOO_SHORT)),)
    return _Amplitude(
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
    make it vanish; the statements. An arm of parameters that is too short to aim is refused.
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
    """e; the factors h - e and h + e where a triangle is recognised; their product in lengths where the factors are
    not.

    In a triangle with the sides D and k and the third side of square M, h = 2 k D, and the factors are M - (D - k)^2
    and (D + k)^2 - M, or the reverse. D is a multiple of the effective length, and k the arm that turns. Expanded, the
    terms of D^2 and of M are far larger than their sum where the lengths of a machine differ.
    """
    triangle = _triangle(problem, right, turned)
    if triangle is not None and not _is_square(triangle.third):
        word = f"third_square_{angle.name}"
        third = naming.product(_positive(triangle.third), word, "square of the third side of the triangle")
        triangle = replace(triangle, third=third)
    seen = from_origin(problem, equation, right, turned[0].as_coeff_Mul()[1])
    if seen is not None:
        named = naming.product(seen, f"scaled_cosine_{angle.name}", "cosine, times the scale, without cancellation")
        return named, None, None if triangle is None else sp.Mul(*triangle.factors)
    return (right, None, None) if triangle is None else (triangle.right, triangle.factors, None)


@dataclass(frozen=True)
class _Triangle:
    """Two sides, `distance` and `side`, which enclose the wanted angle, and the square of the third one."""

    distance: sp.Expr
    side: sp.Expr
    third: sp.Expr
    sense: int
    """+1 where the cosine of the angle grows with distance and side, -1 where it falls."""

    @property
    def right(self) -> sp.Expr:
        """The cosine of the angle, times twice the product of distance and side."""
        return sp.expand(self.sense * (self.distance**2 + self.side**2 - self.third))

    @property
    def factors(self) -> tuple[sp.Expr, sp.Expr]:
        """1 - cosine and 1 + cosine of the angle, times the same product."""
        less, more = self.third - (self.distance - self.side) ** 2, (self.distance + self.side) ** 2 - self.third
        if _is_square(self.third):
            less, more = _product(less), _product(more)
        return (less, more) if self.sense > 0 else (more, less)


def _triangle(problem: Problem, right: sp.Expr, turned: tuple[sp.Expr, sp.Expr, sp.Expr]) -> _Triangle | None:
    """The triangle whose law of cosines a right side is; None where the square of its third side is not simpler than
    this.
    """
    common, square, effective = turned
    number, arm = common.as_coeff_Mul()
    whole = reduce_units(right, problem.units, problem.signs)
    share = whole.as_coefficients_dict()[sp.expand(arm**2)]
    ratio = number / (2 * sp.sqrt(abs(share)))
    if share == 0 or not ratio.is_rational:
        return None
    sense, distance, side = sp.sign(share), ratio * effective, sp.sqrt(abs(share)) * arm
    third = reduce_units(ratio**2 * square + side**2 - sense * whole, problem.units, problem.signs)
    square_of_third = _factored(_with_units(problem, third))
    if not (square_of_third.is_Mul or square_of_third.is_Pow) and len(sp.Add.make_args(third)) >= len(
        sp.Add.make_args(whole)
    ):
        return None
    return _Triangle(distance, side, square_of_third, sense)


def _with_units(problem: Problem, value: sp.Expr) -> sp.Expr:
    """A normal form with cos^2 + sin^2 of known angles written for one, so that squares can be recognised.

    The normal form of p^2 + q^2 - (p cos u + q sin u)^2 has 1 - cos^2 u for sin^2 u. With p^2 (cos^2 u + sin^2 u) for
    p^2, and the same for q^2, it is (p sin u - q cos u)^2.
    """
    for angle in problem.units:
        functions = {cosine(angle), sine(angle)}
        terms = sp.Add.make_args(sp.expand(value))
        turned = [t for t in terms if t.free_symbols & functions]
        seen = {s for t in turned for s in t.free_symbols} - functions
        unit = cosine(angle) ** 2 + sine(angle) ** 2
        value = sp.expand(
            sp.Add(*turned, *(t * unit if t.free_symbols & seen else t for t in terms if t not in turned))
        )
    return value


@cache
def _factored(value: sp.Expr) -> sp.Expr:
    """The value in factors; their coefficients may be the roots of numbers that occur in it."""
    roots = [r for r in value.atoms(sp.Pow) if r.is_number and not r.is_rational]
    return sp.factor(value, extension=roots) if roots else sp.factor(value)


def _is_square(value: sp.Expr) -> bool:
    """Whether a value is the square of a rational expression."""
    return all(f.as_base_exp()[1] % 2 == 0 or (f.is_number and f.is_positive) for f in sp.Mul.make_args(value))


def _solve(problem: Problem, equation: Equation, angle: sp.Symbol, amplitude: _Amplitude) -> Binding:
    sigma = sign_of(angle)
    turned = (amplitude.cos_unit, amplitude.sin_unit) != (1, 0)
    words = ("one_less_cos", "one_plus_cos", "sine_square", "sum", "divisor_of_cos")
    less_cos, plus_cos, square, twice, divisor = (real(f"{word}_{angle.name}") for word in words)
    cos_name = real(f"cos_swing_{angle.name}") if turned else cosine(angle)
    sin_name = real(f"sin_swing_{angle.name}") if turned else sine(angle)
    length, right = amplitude.length, amplitude.right
    size = sp.Abs if amplitude.is_signed else sp.Add
    less, more = amplitude.factors or (_product(length - right), _product(length + right))
    (less, more), column = with_small_entries(problem, equation, (less, more))
    is_fine = sp.Mul(less, more).has(Select)
    told, larger, leg = (less, more), tuple[Let, ...](), None
    if amplitude.aimable is not None:  # joints change the arm, which may be stretched along the coordinate
        leg = other_leg(problem, equation, angle, amplitude.determinant, amplitude.naming.lets)
    if leg is not None:
        (less, more), larger, column = with_leg(angle, (length, right), leg)
    scale: tuple[Let, ...] = (
        Let(twice, less_cos + plus_cos, "twice the scale, as the sum of both: then cosine and sine agree"),
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
        *_cosine(angle, amplitude, cos_name, (plus_cos - less_cos) / below, told),
        Let(square, less_cos * plus_cos, "sine squared, times the squared scale"),
        Let(sin_name, 2 * sigma * Root(square) / size(below)),
        *(_turned(problem, equation, angle, amplitude, (cos_name, sin_name)) if turned else ()),
    ]
    determinant = StepDeterminant(
        angle,
        amplitude.determinant,
        amplitude.determinant_scale,
        (length, right),
        beside=None if leg is None else leg[:2],
        factors=(less_cos, plus_cos),
        swing=Swing(
            cos_name, sin_name, amplitude.cos_unit, amplitude.sin_unit, equation.column is not None and not is_fine
        ),
    )
    return Binding("trigonometric", (angle,), tuple(statements), determinant, cosine_alone=True, yields_to_a_sum=True)


def _cosine(
    angle: sp.Symbol, amplitude: _Amplitude, name: sp.Symbol, value: sp.Expr, factors: tuple[sp.Expr, sp.Expr]
) -> tuple[Statement, ...]:
    """The cosine of the swing, and the condition that there is one. Near the place where the arm vanishes rounding of
    the equation moves it far, and beyond one: there it is one.
    """
    told = sp.Mul(*factors) if amplitude.told is None else amplitude.told
    known = (*amplitude.naming.lets, *(s for s in amplitude.guard if isinstance(s, Let)))
    reason = out_of_reach(angle, told, known)
    if amplitude.aimable is None:
        check = Require(sp.Le(sp.Abs(name), 1 + BOUNDARY / 2), Status.UNREACHABLE, reason=reason)
        return Let(name, value), check
    ratio, size = real(f"ratio_of_{angle.name}"), amplitude.determinant_scale
    near = sp.Le(sp.Abs(ratio), 1 + BOUNDARY / 2 * (1 + size / amplitude.length))
    vanishes = sp.Le(sp.Abs(amplitude.left), FREE_ANGLE * size)
    is_met = sp.Or(sp.And(amplitude.aimable, near), sp.And(sp.Not(amplitude.aimable), vanishes))
    within = Select(sp.Gt(ratio, 1), sp.Integer(1), Select(sp.Lt(ratio, -1), sp.Integer(-1), ratio))
    return Let(ratio, value), Require(is_met, Status.UNREACHABLE, reason=reason), Let(name, within)


def _turned(
    problem: Problem,
    equation: Equation,
    angle: sp.Symbol,
    amplitude: _Amplitude,
    swing: tuple[sp.Symbol, sp.Symbol],
) -> Iterator[Let]:
    """Cosine and sine of the angle from those of the swing; where there is no arm those that the two equations give
    between which a length was eliminated, else the reference.
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


def _product(value: sp.Expr) -> sp.Expr:
    """The value in factors, which read as comparisons of lengths."""
    return _positive(factored(value))


def _positive(product: sp.Expr) -> sp.Expr:
    """A leading minus goes into the factor with the most minus signs."""
    factors = list(sp.Mul.make_args(product))
    sums = [f for f in factors if f.is_Add]
    if -1 not in factors or not sums:
        return product
    factors.remove(sp.Integer(-1))
    most = max(sums, key=lambda f: (sum(t.could_extract_minus_sign() for t in f.args), str(f)))
    return sp.Mul(*[-f if f is most else f for f in factors])
