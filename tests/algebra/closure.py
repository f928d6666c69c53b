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
    BOUNDARY,
    CONVERGED,
    COST_OF_A_STALL,
    LEAST_DAMPING,
    LONGEST_STEP,
    NEARLY,
    PASSES,
    SHARE_OF_DAMPING,
    STALLED,
)
from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select, Wrap, larger
from derive.ir.program import Iterate, Let, Output, Program, Solve, Statement, rewritten
from derive.ir.symbols import SCALE, TRIED, cosine, count, flag, real, sine
from derive.kinematics.branches.assignment import with_branch_signs
from derive.kinematics.differential import scaled_entries, solved_entries
from derive.kinematics.scan.derivations import Scanned, _sides, named_apart
from derive.kinematics.scan.programs import (
    FITS,
    GOAL,
    _agreement,
    _errors,
    _named_entries,
    solved_value,
    with_goal,
)

IS_MET = flag("meets_pose")
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
    short = [m.value for m in derivation.conditionings if m.angle not in derivation.wrist]
    lengths = [Let(real(f"turning_length_{k}"), value) for k, value in enumerate(short, 1)]
    statements = with_goal(named_apart((*first, *solved, left, *lengths), "tried"))
    signed = tuple(rewritten(s, lambda e: e.xreplace(signs)) for s in statements)
    plain = tuple(s for s in signed if isinstance(s, Let))
    return Trial(plain, real("residual_tried"), tuple(real(f"{let.name.name}_tried") for let in lengths))


def joints_program(mechanism: Mechanism, trial: Trial) -> Program:
    """The program that computes the joints at a joint value that was found."""
    solved = [(j, solved_value(mechanism, j.symbol)) for j in mechanism.solved_joints]
    outputs = [Output(begun(j.symbol).name, Wrap(v) if j.is_angle else v) for j, v in solved]
    program = normalise("joints_at", trial.statements, outputs)
    return replace(program, summary="The joints with the searched one known")


def begun(joint: sp.Symbol) -> sp.Symbol:
    """A joint where the steps on the closure begin."""
    return real(f"begun_{joint.name}")


def finish_program(mechanism: Mechanism, wanted: Sequence[sp.Expr], determinant: sp.Symbol) -> Program:
    """The program that meets the pose from joints nearby, and tells whether it does, and whether these joints fit: no
    value in `wanted` may be negative.
    """
    joints = [j.symbol for j in mechanism.solved_joints]
    held = [Let(j.symbol, reference_value(j)) for j in mechanism.held_joints]
    loop, jacobian = steps_on_closure(mechanism, [begun(j) for j in joints])
    last = Solve((), jacobian, (), determinant, "determinant of the Jacobian, positions in characteristic lengths")
    met = Let(IS_MET, sp.Le(real("error"), CONVERGED))
    fits = Let(flag(FITS), sp.And(IS_MET, *(sp.Ge(w, -NEARLY) for w in wanted)))
    outputs = [Output(FITS, fits.name), Output(IS_MET.name, IS_MET)]
    outputs += [Output(f"joint_{j.symbol.name}", j.symbol) for j in mechanism.joints]
    program = normalise("finish_root", (*held, loop, last, met, fits), outputs)
    return replace(program, summary="The joints that meet the pose, and whether they are on the branch")


def steps_on_closure(mechanism: Mechanism, start: Sequence[sp.Expr]) -> tuple[Iterate, tuple[sp.Expr, ...]]:
    """Steps on the closure, those of damped least squares, J^T (J J^T + d)^-1 e, and the Jacobian where they end.

    The damping d is a share of the error. What does not change the pose does not move. Next to a double root every
    step leaves a third of the error; steps that leave nearly all of it are soon given up.
    """
    joints = [j.symbol for j in mechanism.solved_joints]
    lengths = {j.symbol for j in mechanism.solved_joints if not j.is_angle}
    composed, (lets, entries) = named_pose(mechanism), solved_entries(mechanism)
    pose = [Let(n, v) for n, v in zip(GOAL, (*composed.position, *composed.rotation), strict=True)]
    scaled = list(scaled_entries(mechanism, entries))
    errors = [Let(real(f"error_{k}"), v) for k, v in enumerate(_errors(mechanism), 1)]
    names = [let.name for let in errors]
    steps = tuple(real(f"step_{j.name}") for j in joints)
    error, before, left, cost = real("error"), real("error_before"), count("passes_left"), count("cost")
    agreement = _agreement(mechanism)
    squares = [*(n**2 for n in names), *(Select(sp.Gt(let.name, 1), _ZERO, sp.Integer(1)) for let in agreement)]
    rates, jacobian = _named_entries(scaled, len(joints))
    is_last = sp.Or(sp.Gt(2 * error, before), sp.Le(left, 0))
    is_stalled = sp.Gt(error, STALLED * before)
    body = (
        *composed.statements,
        *pose,
        *errors,
        *agreement,
        Let(error, Root(sp.Add(*squares)), "pose error, in characteristic lengths and radians"),
        *lets,
        *rates,
        *_shortest_step(jacobian, names, steps),
        Let(cost, Select(is_stalled, sp.Integer(COST_OF_A_STALL), sp.Integer(1))),
    )
    loop = Iterate(
        state=(*joints, before, left),
        start=(*start, sp.Integer(9), sp.Integer(PASSES)),
        step=tuple(s for s in body if isinstance(s, Let | Solve)),
        following=(*(j + _way(j, s, lengths) for j, s in zip(joints, steps, strict=True)), error, left - cost),
        done=sp.Or(sp.Le(error, BOUNDARY / 100), sp.And(sp.Le(error, CONVERGED), is_last), sp.Le(left, 0)),
        limit=PASSES + 1,
        otherwise=None,
        note="steps of damped least squares on the closure",
    )
    return loop, tuple(jacobian)


def _way(joint: sp.Symbol, step: sp.Symbol, lengths: Container[sp.Symbol]) -> sp.Expr:
    """The step of a joint, within bounds: that of a slide is counted in lengths of the machine."""
    return step * _SHRINKING * (SCALE if joint in lengths else 1)


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
        Let(damping, larger(SHARE_OF_DAMPING * real("error"), LEAST_DAMPING)),
        *(Let(names[i, j], product[i, j] + (damping if i == j else 0)) for i, j in upper),
        Solve(
            multipliers, matrix, tuple(errors), None, "damped least squares: the shortest step that cancels the error"
        ),
        *(Let(step, value) for step, value in zip(steps, jacobian.T * sp.Matrix(multipliers), strict=True)),
        Let(length, Root(sp.Add(*[step**2 for step in steps]))),
        Let(_SHRINKING, Select(is_long, LONGEST_STEP / Select(is_long, length, sp.Integer(1)), sp.Integer(1))),
    ]
