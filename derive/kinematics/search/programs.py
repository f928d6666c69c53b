"""A trial, which solves all joints but one, and the steps on the closure from what it gives."""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.description.mechanism import Joint, Mechanism, Turning
from derive.equations.axes import reference_value
from derive.equations.named_pose import named_pose
from derive.ir.constants import LEAST_DAMPING, LONGEST_STEP, NEARLY, SHARE_OF_DAMPING
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, Root, Select, Wrap, larger
from derive.ir.program import Call, Let, Output, Program, Solve, Statement, rewritten
from derive.ir.symbols import COORDINATE_NAMES, ROTATION_ENTRIES, SCALE, cosine, flag, real, sine
from derive.kinematics.differential import scaled_entries, solved_entries

START = real("start")
LOOKED_FOR = flag("looked_for")
GOAL = {real(c): real(f"goal_{c}") for c in COORDINATE_NAMES} | {r: real(f"goal_{r.name}") for r in ROTATION_ENTRIES}
"""The names of the commanded pose in these programs."""
AGREEMENT = real("agreement")
FITS = "fits"
ERROR = real("error")
_SHRINKING = real("shrinking")
IS_NEWTON = flag("is_newton")
"""Whether a step is one of Newton's method."""
SLOW = sp.Float("0.9")
"""Where a damped step leaves more than this share of the error, one of Newton's method follows."""
FOUND = flag("found")
"""Whether there is a root on the wanted branch."""
_ZERO = sp.Integer(0)


@dataclass(frozen=True)
class Trial:
    """One trial: statements that solve the other joints with the searched one at `TRIED`, and the residual that they
    leave.
    """

    statements: tuple[Let, ...]
    value: sp.Expr
    """The residual, a number without a unit."""
    lengths: tuple[sp.Symbol, ...]
    """Each turns an angle, which turns fast where it is short."""
    room: sp.Symbol
    """How far, without a unit, the nearest step is from where its two roots join."""
    keeps: sp.Symbol
    """Whether an angle is nearly free, so that another value of it may leave no residual."""


def joints_program(mechanism: Mechanism, trial: Trial) -> Program:
    """The program that computes the joints at a joint value that was found."""
    solved = [(j, solved_value(mechanism, j.symbol)) for j in mechanism.solved_joints]
    outputs = [Output(begun(j.symbol).name, Wrap(v) if j.is_angle else v) for j, v in solved]
    program = normalise("joints_at", trial.statements, outputs)
    return replace(program, summary="The joints with the searched one known")


def call_with(
    program: Program,
    arguments: Sequence[sp.Symbol],
    given: Mapping[sp.Symbol, sp.Expr],
    names: Callable[[str], sp.Symbol],
    wanted: sp.Basic = sp.true,
) -> Call:
    """A call of a step with arguments of the caller as they are, and others that are given. names: of its outputs."""
    own = {s: s for s in program.inputs if s in arguments} | dict(given)
    pairs = tuple((s, own[s]) for s in program.inputs if s in own)
    return Call(program, pairs, tuple(names(o.name) for o in program.outputs), wanted=wanted)


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
    body = (*posed(mechanism), *errors, *agreement, size, *lets, *shortest)
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
    body: tuple[Statement, ...] = (*posed(mechanism), *lets, last, fits)
    program = normalise("is_on_branch", body, [Output(FITS, fits.name)])
    return replace(program, summary="Whether joints are on the wanted branch")


def posed(mechanism: Mechanism, value: Callable[[Joint], sp.Expr] | None = None) -> list[Statement]:
    """The statements that compute the pose at the joints. value: of a joint, where joints are no inputs."""
    own = [Let(j.symbol, sp.Integer(0) if j.free else value(j)) for j in mechanism.solved_joints] if value else []
    held = [*own, *(Let(j.symbol, reference_value(j)) for j in mechanism.held_joints)]
    composed = named_pose(mechanism)
    pose = [Let(n, v) for n, v in zip(GOAL, (*composed.position, *composed.rotation), strict=True)]
    return [*held, *composed.statements, *pose]


def solved_value(mechanism: Mechanism, joint: sp.Symbol) -> sp.Expr:
    """The value of a joint in a trial."""
    if any(j.symbol == joint and not j.is_angle for j in mechanism.joints):
        return real(f"{joint.name}_tried")
    return Atan2(real(f"{sine(joint).name}_tried"), real(f"{cosine(joint).name}_tried"))


def _way(joint: sp.Symbol, step: sp.Symbol, lengths: Container[sp.Symbol]) -> sp.Expr:
    """The step of a joint, within bounds: that of a slide is counted in lengths of the machine."""
    return step * _SHRINKING * (SCALE if joint in lengths else 1)


def _named_jacobian(mechanism: Mechanism) -> tuple[list[Statement], sp.Matrix]:
    """The statements that compute the Jacobian, and the Jacobian by the names of its entries."""
    lets, entries = solved_entries(mechanism)
    scaled, width = list(scaled_entries(mechanism, entries)), len(mechanism.solved_joints)
    names = [v if v.is_number else real(f"rate_{k // width + 1}_{k % width + 1}") for k, v in enumerate(scaled)]
    rates = [Let(name, value) for name, value in zip(names, scaled, strict=True) if not value.is_number]
    return [*lets, *rates], sp.Matrix(len(scaled) // width, width, names)


def _shortest_step(jacobian: sp.Matrix, errors: Sequence[sp.Symbol], steps: Sequence[sp.Symbol]) -> list[Let | Solve]:
    """The step of damped least squares, J^T (J J^T + d)^-1 e, or of Newton's method, J^-1 e, and a factor that keeps
    it within bounds.

    A square is rounded where the step that it would make is not: what changes the pose by less than the root of the
    rounding moves by Newton's method alone.
    """
    size, product = len(errors), jacobian * jacobian.T
    upper = [(i, j) for i in range(size) for j in range(i, size)]
    names = {(i, j): real(f"product_{i + 1}_{j + 1}") for i, j in upper}
    multipliers = tuple(real(f"multiplier_{k + 1}") for k in range(size))
    pairs = [(i, j) for i in range(size) for j in range(size)]
    matrix = tuple(Select(IS_NEWTON, jacobian[i, j], names[min(i, j), max(i, j)]) for i, j in pairs)
    damped = jacobian.T * sp.Matrix(multipliers)
    damping, length = real("damping"), real("step_length")
    is_long = sp.Gt(length, LONGEST_STEP)
    return [
        Let(damping, larger(SHARE_OF_DAMPING * ERROR, LEAST_DAMPING)),
        *(Let(names[i, j], product[i, j] + (damping if i == j else 0)) for i, j in upper),
        Solve(multipliers, matrix, tuple(errors), None, "damped least squares, or the step that cancels the error"),
        *(Let(s, Select(IS_NEWTON, m, value)) for s, m, value in zip(steps, multipliers, damped, strict=True)),
        Let(length, Root(sp.Add(*[step**2 for step in steps]))),
        Let(_SHRINKING, Select(is_long, LONGEST_STEP / Select(is_long, length, sp.Integer(1)), sp.Integer(1))),
    ]


def _agreement(mechanism: Mechanism) -> list[Let]:
    """The statements that distinguish a rotation that agrees with the goal from one half a turn away, whose error also
    vanishes.
    """
    if mechanism.task.turning is Turning.NONE:
        return []
    trace = sp.Add(*[GOAL[r] * r for r in ROTATION_ENTRIES])
    return [Let(AGREEMENT, trace, "3 where the rotations agree, -1 where they are half a turn apart")]


def _errors(mechanism: Mechanism) -> list[sp.Expr]:
    """The error to the goal: a shift in characteristic lengths, and the vector of the rotation to
    it (its skew part), where a rotation is commanded.
    """
    places = [(GOAL[real(c)] - real(c)) / SCALE for c in COORDINATE_NAMES]
    if mechanism.task.turning is Turning.NONE:
        return places
    here = sp.Matrix(3, 3, ROTATION_ENTRIES)
    turn = sp.Matrix(3, 3, [GOAL[r] for r in ROTATION_ENTRIES]) * here.T
    return [*places, *((turn[i, j] - turn[j, i]) / 2 for i, j in ((2, 1), (0, 2), (1, 0)))]


def trial_of(
    statements: Sequence[Statement], value: sp.Expr, lengths: Sequence[sp.Symbol], room: sp.Symbol, keeps: sp.Symbol
) -> Trial:
    """A trial from solved statements."""
    return Trial(tuple(s for s in statements if isinstance(s, Let)), value, tuple(lengths), room, keeps)


def roots_named(statements: Sequence[Let]) -> list[Let]:
    """The statements with every root under a name, so that root and slope are computed once."""
    found: list[Let] = []
    for s in statements:
        inner = sorted((r for r in s.value.atoms(Root) if r != s.value), key=sp.default_sort_key)
        names = {r: real(f"root_{f'{number}_' if number else ''}of_{s.name.name}") for number, r in enumerate(inner)}
        found += [Let(name, root) for root, name in names.items()]
        found.append(replace(s, value=s.value.xreplace(names)))
    return found


def with_goal(statements: Sequence[Statement]) -> tuple[Statement, ...]:
    """The statements with the commanded pose by the names in `GOAL`."""
    return tuple(rewritten(s, lambda e: e.xreplace(dict(GOAL))) for s in statements)
