"""Forward-mode differentiation: the rates of the values of a program, by the chain rule, statement by statement.

A rate is a value per unit of time, where some names have given rates and all others follow from these. A choice has the
rate of the side that is chosen; the rate of a solved system M v = b is M^-1 (b' - M' v).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import sympy as sp

from derive.ir.primitives import Select
from derive.ir.program import Let, Solve, Statement
from derive.ir.symbols import Flag, Names, names_in
from derive.ir.verify import BrokenProgram


@dataclass(frozen=True)
class Rates:
    """The rates of names, and the statements that bind them."""

    given: Mapping[sp.Symbol, sp.Expr]
    """Rates that do not follow from a statement."""
    names: Names
    """The names in use."""
    statements: list[Statement] = field(default_factory=list)
    _found: dict[sp.Symbol, sp.Expr] = field(default_factory=dict)
    _unknown: set[sp.Symbol] = field(default_factory=set)

    def through(self, statements: Iterable[Statement]) -> None:
        """Differentiate statements in their order. What a loop, a call or a search binds has no rate, unless one is
        given.
        """
        for s in statements:
            if isinstance(s, Solve):
                self._solved(s)
            elif not isinstance(s, Let):
                self._unknown.update(set(s.bound()) - self.given.keys())
            elif s.name not in self.given and not isinstance(s.name, Flag):
                if not self._unknown.isdisjoint(names_in(s.value)):
                    self._unknown.add(s.name)
                elif (rate := self.of(s.value)) != 0:
                    self._found[s.name] = self._named(s.name, rate)

    def of(self, value: sp.Basic) -> sp.Expr:
        """The rate of a value. Raises `BrokenProgram` if it reads what has none."""
        if strangers := sorted(s.name for s in names_in(value) & self._unknown):
            raise BrokenProgram(f"{', '.join(strangers)}: nothing gives a rate")
        if isinstance(value, Select):
            condition, *sides = value.args
            return Select(condition, *map(self.of, sides))
        known = [s for s in sorted(names_in(value), key=str) if s in self.given or s in self._found]
        return sp.Add(*[sp.diff(value, s).replace(sp.sign, _sign) * self._rate(s) for s in known])

    def _rate(self, name: sp.Symbol) -> sp.Expr:
        return self.given[name] if name in self.given else self._found[name]

    def _named(self, name: sp.Symbol, rate: sp.Expr) -> sp.Expr:
        """A rate, under a name of its own if it is more than a name."""
        if rate.is_Symbol or rate.is_Number:
            return rate
        own = self.names.fresh(f"rate_of_{name.name}")
        self.statements.append(Let(own, rate))
        return own

    def _solved(self, system: Solve) -> None:
        size, columns = system.size, system.columns
        turned = sp.Matrix(size, size, [self.of(v) for v in system.matrix])
        right = sp.Matrix(size, columns, [self.of(v) for v in system.right])
        right -= turned * sp.Matrix(size, columns, list(system.names))
        if any(v != 0 for v in right):
            own = tuple(self.names.fresh(f"rate_of_{name.name}") for name in system.names)
            self.statements.append(Solve(own, system.matrix, tuple(right)))
            self._found.update(zip(system.names, own, strict=True))


def _sign(x: sp.Expr) -> sp.Expr:
    return Select(sp.Gt(x, 0), sp.Integer(1), sp.Integer(-1))
