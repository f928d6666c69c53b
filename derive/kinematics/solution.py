"""What is solved of a machine before programs are made of it: the order of the preparations stands here alone.

The build makes its programs from it and keeps it; the report, its pictures and `explain` read it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import sympy as sp

from derive.description.mechanism import DescriptionError, Joint, Mechanism, Turning
from derive.equations.chain_splits import is_spatial
from derive.equations.conditions import with_conditions
from derive.equations.drives import size, slopes
from derive.equations.machine_checks import with_checks
from derive.equations.pitch.chain import followed_of
from derive.equations.problem import Conditioning
from derive.form.directions import with_exact_directions
from derive.form.machine import in_form
from derive.form.numbers import with_named_loop_angles
from derive.ir.constants import LEAST
from derive.ir.primitives import Root, Select
from derive.kinematics.branches.assembly import Assembled, assembled, with_derived_assembly
from derive.kinematics.branches.assignment import Assignment, assign
from derive.kinematics.branches.derived import with_derived_branches
from derive.kinematics.differential import jacobian_rows
from derive.kinematics.forward import pose_at_axes
from derive.kinematics.inverse import Inverse, solve_pose
from derive.kinematics.margins import Factor, factor_of
from derive.kinematics.search.choice import solve_searched, with_search
from derive.kinematics.search.derivations import Searched
from derive.kinematics.shared_names import refuse_names_of_joints, refuse_shared_names
from derive.plate.passive import GUIDES, guides_determinant
from derive.plate.plate import check_home
from derive.plate.stated_rods import with_fixed_point, with_free_twist, with_positive_lengths, with_stated_rods
from derive.plate.surplus import with_surplus

_MOTOR = "motor_"


@dataclass(frozen=True)
class Solved:
    """The closed form of a machine."""

    mechanism: Mechanism
    """As it is derived, with its assembly modes, its branches, and the conditions of the derivation."""
    closed: Assembled
    inverse: Inverse
    assignments: tuple[Assignment, ...]
    """The step that each branch decides."""

    @property
    def factors(self) -> tuple[Factor, ...]:
        """The factors of the determinants of the two Jacobians, one for each kind of singularity."""
        steps: list[Assignment | Conditioning] = [*self.assignments, *self.inverse.derivation.conditionings]
        found = [factor_of(self.mechanism, one) for one in steps]
        found += [one for joint in self.mechanism.joints for one in _of_loops(self.mechanism, joint)]
        if self.mechanism.passive:
            found.append(Factor(GUIDES, guides_determinant(self.mechanism)))
        if self.closed.margin is not None:
            found.append(Factor(self.closed.name, self.closed.margin))
        return tuple(found)


def _of_loops(mechanism: Mechanism, joint: Joint) -> Iterator[Factor]:
    """The dead points of the loops that move a joint: where its motor does not move it, and where it is free. A
    cylinder always moves its lever: it has one margin, the lever arm over the mean of both arms.
    """
    for loop, by_moved, by_motor in slopes(mechanism, joint, names=False):
        if loop.by not in loop.vector.free_symbols:
            arm = by_moved / Select(sp.Gt(sp.Abs(by_motor), LEAST), by_motor, sp.Integer(1))
            longest = Root(size(mechanism, loop, loop.moved) / 2) if loop.turns[0] else sp.Integer(1)
            yield Factor(f"lever_{loop.moved.name}", arm / longest)
            continue
        yield Factor(f"crank_{loop.by.name.removeprefix(_MOTOR)}", by_motor / size(mechanism, loop, loop.by))
        yield Factor(f"lever_{loop.moved.name}", by_moved / size(mechanism, loop, loop.moved))


Solution = Solved | Searched


def prepared(mechanism: Mechanism, further: Mapping[str, int] | None = None) -> Mechanism:
    """The mechanism as it is derived: in its one form, with its rods recognised, whose lengths are positive."""
    mechanism = in_form(mechanism, further)
    mechanism = with_surplus(mechanism, len(mechanism.solved_joints) - len(jacobian_rows(mechanism)))
    check_joints(mechanism)
    mechanism = with_named_loop_angles(with_exact_directions(with_stated_rods(with_fixed_point(mechanism))))
    return with_free_twist(with_positive_lengths(mechanism))


def solve_machine(mechanism: Mechanism) -> Solution:
    """Solve a prepared mechanism. Raises `Unsolved` or `DescriptionError`."""
    if mechanism.is_platform:
        check_home(mechanism)
    refuse_names_of_joints(mechanism)
    stated, mechanism = mechanism, with_search(mechanism)
    if mechanism.search is not None:
        return solve_searched(stated, mechanism)
    mechanism = with_derived_assembly(mechanism)
    closed = assembled(mechanism, pose_at_axes(mechanism))
    inverse = solve_pose(mechanism)
    mechanism = with_conditions(with_checks(mechanism, inverse.checks), inverse.derivation.conditions)
    refuse_shared_names(mechanism, (*closed.forward.statements, *inverse.naming, *inverse.derivation.statements))
    mechanism = with_derived_branches(mechanism, inverse, closed.forward)
    return Solved(mechanism, closed, inverse, assign(mechanism, inverse, closed.forward))


def check_joints(mechanism: Mechanism) -> None:
    """Refuse more conditions than joints or coordinates: they cannot be met, and no later step would notice."""
    if mechanism.followed_turns:
        followed_of(mechanism)
    rows = jacobian_rows(mechanism)
    equations = len(mechanism.equations) + (mechanism.heading is not None)
    commanded = f"{len(rows)} quantities ({', '.join(rows)})"
    spare = len(mechanism.solved_joints) - len(rows)
    if spare:
        raise DescriptionError(_wrong_number(mechanism, spare, commanded))
    if mechanism.is_platform:  # conditions without joints fix coordinates that are not commanded: see `check_home`
        joints = {j.symbol for j in mechanism.joints}
        equations = sum(bool(sp.sympify(e).free_symbols & joints) for e in mechanism.equations)
    if equations > len(rows):
        raise DescriptionError(f"the closure has {equations} equations, and the task commands only {commanded}")


def _wrong_number(mechanism: Mechanism, spare: int, commanded: str) -> str:
    """The message for a machine with more or fewer joints than commanded quantities."""
    joints, held = mechanism.joints, mechanism.held
    if spare < 0:
        left = f", of which {len(held)} {'is' if len(held) == 1 else 'are'} held" if held else ""
        less = "command less of the pose" + (", and hold the rest by guides=" if mechanism.is_platform else "")
        remedy = _follow_pitch(mechanism, spare) or f"; {less}, or add joints"
        return f"the task commands {commanded}, and there are only {len(joints)} joints{left}{remedy}"
    number = "one joint" if spare == 1 else f"{spare} joints"
    names = "the one that is" if spare == 1 else "those that are"
    remedy = f"name {names} held at the reference: held=({joints[0].name},)"
    if mechanism.chain is None:  # in a closed loop every joint follows from the pose
        remedy = "command more of the pose, or leave out joints: lengths of rods alone may be surplus"
    return (
        f"{number} too many: the task commands {commanded}, and {len(mechanism.solved_joints)} joints are to be solved "
        f"for; {remedy}"
    )


def _follow_pitch(mechanism: Mechanism, spare: int) -> str:
    """The advice on what to command instead, for a chain whose heading may follow from its position."""
    instead = {(Turning.DIRECTION, -1): Turning.PITCH, (Turning.FULL, -1): Turning.PITCH_ROLL}
    found = instead.get((mechanism.task.turning, spare))
    if found is None or mechanism.chain is None or mechanism.task.position != "xyz" or not is_spatial(mechanism.chain):
        return ""
    return f"; where the position decides the heading of the tool, command its {found.value}: Turning.{found.name}"
