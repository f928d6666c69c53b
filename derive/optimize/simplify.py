"""Simplify: steps of a derivation that repeat or undo each other are removed.

turned back    c = a/e cos s - b/e sin s,  s = …,  e² = a² + b²:   b c - a s   →  -e sin s
signs          Let(r23, -x - y), Let(cos_q5, -r23)                            →  Let(cos_q5, x + y)
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import sympy as sp

from derive.ir.passes import is_read_once, normalise
from derive.ir.primitives import Root
from derive.ir.program import Let, Program, Statement
from derive.ir.symbols import is_condition, symbols_of


@dataclass(frozen=True)
class _Turned:
    """Two names that are two others turned by a constant angle, whose cosine and sine are over `length`."""

    names: frozenset[sp.Symbol]
    values: Mapping[sp.Symbol, sp.Expr]
    before: tuple[sp.Symbol, sp.Symbol]
    length: sp.Symbol
    square: sp.Expr
    """The square of the length."""

    def undone_in(self, statement: Statement) -> Statement:
        """A statement with its value in the names before the turn, where that is shorter."""
        if isinstance(statement, Let) and statement.name not in self.names:
            return replace(statement, value=self._undone(statement.value))
        return statement

    def _undone(self, value: sp.Expr) -> sp.Expr:
        if (
            value.free_symbols & self.names != self.names
            or is_condition(value)
            or not value.is_polynomial(*self.names, *self.before)
        ):
            return value
        polynomial = sp.Poly(value.xreplace(dict(self.values)), *self.before)
        if polynomial.total_degree() != 1:
            return value
        found = sp.Add(*[self._tidy(c) * sp.Mul(*[b**k for b, k in zip(self.before, powers, strict=True)])
                         for powers, c in polynomial.terms()])  # fmt: skip
        return found if sp.count_ops(found) < sp.count_ops(value) else value

    def _tidy(self, coefficient: sp.Expr) -> sp.Expr:
        """A coefficient with the name of the length in place of its square."""
        share = sp.cancel(coefficient * self.length / self.square)
        return share * self.length if share.is_number else sp.cancel(coefficient)


def turned_back(program: Program) -> Program:
    """Replace values of a turned direction by those of the direction before the turn, if that is shorter."""
    body = list(program.body)
    for turned in _turns(program.lets()):
        body = [turned.undone_in(s) for s in body]
    return normalise(program.name, body, program.outputs)


def _turns(lets: Iterable[Let]) -> Iterable[_Turned]:
    """The pairs of names c = a/e x - b/e y, s = b/e x + a/e y with e² = a² + b²."""
    values = {let.name: let.value for let in lets}
    lengths = {name: value.args[0] for name, value in values.items() if isinstance(value, Root)}
    names = [name for name, value in values.items() if any(value.has(1 / length) for length in lengths)]
    for cosine, sine in zip(names, names[1:], strict=False):
        for length, square in lengths.items():
            before = sorted(symbols_of(values[cosine]) - symbols_of(square) - {length}, key=str)
            if len(before) == 2 and symbols_of(values[cosine]) == symbols_of(values[sine]):
                x, y = before
                both = {cosine: values[cosine], sine: values[sine]}
                turn = sp.expand(values[cosine] ** 2 + values[sine] ** 2 - (x**2 + y**2) * square / length**2)
                if turn == 0:
                    yield _Turned(frozenset(both), both, (x, y), length, square)


def without_signs(program: Program) -> Program:
    """Bind a name that is read only with a minus sign to its negative."""
    values = {let.name: let for let in program.lets()}
    for let in program.lets():
        source = values.get(-let.value) if not is_condition(let.value) and (-let.value).is_Symbol else None
        if source is not None and is_read_once(program, source.name):
            changed = Let(let.name, sp.expand(-source.value), let.note or source.note)
            body = [changed if s == let else s for s in program.body if s != source]
            return without_signs(normalise(program.name, body, program.outputs))
    return program
