"""Aimed: how far ahead or beside a point is, seen in a direction that was made of it, is known already.

    d = root(x² + y²), e² = select(d > t, d², t²)
    c = select(d > t, (x h - y b)/e², cos(free))
    s = select(d > t, (y h + x b)/e², sin(free))        point = select(d > t, h, x c + y s)
    ahead = x c + y s - l                          →    ahead = point - l

It serves a language that computes one side of a choice alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import combinations

import sympy as sp

from derive.ir.names import Names
from derive.ir.passes import normalise
from derive.ir.primitives import (
    Root,
    Select,
)
from derive.ir.program import (
    Let,
    Program,
    Statement,
)
from derive.ir.symbols import (
    symbols_of,
)


@dataclass(frozen=True)
class _Direction:
    """A cosine and a sine that are quotients by the square of a length where a condition holds."""

    condition: sp.Basic
    names: tuple[sp.Symbol, sp.Symbol]
    dividends: tuple[sp.Expr, sp.Expr]
    square: sp.Expr

    def part_of(self, value: sp.Expr) -> tuple[sp.Expr, sp.Expr] | None:
        """The terms of a value that are proportional to the names, and what they are where the condition holds.

        Terms as they stand: nothing else of the value is written out.
        """
        terms = [term for term in sp.Add.make_args(value) if symbols_of(term) & set(self.names)]
        value = sp.Add(*terms)
        if not symbols_of(value) >= set(self.names) or not value.is_polynomial(*self.names):
            return None
        if sp.Poly(value, *self.names).total_degree() != 1:
            return None
        factors = [sp.diff(value, name) for name in self.names]
        made = sp.Add(*[f * dividend for f, dividend in zip(factors, self.dividends, strict=True)])
        known = sp.cancel(made / self.square)
        if not known.is_polynomial():
            return None
        return value, known


def with_known_projections(program: Program) -> Program:
    """The program with such coordinates taken from what their directions were made of."""
    body, taken = list(program.body), Names.of(program)
    for direction in _directions(program):
        body = list(_seen(body, direction, taken))
    return normalise(program.name, body, program.outputs)


def _seen(body: Iterable[Statement], direction: _Direction, taken: Names) -> Iterator[Statement]:
    """The statements with names for such terms."""
    points: dict[sp.Expr, sp.Symbol] = {}
    for statement in body:
        found = direction.part_of(statement.value) if isinstance(statement, Let) else None
        if isinstance(statement, Let) and found is not None:
            part, known = found
            if part not in points:
                points[part] = taken.fresh(direction.names[0].name.replace("cos_", "point_from_", 1))
                yield Let(points[part], Select(direction.condition, known, part))
            statement = replace(statement, value=statement.value - part + points[part])
        yield statement


def _directions(program: Program) -> Iterator[_Direction]:
    values = {let.name: let.value for let in program.lets()}
    for pair in combinations([name for name, value in values.items() if isinstance(value, Select)], 2):
        (condition, first, _), (other, second, _) = (values[name].args for name in pair)
        divisors = {value.as_numer_denom()[1] for value in (first, second)}
        if condition != other or len(divisors) != 1:
            continue
        divisor = values.get(divisors.pop())
        if not isinstance(divisor, Select) or divisor.args[0] != condition or not divisor.args[1].is_Pow:
            continue
        length, exponent = divisor.args[1].args
        if exponent == 2 and isinstance(values.get(length), Root):
            dividends = (first.as_numer_denom()[0], second.as_numer_denom()[0])
            yield _Direction(condition, pair, dividends, values[length].args[0])
