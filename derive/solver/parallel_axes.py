"""Parallel axes: a sum (or difference) of angles as one unknown.

`a4 = a234 - a2 - a3`: where equations depend on a2, a3 and a4 through their sum alone, the sum takes the place of the
last of them, which follows at the end by the addition theorems.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
import sympy as sp

from derive.algebra.angle_sums import Terms, positive_first, symbol_of_sum, terms_of
from derive.algebra.normal_form import polynomial, reduce_units, split_known
from derive.equations.problem import Binding, Equation, Problem
from derive.geometry.frames import Factor
from derive.ir.interpret import evaluate
from derive.ir.program import Let
from derive.ir.symbols import cosine, sine
from derive.solver.probe import DRAWS, drawn, turned

_SEED = 35
_PARALLEL = 1e-9
"""The largest sine of the angle between parallel directions."""
_FUNCTIONS = ((cosine, sp.cos), (sine, sp.sin))


@dataclass(frozen=True)
class Sum:
    """`symbol` is the signed sum of `terms`; as an unknown it takes the place of the term `replaced`."""

    symbol: sp.Symbol
    terms: Terms
    replaced: sp.Symbol

    def replacement(self) -> sp.Expr:
        """The replaced angle as the sum less the other terms."""
        signs = dict(self.terms)
        others = sp.Add(*[a * s for a, s in self.terms if a != self.replaced])
        return (self.symbol - others) * signs[self.replaced]


def candidate_sums(problem: Problem, arguments: Sequence[sp.Expr]) -> tuple[Sum, ...]:
    """Sums to try: every argument of a sine or cosine with several unknown angles, then every difference of two
    arguments.
    """
    differences = [b - a for a, b in combinations(arguments, 2)]
    found: dict[sp.Symbol, Sum] = {}
    for argument in [*arguments, *differences]:
        unknown, _ = split_known(argument, problem.angles)  # known terms: a held joint, a fixed rotation of the base
        terms = terms_of(unknown, problem.angles)
        if terms is not None and len(terms) > 1:
            terms = positive_first(terms)
            if not _parallel(problem, terms):
                continue
            found.setdefault(symbol_of_sum(terms), Sum(symbol_of_sum(terms), terms, terms[-1][0]))
    return tuple(found.values())


def _parallel(problem: Problem, terms: Terms) -> bool:
    """Whether the axes of some angles are parallel, at random poses. It is true for equations without a rotation, and
    for a sum of angles by which one joint turns.
    """
    together = {angle for angle, _ in terms}
    if not problem.turns or any(together <= turn.amount.free_symbols for turn in problem.turns):
        return True
    values = drawn(problem, [], np.random.default_rng(_SEED))
    directions, rotation = [], np.broadcast_to(np.eye(3), (DRAWS, 3, 3))
    seen = {angle for angle, _ in terms}
    for turn in problem.turns:
        if seen & turn.amount.free_symbols:
            directions.append(rotation[:, :, turn.axis])
            seen -= turn.amount.free_symbols
        rotation = rotation @ turned(turn.axis, np.broadcast_to(evaluate(turn.amount, values), (DRAWS,)))
    return all(np.abs(np.cross(directions[0], other)).max() < _PARALLEL for other in directions[1:])


def substitute(problem: Problem, total: Sum) -> Problem:
    """The problem with the sum as an unknown in place of one of its terms."""
    form = total.replacement()
    angles = tuple(total.symbol if a == total.replaced else a for a in problem.angles)
    units = (*problem.units, total.symbol)
    table = {f(total.replaced): polynomial(g(form), units, ()) for f, g in ((sine, sp.sin), (cosine, sp.cos))}
    table[total.replaced] = form

    def through_sum(equation: Equation) -> Equation:
        if total.replaced in equation.expression.free_symbols:
            # The angle stands outside a sine, and its whole turns count: the equation waits until the angle is known
            return equation
        expression = reduce_units(equation.expression.xreplace(table), units, problem.signs)
        return replace(equation, expression=expression)

    meant = sp.expand(sp.Add(*[a * s for a, s in total.terms]).xreplace(dict(problem.sums)))
    references = {**problem.references, total.symbol: sp.Add(*[problem.references[a] * s for a, s in total.terms])}
    equations = tuple(through_sum(e) for e in problem.equations)
    pending = (*problem.pending, total.replaced)
    return replace(
        problem,
        angles=angles,
        units=units,
        equations=equations,
        references=references,
        pending=pending,
        sums={**problem.sums, total.symbol: meant},
        turns=_through(problem.turns, total.replaced, form),
        links=_through(problem.links, total.replaced, form),
    )


def _through(factors: Sequence[Factor], replaced: sp.Symbol, form: sp.Expr) -> tuple[Factor, ...]:
    return tuple(replace(f, amount=sp.expand(f.amount.xreplace({replaced: form}))) for f in factors)


def resolve(problem: Problem, total: Sum) -> Binding | None:
    """The replaced angle, once the sum and the other terms are known."""
    awaited = (total.symbol, *(a for a, _ in total.terms if a != total.replaced))
    if any(a in (*problem.angles, *problem.pending) for a in awaited):
        return None
    note = f"{total.replaced.name} from the sum {total.symbol.name} of angles about parallel axes"
    sign = dict(total.terms)[total.replaced]
    found = tuple((a, s) for a, s in total.terms if a != total.replaced)
    others = positive_first(found)
    rest = symbol_of_sum(others) if len(others) > 1 else others[0][0]
    form = (total.symbol - rest * (1 if others == found else -1)) * sign
    units = (*problem.units, total.replaced, rest)
    amount = sp.Add(*[a * s for a, s in others])
    named = [Let(f(rest), polynomial(g(amount), units, ())) for f, g in _FUNCTIONS] if len(others) > 1 else []
    lets = tuple(Let(f(total.replaced), polynomial(g(form), units, ())) for f, g in _FUNCTIONS)
    return Binding("sum", (total.replaced,), (*named, replace(lets[0], note=note), *lets[1:]))
