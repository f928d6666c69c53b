"""The unknowns on which a sum of squares depends, found numerically before the sum is expanded.

To expand the square of an equation with a hundred terms takes seconds, and nearly always no unknown cancels. A few
random poses of random machines show this at once: where one unknown is changed alone, the value changes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import sympy as sp

from derive.equations.problem import Problem
from derive.ir.interpret import Array, evaluate
from derive.ir.symbols import cosine, sine, symbols_of

_SEED = 31
DRAWS = 8
"""Random poses, each of a random machine."""
_CHANGED = 1e-9
"""A smaller relative change of a value is rounding: then the value does not depend on the unknown."""


def unknowns_of_squares(problem: Problem, parts: Sequence[sp.Expr]) -> tuple[sp.Symbol, ...]:
    """The unknowns on which the sum of the squares of some expressions depends, in the order of the problem."""
    unknowns = tuple(dict.fromkeys(u for part in parts for u in problem.unknowns_of(part)))
    first = drawn(problem, parts, np.random.default_rng(_SEED))
    other = drawn(problem, parts, np.random.default_rng(_SEED + 1))
    value, size = _sum_of_squares(parts, first)
    found = []
    for unknown in unknowns:
        changed = {s.name: other[s.name] for s in (unknown, cosine(unknown), sine(unknown)) if s.name in first}
        another, its_size = _sum_of_squares(parts, {**first, **changed})
        if np.any(np.abs(another - value) > _CHANGED * (size + its_size)):
            found.append(unknown)
    return tuple(found)


def _sum_of_squares(parts: Sequence[sp.Expr], values: Mapping[str, Array]) -> tuple[Array, Array]:
    """The sum, and the size of its terms, which may cancel each other."""
    total, size = np.zeros(DRAWS), np.zeros(DRAWS)
    for part in parts:
        terms = [evaluate(term, values) for term in sp.Add.make_args(part)]
        total = total + sum(terms, start=np.zeros(DRAWS)) ** 2
        size = size + sum(map(np.abs, terms), start=np.zeros(DRAWS)) ** 2
    return total, size


def drawn(problem: Problem, parts: Sequence[sp.Expr], rng: np.random.Generator) -> dict[str, Array]:
    """Random values of all symbols, those of the rotations too: sines and cosines belong together, a sign is ±1, a flag
    0 or 1.
    """
    amounts = [turn.amount for turn in problem.turns]
    read = {s for part in (*parts, *amounts) for s in symbols_of(part)} | {*problem.lengths}
    names = sorted({s.name for s in read})
    values = {name: rng.uniform(0.5, 2.0, DRAWS) * rng.choice([-1.0, 1.0], DRAWS) for name in names}
    for angle in (*problem.units, *problem.angles, *problem.pending):
        turned = rng.uniform(-np.pi, np.pi, DRAWS)
        values |= {angle.name: turned, cosine(angle).name: np.cos(turned), sine(angle).name: np.sin(turned)}
    for sign in problem.signs:
        values[sign.name] = rng.choice([-1.0, 1.0] if sign.is_nonzero else [0.0, 1.0], DRAWS)
    return values


def turned(axis: int, angle: Array) -> Array:
    """Rotations about a coordinate axis."""
    matrix = np.zeros((len(angle), 3, 3))
    first, second = (axis + 1) % 3, (axis + 2) % 3
    matrix[:, axis, axis] = 1.0
    matrix[:, first, first] = matrix[:, second, second] = np.cos(angle)
    matrix[:, first, second], matrix[:, second, first] = -np.sin(angle), np.sin(angle)
    return matrix
