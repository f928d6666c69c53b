"""Known legs: the distances ahead and beside of an arm that points at a point keep their names in later statements.

A step for u solves along cos u + across sin u = beside, and along sin u - across cos u = root. A later statement that
computes one of these sums from cos u and sin u again takes more operations and adds rounding errors. It reads the name.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from derive.algebra.normal_form import linear_coefficients
from derive.equations.problem import Legs, StepDeterminant
from derive.ir.program import Let, Statement
from derive.ir.symbols import cosine, sine


def with_known_legs(statements: Sequence[Statement], determinants: Sequence[StepDeterminant]) -> tuple[Statement, ...]:
    """The derivation with every multiple of a known leg by its name."""
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
