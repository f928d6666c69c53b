"""What is solved of a machine before programs are made of it: the order of the preparations stands here alone.

The build makes its programs from it and keeps it; the report, its pictures and `explain` read it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from derive.description.mechanism import Mechanism
from derive.equations.conditions import with_conditions
from derive.equations.problem import Conditioning
from derive.form.machine import in_form
from derive.kinematics.branches.assembly import Assembled, assembled, with_derived_assembly
from derive.kinematics.branches.assignment import Assignment, assign
from derive.kinematics.branches.derived import with_derived_branches
from derive.kinematics.forward import pose_at_axes
from derive.kinematics.inverse import Inverse, solve_pose
from derive.kinematics.margins import Factor, factor_of
from derive.kinematics.refusals.number_of_joints import check_joints
from derive.kinematics.scan.choice import with_search
from derive.kinematics.scan.derivations import Scanned, solve_both
from derive.kinematics.shared_names import refuse_names_of_joints, refuse_shared_names
from derive.plate.passive import GUIDES, guides_determinant
from derive.plate.plate import check_home
from derive.plate.stated_rods import with_fixed_point, with_positive_lengths, with_stated_rods


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
        if self.mechanism.passive:
            found.append(Factor(GUIDES, guides_determinant(self.mechanism)))
        if self.closed.margin is not None:
            found.append(Factor(self.closed.name, self.closed.margin))
        return tuple(found)


Solution = Solved | Scanned


def prepared(mechanism: Mechanism, further: Mapping[str, int] | None = None) -> Mechanism:
    """The mechanism as it is derived: in its one form, with its rods recognised, whose lengths are positive."""
    mechanism = in_form(mechanism, further)
    check_joints(mechanism)
    return with_positive_lengths(with_stated_rods(with_fixed_point(mechanism)))


def solve_machine(mechanism: Mechanism) -> Solution:
    """Solve a prepared mechanism. Raises `Unsolved` or `DescriptionError`."""
    if mechanism.is_platform:
        check_home(mechanism)
    refuse_names_of_joints(mechanism)
    mechanism = with_search(mechanism)
    if mechanism.search is not None:
        return solve_both(mechanism)
    mechanism = with_derived_assembly(mechanism)
    closed = assembled(mechanism, pose_at_axes(mechanism))
    inverse = solve_pose(mechanism)
    mechanism = with_conditions(mechanism, inverse.derivation.conditions)
    refuse_shared_names(mechanism, (*closed.forward.statements, *inverse.naming, *inverse.derivation.statements))
    mechanism = with_derived_branches(mechanism, inverse, closed.forward)
    return Solved(mechanism, closed, inverse, assign(mechanism, inverse, closed.forward))
