"""Inverse kinematics: one branch for a commanded pose, or for a commanded point off the flange."""

from __future__ import annotations

from dataclasses import dataclass, replace

import sympy as sp

from derive.algebra.normal_form import polynomial
from derive.description.mechanism import COORDINATE_NAMES_OF_A_PLANE, DescriptionError, Joint, Mechanism, Turning
from derive.equations.axes import (
    axes_of_drives,
    axis_lets,
    finite,
    frozen_lets,
    plain_angle,
    reference_lets,
    reference_value,
)
from derive.equations.closures.closure import FLANGE, Closure
from derive.equations.closures.commanded import closure_at, flange_rotation, offset_closure, pose_closure
from derive.equations.closures.fixed_names import (
    all_angles,
    fixed_lets,
    fixed_names,
    fixed_squares,
    signs_of,
    with_fixed_names,
)
from derive.equations.machine_checks import MachineCheck, apart
from derive.equations.pitch.equations import with_refusal
from derive.equations.pitch.heading import free_heading, free_value
from derive.equations.problem import Problem
from derive.equations.trigonometry import heading_at_joints
from derive.form.numbers import fixed_numbers
from derive.geometry.frames import Motion
from derive.ir.constants import FREE_ANGLE, PLANE
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, Root, Select
from derive.ir.program import Let, Output, Program, Require, Statement, Status
from derive.ir.reason import Unit, Why, about, about_machine
from derive.ir.symbols import HEADING, OFFSET, POSITION, ROTATION_ENTRIES, SCALE, cosine, real, sine
from derive.kinematics.search.guards import without_wrist
from derive.lowering.passes import DERIVED, NOTHING, applied
from derive.plate.passive import commanded, passive_statements, renamed_in
from derive.solver.derivation import Derivation
from derive.solver.solve import solve
from derive.work import counted


@dataclass(frozen=True)
class Inverse:
    """A solved inverse problem: its closure, its derivation, and the statements in front of it."""

    closure: Closure
    derivation: Derivation
    naming: tuple[Statement, ...]
    """Statements whose names the derivation reads: the heading, the tool, frozen joints, references."""
    moving: tuple[Joint, ...]
    frozen: tuple[Joint, ...] = ()
    checks: tuple[MachineCheck, ...] = ()
    """The checks on the machine, which do not depend on the pose."""
    free: tuple[Let, ...] = ()
    """The first statements of the derivation: a joint that the direction of the tool determines where the position
    does not. They read the signs of steps."""

    @property
    def known(self) -> tuple[Statement, ...]:
        """The statements of the derivation, with those in front of it."""
        return (*self.naming, *self.derivation.statements)

    @property
    def signs(self) -> tuple[sp.Symbol, ...]:
        """The signs of its two-root steps, which are still open."""
        return tuple(step.sigma for step in self.derivation.determinants)


@counted
def solve_pose(mechanism: Mechanism) -> Inverse:
    """Solve the closure of a commanded pose for the joints."""
    closure, held = pose_closure(mechanism), mechanism.held_joints
    derivation = _solve(mechanism, closure, mechanism.solved_joints)
    free: tuple[Let, ...] = ()
    if mechanism.followed_turns:
        free, _ = free_heading(mechanism, tuple(step.step for step in derivation.determinants))
        derivation = replace(derivation, statements=(*free, *with_refusal(derivation.statements)))
    kept = tuple(s for j in held for s in frozen_lets(j))
    before = (*reference_lets(mechanism), *fixed_lets(mechanism), *kept, *_heading(mechanism))
    naming = (*before, *passive_statements(mechanism), *closure.lets)
    statements, checks = apart(derivation.statements, fixed_names(mechanism))
    derivation = replace(derivation, statements=statements)
    return Inverse(closure, derivation, naming, mechanism.solved_joints, held, checks, free)


def solve_at(mechanism: Mechanism, known: Joint) -> Inverse:
    """Solve the closure of a commanded pose for all joints except a known one. The equations need not agree."""
    closure, held = closure_at(mechanism, known), mechanism.held_joints
    moving = tuple(j for j in mechanism.solved_joints if j != known)
    kept = tuple(s for j in held for s in frozen_lets(j))
    naming = (*reference_lets(mechanism), *fixed_lets(mechanism), *kept, *closure.lets)
    derivation = _solve(mechanism, closure, moving, is_overdetermined=True)
    statements, checks = apart(without_wrist(derivation), fixed_names(mechanism))
    return Inverse(closure, replace(derivation, statements=statements), naming, moving, held, checks)


def without_steps(mechanism: Mechanism, known: Joint) -> Inverse:
    """A trial with one joint known that solves nothing: the others are found otherwise."""
    moving = tuple(j for j in mechanism.solved_joints if j != known)
    kept = tuple(s for j in mechanism.held_joints for s in frozen_lets(j))
    naming = (*reference_lets(mechanism), *fixed_lets(mechanism), *kept)
    return Inverse(Closure((), ()), Derivation((), (), (), ()), naming, moving, mechanism.held_joints)


def solve_offset(mechanism: Mechanism) -> Inverse:
    """Solve the closure of a commanded point; joints that a position does not determine are frozen."""
    frozen = _frozen_joints(mechanism)
    moving = tuple(j for j in mechanism.joints if j not in frozen)
    closure = offset_closure(mechanism, moving)
    derivation = _solve(mechanism, closure, moving)
    kept = (*(s for j in frozen for s in frozen_lets(j)), *_kept_heading(mechanism, frozen))
    naming = (*reference_lets(mechanism), *fixed_lets(mechanism), *kept, *closure.lets)
    return Inverse(closure, derivation, naming, moving, frozen)


def _kept_heading(mechanism: Mechanism, frozen: tuple[Joint, ...]) -> tuple[Statement, ...]:
    """The heading of a loop's flange with the joints that turn it held at the reference."""
    if mechanism.heading is None:
        return ()
    if moved := sorted(str(s) for s in mechanism.heading.free_symbols - {j.symbol for j in frozen}):
        raise DescriptionError(f"joint {moved[0].upper()!r}, which the position determines, turns the flange")
    return heading_at_joints(mechanism)


def _solve(
    mechanism: Mechanism, closure: Closure, moving: tuple[Joint, ...], *, is_overdetermined: bool = False
) -> Derivation:
    joints = {j.symbol: j for j in mechanism.joints}
    heading = free_heading(mechanism)[1] if mechanism.followed_turns and closure.turns else None
    free = {heading: free_value(heading)} if heading is not None else {}
    problem = Problem(
        angles=tuple(j.symbol for j in moving if j.is_angle),
        lengths=tuple(j.symbol for j in moving if not j.is_angle),
        equations=closure.equations,
        units=(*all_angles(mechanism), HEADING),
        references={j.symbol: reference_value(j) for j in mechanism.joints} | free,
        scale=SCALE,
        signs=signs_of(mechanism),
        is_overdetermined=is_overdetermined,
        turns=closure.turns,
        rotation=ROTATION_ENTRIES if closure.turns else (),
        columns=closure.columns,
        followed=mechanism.followed_turns if closure.turns else 0,
        position=(*POSITION, *FLANGE),
        parameters=fixed_names(mechanism),
        numbers=fixed_numbers(mechanism),
        links=closure.links,
        point=closure.target.point,
        point_lets=closure.target.lets,
        back=None if closure.back is None else (closure.back[0], closure.back[1].point, closure.back[1].lets),
        squares=fixed_squares(mechanism),
        positive=tuple(
            polynomial(with_fixed_names(mechanism, p), all_angles(mechanism), signs_of(mechanism))
            for p in mechanism.positive
        ),
    )
    return solve(problem, closure.arguments, lambda angle: (*axis_lets(joints[angle]), plain_angle(joints[angle])))


def _frozen_joints(mechanism: Mechanism) -> tuple[Joint, ...]:
    """The held joints, and as many of the last rotary joints of a chain as the position does not determine; for a loop
    the joint of its heading that the fewest equations of the position read.
    """
    held, solved = mechanism.held_joints, mechanism.solved_joints
    if mechanism.heading is not None:
        own = [j for j in reversed(mechanism.joints) if j.symbol in mechanism.heading.free_symbols]
        return (min(own, key=lambda j: sum(e.has(j.symbol) for e in mechanism.equations)),)
    excess = len(solved) - len(mechanism.task.position)
    if mechanism.chain is None or excess <= 0:
        return held
    turning = [f for f in mechanism.chain.factors if f.motion is Motion.TURN]
    order = [j for f in turning for j in solved if j.is_angle and j.symbol in f.amount.free_symbols]
    return (*held, *list(dict.fromkeys(order))[-excess:])


def rotation_behind(mechanism: Mechanism) -> sp.Matrix:
    """The rotation of the flange behind the turn about z."""
    return sp.eye(3) if mechanism.chain is None else flange_rotation(mechanism.chain)


def heading_parts(behind: sp.Matrix) -> tuple[sp.Expr, sp.Expr]:
    """Cosine and sine of the nearest heading, up to a common factor: the tool direction comes first, then the twist.

    behind: the rotation of the flange behind the turn about z.
    """
    relative = sp.Matrix(3, 3, ROTATION_ENTRIES) * behind.T
    return relative[0, 0] + relative[1, 1], relative[1, 0] - relative[0, 1]


def heading_lets(behind: sp.Matrix) -> tuple[Statement, ...]:
    """The heading of the commanded rotation; there is none if the tool points exactly the opposite way."""
    along, across = real("heading_along"), real("heading_across")
    length, divisor = real("heading_length"), real("heading_divisor")
    determined = sp.Or(sp.Gt(sp.Abs(along), FREE_ANGLE), sp.Gt(sp.Abs(across), FREE_ANGLE))
    cos_value, sin_value = heading_parts(behind)
    return (
        Let(
            along,
            cos_value,
            "nearest rotation about Z: the tool is turned to the direction that the machine has, the twist is kept",
        ),
        Let(across, sin_value),
        Let(length, Root(along**2 + across**2)),
        Require(determined, Status.UNREACHABLE, reason=about_machine(Why.OPPOSITE)),
        Let(divisor, Select(determined, length, sp.Integer(1))),
        Let(real("cos_heading"), along / divisor),
        Let(real("sin_heading"), across / divisor),
    )


def _heading(mechanism: Mechanism) -> tuple[Statement, ...]:
    return heading_lets(rotation_behind(mechanism)) if mechanism.task.turning is Turning.ABOUT_Z else ()


def inverse_program(
    name: str,
    mechanism: Mechanism,
    inverse: Inverse,
    statements: tuple[Statement, ...],
    last: tuple[Statement, ...] = (),
    of_axes: tuple[Statement, ...] = (),
) -> Program:
    """The program of one branch: checks of inputs, the derivation with its branch signs, the checks `last`, axis
    values and the checks `of_axes` that read them.
    """
    in_plane = tuple(_in_plane(mechanism, name, value) for name, value in inverse.closure.planes)
    resolved = {s.name for s in statements if isinstance(s, Let)}
    frozen = {j.axis for j in inverse.frozen}
    known = frozen | {s.name for s in (*inverse.naming, *statements) if isinstance(s, Let)}
    axes: tuple[Statement, ...] = tuple(
        of_angle(let, j, resolved)
        for j in mechanism.joints
        if j not in inverse.frozen
        for let in axis_lets(j)
        if let.name not in resolved
    )
    axes += axes_of_drives(mechanism, known)
    outputs = [Output(j.axis.name, j.axis) for j in mechanism.joints]
    body = renamed_in((*inverse.naming, *in_plane, *statements, *last, *axes, *of_axes), commanded(mechanism))
    draft = normalise(name, body, outputs)
    groups = (POSITION, OFFSET, tuple(j.reference for j in mechanism.joints))
    checks = tuple(check for group in groups for check in finite([s for s in group if s in draft.inputs]))
    return applied(DERIVED, normalise(name, (*checks, *draft.body), draft.outputs), NOTHING)


def _in_plane(mechanism: Mechanism, name: str, value: sp.Expr) -> Require:
    """The condition that a coordinate outside the task has the value that the machine gives it."""
    distance = sp.Abs(real(name) - value)
    why = Why.OUT_OF_PLANE if mechanism.task.position == COORDINATE_NAMES_OF_A_PLANE else Why.NOT_MOVED
    reason = about(name, why, distance - PLANE * SCALE, Unit.LENGTH)
    return Require(sp.Le(distance, PLANE * SCALE), Status.UNREACHABLE, reason=reason)


def of_angle(let: Let, joint: Joint, resolved: set[sp.Symbol]) -> Let:
    """The axis value from the joint's angle itself, where that is known with its turns."""
    if joint.symbol not in resolved or joint.axis in resolved:
        return let
    direction = Atan2(sine(joint.symbol), cosine(joint.symbol))
    return replace(let, value=let.value.xreplace({direction: joint.symbol}))
