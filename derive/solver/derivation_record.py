"""The record of a derivation: statements in order, equal values under one name, every name bound once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import sympy as sp

from derive.algebra.normal_form import linear_coefficients
from derive.equations.problem import Binding, Conditioning, Legs, Problem, StepDeterminant
from derive.equations.rotations import conditions
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


def with_known_legs(statements: Sequence[Statement], determinants: Sequence[StepDeterminant]) -> tuple[Statement, ...]:
    """The derivation with every multiple of a known leg by its name.

    A step for u solves along cos u + across sin u = beside, and along sin u - across cos u = root. A later statement
    that computes one of these sums from cos u and sin u again takes more operations and adds rounding errors.
    """
    found = tuple(statements)
    for step in determinants:
        if step.legs is not None:
            found = tuple(_through_legs(s, step.step, step.legs) for s in found)
    return found


def _through_legs(statement: Statement, angle: sp.Symbol, legs: Legs) -> Statement:
    own = (cosine(angle), sine(angle))
    if not isinstance(statement, Let) or statement.name in own or not statement.value.is_polynomial():
        return statement
    linear = linear_coefficients(sp.expand(statement.value), own)
    if linear is None or linear[0][0] == 0:
        return statement
    (a, b), rest = linear
    for pair, leg in (((legs.along, legs.across), legs.beside), ((-legs.across, legs.along), legs.root)):
        ratio = sp.cancel(a / pair[0])
        if ratio.is_number and sp.expand(b - ratio * pair[1]) == 0:
            return replace(statement, value=rest + ratio * leg)
    return statement


def unknowns_in(problem: Problem) -> set[sp.Symbol]:
    """The unknowns in the equations."""
    return {u for e in problem.equations for u in problem.unknowns_of(e.expression)}


def left_alone(problem: Problem, record: DerivationRecord) -> list[sp.Expr]:
    """The residuals of the equations of a trial that hold none of its unknowns."""
    alone = [e for e in problem.equations if not problem.unknowns_of(e.expression)]
    bindings = [Binding(e.label, (), e.lets, residual=e.expression / problem.scale_of(e)) for e in alone]
    return [left for b in bindings if (left := record.commit(b).residual) is not None]


def left_of_rotation(problem: Problem, record: DerivationRecord) -> list[sp.Expr]:
    """The expressions that vanish where the commanded rotation agrees with the positions."""
    bindings = (Binding("rotation", (), c.lets, residual=c.expression) for c in conditions(problem))
    found = [record.commit(binding).residual for binding in bindings]
    return [residual for residual in found if residual is not None]


def left_of_positions(problem: Problem, record: DerivationRecord) -> list[sp.Expr]:
    """The residual of the positions where they have one equation too many; if it is zero, the others are zero."""
    return [residual / problem.scale**2 for residual in record.residuals[:1]]
