"""Steps on the closure: the program that meets a pose, or a point off the flange, from what the closed form gives.

It repeats q' = q + J^T (J J^T + d)^-1 e, the step of damped least squares. Here e is the error of the pose at q, and
the damping d is a share of its size. A fold or a free angle is no special case: what does not change the pose does not
move. A solution counts if its error is rounding, and no branch has the wrong sign.

Where the steps meet nothing, the closed form gives another start: with nearly free angles at the reference, then with
them turned to where one step leaves the least error, of many values around the circle. If the steps meet
the pose on another branch, nearly free angles are known from there, and the closed form is taken again; if that
leads to the same branch, the joint of its two roots is mirrored about the start.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import sympy as sp

from derive.description.mechanism import Joint, Mechanism, Turning
from derive.equations.chain_splits import is_spatial
from derive.ir.constants import (
    BOUNDARY,
    CONVERGED,
    DEGREE,
    LEAST_DAMPING,
    LONGEST_STEP,
    NEARLY,
    PASSES,
    REFINED,
    SCANNED,
    SHARE_OF_DAMPING,
)
from derive.ir.passes import normalise
from derive.ir.primitives import NearestPeriod, Root, Select, ToReal, larger
from derive.ir.program import Iterate, Let, Output, Program, Require, Solve, Statement, Status, rewritten
from derive.ir.symbols import COORDINATE_NAMES, OFFSET, ROTATION_ENTRIES, SCALE, called, count, flag, real
from derive.kinematics.branches.assignment import Assignment, margin_lets
from derive.kinematics.differential import jacobian_entries, jacobian_rows
from derive.kinematics.inverse import Inverse
from derive.kinematics.lost_digits.starts import (
    AGAIN,
    ANOTHER,
    ATTEMPT,
    BEFORE,
    BESIDE,
    ENDS,
    FREE_TURN,
    GOAL,
    IS_MET,
    LEFT,
    LEFT_NOW,
    LEFT_OVER,
    MIRRORS,
    NEAREST,
    NEAREST_NOW,
    NEAREST_TURN,
    NEAREST_TURN_NOW,
    SCAN_ENDS,
    STEP,
    TURN,
    closed_form,
    ending,
    is_scan,
    next_attempt,
    refines,
    tried,
)

MET = flag("met")
_ROTATED = (Turning.NONE, Turning.ABOUT_Z, Turning.DIRECTION, Turning.FULL)
"""The commanded rotations whose error is known."""
_ZERO, _ONE = sp.Integer(0), sp.Integer(1)
_FIRST = sp.Integer(9)
"""Larger than every error: the error before the first step."""


@dataclass(frozen=True)
class Machine:
    """What the steps need: the solved inverse, and its derivation and the pose at given axis values."""

    mechanism: Mechanism
    inverse: Inverse
    assignments: tuple[Assignment, ...]
    at_axes: tuple[Statement, ...]
    is_point: bool = False
    """Whether a point off the flange is commanded."""

    @property
    def turning(self) -> Turning:
        """The commanded part of the rotation."""
        return Turning.NONE if self.is_point else self.mechanism.task.turning

    @property
    def rows(self) -> tuple[str, ...]:
        """The rows of the Jacobian that the closure has."""
        return tuple(self.mechanism.task.position) if self.is_point else jacobian_rows(self.mechanism)

    @property
    def has_steps(self) -> bool:
        """Whether there are steps on its closure: it must be that of a chain."""
        chain = self.mechanism.chain
        is_known = chain is not None and (is_spatial(chain) or not self.is_point)
        return is_known and self.turning in _ROTATED


def varying(machine: Machine, branch: Program) -> set[sp.Symbol]:
    """The inputs of a branch that are no constants of the machine, nor the pose."""
    joints = machine.mechanism.joints
    own = {a.sigma for a in machine.assignments} | {s for j in joints for s in (j.reference, j.turn)} | {*OFFSET}
    return own & set(branch.inputs)


def given_name(name: sp.Symbol) -> sp.Symbol:
    """An input of a branch as an argument."""
    return called(f"given_{name.name}", name)


def started(joint: Joint) -> sp.Symbol:
    """The axis value that the branch gives to start from."""
    return real(f"start_{joint.key}")


def meet_program(machine: Machine, branch: Program) -> Program:
    """The program that meets a pose, and tells whether it has."""
    joints = machine.mechanism.joints
    chosen = [Let(real(f"chosen_{j.key}"), _on_its_turn(j, branch)) for j in joints]
    near = {real(f"near_{j.key}") for j in joints}
    needed = [s for s in branch.lets() if s.name in near or s.name.name.startswith(("open_", "reference_"))]
    outputs = [Output(MET.name, IS_MET)]
    outputs += [Output(f"found_{j.key}", let.name) for j, let in zip(joints, chosen, strict=True)]
    names = {name: given_name(name) for name in varying(machine, branch)}
    statements: tuple[Statement, ...] = (_loop(machine, branch), *needed, *chosen)
    word = "point" if machine.is_point else "pose"
    body = [rewritten(s, lambda e: e.xreplace(names)) for s in statements]
    summary = f"The axes that meet a {word}, found by steps on the closure, and whether they do"
    return replace(normalise(f"meet_{word}", body, outputs), summary=summary)


def _loop(machine: Machine, branch: Program) -> Iterate:
    """The steps from one start after the other."""
    joints = machine.mechanism.joints
    closed, starts = closed_form(machine.mechanism, branch)
    following = count("next_attempt")
    attempt = (*next_attempt(following), *closed, ending(closed))
    step = (*_at_axes(machine), *_error(machine), *_sides(machine), *_step(machine), *attempt)
    return Iterate(
        state=(*map(tried, joints), LEFT, ATTEMPT, BEFORE, NEAREST, NEAREST_TURN, TURN, BESIDE),
        start=(*map(started, joints), sp.Integer(PASSES), _ZERO, _FIRST, _FIRST, _ZERO, _ZERO, STEP),
        step=tuple(s for s in step if isinstance(s, Let | Solve)),
        following=(
            *(_next(machine, j, starts[j]) for j in joints),
            Select(ANOTHER, Select(is_scan(following), _ZERO, sp.Integer(PASSES)), LEFT_NOW),
            Select(ENDS, sp.Integer(SCAN_ENDS + 1), following),
            Select(sp.Or(ANOTHER, MIRRORS), _FIRST, real("error")),
            NEAREST_NOW,
            NEAREST_TURN_NOW,
            FREE_TURN,
            Select(refines(following), -BESIDE / Select(sp.Gt(BESIDE, 0), _ONE, sp.Integer(2)), BESIDE),
        ),
        done=sp.Or(IS_MET, sp.And(ANOTHER, sp.Gt(following, SCAN_ENDS)), ENDS),
        limit=3 * (PASSES + 1) + SCANNED + REFINED,
        otherwise=None,
        note="steps of damped least squares on the closure, from one start after the other",
    )


def _on_its_turn(joint: Joint, branch: Program) -> sp.Expr:
    """The axis value on the turn that the branch would choose."""
    near = real(f"near_{joint.key}")
    if joint.is_geared or not any(let.name == near for let in branch.lets()):
        return tried(joint)
    return NearestPeriod(tried(joint), near)


def _at_axes(machine: Machine) -> list[Statement]:
    """The pose, the margins of the branches and the Jacobian at the axis values of a step."""
    mechanism = machine.mechanism
    lets, entries = jacobian_entries(mechanism)  # x, y and z are the position of the point, where it is commanded
    found: dict[sp.Symbol, Let] = {}
    for s in (*machine.at_axes, *margin_lets(mechanism, machine.assignments), *lets):
        if isinstance(s, Let):
            found.setdefault(s.name, s)
    width = len(mechanism.joints)
    for r, row in enumerate(machine.rows):
        for k, j in enumerate(mechanism.joints):
            power = int(not j.axis_is_angle) - int(row in COORDINATE_NAMES)
            value = entries[r * width + k] * SCALE**power if j in machine.inverse.moving else _ZERO
            name = _rate(r, k)
            found[name] = Let(name, value)
    axes = {j.axis: tried(j) for j in mechanism.joints}
    return [rewritten(s, lambda e: e.xreplace(axes)) for s in found.values()]


def _rate(row: int, column: int) -> sp.Symbol:
    return real(f"rate_{row + 1}_{column + 1}")


def _error(machine: Machine) -> list[Statement]:
    """The error of the pose in the rows of the Jacobian, and its size; one more where the rotations are opposite."""
    goal = sp.Matrix(3, 3, [GOAL[r] for r in ROTATION_ENTRIES])
    here = sp.Matrix(3, 3, ROTATION_ENTRIES)
    shift = {c: (GOAL[real(c)] - real(c)) / SCALE for c in COORDINATE_NAMES}
    turn, agreement = _turn(machine.turning, here, goal)
    values = shift | turn
    names = [real(f"error_{k}") for k, _ in enumerate(machine.rows, 1)]
    opposite = Select(sp.Gt(agreement, 0), _ZERO, _ONE)
    return [
        *(Let(n, values[row]) for n, row in zip(names, machine.rows, strict=True)),
        Let(
            real("error"),
            Root(sp.Add(*[n**2 for n in names])) + opposite,
            "error of the pose, in characteristic lengths and radians",
        ),
    ]


def _turn(turning: Turning, here: sp.Matrix, goal: sp.Matrix) -> tuple[dict[str, sp.Expr], sp.Expr]:
    """The vector of the rotation from the pose to the goal by rows of the Jacobian, and what is positive where it is
    less than a quarter turn, or nearly so.
    """
    if turning is Turning.NONE:
        return {}, _ONE
    if turning is Turning.DIRECTION:
        tilt = here.T * here[:, 2].cross(goal[:, 2])
        return {"tilt x": tilt[0], "tilt y": tilt[1]}, here[:, 2].dot(goal[:, 2])
    moved = goal * here.T
    turn = {f"turn {c}": (moved[i, j] - moved[j, i]) / 2 for c, i, j in (("x", 2, 1), ("y", 0, 2), ("z", 1, 0))}
    if turning is Turning.ABOUT_Z:
        return turn, moved[0, 0] + moved[1, 1]
    return turn, moved.trace() - 1


def _sides(machine: Machine) -> list[Statement]:
    """Whether the pose is met, on the wanted branch or on another one."""
    error, close, met = real("error"), flag("pose_is_close"), IS_MET
    wrong = {a: flag(f"beside_{a.branch.name}") for a in machine.assignments}
    sides = [Let(w, sp.Lt(ToReal(a.sigma) * real(f"branch_{a.branch.name}"), -2 * NEARLY)) for a, w in wrong.items()]
    is_last = sp.Or(sp.Gt(2 * error, BEFORE), sp.Le(LEFT, 0))
    is_close = sp.Or(sp.Le(error, BOUNDARY), sp.And(sp.Le(error, CONVERGED), is_last))
    return [
        *sides,
        Let(close, is_close, "the error is rounding, and steps make it no smaller"),
        Let(met, sp.And(close, *(sp.Not(w) for w in wrong.values()), *_possible(machine))),
        Let(MIRRORS, sp.And(close, sp.Or(*wrong.values()))),
    ]


def _possible(machine: Machine) -> list[sp.Basic]:
    """The conditions of forward kinematics, such as those of positive quantities."""
    axes = {j.axis: tried(j) for j in machine.mechanism.joints}
    refusals = (s for s in machine.at_axes if isinstance(s, Require) and s.otherwise is Status.IMPOSSIBLE)
    return [s.condition.xreplace(axes) for s in refusals]


def _step(machine: Machine) -> list[Statement]:
    """The step of damped least squares, J^T (J J^T + d)^-1 e, and the divisor that keeps it within bounds."""
    size, width = len(machine.rows), len(machine.mechanism.joints)
    jacobian = sp.Matrix(size, width, lambda r, k: _rate(r, k))
    product, damping = jacobian * jacobian.T, real("damping")
    names = {(i, j): real(f"product_{i + 1}_{j + 1}") for i in range(size) for j in range(i, size)}
    matrix = tuple(names[min(i, j), max(i, j)] for i in range(size) for j in range(size))
    multipliers = [real(f"multiplier_{k + 1}") for k in range(size)]
    steps = [real(f"step_{j.key}") for j in machine.mechanism.joints]
    length = real("step_length")
    return [
        Let(damping, larger(SHARE_OF_DAMPING * real("error"), LEAST_DAMPING)),
        *(Let(n, product[k] + (damping if k[0] == k[1] else 0)) for k, n in names.items()),
        Solve(tuple(multipliers), matrix, tuple(real(f"error_{k + 1}") for k in range(size))),
        *(Let(n, v) for n, v in zip(steps, jacobian.T * sp.Matrix(multipliers), strict=True)),
        Let(length, Root(sp.Add(*[s**2 for s in steps]))),
        Let(
            LEFT_OVER,
            damping * Root(sp.Add(*[m**2 for m in multipliers])) + length**2,
            "error that a step leaves: what it does not reach, and its curvature",
        ),
        Let(
            real("shrinking"),
            Select(sp.Gt(length, LONGEST_STEP), LONGEST_STEP / Select(sp.Gt(length, LONGEST_STEP), length, _ONE), _ONE),
        ),
    ]


def _next(machine: Machine, joint: Joint, start: sp.Expr) -> sp.Expr:
    """The axis value behind a step: the start of the next attempt; if the pose is met on another branch, the closed
    form with what is known there, or the mirror image; else the step.
    """
    unit = 1 / DEGREE if joint.axis_is_angle else SCALE
    moved = tried(joint) + real("shrinking") * real(f"step_{joint.key}") * unit
    beside = [flag(f"beside_{a.branch.name}") for a in machine.assignments if a.determinant.step == joint.symbol]
    mirrored = Select(beside[0], 2 * start - tried(joint), tried(joint)) if beside else tried(joint)
    return Select(sp.Or(ANOTHER, AGAIN), start, Select(MIRRORS, mirrored, moved))
