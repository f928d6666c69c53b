"""Rounds: where nothing was found, but an angle was nearly free, the search goes around the circle again.

In each round such an angle has another value, next to which a residual may vanish that none of the others leaves.
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from derive.description.mechanism import Mechanism
from derive.equations.axes import reference_value
from derive.ir.constants import FREE_ANGLE, NEARLY_FREE
from derive.ir.primitives import Select, ToReal
from derive.ir.program import Let, Program
from derive.ir.symbols import count, flag

ROUND, KEEPS = count("rounds_before"), flag("keeps_an_angle")
"""How often the search went around before; whether an angle is nearly free in a trial."""
GOES_ROUND = flag("goes_round")
_KEPT, _KEPT_NOW = flag("kept_an_angle"), flag("kept_an_angle_now")
"""Whether an angle was nearly free in a trial, before a pass and behind it."""
_ROUNDS, _LATTICE = 8, 3
"""The rounds, at most. In each the angle of joint k, counted from 1, is turned by as many eighths of a turn more as the
lattice to the power of k says: the values of several free angles are a lattice.
"""
BEGUN: dict[sp.Symbol, sp.Expr] = {ROUND: sp.Integer(0), _KEPT: sp.false}
FOLLOWING = {ROUND: ROUND + Select(GOES_ROUND, sp.Integer(1), sp.Integer(0)), _KEPT: _KEPT_NOW}
"""The state before the first pass, and behind a pass."""


def elsewhere(mechanism: Mechanism) -> dict[sp.Basic, sp.Expr]:
    """What takes the place of free angles, which are those of the reference in the first round, and of the bound below
    which an angle is free.
    """
    found: dict[sp.Basic, sp.Expr] = {FREE_ANGLE: Select(sp.Gt(ROUND, 0), NEARLY_FREE, FREE_ANGLE)}
    for k, j in enumerate((j for j in mechanism.solved_joints if j.is_angle), 1):
        turned = reference_value(j) + ToReal(ROUND) * sp.Float(2 * np.pi * pow(_LATTICE, k, _ROUNDS) / _ROUNDS)
        found |= {f(reference_value(j)): f(turned) for f in (sp.cos, sp.sin)}
    return found


def has_angles(trial: Program) -> bool:
    """Whether a trial tells of angles that may be free."""
    return any(o.name == KEEPS.name for o in trial.outputs)


def keeps_now(is_trial: sp.Basic) -> Let:
    """Whether an angle was nearly free so far."""
    return Let(_KEPT_NOW, sp.Or(_KEPT, sp.And(is_trial, KEEPS)))


def goes_round(is_lost: sp.Basic) -> Let:
    """Whether another round begins. is_lost: whether the way around ended, and nothing was found."""
    return Let(GOES_ROUND, sp.And(is_lost, _KEPT_NOW, sp.Lt(ROUND, _ROUNDS - 1)))
