"""Conditions that the derivation puts on a machine: values of its parameters that must not vanish."""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp

from derive.description.mechanism import Constraint, Mechanism
from derive.equations.closures.fixed_names import fixed_lets
from derive.equations.machine_checks import with_constraints
from derive.ir.constants import DEGREE, SHORTEST_LINK


def with_conditions(mechanism: Mechanism, values: Iterable[sp.Expr]) -> Mechanism:
    """The mechanism with conditions of its derivation: values of its parameters that must not vanish.

    A value vanishes where it is below 1e-9 of the sum of its terms with every sine and cosine at its largest.
    """
    written = {let.name: let.value for let in fixed_lets(mechanism)}
    found = []
    for value in dict.fromkeys(values):
        shown = sp.factor(sp.sympify(value).xreplace(written))
        terms = sp.Add.make_args(sp.expand(sp.sympify(value).xreplace(written)))
        largest = sp.Add(*[sp.Abs(t.replace(_is_turn, lambda *_: sp.Integer(1))) for t in terms])
        words = str(shown.xreplace({DEGREE: sp.Integer(1)})).replace("*", " ")
        message = f"{words} must not be 0: parallel slides"
        found.append(Constraint(sp.Gt(sp.Abs(shown), SHORTEST_LINK * largest), message))
    return with_constraints(mechanism, found)


def _is_turn(value: sp.Basic) -> bool:
    return isinstance(value, sp.sin | sp.cos)
