"""The record of a derivation: statements in order, equal values under one name, every name bound once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import sympy as sp

from derive.equations.problem import Binding, Conditioning, StepDeterminant
from derive.ir.program import Let, Statement, rewritten
from derive.ir.symbols import called, cosine, sine
from derive.ir.verify import BrokenProgram


class DerivationRecord:
    """The bindings of a derivation, in order."""

    def __init__(self) -> None:
        self._statements: list[Statement] = []
        self._by_value: dict[sp.Expr, sp.Symbol] = {}
        self._names: set[str] = set()
        self._determinants: list[StepDeterminant] = []
        self._conditionings: list[Conditioning] = []
        self._residuals: list[sp.Expr] = []
        self.renamed: Mapping[sp.Symbol, sp.Symbol] = {}
        """The names of the last binding that have another name in the record."""

    @property
    def statements(self) -> tuple[Statement, ...]:
        """All statements so far."""
        return tuple(self._statements)

    @property
    def determinants(self) -> tuple[StepDeterminant, ...]:
        """The two-root steps so far."""
        return tuple(self._determinants)

    @property
    def conditionings(self) -> tuple[Conditioning, ...]:
        """The partial steps so far."""
        return tuple(self._conditionings)

    @property
    def residuals(self) -> tuple[sp.Expr, ...]:
        """The expressions that vanish if the equations agree with each other."""
        return tuple(self._residuals)

    def commit(self, binding: Binding) -> Binding:
        """Record a binding. Returns it with the names under which its values are recorded."""
        own = {f(u) for u in binding.unknowns for f in (sine, cosine)}
        names = self._write(binding.statements, keep=own | {*binding.unknowns})
        self.renamed = names
        residual = None if binding.residual is None else binding.residual.xreplace(names)
        binding = replace(
            binding,
            determinant=None if binding.determinant is None else binding.determinant.renamed(names),
            conditioning=None
            if binding.conditioning is None
            else replace(binding.conditioning, value=binding.conditioning.value.xreplace(names), missed=residual),
            residual=residual,
            new_equations=tuple(
                replace(e, expression=e.expression.xreplace(names), lets=()) for e in binding.new_equations
            ),
        )
        self._determinants += [binding.determinant] if binding.determinant is not None else []
        self._conditionings += [binding.conditioning] if binding.conditioning is not None else []
        self._residuals += [binding.residual] if binding.residual is not None else []
        return binding

    def append(self, statements: Sequence[Statement]) -> None:
        """Record further statements under their own names."""
        self._write(statements, keep={s.name for s in statements if isinstance(s, Let)})

    def definitions(self, units: Sequence[sp.Symbol]) -> Mapping[sp.Symbol, sp.Expr]:
        """The polynomials that names stand for, except the sines and cosines of `units`."""
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
