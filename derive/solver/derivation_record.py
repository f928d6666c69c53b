"""The record of a derivation: statements in order, equal values under one name, every name bound once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import sympy as sp

from derive.equations.problem import Binding, Measure, Slope
from derive.ir.program import (
    Let,
    Statement,
    rewritten,
)
from derive.ir.symbols import (
    called,
    cosine,
    sine,
)
from derive.ir.verify import BrokenProgram


class DerivationRecord:
    """The bindings of a derivation, in order."""

    def __init__(self) -> None:
        self._statements: list[Statement] = []
        self._by_value: dict[sp.Expr, sp.Symbol] = {}
        self._names: set[str] = set()
        self._slopes: list[Slope] = []
        self._measures: list[Measure] = []
        self._residuals: list[sp.Expr] = []

    @property
    def statements(self) -> tuple[Statement, ...]:
        """All statements so far."""
        return tuple(self._statements)

    @property
    def slopes(self) -> tuple[Slope, ...]:
        """The two-root steps so far."""
        return tuple(self._slopes)

    @property
    def measures(self) -> tuple[Measure, ...]:
        """The partial steps so far."""
        return tuple(self._measures)

    @property
    def residuals(self) -> tuple[sp.Expr, ...]:
        """The expressions that vanish if the equations agree with each other."""
        return tuple(self._residuals)

    def commit(self, binding: Binding) -> Binding:
        """Record a binding. Returns it with the names under which its values are recorded."""
        names = self._write(binding.statements, keep={f(u) for u in binding.unknowns for f in (sine, cosine)})
        binding = replace(
            binding,
            slope=None if binding.slope is None else _renamed(binding.slope, names),
            measure=None
            if binding.measure is None
            else replace(binding.measure, value=binding.measure.value.xreplace(names)),
            residual=None if binding.residual is None else binding.residual.xreplace(names),
            new_equations=tuple(
                replace(e, expression=e.expression.xreplace(names), lets=()) for e in binding.new_equations
            ),
        )
        self._slopes += [binding.slope] if binding.slope is not None else []
        self._measures += [binding.measure] if binding.measure is not None else []
        self._residuals += [binding.residual] if binding.residual is not None else []
        return binding

    def append(self, statements: Sequence[Statement]) -> None:
        """Record further statements under their own names."""
        self._write(statements, keep={s.name for s in statements if isinstance(s, Let)})

    def definitions(self, units: Sequence[sp.Symbol]) -> Mapping[sp.Symbol, sp.Expr]:
        """The polynomials that names stand for, but for the sines and cosines of the units."""
        own = {f(a) for a in units for f in (sine, cosine)}
        lets = [s for s in self._statements if isinstance(s, Let)]
        return {s.name: s.value for s in lets if s.name not in own and s.value.is_polynomial()}

    def _write(self, statements: Sequence[Statement], keep: set[sp.Symbol]) -> dict[sp.Symbol, sp.Symbol]:
        names: dict[sp.Symbol, sp.Symbol] = {}
        values: dict[sp.Symbol, sp.Expr] = {}
        for statement in statements:
            if not isinstance(statement, Let):
                self._statements.append(rewritten(statement, lambda e: e.xreplace(names)))
                continue
            if values.setdefault(statement.name, statement.value) != statement.value:
                raise BrokenProgram(
                    f"a step binds {statement.name} twice, to {values[statement.name]} and to {statement.value}"
                )
            value = statement.value.xreplace(names)
            shared = self._by_value.get(value)
            if shared is not None and statement.name not in keep:
                names[statement.name] = shared
                continue
            name = self._fresh(statement.name)
            if name != statement.name:
                names[statement.name] = name
            self._by_value.setdefault(value, name)
            self._statements.append(replace(statement, name=name, value=value))
        return names

    def _fresh(self, proposal: sp.Symbol) -> sp.Symbol:
        name, number = proposal.name, 1
        while name in self._names:
            number += 1
            name = f"{proposal.name}_{number}"
        self._names.add(name)
        return proposal if name == proposal.name else called(name, proposal)


def _renamed(slope: Slope, names: Mapping[sp.Symbol, sp.Expr]) -> Slope:
    reach = None if slope.reach is None else (slope.reach[0].xreplace(names), slope.reach[1].xreplace(names))
    legs = None if slope.legs is None else slope.legs.renamed(names)
    return replace(slope, value=slope.value.xreplace(names), reach=reach, legs=legs)
