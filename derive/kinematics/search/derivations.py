"""A mechanism with a root search: closed form where a parameter is zero, a search along one joint where it is not.

Both derivations are parts of one program. Names of the closed form end in `_closed`, names of a trial in `_tried`.
Branches are two-root steps of both derivations, as everywhere. A branch that no step of the trial decides is read off
the root that was found.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import sympy as sp

from derive.description.mechanism import Branch, DescriptionError, Mechanism
from derive.equations.axes import Forward, axis_lets, frozen_lets, held_lets, reference_lets
from derive.equations.closures.fixed_names import fixed_lets
from derive.geometry.frames import Chain
from derive.ir.constants import NEARLY_FREE
from derive.ir.passes import normalise, renamed
from derive.ir.primitives import Root, Select, larger
from derive.ir.program import Let, Output, Program, Require, Statement, rewritten
from derive.ir.symbols import SIDE, TRIED, branch_sign, called, cosine, count, flag, real, sine
from derive.kinematics.branches.assignment import Assignment, assign, refuse_unnamed, steps_and_rest, with_branch_signs
from derive.kinematics.forward import pose_at_axes
from derive.kinematics.inverse import Inverse, of_angle, solve_at, solve_pose, without_steps
from derive.kinematics.search.elimination.equations import Equations, equations_of
from derive.kinematics.search.elimination.order import elimination_of
from derive.kinematics.search.guards import conditions_of, guards_of, least, room_of
from derive.kinematics.search.loop.rounds import elsewhere
from derive.kinematics.search.programs import Trial, trial_of, with_goal
from derive.kinematics.search.slopes import slope_name, with_slopes
from derive.kinematics.search.tool_turn import without_tool_turn
from derive.work import stage

SEARCHED = flag("searched")
_FOLD = sp.Rational(5, 4)
"""Where the room of a step is `1 - c^2`, the root of 1/4 + c^2 is treated as a length: it is shortest where the step is
furthest from its folds, and turns by a sixth up to c = 0.85.
"""


@dataclass(frozen=True)
class Searched:
    """Both derivations of a mechanism with a root search, and the branches of their steps."""

    arm: Mechanism
    """The mechanism, with the turn of its tool as a joint where that is not commanded."""
    forward: Forward
    closed: Inverse | None
    """None where no parameter leads to a closed form."""
    closed_branches: tuple[Assignment, ...]
    trial: Inverse
    trial_branches: tuple[Assignment, ...]
    asked: tuple[Branch, ...]
    """The branches that no step of a trial decides."""
    eliminated: Equations | None = None
    """How the other joints follow from the searched one, where no steps solve them; `trial` has none then."""

    @cached_property
    def mechanism(self) -> Mechanism:
        """The mechanism as it is described."""
        return without_tool_turn(self.arm)


@stage("the root search")
def solve_both(mechanism: Mechanism) -> Searched:
    """Solve the closure without the parameter that needs a search, and with the searched joint known."""
    assert mechanism.search is not None
    forward = pose_at_axes(mechanism)
    if mechanism.search.is_eliminated:
        return _by_elimination(mechanism, forward)
    closed, closed_branches = _in_closed_form(mechanism)
    trial = solve_at(mechanism, mechanism.search.joint)
    if (left := len(trial.derivation.residuals)) != 1:
        raise DescriptionError(f"with {mechanism.search.joint.name} known, {left} conditions are left, not one")
    if guards_of(trial.derivation) is None:
        raise DescriptionError(
            f"a trial along {mechanism.search.joint.name} may be out of reach in its two-root steps only"
        )
    found, asked, unnamed = steps_and_rest(mechanism, trial, forward)
    refuse_unnamed(unnamed)
    return Searched(mechanism, forward, closed, closed_branches, trial, found, asked)


def _by_elimination(mechanism: Mechanism, forward: Forward) -> Searched:
    """A trial without steps, and the elimination that takes their place."""
    assert mechanism.search is not None
    elimination = elimination_of(mechanism, mechanism.search.joint)
    if elimination is None:
        raise DescriptionError(f"with {mechanism.search.joint.name} known, the other joints are not eliminated")
    trial = without_steps(mechanism, mechanism.search.joint)
    _, asked, _ = steps_and_rest(mechanism, trial, forward)
    return Searched(mechanism, forward, None, (), trial, (), asked, equations_of(mechanism, elimination))


def _in_closed_form(mechanism: Mechanism) -> tuple[Inverse | None, tuple[Assignment, ...]]:
    """The closed form of the mechanism with its parameter zero, and its branches."""
    if mechanism.search is None or mechanism.search.where is None:
        return None, ()
    simple = without_search(mechanism)
    closed = solve_pose(simple)
    return closed, assign(simple, closed, pose_at_axes(simple))


def without_search(mechanism: Mechanism) -> Mechanism:
    """The mechanism with its parameter zero, which has a closed form."""
    assert mechanism.search is not None and mechanism.search.where is not None and mechanism.chain is not None
    gone = {mechanism.search.where.symbol: sp.Integer(0)}
    factors = (replace(f, amount=f.amount.xreplace(gone)) for f in mechanism.chain.factors)
    branches = tuple(replace(b, indicator=b.indicator.subs(gone)) for b in mechanism.branches if not b.is_crossing)
    chain = Chain(tuple(f for f in factors if f.amount != 0))
    return replace(mechanism, chain=chain, branches=branches, search=None)


def searched_flag(both: Searched) -> tuple[Let, ...]:
    """The flag that the parameter is not zero; none where there is no closed form."""
    search = both.arm.search
    if search is None or search.where is None:
        return ()
    return (Let(SEARCHED, sp.Gt(sp.Abs(search.where.symbol), 0), f"whether to search along {search.joint.name}"),)


def naming_of(both: Searched) -> tuple[Statement, ...]:
    """The statements in front of the derivation."""
    return both.trial.naming if both.closed is None else both.closed.naming


def from_joints(mechanism: Mechanism) -> Program:
    """The axis values of known joints."""
    known = {j.symbol for j in mechanism.joints}
    solved = [of_angle(let, j, known) for j in mechanism.solved_joints for let in axis_lets(j)]
    kept = [s for j in mechanism.held_joints for s in (*reference_lets(mechanism), *frozen_lets(j))]
    lets = [s for s in (*kept, *solved) if s.name not in known]
    return normalise("from_joints", lets, [Output(j.axis.name, j.axis) for j in mechanism.joints])


def trial_on_branch(both: Searched) -> Trial:
    """One trial on the wanted branch; SIDE = -1 takes the other solution of its two-root step."""
    first, solved = _statements(both)
    kept = tuple(rewritten(s, lambda e: e.xreplace(elsewhere(both.arm))) for s in solved)
    return _trial(both, *_sides(both, first, kept), kept)


def trial_of_all_signs(both: Searched) -> Trial:
    """A trial whose signs are all positive."""
    first, solved = _statements(both)
    return _trial(both, tuple(first), {a.sigma: sp.Integer(1) for a in both.trial_branches}, solved)


def _statements(both: Searched) -> tuple[list[Let], tuple[Statement, ...]]:
    """What a trial knows, and the statements that solve it."""
    mechanism = both.arm
    assert mechanism.search is not None
    joint = mechanism.search.joint.symbol
    own = (Let(cosine(joint), sp.cos(TRIED)), Let(sine(joint), sp.sin(TRIED)))
    held = (let for j in mechanism.held_joints for let in held_lets(j))
    known = [*fixed_lets(mechanism), *own, *held, *both.trial.closure.lets]
    return known, with_branch_signs(both.trial.derivation.statements, both.trial_branches)


def _trial(
    both: Searched, first: Sequence[Let], signs: Mapping[sp.Symbol, sp.Expr], solved: Sequence[Statement]
) -> Trial:
    derivation = both.trial.derivation
    left = Let(real("residual"), derivation.residuals[0])
    turning = [m for m in derivation.conditionings if m.angle not in derivation.wrist]
    values = [m.value for m in turning]
    keeps = Let(flag("keeps"), sp.Or(*(sp.Le(sp.Abs(m.value), NEARLY_FREE * m.scale) for m in turning)))
    rooms = [room_of(c) for c in conditions_of(solved)]
    values += [Root(larger(_FOLD - room, sp.Integer(0))) for room in rooms]
    lengths = [Let(real(f"turning_length_{k}"), value) for k, value in enumerate(values, 1)]
    room = Let(real("room"), least(rooms) if rooms else sp.Integer(1))
    statements = with_goal(named_apart((*first, *solved, left, *lengths, keeps, room), "tried"))
    signed = tuple(rewritten(s, lambda e: e.xreplace(signs)) for s in statements)
    left_over, *short = (real(f"{let.name.name}_tried") for let in (left, *lengths))
    return trial_of(signed, left_over, short, real("room_tried"), flag("keeps_tried"))


def _sides(
    both: Searched, first: Sequence[Let], solved: Sequence[Statement]
) -> tuple[tuple[Let, ...], dict[sp.Symbol, sp.Expr]]:
    """The signs of the steps, by those that are wanted and the side of the trial, and the statements that they read.

    The side is that of the step which, with the wanted signs, comes first to the end of its reach.
    """
    guards = guards_of(both.trial.derivation) or ()
    signs = {a.sigma: wanted(a.branch) for a in both.trial_branches}
    steps = {a.determinant.step: a for a in both.trial_branches}
    if len(guards) < 2:
        return tuple(first), signs | {steps[g.step].sigma: wanted(steps[g.step].branch) * SIDE for g in guards}
    rooms = [real(f"room_of_{g.step.name}") for g in guards]
    statements = list(_with_rooms(first, [rewritten(s, lambda e: e.xreplace(signs)) for s in solved], rooms))
    bound = {s.name for s in statements if isinstance(s, Let)}
    rates = {r: sp.Abs(slope_name(r)) if slope_name(r) in bound else sp.Integer(0) for r in rooms}
    for guard, room in zip(guards, rooms, strict=True):
        is_first, others = flag(f"first_is_{guard.step.name}"), [r for r in rooms if r != room]
        statements.append(Let(is_first, sp.And(*[sp.Le(room * rates[r], r * rates[room]) for r in others])))
        folding = steps[guard.step]
        signs[folding.sigma] = wanted(folding.branch) * Select(_tried(is_first), SIDE, sp.Integer(1))
    return tuple(s for s in statements if isinstance(s, Let)), signs


def _with_rooms(first: Sequence[Let], solved: Sequence[Statement], rooms: Sequence[sp.Symbol]) -> Iterator[Statement]:
    """The statements up to the last guard, and the rooms of all guards, with their slopes."""
    last = max(k for k, s in enumerate(solved) if isinstance(s, Require))
    before = named_apart(solved[: last + 1], "wanted")
    lets = [Let(name, room_of(c)) for name, c in zip(rooms, conditions_of(before), strict=True)]
    yield from with_slopes([*first, *(s for s in before if isinstance(s, Let)), *lets], TRIED)


def _tried(name: sp.Symbol) -> sp.Symbol:
    """The name in a trial."""
    return called(f"{name.name}_tried", name)


def sigma(branch: Branch) -> sp.Symbol:
    """The sign of a branch."""
    return branch_sign(branch.name)


def wanted(branch: Branch) -> sp.Symbol:
    """The sign of a branch as an argument of the search."""
    return count(f"wanted_{branch.name}")


def named_apart(statements: Iterable[Statement], word: str, own: Container[sp.Symbol] = ()) -> tuple[Statement, ...]:
    """The statements with the word appended to every name that they bind, except `own` names."""
    kept = list(statements)
    table = {n: n if n in own else called(f"{n.name}_{word}", n) for s in kept for n in s.bound()}
    return tuple(renamed(rewritten(s, lambda e: e.xreplace(table)), lambda n: table[n]) for s in kept)
