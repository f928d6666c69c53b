"""Polar:  f cos v = a,  f sin v = b  with both f and v unknown.

v is the polar angle of (sigma a, sigma b), and f = sigma |(a, b)| the polar radius. Two roots, or one where f is known
to be positive. Determinant f: its sign is the branch. Where |(a, b)| vanishes v is free (degenerate case); this length
is the conditioning. f is an unknown length; or it is the sine or cosine of another angle, which then becomes known,
times an unknown or a known length, such as an arm that this other angle swings.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import permutations

import sympy as sp

from derive.algebra.normal_form import cancelled, linear_coefficients
from derive.equations.problem import Binding, Column, Conditioning, Equation, Problem, StepDeterminant
from derive.ir.program import Let
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
            unit = _unit(problem, first, in_cosine)
            radius = _Radius(in_cosine[0], unit)
            a, b = (cancelled(unit / constant) * value for _, constant, value in (in_cosine, in_sine))
            yield _solve(problem, angle, radius, (first, a), (second, b))


_Part = tuple[sp.Expr, sp.Expr, sp.Expr]
"""(f, c, a) of an equation c * f * function = a: a product f of unknowns, known c and a."""


@dataclass(frozen=True)
class _Radius:
    """The polar radius: a product of unknowns, times a known length where none of them is a length."""

    unknown: sp.Expr
    unit: sp.Expr

    @property
    def value(self) -> sp.Expr:
        """The radius itself."""
        return self.unit * self.unknown

    def is_positive(self, problem: Problem) -> bool:
        """Whether the description says that the radius is positive."""
        return bool(self.unit.is_positive) and problem.is_positive(self.unknown)


def _unit(problem: Problem, equation: Equation, part: _Part) -> sp.Expr:
    """The known factor of the radius that is a length, in an equation of lengths: an arm that is only turned.

    Without this factor the radius would be a sine, and would be compared with lengths of the machine.
    """
    unknown, constant, _ = part
    if not equation.is_length or unknown.free_symbols & set(problem.lengths):
        return sp.Integer(1)
    return -constant if constant.could_extract_minus_sign() else constant


def _unknown_terms(problem: Problem, equation: Equation) -> list[set[sp.Symbol]]:
    """The unknowns of each term that has unknowns."""
    unknowns = set(problem.atoms())
    found = (t.free_symbols & unknowns for t in sp.Add.make_args(equation.expression))
    return [symbols for symbols in found if symbols]


def _is_in_all(function: sp.Symbol, terms: list[set[sp.Symbol]]) -> bool:
    """Whether all unknown terms have a function as a factor, so that the rest is known."""
    return bool(terms) and all(function in symbols for symbols in terms)


def _radius(problem: Problem, equation: Equation, function: sp.Symbol) -> _Part | None:
    """The parts (f, c, a) of the equation, where it has this form; else None."""
    linear = linear_coefficients(equation.expression, (function,))
    if linear is None or problem.unknowns_of(linear[1]):
        return None
    factor, rest = linear[0][0], linear[1]
    unknown = sp.Mul(*[f for f in sp.Mul.make_args(factor) if problem.unknowns_of(f)])
    unknown = -unknown if unknown.could_extract_minus_sign() else unknown  # a sum has its minus inside
    constant = cancelled(factor / unknown)
    if not problem.unknowns_of(unknown) or not problem.is_never_zero(constant):
        return None
    return unknown, constant, -rest


def _solve(
    problem: Problem,
    angle: sp.Symbol,
    polar_radius: _Radius,
    along: tuple[Equation, sp.Expr],
    across: tuple[Equation, sp.Expr],
) -> Binding:
    naming, radius = Naming(problem, along[0].lets + across[0].lets), polar_radius.value
    a = naming.named(along[1], f"{along[0].label}_of_{angle.name}")
    b = naming.named(across[1], f"{across[0].label}_of_{angle.name}")
    distance = naming.length(f"radius_{angle.name}", a, b, note=f"polar coordinates: the radius at angle {angle.name}")
    note = f"polar coordinates: angle {angle.name} from the {along[0].label} and {across[0].label} equations"
    sigma, determinant = sp.Integer(1), None
    if not polar_radius.is_positive(problem):
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
    column = _column((along, a), (across, b), sigma * distance)
    product = Equation(f"{angle.name} radius", radius - sigma * distance, is_length=along[0].is_length, column=column)
    return Binding("polar", (angle,), (*naming.lets, *known), determinant, conditioning, (product,))


def _conditioning(
    problem: Problem, angle: sp.Symbol, radius: sp.Expr, distance: sp.Expr, scale: sp.Expr
) -> Conditioning:
    """The conditioning of the angle. For a product such as r sin(phi) it is the sine alone, which has no unit: the step
    that finds r has its own conditioning.
    """
    functions = [f for f in sp.Mul.make_args(radius) if f not in problem.lengths and f.is_Symbol]
    if len(functions) == 0 or len(functions) == len(sp.Mul.make_args(radius)):
        return Conditioning(angle, distance, scale)
    return Conditioning(angle, sp.Mul(*functions), sp.Integer(1))


_Side = tuple[tuple[Equation, sp.Expr], sp.Expr]
"""An equation, the value that it gives for one side of the radius, and the name of this value."""


def _column(along: _Side, across: _Side, radius: sp.Expr) -> Column | None:
    """How much smaller than its largest the square of the radius is, by values as small as the angle that it tells:
    where a side is an entry of a rotation, the other entries of its column less the other side. None if neither is,
    or both are, in two columns.
    """
    for ((equation, side), _), ((other, _), beside) in ((along, across), (across, along)):
        column = equation.column
        size = sp.Integer(0) if column is None else sp.Abs(sp.cancel(side / column.entry))
        if column is None or not size.is_positive or column.entry in size.free_symbols:
            continue
        if other.column is None:
            return Column(radius, size**2 * column.others - beside**2, column.lets, size, is_bounded=False)
        others = sp.expand(size**2 * column.others - beside**2)
        if not others.free_symbols & beside.free_symbols:
            return Column(radius, others, column.lets, size)
    return None
