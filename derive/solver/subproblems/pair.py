"""Pair:  a1 cos u + b1 sin u = e1,  a2 cos u + b2 sin u = e2.

One root, by Cramer's rule. Determinant D = a1 b2 - a2 b1. Two kinds are taken:

* A rotation by u takes the vector (A, B) to (e1, e2): Paden and Kahan's subproblem 1. Here a1 = s b2 = A and a2 = -s b1
  = B;
  s is +1, or -1 where u turns the other way, or a sign that is a parameter of the machine.
  D = s (A^2 + B^2), cos u : sin u = A e1 + B e2 : s (A e2 - B e1).
* Any other pair with a determinant that never vanishes: divided by D.

In the first kind |(A, B)| must equal |(e1, e2)|. If this length is always one nothing is divided. If it
can vanish, u is free there (degenerate case), and the length is its conditioning.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations

import sympy as sp

from derive.algebra.normal_form import cancelled, factors_of, linear_coefficients
from derive.algebra.rings import common_factor
from derive.equations.problem import Binding, Conditioning, Equation, Problem
from derive.ir.program import Let
from derive.ir.symbols import cosine, sine
from derive.solver.subproblems.direction import direction
from derive.solver.subproblems.naming import Naming

Row = tuple[sp.Expr, sp.Expr, sp.Expr]


def pair(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """Every angle that two equations determine together."""
    for angle in problem.angles:
        rows = [(e, r) for e in equations for r in [_row(problem, e, angle)] if r is not None]
        for (first, row1), (second, row2) in combinations(rows, 2):
            binding = _solve(problem, angle, (first, second), row1, row2)
            if binding is not None:
                yield binding


def scaled_pair(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """Every angle that two equations determine together, where each equation is a coordinate of a turned vector times a
    factor that never vanishes: the height of an arm's tip, and the square of its distance.
    """
    for angle in problem.angles:
        rows = [(e, r) for e in equations for r in [_row(problem, e, angle)] if r is not None]
        for (first, row1), (second, row2) in combinations(rows, 2):
            parts = [_without_factor(problem, row) for row in (row1, row2)]
            (scaled1, factor1), (scaled2, factor2) = parts
            if factor1 * factor2 == 1 or _sense(problem, scaled1, scaled2) is None:
                continue
            binding = _solve(problem, angle, (first, second), scaled1, scaled2)
            if binding is not None and binding.residual is not None:
                yield replace(binding, residual=binding.residual * _share(problem, factor1 * factor2) ** 2)


def _without_factor(problem: Problem, row: Row) -> tuple[Row, sp.Expr]:
    """The row, divided by a common factor of its coefficients that never vanishes, and this factor."""
    a, b, e = row
    factors = factors_of(common_factor(a, b))
    factor = sp.Mul(*[f for f in factors if not f.is_number and problem.is_never_zero(f)])
    content = sp.Mul(*[abs(f.as_coeff_Mul()[0]) for v in (a, b) for f in sp.Add.make_args(sp.expand(v))][:1])
    factor *= content
    return (cancelled(a / factor), cancelled(b / factor), sp.expand(e / factor)), factor


def _share(problem: Problem, factor: sp.Expr) -> sp.Expr:
    """A factor without its unit: each length in it is divided by the machine's scale."""
    turned = {f(angle) for angle in problem.units for f in (cosine, sine)}
    return factor.xreplace({s: s / problem.scale for s in factor.free_symbols - turned - {*problem.signs}})


def _row(problem: Problem, equation: Equation, angle: sp.Symbol) -> Row | None:
    expression = equation.expression
    if problem.unknowns_of(expression) != (angle,) or angle in expression.free_symbols:
        return None
    linear = linear_coefficients(expression, (cosine(angle), sine(angle)))
    return None if linear is None else (linear[0][0], linear[0][1], -linear[1])


def _solve(problem: Problem, angle: sp.Symbol, used: tuple[Equation, Equation], row1: Row, row2: Row) -> Binding | None:
    (a1, b1, e1), (a2, b2, e2) = row1, row2
    sense = _sense(problem, row1, row2)
    note = f"cosine and sine of {angle.name} from the {used[0].label} and {used[1].label} equations"
    naming = Naming(problem, used[0].lets + used[1].lets)
    e1, e2 = (naming.named(e, f"{u.label}_of_{angle.name}") for e, u in ((e1, used[0]), (e2, used[1])))
    determinant = problem.reduce(a1 * b2 - a2 * b1)
    if sense is not None:
        along = naming.named(a1, f"arm_along_{angle.name}")
        across = naming.named(a2, f"arm_across_{angle.name}")
        cos_part = along * e1 + across * e2
        sin_part = sense * (along * e2 - across * e1)
        if determinant == sense:
            return _bound(angle, naming, cos_part, sin_part, note)
        reach = naming.length("reach", e1, e2)
        scale = problem.scale_of(used[0])
        moved = "arm to its target point" if used[0].is_length else "machine's direction to the commanded one"
        note = f"rotation by {angle.name} that takes the {moved}"
        known = direction(problem, angle, along=cos_part, across=sin_part, conditioning=reach, note=note, scale=scale)
        conditioning, residual = Conditioning(angle, reach, scale), reach**2 - along**2 - across**2
        return Binding("pair", (angle,), (*naming.lets, *known), conditioning=conditioning, residual=residual)
    if not problem.is_never_zero(determinant):
        return None
    inverse = (
        determinant if determinant**2 in (1, *(s**2 for s in problem.signs)) else 1 / determinant
    )  # ±1 is its own inverse
    cos_value, sin_value = (problem.tidy(value * inverse) for value in (e1 * b2 - e2 * b1, a1 * e2 - a2 * e1))
    return _bound(angle, naming, cos_value, sin_value, note)


def _sense(problem: Problem, row1: Row, row2: Row) -> sp.Expr | None:
    """s where the rows are one vector rotated by the angle: +1, or -1 where the angle turns the other way, or a sign of
    the machine; else None.
    """
    (a1, b1, _), (a2, b2, _) = row1, row2
    for sense in (sp.Integer(1), sp.Integer(-1), *problem.signs):
        if problem.reduce(a1 - sense * b2) == 0 and problem.reduce(b1 + sense * a2) == 0:
            return sense
    return None


def _bound(angle: sp.Symbol, naming: Naming, cos_value: sp.Expr, sin_value: sp.Expr, note: str) -> Binding:
    lets = (Let(cosine(angle), cos_value, note), Let(sine(angle), sin_value))
    return Binding("pair", (angle,), (*naming.lets, *lets))
