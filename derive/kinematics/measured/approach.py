"""A few steps of Newton's method from the closed form of the drawing: they meet nearly every pose of the true machine.
What they do not meet is searched: see `lost_digits`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
import sympy as sp

from derive.description.mechanism import Joint
from derive.ir.constants import NEARLY
from derive.ir.interpret import run
from derive.ir.passes import depending_on, normalise
from derive.ir.primitives import Select, ToReal
from derive.ir.program import Call, Iterate, Let, Output, Program, Statement, rewritten
from derive.ir.symbols import SCALE, flag, real
from derive.kinematics.differential import entries_of, is_of_length
from derive.kinematics.lost_digits.closure_steps import (
    FIRST,
    MET,
    OF_TURNS,
    at_step,
    given_name,
    missed,
    on_its_turn,
    possible,
    rate,
    started,
    varying,
)
from derive.kinematics.lost_digits.machine import Machine
from derive.kinematics.lost_digits.starts import GOAL, tried
from derive.kinematics.measured.pose import INNER, Inner
from derive.kinematics.measured.system import System
from derive.kinematics.sampling import machine_at, sample_axes

_BEFORE, _LENGTH = real("length_before"), real("step_length")
_FEW = 8
"""The largest number of steps; three meet a pose where deviations are of the usual size."""
_SHORT = sp.Float("1e-8")
"""What a step of at most this length leaves, in radians and lengths of the machine, is its square: rounding."""
_RATHER_SHORT, _LEFT = sp.Float("3e-7"), sp.Float("1e-14")
"""A step of at most this length is the last, too, if it leaves at most the second, by what the one before has left: a
share of its square."""
_LEAST = sp.Float("1e-12")
"""A determinant at most this size, in lengths of the machine, is taken for zero."""
_SAMPLES = 200
"""The poses of the drawing by which the joints are chosen that turn the flange."""
_ONE = sp.Integer(1)
_ARRIVED, _GOES_ON, _ENDS = flag("is_approached"), flag("goes_on"), flag("is_next_to_it")
_ALIKE = flag("is_turned_alike")


def approached(machine: Machine, lean: Machine, inner: Inner, branch: Program, search: Program) -> Program:
    """The program that meets a pose by a few steps, or else runs the search.

    lean: the machine with the pose and the Jacobian that steps take.
    """
    joints = machine.mechanism.joints
    known_there = {j.axis: tried(j) for j in joints} | inner.sines
    sides = [sp.Ge(ToReal(a.sigma) * real(f"branch_{a.branch.name}"), -2 * NEARLY) for a in machine.assignments]
    near = {real(f"near_{j.key}") for j in joints}
    wanted = [s for s in branch.lets() if s.name in near or s.name.name.startswith(OF_TURNS)]
    last = {tried(j): _stepped(machine, j) for j in joints}
    chosen = [Let(real(f"chosen_{j.key}"), on_its_turn(machine, j, branch).xreplace(last)) for j in joints]
    names = (MET, *(real(f"found_{j.key}") for j in joints))
    arrived = Let(_ARRIVED, sp.And(machine.deviates, _ENDS, _ALIKE, *sides, *possible(machine)))
    given = {name: given_name(name) for name in varying(machine, branch)}
    own = {*GOAL.values(), *map(started, joints), *given.values()}
    asked = tuple((n, n) for n in search.inputs if n in own)
    steps = _steps(machine, lean, inner)
    known = {name for s in steps for name in s.bound()}
    statements: Sequence[Statement] = (
        *inner.goal,
        *steps,
        *(
            rewritten(s, lambda e: e.xreplace(known_there))
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
    return tried(joint) + real(f"step_{joint.key}") / joint.unit if joint in machine.inverse.moving else tried(joint)


def _steps(machine: Machine, lean: Machine, inner: Inner) -> list[Statement]:
    """The steps, until the pose is met, or one is much longer than the one before; what they do not change is first."""
    joints, moving = machine.mechanism.joints, machine.inverse.moving
    sizes = [sp.Abs(real(f"step_{j.key}")) / (1 if j.axis_is_angle else SCALE) for j in moving]
    errors, agreement = missed(lean, _ONE)
    if inner.goal:
        seen = {GOAL[name]: INNER[name] for name in GOAL}
        errors, agreement = [replace(e, value=e.value.xreplace(seen)) for e in errors], agreement.xreplace(seen)
    system, is_regular = _solved(machine, lean, [e.name for e in errors])
    is_settled = sp.And(sp.Lt(_BEFORE, FIRST), sp.Le(_LENGTH, _RATHER_SHORT), sp.Le(_LENGTH**3, _LEFT * _BEFORE**2))
    at_axes = at_step(lean, _ONE)
    moved = depending_on(at_axes, set(map(tried, joints)))
    body = (
        *moved.values(),
        *errors,
        *system,
        Let(_LENGTH, sp.Add(*sizes)),
        Let(_GOES_ON, sp.And(sp.Le(_LENGTH, 2 * _BEFORE), is_regular)),
        Let(_ENDS, sp.And(sp.Or(sp.Le(_LENGTH, _SHORT), is_settled), is_regular)),
    )
    loop = Iterate(
        state=(*map(tried, joints), _BEFORE),
        start=(*map(started, joints), FIRST),
        step=body,
        following=(*(_stepped(machine, j) for j in joints), _LENGTH),
        done=sp.Or(sp.Not(machine.deviates), _ENDS, sp.Not(_GOES_ON)),
        limit=_FEW,
        otherwise=None,
        note="steps of Newton's method on the closure",
    )
    alike = Let(_ALIKE, sp.Gt(agreement, 0))
    return [*(s for s in at_axes if isinstance(s, Let) and s.name not in moved), loop, alike]


def _solved(machine: Machine, lean: Machine, errors: Sequence[sp.Symbol]) -> tuple[list[Let], sp.Basic]:
    """The step, and the condition that there is one."""
    joints, moving = machine.mechanism.joints, machine.inverse.moving
    places = [joints.index(j) for j in moving]
    shifts, slides = sum(map(is_of_length, machine.rows)), sum(not j.axis_is_angle for j in moving)
    matrix = sp.Matrix(len(machine.rows), len(moving), lambda r, k: rate(r, places[k]))
    system = System(matrix, shifts, _turns(lean, places, shifts), (_LEAST, _LEAST * SCALE ** (shifts - slides)))
    steps = zip(moving, system.solve("error", sp.Matrix(errors)), strict=True)
    return [*system.lets, *(Let(real(f"step_{j.key}"), s) for j, s in steps)], sp.And(*system.conditions)


def _turns(lean: Machine, places: Sequence[int], shifts: int) -> tuple[int, ...]:
    """The joints that take what turns the flange, while the others shift it: those whose turns are independent wherever
    the pose is regular, by samples of the drawing.
    """
    mechanism, (statements, entries) = lean.mechanism, lean.entries or ((), ())
    rows, width, drawn = len(lean.rows), len(mechanism.joints), machine_at(mechanism)
    outputs = entries_of(entries, width)
    found, _ = run(
        normalise("sampled_jacobian", (*lean.at_axes, *statements), outputs),
        drawn | sample_axes(mechanism, drawn, _SAMPLES, seed=3),
    )
    values = np.stack([np.broadcast_to(found[o.name], (_SAMPLES,)) for o in outputs], axis=-1)
    jacobian = values.reshape(_SAMPLES, rows, width)[:, :, places]
    whole = np.abs(np.linalg.det(jacobian))
    angles = [k for k, place in enumerate(places) if mechanism.joints[place].axis_is_angle]
    choices = combinations(reversed(angles), rows - shifts)
    shares = {tuple(sorted(c)): np.abs(np.linalg.det(jacobian[:, shifts:, sorted(c)])) for c in choices}
    return max(shares, key=lambda c: float(np.min(shares[c] / whole)))
