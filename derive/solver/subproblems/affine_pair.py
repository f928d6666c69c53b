"""Affine pair:  k1 v + m1 w = e1,  k2 v + m2 w = e2  with k1 m2 - k2 m1 never zero.

One root, by Cramer's rule. Determinant k1 m2 - k2 m1. There is no degenerate case: equations whose determinant can
vanish are not taken. A single coefficient may vanish: a table turned by 90 degrees exchanges its axes.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from derive.algebra.normal_form import linear_coefficients
from derive.equations.problem import Binding, Equation, Problem
from derive.ir.program import Let


def affine_pair(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """Every two lengths that two equations determine together."""
    for first, second in combinations(equations, 2):
        unknowns = problem.unknowns_of(first.expression)
        if (
            len(unknowns) != 2
            or problem.unknowns_of(second.expression) != unknowns
            or not set(unknowns) <= set(problem.lengths)
        ):
            continue
        row1, row2 = (linear_coefficients(e.expression, unknowns) for e in (first, second))
        if row1 is None or row2 is None:
            continue
        ((k1, m1), rest1), ((k2, m2), rest2) = row1, row2
        determinant = problem.reduce(k1 * m2 - k2 * m1)
        if not problem.is_never_zero(determinant):
            continue
        names = " and ".join(unknown.name for unknown in unknowns)
        note = f"{names} from the {first.label} and {second.label} equations, linear in both"
        inverse = determinant if determinant in problem.signs or -determinant in problem.signs else 1 / determinant
        values = [problem.tidy(v * inverse) for v in (m1 * rest2 - m2 * rest1, k2 * rest1 - k1 * rest2)]
        lets = (Let(unknowns[0], values[0], note), Let(unknowns[1], values[1]))
        yield Binding("affine pair", unknowns, (*first.lets, *second.lets, *lets))
