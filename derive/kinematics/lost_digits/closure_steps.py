"""Steps on the closure: the program that meets a pose, or a point off the flange, from what the closed form gives.

It repeats q' = q + J^T (J J^T + d)^-1 e, the step of damped least squares. Here e is the error of the pose at q, and
the damping d is a share of its size, but never so small that a pivot is taken for zero. A fold or a free angle is no
special case: what does not change the pose does not move. A solution counts if its error is rounding, and no branch has
the wrong sign.

Where the steps meet nothing, the closed form gives another start: with nearly free angles at the reference, then with
them turned to where one step leaves the least error, of many values around the circle, at last at some of these. If
the steps meet the pose on another branch, nearly free angles are known from there, and the closed form is taken again;
if that leads to the same branch, the joint of its two roots is mirrored about the start.
"""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from derive.description.mechanism import Joint, Mechanism, Turning
from derive.geometry.frames import Motion
from derive.ir.constants import (
    BOUNDARY,
    CONVERGED,
    LONGEST_STEP,
    MOST_STEPS,
    NEARLY,
    PASSES,
    PIVOT,
    SHARE_OF_DAMPING,
    STALLS,
)
from derive.ir.passes import normalise
from derive.ir.primitives import NearestPeriod, Root, Select, ToReal, larger
from derive.ir.program import Iterate, Let, Output, Program, Require, Solve, Statement, Status, rewritten
from derive.ir.symbols import COORDINATE_NAMES, OFFSET, ROTATION_ENTRIES, SCALE, called, count, flag, real
from derive.kinematics.branches.assignment import margin_lets
from derive.kinematics.differential import jacobian_entries
from derive.kinematics.lost_digits.machine import Machine
from derive.kinematics.lost_digits.starts import (
    AGAIN,
    ANOTHER,
    ATTEMPT,
    BESIDE,
    BEYOND,
    ENDS,
    FREE_TURN,
    GOAL,
    IS_MET,
    LAST,
    LEAST,
    LEFT,
    LEFT_NOW,
    LEFT_OVER,
    MIRRORS,
    MOVES,
    NEAREST,
    NEAREST_NOW,
    NEAREST_TURN,
    NEAREST_TURN_NOW,
    SCAN_ENDS,
    SCANS,
    STEP,
    TURN,
    closed_form,
    ending,
    next_attempt,
    refines,
    tried,
)

MET, SHARE = flag("met"), real("share_of_damping")
OF_TURNS = ("open_", "reference_", "ref_motor_")
"""How the names begin that the choice of a turn reads."""
_NO_NEARER = flag("came_no_nearer")
_ZERO, _ONE = sp.Integer(0), sp.Integer(1)
EXACT = BOUNDARY / 10
"""An error of a machine with deviations is rounding up to this: every pose of it is met by steps."""
FIRST = sp.Integer(9)
"""Larger than every error: the least error before the first step."""


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
    chosen = [Let(real(f"chosen_{j.key}"), on_its_turn(machine, j, branch)) for j in joints]
    near = {real(f"near_{j.key}") for j in joints}
    needed = [s for s in branch.lets() if s.name in near or s.name.name.startswith(OF_TURNS)]
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
    closed, starts = closed_form(machine.mechanism, branch, machine.deviates is not None)
    following, moves = count("next_attempt"), 0 if machine.deviates is None else MOVES
    states = () if machine.deviates is None else (SHARE,)
    moved = () if machine.deviates is None else (sp.Gt(following, 0),)
    near = (j for j in joints if machine.deviates is not None and j.reference in branch.inputs)
    at_reference = {j: Select(sp.Eq(following, 0), j.reference, starts[j]) for j in near}
    attempt = (*next_attempt(following, machine.deviates is not None), *closed, ending(closed, *moved))
    step = (*at_step(machine), *error_at_step(machine), *_sides(machine), *_step(machine), *attempt)
    return Iterate(
        state=(*map(tried, joints), LEFT, ATTEMPT, LEAST, NEAREST, NEAREST_TURN, TURN, BESIDE, *states),
        start=(
            *map(started, joints),
            sp.Integer(STALLS),
            sp.Integer(-moves),
            FIRST,
            FIRST,
            _ZERO,
            _ZERO,
            STEP,
            *(SHARE_OF_DAMPING for _ in states),
        ),
        step=tuple(s for s in step if isinstance(s, Let | Solve)),
        following=(
            *(_next(machine, j, at_reference.get(j, starts[j])) for j in joints),
            Select(ANOTHER, Select(SCANS, _ZERO, sp.Integer(STALLS)), LEFT_NOW),
            Select(ENDS, Select(SCANS, sp.Integer(SCAN_ENDS), sp.Integer(LAST + 1)), following),
            Select(sp.Or(ANOTHER, MIRRORS), FIRST, Select(sp.Lt(real("error"), LEAST), real("error"), LEAST)),
            NEAREST_NOW,
            NEAREST_TURN_NOW,
            FREE_TURN,
            Select(refines(following), -BESIDE / Select(sp.Gt(BESIDE, 0), _ONE, sp.Integer(2)), BESIDE),
            *(_next_share() for _ in states),
        ),
        done=sp.Or(IS_MET, sp.And(ANOTHER, sp.Gt(following, LAST)), sp.And(ENDS, sp.Not(SCANS))),
        limit=MOST_STEPS + moves * (PASSES + 1),
        otherwise=None,
        note="steps of damped least squares on the closure, from one start after the other",
    )


def _next_share() -> sp.Expr:
    """More damping behind a step that came no nearer, less behind another one."""
    more, less = SHARE * 10, SHARE / 10
    changed = Select(_NO_NEARER, Select(sp.Gt(more, _ONE), _ONE, more), larger(less, SHARE_OF_DAMPING))
    return Select(sp.Or(ANOTHER, MIRRORS), SHARE_OF_DAMPING, changed)


def on_its_turn(machine: Machine, joint: Joint, branch: Program) -> sp.Expr:
    """The axis value on the turn that the branch would choose."""
    near, told = real(f"near_{joint.key}"), machine.commanded.get(joint)
    value = tried(joint) if told is None else told.value(tried(joint))
    lets = {let.name: let.value for let in branch.lets()}
    if joint.is_geared or near not in lets:
        return value
    if told is None:
        return NearestPeriod(value, near)
    if _moves_others(machine.mechanism, joint):
        return value  # they were found for the turn of the start
    start = real(f"open_{joint.key}")
    at_reference = {joint.reference: told.value(joint.reference)}
    own = lets[near].xreplace({start: lets[start].xreplace(at_reference)}) if start in lets else near
    return NearestPeriod(tried(joint) + told.shift, told.gain * own) / told.gain


def _moves_others(mechanism: Mechanism, joint: Joint) -> bool:
    """Whether a whole turn of an axis moves another joint, or shifts the chain."""
    assert mechanism.chain is not None
    shifts = (f.amount for f in mechanism.chain.factors if f.motion is Motion.SHIFT)
    gears = (j.coupling for j in mechanism.joints if j is not joint)
    return any({joint.motor, joint.symbol} & value.free_symbols for value in (*shifts, *gears))


def at_step(machine: Machine, scale: sp.Expr = SCALE) -> list[Statement]:
    """The pose, the margins of the branches and the Jacobian at the axis values of a step. scale: the unit of lengths
    in the Jacobian.
    """
    mechanism = machine.mechanism
    lets, entries = machine.entries or jacobian_entries(mechanism)  # x, y and z are those of a commanded point
    found: dict[sp.Symbol, Let] = {}
    for s in (*machine.at_axes, *margin_lets(mechanism, machine.assignments), *lets):
        if isinstance(s, Let):
            found.setdefault(s.name, s)
    width = len(mechanism.joints)
    for r, row in enumerate(machine.rows):
        for k, j in enumerate(mechanism.joints):
            power = int(not j.axis_is_angle) - int(row in COORDINATE_NAMES)
            value = entries[r * width + k] * scale**power if j in machine.inverse.moving else _ZERO
            name = rate(r, k)
            found[name] = Let(name, value)
    axes = {j.axis: tried(j) for j in mechanism.joints}
    return [rewritten(s, lambda e: e.xreplace(axes)) for s in found.values()]


def rate(row: int, column: int) -> sp.Symbol:
    return real(f"rate_{row + 1}_{column + 1}")


def error_at_step(machine: Machine) -> list[Statement]:
    """The error of the pose in the rows of the Jacobian, and its size; one more where the rotations are opposite."""
    errors, agreement = missed(machine, SCALE)
    size = Root(sp.Add(*[e.name**2 for e in errors])) + Select(sp.Gt(agreement, 0), _ZERO, _ONE)
    return [*errors, Let(real("error"), size, "error of the pose, in characteristic lengths and radians")]


def missed(machine: Machine, scale: sp.Expr) -> tuple[list[Let], sp.Expr]:
    """The error of the pose in the rows of the Jacobian, and what is positive unless the rotations are opposite."""
    goal = sp.Matrix(3, 3, [GOAL[r] for r in ROTATION_ENTRIES])
    shift = {c: (GOAL[real(c)] - real(c)) / scale for c in COORDINATE_NAMES}
    turn, agreement = _turn(machine.turning, sp.Matrix(3, 3, ROTATION_ENTRIES), goal)
    values = shift | turn
    return [Let(real(f"error_{k}"), values[row]) for k, row in enumerate(machine.rows, 1)], agreement


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
    is_last = sp.Or(sp.Gt(2 * error, LEAST), sp.Le(LEFT, 0))
    bound = BOUNDARY if machine.deviates is None else EXACT
    is_close = sp.Or(sp.Le(error, bound), sp.And(sp.Le(error, CONVERGED), is_last))
    return [
        *sides,
        Let(close, is_close, "the error is rounding, and steps make it no smaller"),
        Let(met, sp.And(close, *(sp.Not(w) for w in wrong.values()), *possible(machine))),
        Let(MIRRORS, sp.And(close, sp.Or(*wrong.values()))),
    ]


def possible(machine: Machine) -> list[sp.Basic]:
    """The conditions of forward kinematics, such as those of positive quantities."""
    axes = {j.axis: tried(j) for j in machine.mechanism.joints}
    refusals = (s for s in machine.at_axes if isinstance(s, Require) and s.otherwise is Status.IMPOSSIBLE)
    return [s.condition.xreplace(axes) for s in refusals]


def _step(machine: Machine) -> list[Statement]:
    """The step of damped least squares, J^T (J J^T + d)^-1 e, and the divisor that keeps it within bounds."""
    size, width = len(machine.rows), len(machine.mechanism.joints)
    jacobian = sp.Matrix(size, width, lambda r, k: rate(r, k))
    product, damping = jacobian * jacobian.T, real("damping")
    names = {(i, j): real(f"product_{i + 1}_{j + 1}") for i in range(size) for j in range(i, size)}
    matrix = tuple(names[min(i, j), max(i, j)] for i in range(size) for j in range(size))
    squares = [real(f"square_{k + 1}") for k in range(size)]
    share = SHARE_OF_DAMPING if machine.deviates is None else SHARE
    multipliers = [real(f"multiplier_{k + 1}") for k in range(size)]
    steps = [real(f"step_{j.key}") for j in machine.mechanism.joints]
    length = real("step_length")
    return [
        Let(_NO_NEARER, sp.Gt(real("error"), LEAST)),
        *(Let(square, product[k, k]) for k, square in enumerate(squares)),
        Let(damping, larger(share * real("error"), 2 * PIVOT * sp.Add(*squares)), "no pivot is taken for zero"),
        *(Let(n, squares[k[0]] + damping if k[0] == k[1] else product[k]) for k, n in names.items()),
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
    unit = (1 if joint.axis_is_angle else SCALE) / joint.unit
    moved = tried(joint) + real("shrinking") * real(f"step_{joint.key}") * unit
    beside = [flag(f"beside_{a.branch.name}") for a in machine.assignments if a.determinant.step == joint.symbol]
    across = 2 * start - tried(joint)
    mirrored = Select(beside[0], across, tried(joint)) if beside else tried(joint)
    if machine.deviates is not None:
        mirrored, start = across, start + BEYOND * (start - tried(joint))
    return Select(sp.Or(ANOTHER, AGAIN), start, Select(MIRRORS, mirrored, moved))
