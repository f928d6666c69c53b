"""Quadratic:  a v^2 + b v + c = 0  in an unknown length, with a never zero.

Two roots, v = p + sigma root(D) with p = -b / 2a and the discriminant D = p^2 - c / a, kept factored. Determinant
2 a (v - p): sigma is its sign times that of a. One root where a quantity known to be positive is a multiple of the
determinant. Guard: D >= 0; where it vanishes both roots meet (degenerate case).
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from derive.algebra.normal_form import cancelled, factored, linear_coefficients
from derive.equations.problem import Binding, Conditioning, Equation, Problem, StepDeterminant, sign_of
from derive.ir.constants import BOUNDARY
from derive.ir.primitives import Root
from derive.ir.program import Let, Require, Statement, Status
from derive.ir.symbols import real
from derive.solver.subproblems.naming import Naming
from derive.solver.subproblems.shortfall import cannot_reach


def quadratic(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """Every length that one quadratic equation determines up to a sign."""
    for equation in equations:
        unknowns = problem.unknowns_of(equation.expression)
        if len(unknowns) != 1 or unknowns[0] not in problem.lengths or not equation.expression.is_polynomial(*unknowns):
            continue
        poly = sp.Poly(equation.expression, unknowns[0])
        if poly.degree() == 2 and problem.is_never_zero(poly.coeff_monomial(unknowns[0] ** 2)):
            yield _solve(problem, equation, unknowns[0], poly)


def _solve(problem: Problem, equation: Equation, unknown: sp.Symbol, poly: sp.Poly) -> Binding:
    a, b, c = (sp.sympify(poly.coeff_monomial(unknown**k)) for k in (2, 1, 0))
    naming = Naming(problem, equation.lets)
    middle = naming.named(cancelled(-b / (2 * a)), f"middle_{unknown.name}")
    square = real(f"radicand_{unknown.name}")
    scale = equation.scales.get(unknown, 2 * problem.scale)
    determinant = cancelled(sp.diff(equation.expression, unknown) / a)
    written_out = determinant.xreplace({let.name: let.value for let in equation.lets})
    known_sign = _known_sign(problem, written_out, unknown)
    sigma = sign_of(unknown) if known_sign is None else known_sign
    half = cancelled(scale / (2 * a))
    radicand = factored(cancelled(b**2 / (4 * a**2) - c / a))
    reason = cannot_reach(equation.label, radicand, naming.lets)
    reaches = Require(sp.Ge(square, -BOUNDARY * half**2), Status.UNREACHABLE, reason=reason)
    statements: tuple[Statement, ...] = (
        *naming.lets,
        Let(square, radicand, f"quadratic equation for {unknown.name}: {equation.label}"),
        *(() if radicand.is_nonnegative else (reaches,)),
        Let(unknown, middle + sigma * Root(square)),
    )
    over = cancelled(scale / sp.Abs(a))
    if known_sign is not None:
        return Binding(
            "quadratic", (unknown,), statements, conditioning=Conditioning(unknown, determinant, over, "meet")
        )
    return Binding("quadratic", (unknown,), statements, StepDeterminant(unknown, determinant, over))


def _known_sign(problem: Problem, determinant: sp.Expr, unknown: sp.Symbol) -> sp.Expr | None:
    """The sign of a determinant that is a multiple of a positive quantity, with other unknowns eliminated by affine
    equations. It may be a sign of the machine.
    """
    determinant = cancelled(determinant) if problem.positive else determinant
    for quantity in problem.positive:
        value = _through(problem, quantity, unknown)
        if value == 0 or not (determinant.free_symbols ^ value.free_symbols) <= {*problem.signs}:
            continue  # no multiple: one value has a symbol that the other lacks
        ratio = cancelled(determinant / value)
        for sign in (sp.Integer(1), *(s for s in problem.signs if s.is_nonzero and s in ratio.free_symbols)):
            number = cancelled(ratio * sign)
            if number.is_number and number != 0:
                return sign if number > 0 else -sign
    return None


def _through(problem: Problem, quantity: sp.Expr, unknown: sp.Symbol) -> sp.Expr:
    for equation in problem.equations:
        for other in problem.lengths:
            linear = linear_coefficients(equation.expression, (other,))
            if other == unknown or other not in quantity.free_symbols or linear is None or linear[0][0] == 0:
                continue
            if not linear[0][0].free_symbols:
                quantity = sp.expand(quantity.xreplace({other: -linear[1] / linear[0][0]}))
    return quantity
