"""The choice of the joint that is searched, where no subproblem solves a chain.

With one joint known the others are solved, and one equation is left: the residual of a trial along this joint. For a
commanded point the third coordinate is left; held joints are known anyway. Every rotary joint is tried in turn. The
positions are solved before the rotation, so their equations may hold no more unknown joints than there are equations
(one more where three axes are parallel); a joint that violates this is not tried. Of several suitable joints the one
is taken whose trial has the fewest branches, then the fewest guards, then the fewest operations.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import sympy as sp

from derive.description.mechanism import Branch, Joint, Mechanism, Search, Turning, crossing
from derive.equations.closures.commanded import closure_at
from derive.equations.conditions import with_conditions
from derive.equations.machine_checks import with_checks
from derive.ir.program import Let
from derive.ir.symbols import cosine, names_in, sine
from derive.kinematics.branches.derived import with_named_steps
from derive.kinematics.forward import pose_at_axes
from derive.kinematics.inverse import Inverse, solve_at, solve_pose
from derive.kinematics.refusals.neighbours import fitting_task, what_misses
from derive.kinematics.search.derivations import Searched, solve_both
from derive.kinematics.search.elimination.order import elimination_of
from derive.kinematics.search.guards import guards_of
from derive.kinematics.search.loop.near import NEAR
from derive.kinematics.search.tool_turn import TOOL_TURN, with_tool_turn
from derive.kinematics.search.wave import wave_program
from derive.kinematics.shared_names import refuse_shared_names
from derive.solver.solve import MOST_TERMS
from derive.solver.subproblems.two_slides import leaves_two_slides
from derive.solver.unsolved import Undetermined, Unsolved, with_advice
from derive.work import TooMuchWork, at_most

MOST_SOLUTIONS = 16
"""An arm with six joints has no more solutions for a pose."""
_MOST_TERMS = 4 * MOST_TERMS
"""The work of the trials along all joints."""


@dataclass(frozen=True)
class _Candidate:
    joint: Joint
    trial: Inverse

    @property
    def rank(self) -> tuple[int, int, int]:
        """Smaller is better."""
        derivation = self.trial.derivation
        size = sum(int(sp.count_ops(s.value)) for s in derivation.statements if isinstance(s, Let))
        return (len(derivation.determinants), len(guards_of(derivation) or ()), size)


def with_search(mechanism: Mechanism) -> Mechanism:
    """The mechanism with the joint that is searched, if its closure has no closed form. Raises `Unsolved` where no
    joint would do.
    """
    if mechanism.search is not None or mechanism.chain is None:
        return mechanism
    try:
        solve_pose(mechanism)
    except Undetermined:
        raise
    except Unsolved as problem:
        arm = with_tool_turn(mechanism)
        found = _best(arm) if _may_be_searched(arm) else None
        if found is None and (by_elimination := _eliminated(arm)) is not None:
            return by_elimination
        if found is None:
            refusal = type(problem)(with_advice(str(problem), _advice(mechanism)))
            refusal.steps = problem.steps
            raise refusal from None
        return _searched(arm, found)
    return mechanism


def solve_searched(stated: Mechanism, mechanism: Mechanism) -> Searched:
    """A machine solved with its search. Where the residual of the steps is no wave, the joints are eliminated.

    stated: the machine before a search was chosen.
    """
    both = solve_both(mechanism)
    try:
        wave_program(both)
    except Unsolved:
        other = _eliminated(with_tool_turn(stated)) if stated.search is None else None
        if other is None:
            raise
        both = solve_both(other)
    return both


def _eliminated(mechanism: Mechanism) -> Mechanism | None:
    """The mechanism with a search whose other joints are eliminated; None where that is impossible."""
    found = elimination_of(mechanism)
    if found is None:
        return None
    side = crossing("crossing", positive=+1, negative=-1)
    chosen = _with_crossing(mechanism, Search(found.searched, is_eliminated=True), side)
    (last,) = (b for b in chosen.branches if b.is_crossing)
    joint, most = found.searched.name, min(2 * found.degree, MOST_SOLUTIONS)
    note = (
        f"No closed form is known. With {joint} known the other joints follow from linear equations, whose determinant "
        f"vanishes where the arm closes. The inverse looks for these values of {joint}, all around the circle; there "
        f"are at most {most} solutions. The byte {last.name} is the sign of the determinant of the Jacobian. "
        f"{_of_one_branch(joint)}"
    )
    return replace(chosen, notes=(*mechanism.notes, note))


def _with_crossing(mechanism: Mechanism, search: Search, side: Branch) -> Mechanism:
    """The mechanism with its search; its last branch tells the roots apart: `side`, if it states none."""
    own = tuple(b for b in mechanism.branches if b.is_crossing)
    others = tuple(b for b in mechanism.branches if not b.is_crossing)
    last = own or (side,)
    return replace(mechanism, branches=(*others, *last), search=search)


def _best(mechanism: Mechanism) -> _Candidate | None:
    """The best candidate, the first of equals; None where no joint would do."""
    with at_most(_MOST_TERMS):
        return min(_candidates(mechanism), key=lambda c: c.rank, default=None)


def _advice(mechanism: Mechanism) -> str:
    """What would help a machine whose joints are not solved."""
    tried = "a search along one joint does not solve the others" if _may_be_searched(mechanism) else ""
    is_whole = mechanism.task.turning is Turning.FULL
    return "; ".join(filter(None, (what_misses(mechanism), "" if is_whole else fitting_task(mechanism), tried)))


def _may_be_searched(mechanism: Mechanism) -> bool:
    """Whether the pose of the whole flange is commanded, or a point."""
    is_known = mechanism.task.turning in (Turning.FULL, Turning.NONE) and mechanism.task.position == "xyz"
    return mechanism.chain is not None and is_known


def _candidates(mechanism: Mechanism) -> Iterator[_Candidate]:
    for joint in mechanism.solved_joints:
        try:
            if not joint.is_angle or joint.free or not _may_be_solved(mechanism, joint):
                continue
            trial = solve_at(mechanism, joint)
        except (Unsolved, TooMuchWork):
            continue
        if len(trial.derivation.residuals) == 1 and guards_of(trial.derivation) is not None and not _turns_tool(trial):
            yield _Candidate(joint, trial)


def _turns_tool(trial: Inverse) -> bool:
    """Whether a branch of a trial depends on the turn of the tool, which no axis tells."""
    turn = TOOL_TURN.symbol
    names = {turn, cosine(turn), sine(turn)}
    return any(names & names_in(d.value) for d in trial.derivation.determinants)


def _may_be_solved(mechanism: Mechanism, known: Joint) -> bool:
    """Whether, with one joint known, the equations of the positions hold no more unknown joints than there are
    equations; one more of three parallel joints, since the rotation tells their sum. Or whether the rotation gives all
    turns, and two slides are left.
    """
    closure = closure_at(mechanism, known)
    moving = [j for j in mechanism.solved_joints if j != known]
    turning = sum(j.is_angle for j in moving)
    if closure.turns and leaves_two_slides(turning, len(moving) - turning):
        return True
    unknown = [j.symbol for j in moving]
    read = [names_in(e.expression) for e in closure.equations]
    present = [u for u in unknown if any(names & {u, cosine(u), sine(u)} for names in read)]
    are_parallel = any(len(turn.amount.free_symbols & set(unknown)) > 2 for turn in closure.turns)
    return len(present) <= len(read) + are_parallel


def _searched(mechanism: Mechanism, found: _Candidate) -> Mechanism:
    """The mechanism with its search; its last branch is the sign of the slope at a root."""
    forward, trial = pose_at_axes(mechanism), found.trial
    refuse_shared_names(mechanism, (*forward.statements, *trial.naming, *trial.derivation.statements))
    side = crossing("crossing", rising=+1, falling=-1)
    named = with_named_steps(_with_crossing(mechanism, Search(found.joint), side), trial, forward)
    noted = replace(named, notes=(*mechanism.notes, _note(named, found)))
    return with_conditions(with_checks(noted, trial.checks), trial.derivation.conditions)


def _note(mechanism: Mechanism, found: _Candidate) -> str:
    """The note about the root search for users."""
    (last,) = (b for b in mechanism.branches if b.is_crossing)
    joint = found.joint.name
    first = (
        f"No closed form is known: with {joint} known the other joints are solved, and one equation is left. The "
        f"inverse looks for its roots along {joint}, all around the circle."
    )
    return (
        f"{first} The byte {last.name} tells whether the residual rises or falls with {joint} at the root. "
        f"{_of_one_branch(joint)}"
    )


def _of_one_branch(joint: str) -> str:
    """Which solution of a branch is the answer, for users."""
    return (
        "Of the solutions of one branch the answer is the one next to the reference, if all axes together are less "
        f"than {np.degrees(float(NEAR)):.1f} degrees away; else the one whose {joint} is nearest to the reference."
    )
