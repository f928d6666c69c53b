"""What an orientation kinematics carries: its end point as parts that the flange, the wrist between its axes, and the tool hold.

A shift along the axis of the turns before it is the flange's, one along the axis of the turns behind it is the tool's, any other
is the wrist's: only a flange that keeps its orientation tells where that part points.
"""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from derive.frames import Factor, Motion
from derive.mechanism import COORDINATE_NAMES, Mechanism
from derive.passes import assemble
from derive.program import Output, Program, Root

BASE = tuple(f"base_{c}" for c in COORDINATE_NAMES)
TOOL = tuple(f"carried_{c}" for c in COORDINATE_NAMES)
WRIST = "wrist_offset"


def carried_program(mechanism: Mechanism) -> Program:
    """Parameters → the flange's part, the tool's part, and the size of the wrist's part."""
    assert mechanism.chain is not None
    factors = mechanism.chain.factors
    base, tool = [sp.Integer(0)] * 3, [sp.Integer(0)] * 3
    between: list[sp.Expr] = []
    for i, factor in enumerate(factors):
        if factor.motion is not Motion.SHIFT:
            continue
        if _all_about(factors[:i], factor.axis):
            base[factor.axis] += factor.amount
        elif _all_about(factors[i:], factor.axis):
            tool[factor.axis] += factor.amount
        else:
            between.append(factor.amount)
    outputs = [Output(n, v) for n, v in zip((*BASE, *TOOL), (*base, *tool), strict=True)]
    size = Root(sp.Add(*[v**2 for v in between])) if between else sp.Integer(0)
    return assemble("carried", (), [*outputs, Output(WRIST, size)])


def _all_about(factors: Sequence[Factor], axis: int) -> bool:
    return all(f.axis == axis for f in factors if f.motion is not Motion.SHIFT)
