"""Trigonometric:  a cos u + b sin u = e.

Two roots. With h = |(a, b)|, C = e / h and S = sigma sqrt((h - e)(h + e)) / h:
cos u = (a C - b S) / h,  sin u = (b C + a S) / h. The radicand stays a product: expanded it loses half the digits.
Slope a sin u - b cos u = h S: sigma is its sign. Guard: |e| <= h, else there is no solution; where they are
equal both roots meet (degenerate case). An h that can vanish is refused below 1e-9 of the length it is
compared with: nothing can be aimed then.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import sympy as sp

from derive.algebra import cosine, linear_coefficients, sine
from derive.problem import Binding, Equation, Problem, Slope
from derive.program import BOUNDARY, SHORTEST_LINK, Let, Require, Root, Select, Statement, Status, real
from derive.subproblems.lateral import aimed_at_point
from derive.subproblems.naming import Naming


def trigonometric(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """Every angle that one equation determines up to a sign."""
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
        if any(_is_commanded(problem, equation, v) for v in (a, b)) and not _is_commanded(problem, equation, rest):
            yield aimed_at_point(problem, equation, angle, (flip * a, flip * b, -flip * rest))
        else:
            yield _solve(problem, equation, angle, _amplitude(problem, equation, angle, flip * a, flip * b, -flip * rest))


def _is_commanded(problem: Problem, equation: Equation, coefficient: sp.Expr) -> bool:
    """Whether a coefficient changes with the commanded position."""
    written_out = coefficient.xreplace({let.name: let.value for let in equation.lets})
    return bool(problem.reduce(written_out).free_symbols & {real(c) for c in ("x", "y", "z")})


@dataclass(frozen=True)
class _Amplitude:
    """h as a product, the direction of (a, b), and e with squares written through h."""

    naming: Naming
    length: sp.Expr
    guard: tuple[Statement, ...]
    cos_unit: sp.Expr
    sin_unit: sp.Expr
    right: sp.Expr
    slope: sp.Expr
    slope_scale: sp.Expr


def _amplitude(
    problem: Problem, equation: Equation, angle: sp.Symbol, a: sp.Expr, b: sp.Expr, e: sp.Expr
) -> _Amplitude:
    naming = Naming(problem, equation.lets)
    slope = a * sine(angle) - b * cosine(angle)
    common = sp.Mul(*[f for f in sp.Mul.make_args(sp.gcd(a, b)) if f.is_positive])  # it divides, and keeps every sign
    along, across = sp.cancel(a / common), sp.cancel(b / common)
    if along.is_number and across.is_number:
        size = sp.sqrt(along**2 + across**2)
        return _Amplitude(naming, common * size, (), along / size, across / size, e, slope, common * size)
    if across == 0 and problem.is_never_zero(along):  # of either sign: sigma is then the sign of the sine
        return _Amplitude(naming, common * along, (), sp.Integer(1), sp.Integer(0), e, sine(angle), sp.Integer(1))
    along, across = naming.named(along, f"along_{angle.name}"), naming.named(across, f"across_{angle.name}")
    effective = naming.length(f"effective_{angle.name}", along, across, note="effective length that the angle turns")
    right = e.subs(along**2, effective**2 - across**2) if along.is_Symbol else e
    if problem.is_never_zero(along**2 + across**2):
        length = common * effective
        return _Amplitude(naming, length, (), along / effective, across / effective, sp.expand(right), slope, length)
    aimable = sp.Gt(effective, SHORTEST_LINK * common / 2)
    divisor = real(f"divisor_{angle.name}")
    guard = (
        Require(aimable, Status.UNREACHABLE, f"{angle.name}: its effective length is too short"),
        Let(divisor, Select(aimable, effective, sp.Integer(1))),
    )
    right = e
    if along.is_Symbol:
        right = sp.expand(e.subs(along**2, divisor**2 - across**2))
    return _Amplitude(
        naming, common * divisor, guard, along / divisor, across / divisor, right, slope,
        equation.scales.get(angle, common * problem.scale),
    )


def _solve(problem: Problem, equation: Equation, angle: sp.Symbol, amplitude: _Amplitude) -> Binding:
    sigma = real(f"sigma_{angle.name}")
    turned = (amplitude.cos_unit, amplitude.sin_unit) != (1, 0)
    scale = real(f"swing_scale_{angle.name}" if turned else f"scale_{angle.name}")
    square = real(f"sine_square_{angle.name}")
    cos_name = real(f"cos_swing_{angle.name}") if turned else cosine(angle)
    sin_name = real(f"sin_swing_{angle.name}") if turned else sine(angle)
    length, right = amplitude.length, amplitude.right
    statements: list[Statement] = [
        *amplitude.naming.lets,
        *amplitude.guard,
        Let(scale, length, f"{angle.name}: law of cosines in the {equation.label} equation"),
        Let(square, _product(length - right) * _product(length + right) / scale**2, "kept as a product"),
        Require(sp.Ge(square, -BOUNDARY), Status.UNREACHABLE, f"{angle.name}: out of reach"),
        Let(cos_name, right / scale),
        Let(sin_name, sigma * Root(square)),
    ]
    if turned:
        statements += [
            Let(cosine(angle), amplitude.cos_unit * cos_name - amplitude.sin_unit * sin_name),
            Let(sine(angle), amplitude.sin_unit * cos_name + amplitude.cos_unit * sin_name),
        ]
    slope = Slope(sigma, amplitude.slope, amplitude.slope_scale, (length, right))
    return Binding("trigonometric", (angle,), tuple(statements), slope, cosine_alone=True)


def _product(value: sp.Expr) -> sp.Expr:
    """Factored, with a leading minus inside the factor that has most of them: it reads as lengths compared."""
    factored = sp.factor(value)
    factors = list(sp.Mul.make_args(factored))
    sums = [f for f in factors if f.is_Add]
    if -1 not in factors or not sums:
        return factored
    factors.remove(sp.Integer(-1))
    most = max(sums, key=lambda f: (sum(t.could_extract_minus_sign() for t in f.args), str(f)))
    return sp.Mul(*[-f if f is most else f for f in factors])
