"""The label of a dimension: the parameter, or the simple expression of parameters, that it equals on every machine."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
import sympy as sp

from derive.description.mechanism import Joint, Mechanism, Parameter, Role
from derive.ir.constants import DEGREE
from derive.ir.interpret import Array, evaluate
from derive.kept import kept_by_identity
from derive.kinematics.sampling import sample_machine

Values = Mapping[str, Array]
LENGTHS = (Role.LENGTH, Role.SIGNED_LENGTH, Role.DISTANCE)
_SEEDS = (11, 12, 13)
"""Seeds of other machines, on which a dimension that equals a parameter by coincidence differs from it."""
_SAME = 1e-9


def interface(mechanism: Mechanism, amount: sp.Expr) -> sp.Expr:
    """An amount of a chain in the names of axes and parameters, angles in degrees; fixed angles are left out."""
    names = {j.symbol: axis_name(j) * (DEGREE if j.is_angle else 1) for j in mechanism.joints}
    named = sp.sympify(amount).xreplace(names)
    turning = any(j.symbol in amount.free_symbols and j.is_angle for j in mechanism.joints)
    if turning and not any(j.symbol in amount.free_symbols and not j.is_angle for j in mechanism.joints):
        named = sp.expand(named / DEGREE)
        axes = {axis_name(j) for j in mechanism.joints}
        named = sp.Add(*[t for t in sp.Add.make_args(named) if t.free_symbols & axes])
    return plain(sp.expand(named.subs(DEGREE, sp.pi / 180)))


def plain(label: sp.Expr) -> sp.Expr:
    """The label with symbols without assumptions."""
    return label.xreplace({s: sp.Symbol(s.name) for s in label.free_symbols})


def axis_name(joint: Joint) -> sp.Symbol:
    """The axis as a label."""
    return sp.Symbol(joint.moved_name)


def lengths_of(mechanism: Mechanism) -> tuple[Parameter, ...]:
    """The parameters that are lengths of the machine."""
    return tuple(p for p in mechanism.parameters if p.role in LENGTHS)


class Naming:
    """Finds the labels of lengths by measuring them on machines of other dimensions."""

    def __init__(self, mechanism: Mechanism, values: Values) -> None:
        self._parameters = lengths_of(mechanism)
        self._angles = tuple(p.name for p in mechanism.parameters if p.role is Role.ANGLE)
        self._machines = [{**values, **other} for other in _others(mechanism)]
        self._given = {p.name: np.array([float(m[p.name]) for m in self._machines]) for p in self._parameters}

    def length(self, measure: Callable[[Values], float]) -> sp.Expr | None:
        """The parameter, or half of it, that equals the length on every machine; else None."""
        return self._found(lambda machine: abs(measure(machine)), magnitude=True)

    def angle(self, measure: Callable[[Values], float]) -> sp.Expr | None:
        """The parameter that equals the angle, in degrees, on every machine; else None."""
        measured = np.array([measure(machine) for machine in self._machines])
        for name in self._angles:
            given = np.array([float(machine[name]) for machine in self._machines])
            if np.all(np.abs((measured - given + 180.0) % 360.0 - 180.0) <= _SAME * 360.0):
                return sp.Symbol(name)
        return None

    def coordinates(self, entries: Sequence[Callable[[Values], float]]) -> tuple[sp.Expr, ...] | None:
        """The parameters that equal the coordinates of a point; None if one of them is neither a
        parameter nor zero.
        """
        found = [self._found(entry, magnitude=False) for entry in entries]
        names = [name for name in found if name is not None]
        return tuple(names) if len(names) == len(found) and any(n != 0 for n in names) else None

    def _found(self, measure: Callable[[Values], float], *, magnitude: bool) -> sp.Expr | None:
        measured = np.array([measure(machine) for machine in self._machines])
        for expression, given in self._candidates(magnitude):
            if np.all(np.abs(measured - given) <= _SAME * (1.0 + np.abs(given))):
                return expression
        return None

    def _candidates(self, magnitude: bool) -> Iterator[tuple[sp.Expr, Array]]:
        yield sp.Integer(0), np.zeros(len(self._machines))
        for parameter in self._parameters:
            given = self._given[parameter.name]
            for factor in (sp.Integer(1), sp.Rational(1, 2)):
                scaled = given * float(factor)
                yield factor * sp.Symbol(parameter.name), np.abs(scaled) if magnitude else scaled


@kept_by_identity(10)
def _others(mechanism: Mechanism) -> tuple[Values, ...]:
    """The parameters of other machines."""
    return tuple(_own(mechanism, seed) for seed in _SEEDS)


def _own(mechanism: Mechanism, seed: int) -> dict[str, Array]:
    """The parameters of another machine; those that are zero in this one are not zero there."""
    generator = np.random.default_rng(seed)
    drawn = sample_machine(mechanism, seed)
    found = {}
    for parameter in mechanism.parameters:
        is_zero = parameter.role in (*LENGTHS, Role.ANGLE) and parameter.nominal == 0
        found[parameter.name] = np.asarray(generator.uniform(1.0, 2.0)) if is_zero else drawn[parameter.name]
    return found


def vector_at(entries: Sequence[sp.Expr], values: Values) -> Array:
    """The entries as numbers; a vector in the plane lies at z = 0."""
    found = [float(evaluate(sp.sympify(e), values)) for e in entries]
    return np.array([*found, *[0.0] * (3 - len(found))])
