"""Affine system:  M v = e  for two or three unknown lengths v in as many equations, with det M never zero.

One root, by Cramer's rule. Determinant det M. There is no degenerate case: equations whose determinant can vanish are
not taken. A single coefficient may vanish: a table turned by 90 degrees exchanges its axes. Where det M is made of
parameters alone, a machine for which it vanishes is refused: two of its slides are parallel.

Along a direction:  k₁ v + c₁ = 0 and k₂ v + c₂ = 0 with k₁² + k₂² never zero, for one unknown length v: a slide along
a direction that is known. One root, v = -(k₁ c₁ + k₂ c₂) / (k₁² + k₂²); earlier steps have made sure that the equations
agree.

Across:  one or two equations whose determinant can vanish, and is made of the directions of slides alone: a ram that a
head may lay flat. There a slide is at right angles to the coordinate that it has to change, or two slides are parallel,
and one of them is free (degenerate case):
the values nearest to the reference that satisfy the equations, v = r + M' (e - M r) / |M|^2, where the equations agree.
The determinant is the conditioning. Taken only where nothing else is left.

Along a direction that can vanish:  the same as along a direction, with k₁² + k₂² that may be zero. There, and where v
would be larger than an input may be, v is free, and keeps its reference (degenerate case). The length of the direction
is the conditioning. The steps before may have come from a difference of the equations that says nothing there: all of
them are tested with the value.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import sympy as sp

from derive.algebra.normal_form import linear_coefficients
from derive.equations.problem import Binding, Conditioning, Equation, Problem
from derive.ir.constants import FREE_ANGLE, LARGEST, MET
from derive.ir.primitives import Select
from derive.ir.program import Let, Require, Statement, Status
from derive.ir.reason import Why, about_joint
from derive.ir.symbols import ROTATION_ENTRIES, cosine, real, sine
from derive.solver.subproblems.naming import Naming

_NAMES = {2: "pair", 3: "triple"}
_WORDS = {2: "linear in both", 3: "linear in all three"}


def affine_pair(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """Every two lengths that two equations determine together."""
    return _systems(problem, equations, 2)


def affine_triple(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """Every three lengths that three equations determine together."""
    return _systems(problem, equations, 3)


def affine_along(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """Every length that two or three equations determine together but none of them alone: along a known direction."""
    for count in _NAMES:
        for some in combinations(equations, count):
            unknowns = problem.unknowns_of(sp.Tuple(*(e.expression for e in some)))
            if len(unknowns) != 1 or unknowns[0] not in problem.lengths:
                continue
            rows = [row for e in some if (row := linear_coefficients(e.expression, unknowns)) is not None]
            direction = [row[0][0] for row in rows]
            if len(rows) != count or any(k == 0 or problem.determines(k) for k in direction):
                continue
            size = problem.reduce(sum(k**2 for k in direction))
            if problem.determines(size):
                value = problem.tidy(-sum(k * row[1] for k, row in zip(direction, rows, strict=True)) / size)
                note = f"{unknowns[0].name} from the {_listed([e.label for e in some])} equations, along its direction"
                statements = (*(let for e in some for let in e.lets), Let(unknowns[0], value, note))
                yield Binding("affine along", unknowns, statements, conditions=problem.conditions(size))


def _systems(problem: Problem, equations: tuple[Equation, ...], count: int) -> Iterator[Binding]:
    for some in combinations(equations, count):
        present = [problem.unknowns_of(e.expression) for e in some]
        unknowns = tuple(u for u in problem.lengths if any(u in found for found in present))
        alone = any(len(found) < 2 for found in present)  # such an equation determines its length by itself
        if len(unknowns) == count and not alone and all(set(found) <= set(unknowns) for found in present):
            binding = _solve(problem, some, unknowns)
            if binding is not None:
                yield binding


def affine_across(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """The lengths of a system whose determinant can vanish, and is made of directions alone."""
    for count in (1, 2):
        for some in combinations(equations, count):
            unknowns = problem.unknowns_of(sp.Tuple(*(e.expression for e in some)))
            rows = [row for e in some if (row := linear_coefficients(e.expression, unknowns)) is not None]
            if len(unknowns) == len(rows) == count and set(unknowns) <= {*problem.lengths}:
                matrix, rest = sp.Matrix([row[0] for row in rows]), sp.Matrix([row[1] for row in rows])
                value = problem.reduce(matrix.det(method="berkowitz"))
                if value != 0 and _is_direction(problem, value):
                    statements = _or_free(problem, some, unknowns, matrix, rest)
                    conditioning = Conditioning(unknowns[-1], value, sp.Integer(1))
                    yield Binding("affine across", unknowns, statements, conditioning=conditioning)


def _is_direction(problem: Problem, value: sp.Expr) -> bool:
    """Whether a value is made of directions alone, so that it has no unit and needs no scale."""
    directions = {f(a) for a in problem.units for f in (cosine, sine)} | {*ROTATION_ENTRIES}
    return set(problem.reduce(value).free_symbols) <= directions


def affine_along_or_free(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """Every length that several equations hold alone, along a direction that can vanish."""
    for unknown in problem.lengths:
        alone = [e for e in equations if problem.unknowns_of(e.expression) == (unknown,)]
        some = [(e, row) for e in alone if (row := linear_coefficients(e.expression, (unknown,))) is not None]
        if len(some) < 2 or len(some) < len(alone) or not all(_is_direction(problem, row[0][0]) for _, row in some):
            continue
        naming = Naming(problem, tuple(let for e in alone for let in e.lets))
        along = [naming.named(row[0][0], f"{e.label}_along_{unknown.name}") for e, row in some]
        right = [naming.named(-row[1], f"{e.label}_of_{unknown.name}") for e, row in some]
        size = naming.length(f"direction_of_{unknown.name}", *along)
        total, divisor = sp.Add(*(k * e for k, e in zip(along, right, strict=True))), real(f"divisor_{unknown.name}")
        points = sp.And(sp.Gt(size, FREE_ANGLE), sp.Le(sp.Abs(total), LARGEST * size**2))
        agree = (sp.Abs(k * unknown - e) <= MET * problem.scale for k, e in zip(along, right, strict=True))
        note = f"{unknown.name} from the {_listed([e.label for e in alone])} equations, along its direction"
        statements: tuple[Statement, ...] = (
            *naming.lets,
            Let(divisor, Select(points, size, sp.Integer(1))),
            Let(unknown, Select(points, total / divisor**2, problem.references[unknown]), note),
            Require(sp.And(*agree), Status.UNREACHABLE, reason=about_joint(unknown, Why.SLIDE_ACROSS)),
        )
        conditioning = Conditioning(unknown, size, sp.Integer(1))
        yield Binding("affine along or free", (unknown,), statements, conditioning=conditioning)


def _or_free(
    problem: Problem,
    equations: tuple[Equation, ...],
    unknowns: tuple[sp.Symbol, ...],
    matrix: sp.Matrix,
    rest: sp.Matrix,
) -> tuple[Statement, ...]:
    """Cramer's rule, and the values nearest to the reference where the determinant vanishes."""
    last = unknowns[-1]
    naming = Naming(problem, tuple(let for e in equations for let in e.lets))
    right = [naming.named(-c, f"{e.label}_of_{last.name}") for c, e in zip(rest, equations, strict=True)]
    across, divisor = real(f"direction_of_{last.name}"), real(f"divisor_{last.name}")
    points = sp.Gt(sp.Abs(across), FREE_ANGLE)
    references = sp.Matrix([problem.references[u] for u in unknowns])
    apart = sp.Matrix(right) - matrix * references
    size = matrix.norm() ** 2 if matrix.rows == 2 else sp.Integer(1)
    nearest = references + (matrix.T * apart / size if matrix.rows == 2 else sp.zeros(1, 1))
    solved = _adjugate(problem, matrix) * sp.Matrix(right) / divisor
    note = f"{_listed([str(u) for u in unknowns])} from the {_listed([e.label for e in equations])} equations"
    lets = [Let(u, Select(points, s, n)) for u, s, n in zip(unknowns, solved, nearest, strict=True)]
    left = matrix * sp.Matrix(unknowns) - sp.Matrix(right)
    agree = sp.And(*(sp.Le(sp.Abs(value), FREE_ANGLE * problem.scale) for value in left))
    sizes = (sp.Le(sp.Abs(u), LARGEST) for u in unknowns)
    return (
        *naming.lets,
        Let(across, problem.tidy(matrix.det(method="berkowitz")), f"{note}: how far from across"),
        Let(divisor, Select(points, across, sp.Integer(1))),
        *lets,
        Require(sp.And(sp.Or(points, agree), *sizes), Status.UNREACHABLE, reason=about_joint(last, Why.SLIDE_ACROSS)),
    )


def _solve(problem: Problem, equations: tuple[Equation, ...], unknowns: tuple[sp.Symbol, ...]) -> Binding | None:
    rows = [linear_coefficients(e.expression, unknowns) for e in equations]
    if any(row is None for row in rows):
        return None
    matrix = sp.Matrix([row[0] for row in rows if row is not None])
    rest = sp.Matrix([row[1] for row in rows if row is not None])
    determinant = problem.reduce(matrix.det(method="berkowitz"))
    if not problem.determines(determinant):
        return None
    inverse = determinant if determinant in problem.signs or -determinant in problem.signs else 1 / determinant
    values = [problem.tidy(v * inverse) for v in -_adjugate(problem, matrix) * rest]
    labels, names = ([str(v) for v in group] for group in ((e.label for e in equations), unknowns))
    note = f"{_listed(names)} from the {_listed(labels)} equations, {_WORDS[len(unknowns)]}"
    lets = (Let(unknowns[0], values[0], note), *map(Let, unknowns[1:], values[1:]))
    statements = (*(let for e in equations for let in e.lets), *lets)
    return Binding(f"affine {_NAMES[len(unknowns)]}", unknowns, statements, conditions=problem.conditions(determinant))


def _adjugate(problem: Problem, matrix: sp.Matrix) -> sp.Matrix:
    """det M times the inverse of M: the cofactors of three rows in normal form; for a rotation, its own entries."""
    adjugate = matrix.adjugate()
    return adjugate if matrix.rows == 2 else adjugate.applyfunc(problem.reduce)


def _listed(names: list[str]) -> str:
    if len(names) == 1:
        return names[0]
    return f"{', '.join(names[:-1])} and {names[-1]}"


def affine(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """Every length that one equation k v + c = 0 determines by itself. If k can vanish the equation is not taken; if k
    is made of parameters alone, a machine for which it vanishes is refused.
    """
    for equation in equations:
        unknowns = problem.unknowns_of(equation.expression)
        if len(unknowns) != 1 or unknowns[0] not in problem.lengths:
            continue
        linear = linear_coefficients(equation.expression, unknowns)
        if linear is None or not problem.determines(linear[0][0]):
            continue
        (coefficient,), rest = linear
        note = f"{unknowns[0].name} from the {equation.label} equation, which is linear in it"
        statements = (*equation.lets, Let(unknowns[0], sp.expand(-rest / coefficient), note))
        yield Binding("affine", unknowns, statements, conditions=problem.conditions(coefficient))
