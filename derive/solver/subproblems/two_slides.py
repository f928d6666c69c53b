"""Two slides in space:  k1 v1 + k2 v2 + c = 0, three equations for two unknown lengths, of a trial.

n = k1 x k2 is across both slides. Along n the equations say c n = 0, whatever the lengths: the residual. Across n they
have one root, v1 = -c (k2 x n) / n², v2 = -c (n x k1) / n². Where the slides are parallel, n = 0, the lengths are not
determined: the trial takes some, and the pose that they make does not agree with the commanded one.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import sympy as sp

from derive.algebra.normal_form import linear_coefficients
from derive.equations.problem import Binding, Equation, Problem
from derive.ir.constants import FREE_ANGLE
from derive.ir.primitives import Select
from derive.ir.program import Let
from derive.ir.symbols import real
from derive.solver.subproblems.naming import Naming


def rotation_gives_turns(problem: Problem) -> bool:
    """Whether a trial has three unknown turns, and two slides that the positions read with them."""
    present = {u for e in problem.equations for u in problem.unknowns_of(e.expression)}
    is_whole = bool(problem.turns) and len(problem.columns) == 3 and not problem.followed
    counted = leaves_two_slides(len(problem.angles), len(problem.lengths)) and len(problem.equations) == 3
    return problem.is_overdetermined and is_whole and counted and len(present) > len(problem.equations)


def leaves_two_slides(angles: int, lengths: int) -> bool:
    """Whether so many unknown turns may follow from a rotation, and so many unknown slides from a position then."""
    return (angles, lengths) == (3, 2)


def of_turns(problem: Problem) -> Problem:
    """The problem of its rotation alone."""
    return replace(problem, equations=(), lengths=(), links=(), back=None, is_overdetermined=False)


def two_slides(problem: Problem, equations: tuple[Equation, ...]) -> Iterator[Binding]:
    """The two lengths of three equations, and their residual; none where the slides are parallel at every pose."""
    unknowns = problem.unknowns_of(sp.Tuple(*(e.expression for e in equations)))
    rows = [row for e in equations if (row := linear_coefficients(e.expression, unknowns)) is not None]
    if not (len(rows) == 3 and len(unknowns) == 2 and set(unknowns) <= set(problem.lengths)):
        return
    naming = Naming(problem, tuple(let for e in equations for let in e.lets))

    def named(values: sp.Matrix, word: str) -> sp.Matrix:
        return sp.Matrix([naming.named(v, f"{e.label}_{word}") for v, e in zip(values, equations, strict=True)])

    first, second = (named([row[0][k] for row in rows], f"along_{u.name}") for k, u in enumerate(unknowns))
    rest, normal = named([row[1] for row in rows], "beside_slides"), first.cross(second)
    if all(problem.reduce(value) == 0 for value in normal):
        return
    across = named(normal, "across_slides")
    size, divisor = naming.product(across.dot(across), "square_across_slides"), real("divisor_of_slides")
    values = (-rest.dot(side) / divisor for side in (second.cross(across), across.cross(first)))
    lets = (
        *naming.lets,
        Let(divisor, Select(sp.Gt(size, FREE_ANGLE**2), size, sp.Integer(1))),
        *(
            Let(u, value, f"{u.name}, where the slides are not parallel")
            for u, value in zip(unknowns, values, strict=True)
        ),
    )
    yield Binding("two slides", unknowns, lets, residual=rest.dot(across) / problem.scale)
