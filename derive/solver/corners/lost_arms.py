"""Lost arms: an arm that is made of several roots may round to nothing while the point it turns to is off the axis.

A step takes u as the angle from an arm (p, q) to a point (x, y), of one length but for rounding. Where the arm is known
through one root it is as small as the point. Where it is a sum of several roots near their folds, each with half of its
digits, the sum may be zero and the point not. The same happens to one root that is computed from an entry of a rotation
near one, or from a polar radius near its largest value. Then nothing is left to divide by: u is free, as it is where
the point is on the axis.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from derive.equations.problem import StepDeterminant
from derive.ir.primitives import Select
from derive.ir.program import Let, Statement


def with_lost_arms_free(
    statements: Sequence[Statement], determinants: Sequence[StepDeterminant]
) -> tuple[Statement, ...]:
    """The statements, with every angle free also where an arm of several roots has rounded to nothing."""
    roots = {step.sigma for step in determinants if step.reach is not None}
    coarse = {step.sigma for step in determinants if step.swing is not None and step.swing.is_coarse}
    read: dict[sp.Symbol, set[sp.Symbol]] = {s: {s} for s in roots}
    lengths: dict[sp.Symbol, tuple[sp.Basic, sp.Basic]] = {}
    found: list[Statement] = []
    for s in statements:
        if isinstance(s, Let):
            read[s.name] = set[sp.Symbol]().union(*(read.get(n, set()) for n in s.value.free_symbols))
            lengths |= _length(s, read, coarse)
            s = _free(s, lengths)
        found.append(s)
    return tuple(found)


def _length(
    let: Let, read: dict[sp.Symbol, set[sp.Symbol]], coarse: set[sp.Symbol]
) -> dict[sp.Symbol, tuple[sp.Basic, sp.Basic]]:
    """The length of an arm of several roots, or of a coarse one, by its name: where its angle is determined, and where
    it also divides.
    """
    value = let.value
    if (
        not isinstance(value, Select)
        or not isinstance(value.args[0], sp.And)
        or len(read[let.name]) < 2
        and not read[let.name] & coarse
    ):
        return {}
    long = [c for c in value.args[0].args if isinstance(c, sp.StrictGreaterThan) and c.rhs == 0]
    rest = [c for c in value.args[0].args if c not in long]
    return {let.name: (rest[0], value.args[0])} if len(long) == len(rest) == 1 else {}


def _free(let: Let, lengths: dict[sp.Symbol, tuple[sp.Basic, sp.Basic]]) -> Let:
    if not isinstance(let.value, Select):
        return let
    condition, determined, free = let.value.args
    for name in determined.free_symbols & lengths.keys():
        if condition == lengths[name][0]:
            return replace(let, value=Select(lengths[name][1], determined, free))
    return let
