"""Polar:  f cos v = a,  f sin v = b  with both f and v unknown.

v is the polar angle of (sigma a, sigma b), and f = sigma |(a, b)| the polar radius. Two roots, or one where f is known
to be positive. Determinant f: its sign is the branch. Where |(a, b)| vanishes v is free (degenerate case); it is the
conditioning. f is an unknown length, or a product with the sine or cosine of another angle, which then becomes known.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import permutations

import sympy as sp

from derive.algebra.normal_form import cancelled, linear_coefficients
from derive.equations.problem import Binding, Conditioning, Equation, Problem, StepDeterminant
from derive.ir.program import (
    Let,
)
from derive.ir.symbols import cosine, sine
from derive.solver.subproblems.direction import direction
from derive.solver.subproblems.naming import Naming


def polar(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """Every angle and length that two equations determine together."""
    terms = [(e, _unknown_terms(problem, e)) for e in equations]
    for angle in problem.angles:
        in_cosines = [_radius(problem, e, cosine(angle)) if _is_in_all(cosine(angle), t) else None for e, t in terms]
        in_sines = [_radius(problem, e, sine(angle)) if _is_in_all(sine(angle), t) else None for e, t in terms]
        seen = zip(equations, in_cosines, in_sines, strict=True)
        for (first, in_cosine, _), (second, _, in_sine) in permutations(seen, 2):
            if in_cosine is None or in_sine is None or in_cosine[0] != in_sine[0]:
                continue
            if {angle, cosine(angle), sine(angle)} & in_cosine[0].free_symbols:
                continue
            yield _solve(problem, angle, in_cosine[0], (first, in_cosine[1]), (second, in_sine[1]))


def _unknown_terms(problem: Problem, equation: Equation) -> list[set[sp.Symbol]]:
    """The unknowns of each term that has some."""
    unknowns = set(problem.atoms())
    found = (t.free_symbols & unknowns for t in sp.Add.make_args(equation.expression))
    return [symbols for symbols in found if symbols]


def _is_in_all(function: sp.Symbol, terms: list[set[sp.Symbol]]) -> bool:
    """Whether all unknown terms have a function as a factor, so that the rest is known."""
    return bool(terms) and all(function in symbols for symbols in terms)


def _radius(problem: Problem, equation: Equation, function: sp.Symbol) -> tuple[sp.Expr, sp.Expr] | None:
    """(f, a) where the equation is f * function = a with known a and a product f of unknowns; else None."""
    linear = linear_coefficients(equation.expression, (function,))
    if linear is None or problem.unknowns_of(linear[1]):
        return None
    factor, rest = linear[0][0], linear[1]
    unknown = sp.Mul(*[f for f in sp.Mul.make_args(factor) if problem.unknowns_of(f)])
    unknown = -unknown if unknown.could_extract_minus_sign() else unknown  # a sum has its minus inside
    constant = cancelled(factor / unknown)
    if not problem.unknowns_of(unknown) or not problem.is_never_zero(constant):
        return None
    return unknown, -rest / constant


def _solve(
    problem: Problem,
    angle: sp.Symbol,
    radius: sp.Expr,
    along: tuple[Equation, sp.Expr],
    across: tuple[Equation, sp.Expr],
) -> Binding:
    naming = Naming(problem, along[0].lets + across[0].lets)
    a = naming.named(along[1], f"{along[0].label}_of_{angle.name}")
    b = naming.named(across[1], f"{across[0].label}_of_{angle.name}")
    distance = naming.length(f"radius_{angle.name}", a, b, note=f"polar coordinates: the radius at angle {angle.name}")
    note = f"polar coordinates: angle {angle.name} from the {along[0].label} and {across[0].label} equations"
    sigma, determinant = sp.Integer(1), None
    if not _is_positive(problem, radius):
        determinant = StepDeterminant(angle, radius, problem.scale_of(along[0]))
        sigma = determinant.sigma
    known = direction(
        problem,
        angle,
        along=sigma * a,
        across=sigma * b,
        conditioning=distance,
        note=note,
        is_length=True,
        scale=problem.scale_of(along[0]),
    )
    conditioning = _conditioning(problem, angle, radius, distance, problem.scale_of(along[0]))
    if radius in problem.lengths:
        statements = (*naming.lets, Let(radius, sigma * distance), *known)
        return Binding("polar", (radius, angle), statements, determinant, conditioning)
    product = Equation(f"{angle.name} radius", radius - sigma * distance, is_length=along[0].is_length)
    return Binding("polar", (angle,), (*naming.lets, *known), determinant, conditioning, (product,))


def _conditioning(
    problem: Problem, angle: sp.Symbol, radius: sp.Expr, distance: sp.Expr, scale: sp.Expr
) -> Conditioning:
    """For a product such as r sin(phi) the sine alone, which has no unit: the step that finds r has its own
    conditioning.
    """
    functions = [f for f in sp.Mul.make_args(radius) if f not in problem.lengths and f.is_Symbol]
    if len(functions) == 0 or len(functions) == len(sp.Mul.make_args(radius)):
        return Conditioning(angle, distance, scale)
    return Conditioning(angle, sp.Mul(*functions), sp.Integer(1))


def _is_positive(problem: Problem, radius: sp.Expr) -> bool:
    return problem.is_positive(radius)
