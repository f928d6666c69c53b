"""A few steps of Newton's method from the closed form of the drawing: they meet nearly every pose of the true machine.
What they do not meet is searched: see `lost_digits`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from derive.description.mechanism import Joint
from derive.ir.constants import NEARLY
from derive.ir.passes import normalise
from derive.ir.primitives import Select, ToReal
from derive.ir.program import Call, Iterate, Let, Output, Program, Solve, Statement, rewritten
from derive.ir.symbols import SCALE, flag, real
from derive.kinematics.lost_digits.closure_steps import (
    FIRST,
    MET,
    OF_TURNS,
    at_step,
    error_at_step,
    given_name,
    on_its_turn,
    possible,
    rate,
    started,
    varying,
)
from derive.kinematics.lost_digits.machine import Machine
from derive.kinematics.lost_digits.starts import GOAL, tried

_BEFORE = real("error_before")
_FEW = 8
"""The largest number of steps; four meet a pose where deviations are of the usual size."""
_SHORT = sp.Float("1e-8")
"""What a step of at most this length leaves, in radians and lengths of the machine, is its square: rounding."""
_ARRIVED, _AWAY, _ENDS, _HERE = flag("is_approached"), flag("goes_away"), flag("is_next_to_it"), real("error")
_SLOPE = real("slope_of_the_pose")


def approached(machine: Machine, lean: Machine, branch: Program, search: Program) -> Program:
    """The program that meets a pose by a few steps, or else runs the search.

    lean: the machine with its true pose and Jacobian alone, for the steps.
    """
    joints = machine.mechanism.joints
    axes = {j.axis: tried(j) for j in joints}
    sides = [sp.Ge(ToReal(a.sigma) * real(f"branch_{a.branch.name}"), -2 * NEARLY) for a in machine.assignments]
    near = {real(f"near_{j.key}") for j in joints}
    wanted = [s for s in branch.lets() if s.name in near or s.name.name.startswith(OF_TURNS)]
    last = {tried(j): _stepped(machine, j) for j in joints}
    chosen = [Let(real(f"chosen_{j.key}"), on_its_turn(machine, j, branch).xreplace(last)) for j in joints]
    names = (MET, *(real(f"found_{j.key}") for j in joints))
    arrived = Let(_ARRIVED, sp.And(machine.deviates, _ENDS, *sides, *possible(machine)))
    given = {name: given_name(name) for name in varying(machine, branch)}
    own = {*GOAL.values(), *map(started, joints), *given.values()}
    asked = tuple((n, n) for n in search.inputs if n in own)
    steps = _steps(machine, lean)
    known = set(steps.bound())
    statements: Sequence[Statement] = (
        steps,
        *(
            rewritten(s, lambda e: e.xreplace(axes))
            for s in machine.at_axes
            if isinstance(s, Let) and s.name not in known
        ),
        *wanted,
        *chosen,
        arrived,
        Call(search, asked, names, "what a few steps do not meet is searched", sp.Not(_ARRIVED)),
    )
    outputs = [Output(MET.name, sp.Or(_ARRIVED, MET))]
    outputs += [
        Output(f"found_{j.key}", Select(_ARRIVED, let.name, other))
        for j, let, other in zip(joints, chosen, names[1:], strict=True)
    ]
    body = [rewritten(s, lambda e: e.xreplace(given)) for s in statements]
    return replace(normalise("meet_true_pose", body, outputs), summary=search.summary)


def _stepped(machine: Machine, joint: Joint) -> sp.Expr:
    """The axis value behind a step."""
    unit = (1 if joint.is_angle else SCALE) / joint.unit
    return tried(joint) + real(f"step_{joint.key}") * unit if joint in machine.inverse.moving else tried(joint)


def _steps(machine: Machine, lean: Machine) -> Iterate:
    """The steps, until the pose is met, or one comes no nearer."""
    joints, moving = machine.mechanism.joints, machine.inverse.moving
    places = [k for k, j in enumerate(joints) if j in moving]
    step = {j: real(f"step_{j.key}") for j in moving}
    size, length = len(machine.rows), sp.Add(*(sp.Abs(s) for s in step.values()))
    matrix = tuple(rate(r, k) for r in range(size) for k in places)
    errors = tuple(real(f"error_{k + 1}") for k in range(size))
    body = (
        *at_step(lean),
        *error_at_step(lean),
        Let(_AWAY, sp.Gt(_HERE, _BEFORE)),
        Solve(tuple(step.values()), matrix, errors, _SLOPE),
        Let(_ENDS, sp.And(sp.Le(length, _SHORT), sp.Gt(sp.Abs(_SLOPE), 0), sp.Le(_HERE, NEARLY))),
    )
    return Iterate(
        state=(*map(tried, joints), _BEFORE),
        start=(*map(started, joints), FIRST),
        step=tuple(s for s in body if isinstance(s, Let | Solve)),
        following=(*(_stepped(machine, j) for j in joints), _HERE),
        done=sp.Or(sp.Not(machine.deviates), _ENDS, _AWAY),
        limit=_FEW,
        otherwise=None,
        note="steps of Newton's method on the closure",
    )
