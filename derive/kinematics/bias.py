"""The bias: the acceleration of the frame where the axes move at constant speeds.

The frame has the velocity J q' and the acceleration J q'' + J' q'. The second term is the rate of the first at constant
speeds q'. It is found from the statements of the Jacobian by forward-mode differentiation, with the pose of a loop
moving as its Jacobian says: nothing is differentiated through forward kinematics of a loop.
"""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from derive.description.mechanism import Mechanism
from derive.equations.axes import Forward, finite
from derive.ir.passes import normalise
from derive.ir.program import Let, Output, Program, Statement
from derive.ir.symbols import Names, real
from derive.kinematics.differential import TWIST_ROWS, jacobian_rows, platform_velocities
from derive.kinematics.rates import Rates
from derive.work import stage


def bias_names(rows: Sequence[str]) -> tuple[str, ...]:
    """The names of the outputs: `bias_turn_z`."""
    return tuple(f"bias_{row.replace(' ', '_')}" for row in rows)


@stage("the acceleration at constant speeds")
def bias_programs(mechanism: Mechanism, programs: Sequence[Program], forward: Forward) -> list[Program]:
    """axis_*, speed_* → the acceleration at these speeds: of the rows of the Jacobian, and of those of a twist where it
    has a program.
    """
    rows = {"jacobian": ("bias", jacobian_rows(mechanism)), "twist": ("twist_bias", TWIST_ROWS)}
    return [_bias_program(*rows[p.name], mechanism, p, forward) for p in programs if p.name in rows]


def _bias_program(name: str, rows: Sequence[str], mechanism: Mechanism, jacobian: Program, forward: Forward) -> Program:
    speeds = [j.speed for j in mechanism.joints]
    body: tuple[Statement, ...]
    pose: dict[sp.Symbol, sp.Expr]
    if mechanism.is_platform:
        body, pose, known = platform_velocities(mechanism, forward)
        values = [known.get(row, sp.Integer(0)) for row in rows]
    else:
        body, values = jacobian.body, _products([o.value for o in jacobian.outputs], speeds)
        velocities = [Let(real(f"velocity_{row.replace(' ', '_')}"), v) for row, v in zip(rows, values, strict=True)]
        moved = mechanism.task.position if mechanism.chain is None else ()
        pose = {real(row): let.name for row, let in zip(rows, velocities, strict=True) if row in moved}
        body = (*body, *(velocities if pose else ()))
    moving = {j.axis: j.speed / j.unit for j in mechanism.joints}
    rates = Rates(moving | pose, Names(name.name for s in body for name in (*s.bound(), *s.reads())))
    rates.through(body)
    outputs = [Output(n, rates.of(v)) for n, v in zip(bias_names(rows), values, strict=True)]
    return normalise(name, (*finite(speeds), *body, *rates.statements), outputs)


def _products(entries: Sequence[sp.Expr], speeds: Sequence[sp.Symbol]) -> list[sp.Expr]:
    """The rows of a Jacobian times the speeds."""
    rows = (entries[k : k + len(speeds)] for k in range(0, len(entries), max(len(speeds), 1)))
    return [sp.Add(*[e * s for e, s in zip(row, speeds, strict=True)]) for row in rows]
