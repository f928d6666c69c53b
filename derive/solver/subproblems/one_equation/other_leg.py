"""The other leg of a swing, from the two equations of the other coordinates.

A step that solves a cos u + b sin u = e for u takes the other leg, a sin u - b cos u, from h^2 - e^2, where h is the
length of (a, b). If a chain is nearly stretched along the coordinate of this equation, both are as long as the
chain, and their difference has lost the digits of the leg. The squares of the other two coordinates add up to
H^2 = leg^2 + d^2, in which H is commanded and d known: so leg^2 = (H - d)(H + d), with all digits of H. Where H is
longer than h, leg^2 = (h - e)(h + e) keeps more digits, and is taken.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import sympy as sp

from derive.algebra.normal_form import factored, reduce_units, split_known
from derive.algebra.rings import may_be_square
from derive.equations.problem import Equation, Problem
from derive.ir.constants import ROUNDING
from derive.ir.primitives import Select
from derive.ir.program import Let
from derive.ir.symbols import cosine, real, sine
from derive.solver.probe import unknowns_of_squares
from derive.solver.subproblems.naming import Naming

Leg = tuple[sp.Expr, sp.Expr, tuple[Let, ...]]
"""H and d, and the statements that bind what they read."""


def other_leg(
    problem: Problem, equation: Equation, angle: sp.Symbol, leg: sp.Expr, known: tuple[Let, ...]
) -> Leg | None:
    """H and d of this leg; None if no two other equations give them. known: the bindings of the step so far."""
    others = [e for e in problem.equations if e.is_length and e.label != equation.label]
    found = (_of_pair(problem, pair, angle, leg, known) for pair in combinations(others, 2))
    return next(filter(None, found), None)


def with_leg(
    angle: sp.Symbol, legs: tuple[sp.Expr, sp.Expr], leg: Leg
) -> tuple[tuple[sp.Expr, sp.Expr], tuple[Let, ...], tuple[Let, ...]]:
    """The factors h - e and h + e, the smaller one as the square of the other leg over the larger one where H is
    shorter than h; the statement that binds the larger one; the statements that the leg reads. legs: h and e.
    """
    (length, right), (distance, beside, lets) = legs, leg
    is_ahead = sp.Gt(right, 0)
    larger = Let(real(f"larger_factor_{angle.name}"), length + Select(is_ahead, right, -right))
    by_leg = (distance - beside) * (distance + beside) / larger.name
    smaller = Select(sp.Lt(distance, length), by_leg, length - Select(is_ahead, right, -right))
    return (Select(is_ahead, smaller, larger.name), Select(is_ahead, larger.name, smaller)), (larger,), lets


def held_by_leg(leg: Leg, length: sp.Expr, scale: sp.Expr) -> sp.Basic:
    """The condition that d is no longer than H, but for rounding, where H is shorter than h. length: h."""
    distance, beside, _ = leg
    return sp.Or(sp.Ge(distance, length), sp.Le(sp.Abs(beside), distance + ROUNDING * scale))


def _of_pair(
    problem: Problem, pair: Sequence[Equation], angle: sp.Symbol, leg: sp.Expr, before: tuple[Let, ...]
) -> Leg | None:
    sides = [split_known(e.expression, problem.atoms()) for e in pair]
    plain = {*problem.angles, *problem.lengths}
    if any(moving == 0 or known == 0 or moving.free_symbols & plain for moving, known in sides):
        return None
    if unknowns_of_squares(problem, [moving for moving, _ in sides]) not in ((), (angle,)):
        return None
    whole = sum((moving**2 for moving, _ in sides), start=sp.Integer(0)) - leg**2
    beside = _root_of(problem, reduce_units(whole, problem.units, problem.signs))
    if beside is None:
        return None
    naming = Naming(problem, tuple(dict.fromkeys((*before, *(let for e in pair for let in e.lets)))))
    words = [f"wrist_{e.label}" for e in pair]
    knowns = [naming.named(-known, word) for word, (_, known) in zip(words, sides, strict=True)]
    note = f"distance at which the arm that {angle.name} turns has to end"
    distance = naming.length(f"span_{angle.name}", *knowns, note=note)
    return distance, naming.named(beside, f"beside_{angle.name}", "its part that the angle does not turn"), naming.lets


def _root_of(problem: Problem, square: sp.Expr) -> sp.Expr | None:
    """The root of the square of a product of known values; None if the expression is no such square."""
    if problem.unknowns_of(square) or not may_be_square(square, problem.units):
        return None
    for known in problem.units:  # the normal form has 1 - cosine² for sine²
        parts = sp.Poly(square, cosine(known)) if cosine(known) in square.free_symbols else None
        if parts is not None and sp.expand(parts.coeff_monomial(1) + parts.coeff_monomial(cosine(known) ** 2)) == 0:
            square = sp.expand(parts.coeff_monomial(1)) * sine(known) ** 2
    factors = [f.as_base_exp() for f in sp.Mul.make_args(factored(square))]
    number = sp.sqrt(sp.Mul(*[base**exponent for base, exponent in factors if base.is_number]))
    named = [(base, exponent / 2) for base, exponent in factors if not base.is_number]
    is_square = number.is_rational and all(half.is_integer for _, half in named)
    return sp.Mul(number, *[base**half for base, half in named]) if is_square else None
