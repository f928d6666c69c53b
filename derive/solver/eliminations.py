"""Eliminations, in tiers: each tier is tried only where no equation of the previous one fits a subproblem.

* difference: an unknown length that is linear in two equations is eliminated between them, where the two coefficients
  never vanish together: there the difference would be 0 = 0, a singularity that the machine does not have. The others
  (`lossy_differences`) are tried last;
* elimination: an unknown length that is linear in one equation, with a number as its coefficient, is put into the
  others;
* free of lengths: where equations outnumber their unknown lengths, the weighted sum in which all of these cancel;
* squares: the sum of the squares of two equations, known parts on the right side, is free of the angle that
  turns both (this is the law of cosines). Then sums that hold an unknown length are tried, as for a boom beside the
  axis that turns it. As a last resort three equations are squared: their sum is free of an angle that turns all three.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations

import sympy as sp

from derive.algebra.normal_form import linear_coefficients, reduce_units, split_known
from derive.equations.problem import Equation, Problem
from derive.solver.probe import unknowns_of_squares
from derive.solver.subproblems.naming import Naming

_MOST_UNKNOWN = 3
"""No subproblem takes an equation with more unknowns than this: three lengths are the coordinates of a point."""


def differences(problem: Problem) -> tuple[Equation, ...]:
    """Equations from which one unknown length has been eliminated, as good as the two for all poses."""
    return tuple(e for e, is_lossless in _differences(problem) if is_lossless)


def lossy_differences(problem: Problem) -> tuple[Equation, ...]:
    """Equations from which one unknown length has been eliminated; they say nothing if both coefficients
    vanish.
    """
    return tuple(e for e, is_lossless in _differences(problem) if not is_lossless)


def _differences(problem: Problem) -> Iterator[tuple[Equation, bool]]:
    for first, second in combinations(problem.equations, 2):
        for unknown in problem.lengths:
            rows = [linear_coefficients(e.expression, (unknown,)) for e in (first, second)]
            if rows[0] is None or rows[1] is None:
                continue
            a, b = rows[0][0][0], rows[1][0][0]
            if a == 0 or b == 0 or problem.unknowns_of(a) or problem.unknowns_of(b):
                continue
            expression = reduce_units(b * first.expression - a * second.expression, problem.units, problem.signs)
            label = f"{first.label} and {second.label}"
            is_lossless = problem.determines(problem.reduce(a**2 + b**2))
            lost = () if is_lossless else tuple(e.expression.xreplace({unknown: 0}) for e in (first, second))
            yield Equation(label, expression, first.lets + second.lets, apart=lost), is_lossless


def eliminations(problem: Problem) -> tuple[Equation, ...]:
    """Equations into which an unknown length has been put from another equation."""
    found: list[Equation] = []
    for source in problem.equations:
        for unknown in problem.lengths:
            linear = linear_coefficients(source.expression, (unknown,))
            if linear is None or linear[0][0] == 0 or linear[0][0].free_symbols:
                continue
            value = -linear[1] / linear[0][0]
            for target in problem.equations:
                if target is source or unknown not in target.expression.free_symbols:
                    continue
                expression = reduce_units(target.expression.xreplace({unknown: value}), problem.units, problem.signs)
                label = f"{target.label} (through {source.label})"
                found.append(replace(target, label=label, expression=expression, lets=source.lets + target.lets))
    return tuple(found)


def free_of_lengths(problem: Problem) -> tuple[Equation, ...]:
    """Where equations outnumber their unknown lengths, the weighted sum without these: the coefficients of the lengths
    are known, and the weights of the equations are the minors of the matrix of these coefficients.
    """
    found: list[Equation] = []
    for count in (3, 4):
        for some in combinations(problem.equations, count):
            equation = _free_of_lengths(problem, some)
            found += [] if equation is None else [equation]
    return tuple(found)


def _free_of_lengths(problem: Problem, equations: Sequence[Equation]) -> Equation | None:
    present = {s for e in equations for s in e.expression.free_symbols}
    lengths = tuple(u for u in problem.lengths if u in present)
    read = [linear_coefficients(e.expression, lengths) for e in equations]
    if len(lengths) != len(equations) - 1 or any(r is None for r in read):
        return None
    rows = [r[0] for r in read if r is not None]
    if any(problem.unknowns_of(c) for row in rows for c in row):
        return None
    others = ([row for i, row in enumerate(rows) if i != k] for k in range(len(rows)))
    minors = [problem.tidy((-1) ** k * sp.Matrix(left).det()) for k, left in enumerate(others)]
    if not problem.determines(problem.reduce(sp.Add(*[m**2 for m in minors]))):
        return None
    total = sp.Add(*[m * e.expression for m, e in zip(minors, equations, strict=True)])
    label = " and ".join(e.label for e in equations)
    factors = sp.Mul.make_args(sp.factor_terms(reduce_units(total, problem.units, problem.signs)))
    short = sp.expand(sp.Mul(*[f for f in factors if not f.is_positive]))  # a constant factor says nothing of a pose
    return Equation(label, short, tuple(let for e in equations for let in e.lets), is_length=False)


def squares(problem: Problem, count: int = 2) -> tuple[Equation, ...]:
    """Sums of squares of `count` equations; the known side is named as the length `reach`."""
    return _sums_of_squares(problem, [e for e in problem.equations if not _has_length(problem, e)], count)


def squares_with_lengths(problem: Problem) -> tuple[Equation, ...]:
    """Sums of squares of two equations that hold an unknown length, as for a boom beside the axis that turns it."""
    return _sums_of_squares(problem, [e for e in problem.equations if _has_length(problem, e)], 2)


def _has_length(problem: Problem, equation: Equation) -> bool:
    return bool(equation.expression.free_symbols & {*problem.lengths})


def _sums_of_squares(problem: Problem, equations: Sequence[Equation], count: int) -> tuple[Equation, ...]:
    found = [_sum_of_squares(problem, some) for some in combinations(equations, count)]
    return tuple(equation for equation in found if equation is not None)


def squares_of_three(problem: Problem) -> tuple[Equation, ...]:
    """Sums of squares of three equations."""
    return squares(problem, 3)


def _sum_of_squares(problem: Problem, equations: tuple[Equation, ...]) -> Equation | None:
    sides = [split_known(e.expression, problem.atoms()) for e in equations]
    if any(moving == 0 or known == 0 or bool(moving.free_symbols & {*problem.angles}) for moving, known in sides):
        return None
    unknowns = {unknown for e in equations for unknown in problem.unknowns_of(e.expression)}
    left = unknowns_of_squares(problem, [m for m, _ in sides])
    if len(left) not in range(1, min(len(unknowns), _MOST_UNKNOWN + 1)):
        return None
    moving = reduce_units(sum(m**2 for m, _ in sides), problem.units, problem.signs)
    naming = Naming(problem, tuple(let for e in equations for let in e.lets))
    spanned = [
        naming.named(-known, f"wrist_{e.label}", "coordinate of the point that the remaining links must reach")
        for e, (_, known) in zip(equations, sides, strict=True)
    ]
    reach = naming.length("reach", *spanned, note="distance that the remaining links must span")
    return Equation(" + ".join(f"{e.label}²" for e in equations), moving - reach**2, naming.lets, is_squared=True)
