"""Direction:  cos u : sin u = along : across.

One root. If the conditioning (the length of the vector that turns) vanishes nothing determines u, and u takes the
value of the reference. Cosine and sine are divided by the length of (along, across) itself, so that sin^2 + cos^2 = 1
to rounding.
"""

from __future__ import annotations

import sympy as sp

from derive.equations.problem import Problem
from derive.ir.constants import FREE_ANGLE
from derive.ir.primitives import NearestOnArc, Root, Select
from derive.ir.program import Let, Statement
from derive.ir.symbols import cosine, real, sine

AT_THE_SINGULARITY = "at a singularity: the angle of the reference"


def direction(
    problem: Problem,
    angle: sp.Symbol,
    *,
    along: sp.Expr,
    across: sp.Expr,
    conditioning: sp.Expr,
    note: str,
    is_length: bool = False,
    scale: sp.Expr | None = None,
) -> tuple[Statement, ...]:
    """Bind cosine and sine of the angle; `conditioning` says whether they are determined.

    `is_length`: the conditioning is the length of (along, across) itself. `scale`: the length of the machine with
    which it is compared.
    """
    determined = sp.Gt(conditioning, FREE_ANGLE * (problem.scale if scale is None else scale))
    cos_free, sin_free = free_angle(problem, angle)
    names = [real(f"{word}_{angle.name}") for word in ("along", "across", "length")]
    cos_name, sin_name, length = names
    square = cos_name**2 + sin_name**2
    long_enough = determined if is_length else sp.And(determined, sp.Gt(square, 0))
    return (
        Let(cos_name, along, note),
        Let(sin_name, across),
        Let(length, Select(long_enough, conditioning if is_length else Root(square), sp.Integer(1))),
        Let(cosine(angle), Select(determined, cos_name / length, cos_free), AT_THE_SINGULARITY),
        Let(sine(angle), Select(determined, sin_name / length, sin_free)),
    )


def free_angle(problem: Problem, angle: sp.Symbol) -> tuple[sp.Expr, sp.Expr]:
    """Cosine and sine of the angle where nothing determines it."""
    reference = _reference(problem, angle)
    return sp.cos(reference), sp.sin(reference)


def _reference(problem: Problem, angle: sp.Symbol) -> sp.Expr:
    """The reference, moved onto the half circle that the machine has."""
    reference = problem.references[angle]
    if sine(angle) in problem.positive:
        return NearestOnArc(reference, sp.pi / 2, sp.pi / 2)
    if cosine(angle) in problem.positive:
        return NearestOnArc(reference, sp.Integer(0), sp.pi / 2)
    return reference
