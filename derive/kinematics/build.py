"""The build: from a description to all programs of a mechanism."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.description.amounts import almost_right_angles
from derive.description.mechanism import DescriptionError, Mechanism, Turning
from derive.equations.axes import Forward, finite
from derive.equations.limits import limits_program
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.program import Let, Output, Program, Statement
from derive.ir.symbols import OFFSET, real
from derive.kinematics.bias import bias_programs
from derive.kinematics.branches.assembly import Assembled, assembly_checks, bound_checks, mirror_checks
from derive.kinematics.branches.assignment import Assignment, assign, margin_lets, with_branch_signs
from derive.kinematics.bundle import bundle_of
from derive.kinematics.coupling import coupling_programs
from derive.kinematics.differential import jacobian_program, twist_program
from derive.kinematics.flange_rotation import image_program, needs_twist, projection_program
from derive.kinematics.forward import at_point, derivation_at_axes, forward_program, orientation_program
from derive.kinematics.inverse import Inverse, inverse_program, solve_offset
from derive.kinematics.kinematics import Kinematics, Margin
from derive.kinematics.lost_digits.doubts import meeting, with_doubts
from derive.kinematics.lost_digits.machine import Machine
from derive.kinematics.margins import samples_anywhere, singularity_program
from derive.kinematics.measured.programs import Measured, measured_programs
from derive.kinematics.parameters import machine_parameters, setup_program
from derive.kinematics.refusals.no_pose import near_home
from derive.kinematics.sampling import sample_machine, with_share
from derive.kinematics.search.derivations import Searched, from_joints, trial_on_branch
from derive.kinematics.search.inverse import branch_statements, search_given
from derive.kinematics.search.margins import DETERMINANT, determinant_margin, margin_statements
from derive.kinematics.search.programs import GOAL
from derive.kinematics.shared_names import SharedName, refuse_names, refuse_shared_names, with_free_names
from derive.kinematics.solution import Solved, prepared, solve_machine
from derive.plate.newton import found_again
from derive.plate.tension import tension_checks
from derive.plate.turning import joints_at_home
from derive.solver.unsolved import Unsolved


def build(mechanism: Mechanism) -> Kinematics:
    """Derive all programs of a mechanism. Raises `Unsolved` or `DescriptionError` if they cannot be derived."""
    warning = almost_right_angles(mechanism)
    try:
        noted = replace(mechanism, notes=(*mechanism.notes, f"{warning}.")) if warning else mechanism
        if noted.nominal:  # the drawing is derived; its deviations are inputs
            noted = replace(noted, chain=noted.nominal.chain, drawn=noted.nominal.drawn, joints=noted.nominal.joints)
        found = with_free_names(noted, lambda further: replace(_built(prepared(noted, further)), further=dict(further)))
        return with_share(found)
    except (Unsolved, DescriptionError) as problem:
        if warning:
            raise type(problem)(f"{problem}; {warning}") from None
        raise


def _built(mechanism: Mechanism) -> Kinematics:
    solution = solve_machine(mechanism)
    if mechanism.nominal and isinstance(solution, Searched):
        raise DescriptionError("an arm whose joint is searched for roots has no programs with deviations yet")
    return _searched_form(solution) if isinstance(solution, Searched) else _closed_form(solution)


def _closed_form(solved: Solved) -> Kinematics:
    """The programs of a machine with a closed form."""
    mechanism, closed, inverse, assignments = solved.mechanism, solved.closed, solved.inverse, solved.assignments
    forward = closed.forward
    at_axes = derivation_at_axes(mechanism, inverse, forward)
    margins = margin_lets(mechanism, assignments)
    jacobian = jacobian_program(mechanism, forward)
    machine = Machine(mechanism, inverse, assignments, at_axes)
    statements, doubts = with_doubts(machine, with_branch_signs(inverse.derivation.statements, assignments))
    at_home = joints_at_home(mechanism, statements) if mechanism.is_platform else ()
    at_poses = _samples(mechanism, inverse, at_home, jacobian)
    singularity, kept = singularity_program(mechanism, at_axes, solved.factors, jacobian, at_poses)
    forward_only = replace(forward, statements=at_axes)
    last = _last(mechanism, closed, statements, offset=False)
    again = found_again(mechanism) if mechanism.is_platform else ()
    branch = inverse_program("branch", mechanism, inverse, statements, last, again)
    programs = [
        forward_program(mechanism, forward_only, margins),
        orientation_program(forward),
        branch if mechanism.nominal else meeting(machine, branch, doubts),
        limits_program(mechanism),
        singularity,
        jacobian,
        image_program(mechanism),
    ]
    programs += _further_programs(mechanism, closed, inverse)
    if mechanism.nominal:
        programs = measured_programs(Measured(mechanism, machine, forward_only, margins, doubts), programs)
    programs += bias_programs(mechanism, programs, forward)
    return bundle_of(solved, programs, kept, at_home)


def _further_programs(mechanism: Mechanism, closed: Assembled, inverse: Inverse) -> list[Program]:
    """The programs that only some mechanisms have."""
    programs = []
    if mechanism.task.turning is not Turning.NONE:
        programs.append(projection_program(mechanism))
    if needs_twist(mechanism):
        programs.append(twist_program(mechanism, closed.forward))
    if mechanism.is_orientation:
        programs += coupling_programs(mechanism)
    elif mechanism.offers_points:
        programs += _offset_programs(mechanism, closed, inverse.derivation.conditions)
    return programs


def _samples(
    mechanism: Mechanism, inverse: Inverse, at_home: Sequence[Statement], jacobian: Program
) -> dict[str, NDArray[np.float64]]:
    """Poses at which the exponents of margins are found."""
    if not mechanism.is_platform:
        return samples_anywhere(mechanism, jacobian)
    samples = near_home(mechanism, inverse.known, inverse.signs, sample_machine(mechanism, 11), 12)
    constants, _ = run(setup_program(mechanism, machine_parameters(mechanism), at_home=at_home), samples)
    return samples | constants


def _searched_form(both: Searched) -> Kinematics:
    """The programs of a chain that has no closed form, or has one only where a parameter is zero: one joint is
    searched, and the determinant of the Jacobian is the margin.
    """
    mechanism = both.mechanism
    tried = () if both.eliminated else trial_on_branch(both).statements
    refuse_names(mechanism, (*GOAL.values(), *(s.name for s in tried)))
    refuse_shared_names(mechanism, branch_statements(both))
    statements, margins = margin_statements(both)
    determinant, scaled = determinant_margin(both)
    margin = Let(real(f"margin_{DETERMINANT.name}"), scaled)
    programs = [
        forward_program(mechanism, replace(both.forward, statements=statements), margins),
        orientation_program(both.forward),
        inverse_program("branch", mechanism, both.closed or both.trial, branch_statements(both)),
        search_given(both),
        from_joints(mechanism),
        limits_program(mechanism),
        normalise(
            "singularity", (*both.forward.statements, *determinant, margin), [Output(DETERMINANT.name, margin.name)]
        ),
        jacobian_program(mechanism, both.forward),
        image_program(mechanism),
        projection_program(mechanism),
        *([twist_program(mechanism, both.forward)] if needs_twist(mechanism) else []),
    ]
    programs += bias_programs(mechanism, programs, both.forward)
    finished = bundle_of(both, programs, (Margin(DETERMINANT.name, 1, "type 1"),))
    return replace(finished, tried_branches=len(both.trial_branches))


def _last(
    mechanism: Mechanism, closed: Assembled, statements: tuple[Statement, ...], *, offset: bool
) -> tuple[Statement, ...]:
    """The checks of a solution of the inverse, besides the closure."""
    closure = (*assembly_checks(mechanism, closed, statements, offset), *bound_checks(mechanism, offset))
    closure += tension_checks(mechanism, offset)
    return (*mirror_checks(mechanism, statements), *closure)


def _offset_programs(mechanism: Mechanism, closed: Assembled, conditions: tuple[sp.Expr, ...]) -> list[Program]:
    """The programs for a point off the flange. They may not put further conditions on the machine: where they do, there
    are none, or the description is refused if it asks for them.
    """
    forward = closed.forward
    try:
        inverse = solve_offset(mechanism)
        refuse_shared_names(mechanism, (*inverse.naming, *inverse.derivation.statements))
        assignments = assign(mechanism, inverse, forward, optional_zero=bool(inverse.frozen))
        if further := [c for c in inverse.derivation.conditions if c not in conditions]:
            raise DescriptionError(f"{further[0]} must not vanish, which the pose does not need")
    except SharedName:
        raise
    except (Unsolved, DescriptionError) as problem:
        if mechanism.offset_interface is None:
            return []
        raise type(problem)(
            f"with offset_interface=False it could be built, but for a point off the flange {problem}"
        ) from None
    at_axes = derivation_at_axes(mechanism, inverse, at_point(forward))
    machine = Machine(mechanism, inverse, assignments, at_axes, is_point=True)
    statements, doubts = with_doubts(machine, with_branch_signs(inverse.derivation.statements, assignments))
    last = _last(mechanism, closed, statements, offset=True)
    return [
        meeting(machine, inverse_program("offset_branch", mechanism, inverse, statements, last), doubts),
        _offset_configuration(mechanism, inverse, forward, assignments),
    ]


def _offset_configuration(
    mechanism: Mechanism, inverse: Inverse, forward: Forward, assignments: tuple[Assignment, ...]
) -> Program:
    margins = margin_lets(mechanism, assignments)
    outputs = [Output(m.name.name, m.name) for m in margins]
    known = derivation_at_axes(mechanism, inverse, at_point(forward))
    draft = normalise("offset_configuration", (*known, *margins), outputs)
    points = [s for s in draft.inputs if s in OFFSET]
    return normalise("offset_configuration", (*finite(points), *draft.body), draft.outputs)
