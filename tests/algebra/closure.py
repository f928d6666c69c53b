"""A trial, which solves all joints but one, and the steps on the closure from what it gives."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.description.mechanism import Mechanism
from derive.equations.axes import held_lets, reference_value
from derive.equations.closures.fixed_names import fixed_lets
from derive.equations.named_pose import named_pose
from derive.ir.constants import (
    LEAST_DAMPING,
    LONGEST_STEP,
    NEARLY,
    SHARE_OF_DAMPING,
)
from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select, Wrap, larger
from derive.ir.program import Let, Output, Program, Solve, Statement, rewritten
from derive.ir.symbols import SCALE, TRIED, cosine, flag, real, sine
from derive.kinematics.branches.assignment import with_branch_signs
from derive.kinematics.differential import scaled_entries, solved_entries
from derive.kinematics.scan.derivations import Scanned, _sides, named_apart
from derive.kinematics.scan.guards import conditions_of, least, room_of
from derive.kinematics.scan.programs import (
    FITS,
    GOAL,
    _agreement,
    _errors,
    _named_entries,
    solved_value,
    with_goal,
)

ERROR = real("error")
_SHRINKING = real("shrinking")
_ZERO = sp.Integer(0)


@dataclass(frozen=True)
class Trial:
    """One trial: statements that solve the other joints with the scanned one at `TRIED`, and the residual that they
    leave.
    """

    statements: tuple[Let, ...]
    value: sp.Expr
    """The residual, a number without a unit."""
    lengths: tuple[sp.Symbol, ...]
    """Each turns an angle, which turns fast where it is short."""
    room: sp.Symbol
    """How far, without a unit, the nearest step is from where its two roots join."""


def trial_on_branch(both: Scanned) -> Trial:
    """One trial on the wanted branch; SIDE = -1 takes the other solution of its two-root step."""
    first, solved = _statements(both)
    statements, signs = _sides(both, first, solved)
    return _trial(both, [s for s in statements if isinstance(s, Let)], signs, solved)


def trial_of_all_signs(both: Scanned) -> Trial:
    """A trial whose signs are all positive."""
    first, solved = _statements(both)
    return _trial(both, tuple(first), {a.sigma: sp.Integer(1) for a in both.trial_branches}, solved)


def _statements(both: Scanned) -> tuple[list[Let], tuple[Statement, ...]]:
    """What a trial knows, and the statements that solve it."""
    mechanism = both.mechanism
    assert mechanism.search is not None
    joint = mechanism.search.joint.symbol
    own = (Let(cosine(joint), sp.cos(TRIED)), Let(sine(joint), sp.sin(TRIED)))
    held = (let for j in mechanism.held_joints for let in held_lets(j))
    known = [*fixed_lets(mechanism), *own, *held, *both.trial.closure.lets]
    return known, with_branch_signs(both.trial.derivation.statements, both.trial_branches)


def _trial(
    both: Scanned, first: Sequence[Let], signs: Mapping[sp.Symbol, sp.Expr], solved: Sequence[Statement]
) -> Trial:
    derivation = both.trial.derivation
    left = Let(real("residual"), derivation.residuals[0])
    values = [m.value for m in derivation.conditionings if m.angle not in derivation.wrist]
    lengths = [Let(real(f"turning_length_{k}"), value) for k, value in enumerate(values, 1)]
    rooms = [room_of(c) for c in conditions_of(solved)]
    room = Let(real("room"), least(rooms) if rooms else sp.Integer(1))
    statements = with_goal(named_apart((*first, *solved, left, *lengths, room), "tried"))
    signed = tuple(rewritten(s, lambda e: e.xreplace(signs)) for s in statements)
    plain = tuple(s for s in signed if isinstance(s, Let))
    left_over, *short = (real(f"{let.name.name}_tried") for let in (left, *lengths))
    return Trial(plain, left_over, tuple(short), real("room_tried"))


def joints_program(mechanism: Mechanism, trial: Trial) -> Program:
    """The program that computes the joints at a joint value that was found."""
    solved = [(j, solved_value(mechanism, j.symbol)) for j in mechanism.solved_joints]
    outputs = [Output(begun(j.symbol).name, Wrap(v) if j.is_angle else v) for j, v in solved]
    program = normalise("joints_at", trial.statements, outputs)
    return replace(program, summary="The joints with the searched one known")


def begun(joint: sp.Symbol) -> sp.Symbol:
    """A joint where the steps on the closure begin."""
    return real(f"begun_{joint.name}")


def moved_to(joint: sp.Symbol) -> sp.Symbol:
    """A joint behind a step on the closure."""
    return real(f"moved_{joint.name}")


def step_program(mechanism: Mechanism) -> Program:
    """The program that makes one step of damped least squares, J^T (J J^T + d)^-1 e, towards the pose.

    The damping d is a share of the error. What does not change the pose does not move. Next to a double root every
    step leaves a third of the error.
    """
    joints = [j.symbol for j in mechanism.solved_joints]
    lengths = {j.symbol for j in mechanism.solved_joints if not j.is_angle}
    errors = [Let(real(f"error_{k}"), v) for k, v in enumerate(_errors(mechanism), 1)]
    names, agreement = [let.name for let in errors], _agreement(mechanism)
    squares = [*(n**2 for n in names), *(Select(sp.Gt(let.name, 1), _ZERO, sp.Integer(1)) for let in agreement)]
    size = Let(ERROR, Root(sp.Add(*squares)), "pose error, in characteristic lengths and radians")
    lets, jacobian = _named_jacobian(mechanism)
    steps = tuple(real(f"step_{j.name}") for j in joints)
    shortest = _shortest_step(jacobian, names, steps)
    body = (*_posed(mechanism), *errors, *agreement, size, *lets, *shortest)
    moved = [Output(moved_to(j).name, j + _way(j, s, lengths)) for j, s in zip(joints, steps, strict=True)]
    program = normalise("step_on_closure", body, [Output(ERROR.name, ERROR), *moved])
    return replace(program, summary="A step of all joints towards the pose, and the error before it")


def fits_program(mechanism: Mechanism, wanted: Sequence[sp.Expr], determinant: sp.Symbol) -> Program:
    """The program that tells whether joints are on the branch: no value in `wanted` is negative."""
    lets, jacobian = _named_jacobian(mechanism)
    last = Solve(
        (), tuple(jacobian), (), determinant, "determinant of the Jacobian, positions in characteristic lengths"
    )
    fits = Let(flag(FITS), sp.And(*(sp.Ge(w, -NEARLY) for w in wanted)))
    body: tuple[Statement, ...] = (*_posed(mechanism), *lets, last, fits)
    program = normalise("is_on_branch", body, [Output(FITS, fits.name)])
    return replace(program, summary="Whether joints are on the wanted branch")


def _posed(mechanism: Mechanism) -> list[Statement]:
    """The statements that compute the pose at the joints."""
    held = [Let(j.symbol, reference_value(j)) for j in mechanism.held_joints]
    composed = named_pose(mechanism)
    pose = [Let(n, v) for n, v in zip(GOAL, (*composed.position, *composed.rotation), strict=True)]
    return [*held, *composed.statements, *pose]


def _way(joint: sp.Symbol, step: sp.Symbol, lengths: Container[sp.Symbol]) -> sp.Expr:
    """The step of a joint, within bounds: that of a slide is counted in lengths of the machine."""
    return step * _SHRINKING * (SCALE if joint in lengths else 1)


def _named_jacobian(mechanism: Mechanism) -> tuple[list[Statement], sp.Matrix]:
    """The statements that compute the Jacobian, and the Jacobian by the names of its entries."""
    lets, entries = solved_entries(mechanism)
    rates, jacobian = _named_entries(list(scaled_entries(mechanism, entries)), len(mechanism.solved_joints))
    return [*lets, *rates], jacobian


def _shortest_step(jacobian: sp.Matrix, errors: Sequence[sp.Symbol], steps: Sequence[sp.Symbol]) -> list[Let | Solve]:
    """The step of damped least squares, J^T (J J^T + d)^-1 e, and a factor that keeps it within bounds."""
    size, product = len(errors), jacobian * jacobian.T
    upper = [(i, j) for i in range(size) for j in range(i, size)]
    names = {(i, j): real(f"product_{i + 1}_{j + 1}") for i, j in upper}
    multipliers = tuple(real(f"multiplier_{k + 1}") for k in range(size))
    matrix = tuple(names[min(i, j), max(i, j)] for i in range(size) for j in range(size))
    damping, length = real("damping"), real("step_length")
    is_long = sp.Gt(length, LONGEST_STEP)
    return [
        Let(damping, larger(SHARE_OF_DAMPING * ERROR, LEAST_DAMPING)),
        *(Let(names[i, j], product[i, j] + (damping if i == j else 0)) for i, j in upper),
        Solve(
            multipliers, matrix, tuple(errors), None, "damped least squares: the shortest step that cancels the error"
        ),
        *(Let(step, value) for step, value in zip(steps, jacobian.T * sp.Matrix(multipliers), strict=True)),
        Let(length, Root(sp.Add(*[step**2 for step in steps]))),
        Let(_SHRINKING, Select(is_long, LONGEST_STEP / Select(is_long, length, sp.Integer(1)), sp.Integer(1))),
    ]
