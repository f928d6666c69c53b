"""Branch assignment: a branch belongs to the two-root step whose determinant has the sign of the branch's indicator."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import sympy as sp

from derive.algebra.normal_form import cancelled, reduce_units
from derive.description.mechanism import Branch, DescriptionError, Mechanism
from derive.equations.axes import Forward
from derive.equations.closures.fixed_names import all_angles, with_fixed_names
from derive.equations.problem import StepDeterminant
from derive.equations.trigonometry import named_trigonometry
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import ToReal
from derive.ir.program import Let, Output, Statement, Status, rewritten
from derive.ir.symbols import branch_sign, real
from derive.kinematics.forward import derivation_at_axes
from derive.kinematics.inverse import Inverse
from derive.kinematics.refusals.no_pose import near_home, why_no_pose
from derive.kinematics.sampling import possible_axes, sample_machine
from derive.plate.turning import given_pose
from derive.work import stage

_SAMPLES = 64
_SAME = 1e-9
"""Ratios that differ by less than this share are equal."""


@dataclass(frozen=True)
class Assignment:
    """A branch, the determinant of the step that decides it, and whether both have the same sign (+1) or
    opposite signs (-1).
    """

    branch: Branch
    determinant: StepDeterminant
    orientation: int

    @property
    def sigma(self) -> sp.Symbol:
        """The sign of the branch, an integer: +1 is byte 1."""
        return branch_sign(self.branch.name)

    @property
    def factor(self) -> sp.Symbol:
        """The sign of the branch as a real number, for products."""
        return real(f"sign_{self.branch.name}")

    def margin(self, mechanism: Mechanism) -> sp.Expr:
        """The determinant over its scale, with the sign of the branch: positive is byte 1."""
        value = cancelled(self.orientation * self.determinant.value / self.determinant.scale)
        return reduce_units(value, all_angles(mechanism)) if value.is_polynomial() else value


@stage("the signs of the branches")
def assign(
    mechanism: Mechanism, inverse: Inverse, forward: Forward, optional_zero: bool = False
) -> tuple[Assignment, ...]:
    """Find the step of every branch. Raises `DescriptionError` if there is not exactly one.

    optional_zero: compare on a machine without its optional lengths. The steps of the offset problem correspond to the
    branches of the machine only where the point is the flange itself.
    """
    found, unnamed = _assigned(mechanism, inverse, forward, optional_zero)
    refuse_unnamed(unnamed)
    return found


def refuse_unnamed(steps: Sequence[StepDeterminant]) -> None:
    """Refuse steps with two solutions that no branch names."""
    if steps:
        names = ", ".join(s.step.name for s in steps)
        raise DescriptionError(
            f"no branch names the two solutions for {names}: state one for each, by a quantity whose sign tells them "
            "apart, or exclude one by a quantity in positive="
        )


def _assigned(
    mechanism: Mechanism, inverse: Inverse, forward: Forward, optional_zero: bool
) -> tuple[tuple[Assignment, ...], tuple[StepDeterminant, ...]]:
    """The step of every branch, and the steps that no branch names."""
    determinants = inverse.derivation.determinants
    if not determinants and not mechanism.branches:
        return (), ()
    sampled, indicators = _sampled(mechanism, inverse, forward, optional_zero)
    found: list[Assignment] = []
    for branch, indicator in zip(mechanism.branches, indicators, strict=True):
        steps = _steps_of(branch, indicator, determinants, sampled)
        if len(steps) != 1:
            raise DescriptionError(
                f"branch {branch.name!r}: its indicator agrees with {len(steps)} steps, not one: its sign must change "
                f"where two solutions meet, {_met(determinants)}"
            )
        first = next((a.branch.name for a in found if a.determinant == steps[0][0]), None)
        if first is not None:
            raise DescriptionError(f"branches {first!r} and {branch.name!r} name the same two solutions")
        found.append(Assignment(branch, *steps[0]))
    unnamed = tuple(s for s in determinants if s not in [a.determinant for a in found])
    return tuple(found), unnamed


def _steps_of(
    branch: Branch, indicator: np.ndarray, determinants: Sequence[StepDeterminant], sampled: Sequence[np.ndarray]
) -> list[tuple[StepDeterminant, int]]:
    """The steps whose determinants have the sign of an indicator, or the opposite one. Several steps may agree.

    If the assembly of a loop is the reason, the indicator means the step whose unknown it reads. If long links are the
    reason, it means the step to whose determinant it is proportional.
    """
    agreeing = [
        (s, o, row)
        for s, row in zip(determinants, sampled, strict=True)
        for o in (1, -1)
        if np.all(o * np.sign(row) == np.sign(indicator))
    ]
    found = [(s, o) for s, o, _ in agreeing]
    own = [(s, o) for s, o in found if s.step in branch.indicator.free_symbols]
    same = [(s, o) for s, o, row in agreeing if _are_multiples(row, indicator)]
    return next((few for few in (same, own) if len(few) == 1), found) if len(found) > 1 else found


def _are_multiples(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two quantities have the same ratio at all samples."""
    return bool(np.abs(one * other[0] - one[0] * other).max() <= _SAME * np.abs(one * other[0]).max())


def _met(determinants: Sequence[StepDeterminant]) -> str:
    """The unknowns with two solutions, in words."""
    if not determinants:
        return "and this machine has one solution alone"
    return f"those for {', '.join(s.step.name for s in determinants)}"


def steps_and_rest(
    mechanism: Mechanism, inverse: Inverse, forward: Forward
) -> tuple[tuple[Assignment, ...], tuple[Branch, ...], tuple[StepDeterminant, ...]]:
    """The assignments of the branches that a step decides, the branches that no step decides, and the steps that no
    branch names.
    """
    branches = tuple(b for b in mechanism.branches if not b.is_crossing)
    named = replace(mechanism, branches=branches)
    sampled, indicators = _sampled(named, inverse, forward, False)
    decided = tuple(
        b
        for b, row in zip(branches, indicators, strict=True)
        if any(np.all(o * np.sign(s) == np.sign(row)) for s in sampled for o in (1, -1))
    )
    found, unnamed = _assigned(replace(mechanism, branches=decided), inverse, forward, False)
    return found, tuple(b for b in branches if b not in decided), unnamed


def steps_without_branch(mechanism: Mechanism, inverse: Inverse, forward: Forward) -> tuple[StepDeterminant, ...]:
    """The two-root steps whose determinants have the sign of no indicator."""
    determinants = inverse.derivation.determinants
    if not determinants or not mechanism.branches:
        return determinants
    sampled, indicators = _sampled(mechanism, inverse, forward, False)
    named = [
        step
        for branch, indicator in zip(mechanism.branches, indicators, strict=True)
        for step, _ in _steps_of(branch, indicator, determinants, sampled)
    ]
    return tuple(step for step in determinants if step not in named)


def _sampled(
    mechanism: Mechanism, inverse: Inverse, forward: Forward, optional_zero: bool
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    lets, indicators = named_trigonometry(
        mechanism, [with_fixed_names(mechanism, b.indicator) * b.signs[0] for b in mechanism.branches]
    )
    determinants = [s.value for s in inverse.derivation.determinants]
    if mechanism.is_platform:
        forward = given_pose(mechanism)
    named = [Let(real(f"sign_{k}"), v) for k, v in enumerate([*determinants, *indicators])]
    statements = (*derivation_at_axes(mechanism, inverse, forward), *lets, *named)
    program = normalise("signs", statements, [Output(n.name.name, n.name) for n in named])
    machine = sample_machine(mechanism, 21, optional_zero)
    if mechanism.is_platform:
        samples = near_home(mechanism, inverse.known, inverse.signs, machine, 22)
    else:
        machine |= {f"point_{c}": np.asarray(0.0) for c in "xyz"}
        samples = possible_axes(mechanism, machine, _SAMPLES, 22, program)
    count = max(v.size for v in samples.values())
    values, status = run(program, samples)
    good = np.broadcast_to(status == Status.OK, (count,))
    if not good.any():
        raise DescriptionError(why_no_pose(mechanism))
    rows = [np.broadcast_to(values[n.name.name], (count,))[good] for n in named]
    return rows[: len(determinants)], rows[len(determinants) :]


def with_branch_signs(statements: Sequence[Statement], assignments: Sequence[Assignment]) -> tuple[Statement, ...]:
    """The derivation with the sign of every step replaced by that of its branch, converted to a real number here."""
    table = {a.determinant.sigma: a.orientation * a.factor for a in assignments}
    named = ((a, f"{a.branch.name}: +1 {a.branch.names[0]}, -1 {a.branch.names[1]}") for a in assignments)
    signs = (Let(a.factor, ToReal(a.sigma), note) for a, note in named)
    return (*signs, *(rewritten(s, lambda e: e.xreplace(table)) for s in statements))


def margin_lets(mechanism: Mechanism, assignments: Sequence[Assignment]) -> tuple[Let, ...]:
    """`branch_<name>`: the signed margin of every branch."""
    return tuple(Let(real(f"branch_{a.branch.name}"), a.margin(mechanism)) for a in assignments)
