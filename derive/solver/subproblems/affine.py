"""Affine:  k v + c = 0  with k never zero.

One root, v = -c / k. Determinant k. There is no degenerate case: an equation whose k can vanish is not taken. Where k
is made of parameters alone, a machine for which it vanishes is refused.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from derive.algebra.normal_form import linear_coefficients
from derive.equations.problem import Binding, Equation, Problem
from derive.ir.program import Let


def affine(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """Every length that one equation determines by itself."""
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
