"""Spheres, or trilateration:  |P - C_i| = r_i  for two circles in the plane, or three spheres in space.

Two roots, mirror images in the line or plane of the centres. Let n be normal to it, and p0 the foot of the
perpendicular from P, seen from C_1: P = C_1 + p0 + sigma root(r_1^2 - |p0|^2) n / |n|. The only division is by |n|^2,
which vanishes where the centres coincide or lie on a line: nothing determines P then, and the pose is refused.
Determinant: that of the rod vectors P - C_i; its sign is sigma. Guard: the spheres intersect. If they touch, both
roots meet (degenerate case).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import sympy as sp

from derive.algebra.normal_form import cancelled, factored, is_compound
from derive.equations.problem import Binding, Equation, Problem, StepDeterminant, sign_of
from derive.ir.constants import BOUNDARY, FREE_ANGLE
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Require, Statement, Status
from derive.ir.reason import Why, about_machine
from derive.ir.symbols import real

_ASSEMBLY = real("assembly")
"""The name of the step, which finds all unknowns together."""


@dataclass(frozen=True)
class Sphere:
    """A centre and the square of a radius."""

    centre: sp.Matrix
    radius_square: sp.Expr


def spheres(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """All unknown lengths together, where as many equations are spheres about known centres."""
    unknowns = problem.lengths
    if len(unknowns) not in (2, 3) or problem.angles or problem.pending:
        return
    found = [(e, s) for e in equations for s in [_sphere(problem, e)] if s is not None]
    for chosen in combinations(found, len(unknowns)):
        yield _solve(problem, tuple(e for e, _ in chosen), tuple(s for _, s in chosen))


def _sphere(problem: Problem, equation: Equation) -> Sphere | None:
    unknowns = problem.lengths
    try:
        poly = sp.Poly(equation.expression, *unknowns)
    except sp.PolynomialError:
        return None
    scale = poly.coeff_monomial(unknowns[0] ** 2)
    squares = {u**2: scale for u in unknowns}
    quadratic = {m for m in poly.monoms() if sum(m) == 2}
    if scale == 0 or not problem.is_never_zero(scale) or len(quadratic) != len(squares):
        return None
    if any(cancelled(poly.coeff_monomial(u**2) - scale) != 0 for u in unknowns) or poly.total_degree() != 2:
        return None
    centre = sp.Matrix([cancelled(-poly.coeff_monomial(u) / (2 * scale)) for u in unknowns])
    constant = poly.coeff_monomial(1) / scale
    return Sphere(centre, factored(problem.tidy(centre.dot(centre) - constant)))


def _solve(problem: Problem, used: tuple[Equation, ...], found: tuple[Sphere, ...]) -> Binding:
    unknowns = problem.lengths
    statements: list[Statement] = [let for e in used for let in e.lets]
    centres = [_named(statements, s.centre, f"centre_{k}", unknowns) for k, s in enumerate(found, 1)]
    apart = [
        _named(statements, c - centres[0], f"centre_1_to_{k}", unknowns, f"vector from centre 1 to centre {k}")
        for k, c in enumerate(centres[1:], 2)
    ]
    sigma = sign_of(_ASSEMBLY)
    parts = _circles(statements, found, apart[0]) if len(unknowns) == 2 else _three(statements, found, apart)
    foot, normal, normal_square, height_square = parts
    foot = _named(statements, foot, "foot", unknowns, "foot of the perpendicular, seen from centre 1")
    height, multiple = real("height_square"), real("height_by_normal")
    base = "line" if len(unknowns) == 2 else "plane"
    length_scale = _length(found[0].radius_square)
    if height_square is None:
        height_square = found[0].radius_square - foot.dot(foot)
    statements += [
        Let(height, height_square, f"square of the height over the {base} of the centres"),
        Require(sp.Ge(height, -BOUNDARY * length_scale**2), Status.IMPOSSIBLE, reason=about_machine(Why.RODS_APART)),
        Let(multiple, sigma * Root(height / normal_square), "height, as a multiple of the normal"),
    ]
    for u, c, f, n in zip(unknowns, centres[0], foot, normal, strict=True):
        statements.append(Let(u, c + f + multiple * n))
    rods = sp.Matrix.hstack(
        *(_named(statements, sp.Matrix(unknowns) - c, f"rod_{k}", unknowns) for k, c in enumerate(centres, 1))
    )
    scale = sp.Mul(*[_divisor(problem, _length(s.radius_square)) for s in found])
    determinant = StepDeterminant(_ASSEMBLY, rods.det(), scale)
    return Binding("spheres", unknowns, tuple(statements), determinant)


Parts = tuple[sp.Matrix, sp.Matrix, sp.Expr, sp.Expr | None]
"""Foot, normal, the square of the normal's length, and the square of the height where a better formula than that by
the foot exists."""


def _circles(statements: list[Statement], found: tuple[Sphere, ...], apart: sp.Matrix) -> Parts:
    """Two circles: the normal is `apart` turned left by 90 degrees. The height follows from Heron's formula, in
    factors.
    """
    square = _normal_square(statements, apart.dot(apart), found)
    between, along = real("between_centres"), real("foot_fraction")
    first, second = (_named_length(statements, _length(f.radius_square), f"radius_{k}") for k, f in enumerate(found, 1))
    statements += [
        Let(between, Root(square), "distance between the centres"),
        Let(
            along,
            ((first - second) * (first + second) + square) / (2 * square),
            "foot of the perpendicular, as a fraction of this distance",
        ),
    ]
    normal = sp.Matrix([-apart[1], apart[0]])
    sides = (first + second - between, between + first - second, between + second - first, between + first + second)
    return along * apart, normal, square, sp.Mul(*sides) / (4 * square)


def _three(statements: list[Statement], found: tuple[Sphere, ...], apart: list[sp.Matrix]) -> Parts:
    """Foot and normal for three spheres."""
    u, v = apart
    normal = _named(
        statements, u.cross(v), "normal", (real("x"), real("y"), real("z")), "normal to the plane of the centres"
    )
    square = _normal_square(statements, normal.dot(normal), found)
    products = []
    for k, w in ((2, u), (3, v)):
        product = real(f"projection_{k}")
        value = (found[0].radius_square - found[k - 1].radius_square + w.dot(w)) / 2
        statements.append(
            Let(product, value, f"trilateration: the foot projected on the vector to centre {k}, times its length")
        )
        products.append(product)
    foot = (products[0] * v.cross(normal) + products[1] * normal.cross(u)) / square
    return foot, normal, square, None


def _normal_square(statements: list[Statement], value: sp.Expr, found: tuple[Sphere, ...]) -> sp.Symbol:
    square, divisor = real("normal_square"), real("normal_divisor")
    scale = _length(found[0].radius_square) ** (2 if len(found) == 2 else 4)
    determined = sp.Gt(square, FREE_ANGLE**2 * scale)
    statements += [
        Let(square, value, "squared length of the normal"),
        Require(determined, Status.IMPOSSIBLE, reason=about_machine(Why.CENTRES_ON_A_LINE)),
        Let(divisor, Select(determined, square, sp.Integer(1))),
    ]
    return divisor


def _named(
    statements: list[Statement], vector: sp.Matrix, name: str, unknowns: tuple[sp.Symbol, ...], note: str = ""
) -> sp.Matrix:
    """The vector with names for its components, bound here where a component is more than a name; the note stands at
    the first binding.
    """
    entries = []
    for value, unknown in zip(vector, unknowns, strict=True):
        if is_compound(value):
            symbol = real(f"{name}_{unknown.name}")
            statements.append(Let(symbol, value, note))
            note = ""
            value = symbol
        entries.append(value)
    return sp.Matrix(entries)


def _named_length(statements: list[Statement], value: sp.Expr, name: str) -> sp.Expr:
    """The value itself where it is a name, else a name that is bound here."""
    if not is_compound(value):
        return value
    statements.append(Let(real(name), value))
    return real(name)


def _length(square: sp.Expr) -> sp.Expr:
    return sp.sqrt(factored(square))


def _divisor(problem: Problem, length: sp.Expr) -> sp.Expr:
    """The length of a rod, by which the determinant is divided; 1 where a strut of variable length has none."""
    return length if problem.is_never_zero(length) else Select(sp.Gt(length, 0), length, 1)
