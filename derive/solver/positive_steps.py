"""Two-root steps of which only one root belongs to the machine: the determinant is a multiple of a positive quantity.

A description says `positive=(sin(A2),)` for an elbow that cannot bend the other way. The law of cosines still has two
roots, but the sign of the machine's root is known, and no branch needs a name. If the determinant vanishes both
roots meet: this is still a singularity.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import sympy as sp

from derive.equations.problem import Conditioning, Problem, StepDeterminant
from derive.ir.constants import DEGREE
from derive.ir.program import Statement, rewritten


def known_signs(problem: Problem, determinants: Sequence[StepDeterminant]) -> Mapping[StepDeterminant, int]:
    """The steps whose determinant has one sign in this machine, with the sign."""
    if not problem.positive:
        return {}
    found = ((step, _sign(problem, step.value)) for step in determinants)
    return {step: sign for step, sign in found if sign}


def _sign(problem: Problem, value: sp.Expr) -> int:
    """The sign of a value that is a positive quantity times positive parameters or their negative; else 0."""
    reduced = problem.reduce(value)
    for quantity in problem.positive:
        ratio = sp.cancel(reduced / quantity).xreplace({DEGREE: sp.pi / 180})
        if ratio.is_positive or ratio.is_negative:
            return 1 if ratio.is_positive else -1
    return 0


def with_known_signs(statements: Sequence[Statement], signs: Mapping[StepDeterminant, int]) -> tuple[Statement, ...]:
    """The statements with numbers in place of the known signs."""
    table = {step.sigma: sp.Integer(sign) for step, sign in signs.items()}
    return tuple(rewritten(s, lambda e: e.xreplace(table)) for s in statements)


def where_roots_meet(signs: Mapping[StepDeterminant, int]) -> tuple[Conditioning, ...]:
    """The singularities of the steps with a known sign."""
    return tuple(Conditioning(step.step, step.value, step.scale, "meet") for step in signs)
