"""All branches of the inverse in one straight line, for trusted input, as languages print it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.ir.passes import without_reasons
from derive.ir.program import Let, Program
from derive.ir.symbols import Sign, branch_sign, symbols_of
from derive.kept import kept_by_identity
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.lost_digits.doubts import without_meeting
from derive.lowering.passes import ANY_TURN, NOTHING, STRAIGHT_LINE, TRUSTED, Given, applied, lowered
from derive.lowering.unrolling import is_straight
from derive.optimize.without_periods import turns_that_count


@dataclass(frozen=True)
class EveryBranch:
    """The program of all branches, and the bindings of its constants."""

    program: Program
    """Its outputs are the axes of every slot on any turn, and the refusal of the slot; where digits may be lost it has
    no answer."""
    parts: tuple[Let, ...]
    counted: frozenset[sp.Symbol]
    """The axes whose turn is already chosen, because another axis moves with it."""


def can_be_unrolled(kin: Kinematics) -> bool:
    """Whether the inverse is a straight line for every branch."""
    return is_straight(without_meeting(kin.branch)) and is_straight(kin.limits)


def is_unrolled(kin: Kinematics) -> bool:
    """Whether all its branches stand in one straight line: a machine without branches has one by itself."""
    return bool(kin.branches) and can_be_unrolled(kin)


def has_doubts(kin: Kinematics) -> bool:
    """Whether the straight line has no answer where digits may be lost."""
    return can_be_unrolled(kin) and not is_straight(kin.branch)


def without_doubts(kin: Kinematics) -> Kinematics:
    """The kinematics whose branch has no answer where digits may be lost, and refuses without a reason."""
    return replace(kin, branch=without_reasons(without_meeting(kin.derived_branch)))


def signs(kin: Kinematics) -> tuple[Sign, ...]:
    """The branch signs, with the names of the two branches."""
    return tuple(Sign(branch_sign(b.name), b.names) for b in kin.branches)


def trusted(kin: Kinematics) -> Program:
    """One branch for trusted input, before the choice of its turns is removed."""
    return applied(TRUSTED, kin.branch, given_to_branch(kin))


def given_to_branch(kin: Kinematics) -> Given:
    """What passes know of a branch: no turn is commanded."""
    return Given(constants(kin), inputs={joint.turn: sp.Integer(0) for joint in kin.period_joints})


def constants(kin: Kinematics) -> frozenset[str]:
    """The names of the values that the setup computes."""
    return frozenset(o.name for o in kin.setup.outputs)


def known_constants(kin: Kinematics) -> Sequence[Let]:
    """The bindings of constants that are computed from other constants."""
    return [let for let in kin.setup.lets() if let.name.name in constants(kin)]


@dataclass(frozen=True)
class StraightLines:
    """The inverse where no digits are lost, for trusted input and axes on any turn: one program of all branches, one of
    one."""

    trusted: Program
    """One branch before it was lowered, and before the choice of its turns was removed."""
    every: Program
    """The program whose outputs are the axes and the refusal of every slot."""
    one: Program
    parts: tuple[Let, ...]
    """The bindings of the constants that both programs read."""


@kept_by_identity(10)
def straight_lines(kin: Kinematics) -> StraightLines:
    """Both programs, lowered together: C takes one of them, Python both."""
    one = trusted(without_doubts(kin))
    program = applied(ANY_TURN, one, NOTHING)
    (every, single), parts = lowered(
        [replace(program, name="branches"), replace(program, name="branch")],
        constants(kin),
        STRAIGHT_LINE,
        branches={"branches": signs(kin)},
        known=known_constants(kin),
    )
    return StraightLines(one, every, single, parts)


def every_branch(kin: Kinematics, name: str) -> EveryBranch:
    """All branches of a machine that is unrolled, as one program of this name."""
    found = straight_lines(kin)
    program = replace(found.every, name=name)
    return EveryBranch(program, read_of(found.parts, program), turns_that_count(found.trusted))


def read_of(parts: Sequence[Let], program: Program) -> tuple[Let, ...]:
    """The parts that a program reads, directly or through other parts."""
    wanted, found = set(program.inputs), list[Let]()
    for part in reversed(parts):
        if part.name in wanted:
            wanted |= symbols_of(part.value)
            found.insert(0, part)
    return tuple(found)
