"""The search: one loop, in each pass of which one step is made of what the search is at.

It looks around the circle, from the start to both sides, for parts in which the wave may vanish. In a part there are
starts, on both sides of a step whose roots may join there. From a start the joint is settled on the wanted branch, and
then the whole closure is met. If that leads to another branch, the joints are mirrored about where they began: two
solutions that meet stand on both sides of it. The answer is the root nearest to the start; or the next one ahead of it,
where all are asked for, one after the other. Where joints are eliminated, two solutions may stand at one root, each a
twin of the other: then the answer is the one nearer to the reference, or both are.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.description.mechanism import Mechanism
from derive.equations.axes import reference_value
from derive.ir.constants import BOUNDARY, CONVERGED, COST_OF_A_STALL, PASSES, STALLED
from derive.ir.passes import normalise
from derive.ir.primitives import Select, ToReal, Wrap
from derive.ir.program import Call, Iterate, Let, Output, Program
from derive.ir.symbols import SIDE, TRIED, called, count, flag, real
from derive.kinematics.search.loop import rounds, starts
from derive.kinematics.search.loop.parts import AHEAD_BY, DIRECTION, IS_ROUNDING, SAFE
from derive.kinematics.search.loop.tried import (
    AT,
    BEST_NOW,
    LEAST_NOW,
    ROOM,
    SETTLED,
    better,
    lengths_of,
    newton_is_done,
    newton_step,
    shortest_is_done,
    shortest_step,
    trials_begun,
    trials_go_on,
    turned_by_a_sixth,
)
from derive.kinematics.search.loop.twins import (
    HAS_TWIN,
    TWIN,
    TWO_WAYS,
    is_twin,
    kept,
    kept_now,
    nearer_twin,
    twin,
    twin_now,
    twins_now,
)
from derive.kinematics.search.programs import (
    ERROR,
    FITS,
    FOUND,
    IS_NEWTON,
    LOOKED_FOR,
    SLOW,
    START,
    begun,
    call_with,
    moved_to,
)

FIND_ROOT = "find_root"
"""The name of the program."""
ONWARD = flag("onward")
"""Whether the next root ahead of the start is wanted, not the nearest one."""
AWAY = real("away")
"""How far (radians) the root is away from the start."""
AHEAD = sp.Float("1e-7")
"""The nearest root is the one nearest to a joint that is ahead of the start by this (radians). Where a machine is
symmetric about its start, roots are as far to both sides, and rounding would choose, in every language another one.
The next root ahead is further away than this.
"""
ELSEWHERE = sp.Float("2.5")
"""All roots are found onward from so far ahead of the reference, which may be a root."""
MOST_PASSES = 4000
"""The passes of the search, at most: 30 to 140 at a random pose; of 10,800 poses at random, next to straight wrists
and folded elbows 44 took more than 1,000, and none more than 1,708; an almost spherical wrist on a long arm 1,808.
"""
MOST_WHERE_ELIMINATED, COST_WHERE_ELIMINATED = 4000, 2
"""The same for joints that are eliminated, and what a stall costs: a start may lead to any root, and no sign of a step
tells two that nearly join.
"""
_LOOKING, _SHORTENING, _SETTLING, _MEETING = map(sp.Integer, range(4))
"""What the search is at: it looks for a part, for where a length is shortest, for a joint value, for the closure."""
_STAGE, _PLACE, _WIDTH = count("stage"), real("place"), real("width")
_NUMBER, _SHORTEST, _ASIDE = count("number_of_start"), real("shortest"), real("aside")
_BEFORE, _LEFT, _MIRRORED = real("error_before"), count("steps_left"), flag("was_mirrored")
_NEAREST, _PASSES_LEFT = real("nearest"), count("passes_left")
_SETTLED = tuple(real(f"settled_{k}") for k in range(1, 7))
"""The last joint values of a part, on one side, from which the closure was met."""
FIRST, LONGEST = sp.Float("1e-13"), sp.Rational(1, 2)
"""The width of a part to begin with, and of one that is not widened further: it is followed by another."""
_NEAR = sp.Float("1e-3")
"""In a narrow part steps on the closure begin only where the residual of the branch is at most this."""
_ROOM = sp.Float("1e-6")
"""Where a step has more room, its two roots are too far apart for one to be on the branch of the other."""
_SAME = sp.Float("1e-12")
"""Joint values this near (radians) are the same: from there the closure is met once. In a narrow part none are."""
_MOVED = sp.Float("1e-8")
"""Joints are mirrored if the steps on the closure moved them by more than this (radians and lengths, added)."""
_TURN = 2 * sp.pi
_ZERO, _ONE, _FAR = sp.Integer(0), sp.Integer(1), sp.Integer(9)


@dataclass(frozen=True)
class Steps:
    """The programs of the steps: they look, try a joint value, give all joints there, step, and tell the branch."""

    look: Program
    trial: Program
    joints_at: Program | None
    """None where the trial tells the joints, too: its rate is 0, so that one trial settles."""
    step: Program
    fits: Program


def search_program(mechanism: Mechanism, steps: Steps, arguments: Sequence[sp.Symbol]) -> Program:
    """The search. arguments: those of its steps that do not change in it."""
    assert mechanism.search is not None
    joints, eliminated = [j.symbol for j in mechanism.solved_joints], mechanism.search.is_eliminated
    most = MOST_WHERE_ELIMINATED if eliminated else MOST_PASSES
    lengths, has_rounds = lengths_of(steps.trial), rounds.has_angles(steps.trial)
    body = (
        *_looked(steps.look, arguments),
        *_tried(steps, arguments, lengths),
        *_met(steps, arguments, mechanism, joints),
        *(twins_now(mechanism.solved_joints, _NEAREST - AHEAD, _is_at(_SETTLING), _NEAR) if eliminated else ()),
        *_next_start(lengths, SIDE in steps.trial.inputs, has_twins=eliminated),
        *_ends(has_rounds=has_rounds),
    )
    begin = {_STAGE: _LOOKING, DIRECTION: _ONE, SIDE: _ONE, _NEAREST: _FAR, _PASSES_LEFT: sp.Integer(most)}
    begin |= {_PLACE: Select(ONWARD, AHEAD, _ZERO), _MIRRORED: sp.false, IS_NEWTON: sp.false}
    begin |= dict.fromkeys(_SETTLED, _FAR)
    following = _following(joints, COST_WHERE_ELIMINATED if eliminated else COST_OF_A_STALL)
    if has_rounds:
        begin, following = begin | rounds.BEGUN, following | rounds.FOLLOWING
    if eliminated:
        begin |= {HAS_TWIN: sp.false, TWO_WAYS: sp.false}
        following |= {HAS_TWIN: flag("has_twin_now"), TWO_WAYS: flag("has_two_ways")}
        following |= {twin(j): twin_now(j) for j in joints}
    named = [Let(called(f"{n.name}_next", n), value) for n, value in following.items()]
    is_always = mechanism.search.where is None
    loop = Iterate(
        state=tuple(following),
        start=tuple(begin.get(n, _ZERO) for n in following),
        step=(*body, *named),
        following=tuple(let.name for let in named),
        done=flag("is_over") if is_always else sp.Or(sp.Not(LOOKED_FOR), flag("is_over")),
        limit=most + 1,
        otherwise=None,
        note="one step of the search",
    )
    held: dict[sp.Symbol, sp.Expr] = {j.symbol: reference_value(j) for j in mechanism.held_joints}
    found = {j: Select(flag("takes_twin"), twin_now(j), kept_now(j)) if eliminated else kept_now(j) for j in joints}
    nearest = real("nearest_now")
    outputs = [
        Output(FOUND.name, sp.Lt(nearest, _FAR)),
        Output(AWAY.name, Select(sp.Lt(nearest, _FAR), nearest, _ZERO)),
        *_joints_out("found", mechanism, held | found),
    ]
    if eliminated:
        others = held | {j: twin_now(j) for j in joints}
        outputs += [Output(TWIN, flag("has_twin_now")), *_joints_out(TWIN, mechanism, others)]
    lets = nearer_twin(mechanism.solved_joints, AHEAD, ONWARD) if eliminated else ()
    program = normalise(FIND_ROOT, (loop, *lets), outputs)
    return replace(program, summary="The joints at the root nearest to the start, or next ahead of it")


def _joints_out(word: str, mechanism: Mechanism, values: Mapping[sp.Symbol, sp.Expr]) -> list[Output]:
    return [Output(f"{word}_{j.symbol.name}", values[j.symbol]) for j in mechanism.joints if not j.free]


def _call(
    program: Program, arguments: Sequence[sp.Symbol], given: Mapping[sp.Symbol, sp.Expr], wanted: sp.Basic
) -> Call:
    flags = {IS_ROUNDING.name: IS_ROUNDING, FITS: IS_ROUNDING, rounds.KEEPS.name: rounds.KEEPS}
    return call_with(program, arguments, given, lambda name: called(name, flags.get(name, ERROR)), wanted)


def _is_at(stage: sp.Integer) -> sp.Basic:
    return sp.Eq(_STAGE, stage)


def _looked(look: Program, arguments: Sequence[sp.Symbol]) -> Iterator[Let | Call]:
    """Whether a part, or the way around the circle, ends here."""
    given = {AHEAD_BY: _PLACE + _WIDTH, DIRECTION: DIRECTION}
    yield _call(look, (*arguments, START), given, _is_at(_LOOKING))
    is_part = sp.Gt(_WIDTH, 0)
    ends = sp.Or(sp.Not(IS_ROUNDING), sp.Ge(_WIDTH, LONGEST))
    yield Let(flag("part_ends"), sp.And(_is_at(_LOOKING), is_part, ends))
    # what is further away than the nearest root need not be looked at; one that is a little behind the start is a
    # turn ahead
    whole = Select(ONWARD, _TURN - AHEAD, sp.pi)
    yield Let(real("end_of_way"), Select(sp.Lt(_NEAREST, whole), _NEAREST + Select(ONWARD, -2, 2) * AHEAD, whole))
    yield Let(flag("way_ends"), sp.And(_is_at(_LOOKING), sp.Not(is_part), sp.Ge(_PLACE, real("end_of_way"))))


def _tried(steps: Steps, arguments: Sequence[sp.Symbol], lengths: int) -> Iterator[Let | Call]:
    """A trial, and whether the joint value is settled."""
    direction, ends = ToReal(DIRECTION), (_PLACE, _PLACE + _WIDTH)
    is_trial = sp.Or(_is_at(_SHORTENING), _is_at(_SETTLING))
    has_rounds = rounds.has_angles(steps.trial)
    given = {SIDE: SIDE, rounds.ROUND: rounds.ROUND if has_rounds else _ZERO}
    yield _call(steps.trial, arguments, given | {TRIED: START + direction * AT}, is_trial)
    if has_rounds:
        yield rounds.keeps_now(is_trial)
    chosen = [
        starts.of_length(lengths, _NUMBER, [real(f"{n}_{k}") for k in range(1, 1 + lengths)]) if lengths else _ZERO
        for n in ("length", "growth")
    ]
    yield from better(_is_at(_SHORTENING), chosen[0], sp.Gt(_NUMBER, starts.POINTS))
    yield from newton_step(ends, direction, starts.is_point(_WIDTH))
    yield from shortest_step(ends, direction * chosen[1])
    yield Let(flag("is_shortest"), sp.And(_is_at(_SHORTENING), shortest_is_done()))
    yield Let(real("shortest_now"), Select(flag("is_shortest"), BEST_NOW, _SHORTEST))
    yield Let(real("aside_now"), Select(flag("is_shortest"), turned_by_a_sixth(), _ASIDE))
    yield Let(flag("is_settled"), sp.And(_is_at(_SETTLING), newton_is_done(starts.is_point(_WIDTH))))
    # a simple root leaves no residual on its branch; the other side of a step counts only where its roots join
    leaves_little = sp.Or(sp.Le(LEAST_NOW, _NEAR), *([sp.Gt(rounds.ROUND, 0)] if has_rounds else []))
    is_simple = sp.And(leaves_little, sp.Or(sp.Gt(SIDE, 0), sp.Le(ROOM, _ROOM)))
    yield Let(flag("is_known"), sp.Or(*[sp.Le(sp.Abs(SETTLED - known), _SAME) for known in _SETTLED]))
    narrow = starts.is_narrow(_WIDTH)
    is_new = sp.Or(sp.And(narrow, is_simple), sp.And(sp.Not(narrow), sp.Not(flag("is_known"))))
    yield Let(flag("is_near"), sp.And(flag("is_settled"), is_new))
    if steps.joints_at is None:
        return
    yield _call(steps.joints_at, arguments, given | {TRIED: START + direction * SETTLED}, flag("is_near"))


def _met(
    steps: Steps, arguments: Sequence[sp.Symbol], mechanism: Mechanism, joints: Sequence[sp.Symbol]
) -> Iterator[Let | Call]:
    """A step on the closure; where it is met, whether the joints fit, and are the nearest."""
    assert mechanism.search is not None
    searched, here = mechanism.search.joint.symbol, dict[sp.Symbol, sp.Expr]((j, j) for j in joints)
    yield _call(steps.step, arguments, {**here, IS_NEWTON: IS_NEWTON}, _is_at(_MEETING))
    is_last = sp.Or(sp.Gt(2 * ERROR, _BEFORE), sp.Le(_LEFT, 0))
    ends = sp.Or(sp.Le(ERROR, BOUNDARY / 100), sp.And(sp.Le(ERROR, CONVERGED), is_last), sp.Le(_LEFT, 0))
    yield Let(flag("steps_end"), sp.And(_is_at(_MEETING), ends))
    yield Let(flag("meets_pose"), sp.And(flag("steps_end"), sp.Le(ERROR, CONVERGED)))
    yield _call(steps.fits, arguments, here, flag("meets_pose"))
    ahead = searched - START - AHEAD
    yield Let(real("way_ahead"), Select(ONWARD, Wrap(ahead - sp.pi) + sp.pi + AHEAD, sp.Abs(Wrap(ahead))))
    within = sp.Or(sp.Not(ONWARD), sp.And(sp.Gt(real("way_ahead"), AHEAD), sp.Lt(real("way_ahead"), _TURN - AHEAD)))
    fits = sp.And(flag("meets_pose"), flag(FITS))
    is_new = sp.And(fits, within)
    if mechanism.search.is_eliminated:
        yield Let(flag("is_answer"), is_new)
        yield from is_twin(mechanism.solved_joints, _NEAREST, AHEAD)
        is_new = sp.And(flag("is_answer"), sp.Not(flag("is_twin")))
    yield Let(flag("is_better"), sp.And(is_new, sp.Lt(real("way_ahead"), _NEAREST)))
    yield Let(real("nearest_now"), Select(flag("is_better"), real("way_ahead"), _NEAREST))
    yield Let(real("moved"), sp.Add(*[sp.Abs(j - _begun(j)) for j in joints]))
    has_moved = sp.Gt(real("moved"), _MOVED)
    yield from (Let(kept_now(j), Select(flag("is_better"), j, kept(j))) for j in joints)
    yield Let(flag("mirrors"), sp.And(flag("meets_pose"), sp.Not(flag(FITS)), sp.Not(_MIRRORED), has_moved))


def _next_start(lengths: int, has_sides: bool, *, has_twins: bool) -> Iterator[Let]:
    """The start that follows, if one ends here."""
    is_unsettled = sp.And(flag("is_settled"), sp.Not(flag("is_near")))
    yield Let(flag("start_ends"), sp.Or(is_unsettled, sp.And(flag("steps_end"), sp.Not(flag("mirrors")))))
    yield Let(count("next_number"), starts.next_number(lengths, _NUMBER, _WIDTH))
    lacks_none = sp.Or(sp.Not(flag("has_two_ways")), flag("has_twin_now")) if has_twins else sp.true
    yield Let(flag("is_nearest"), sp.And(sp.Le(real("nearest_now"), _PLACE + 2 * AHEAD), lacks_none))
    is_last = sp.Or(flag("is_nearest"), sp.Eq(count("next_number"), 0))
    has_other = sp.And(sp.Gt(SIDE, 0), sp.Not(flag("is_nearest"))) if has_sides else sp.false
    yield Let(flag("side_ends"), sp.And(flag("start_ends"), is_last, has_other))
    yield Let(flag("part_is_done"), sp.And(flag("start_ends"), is_last, sp.Not(flag("side_ends"))))
    yield Let(flag("is_first"), sp.Or(flag("part_ends"), flag("side_ends")))
    moves_on = Select(flag("start_ends"), count("next_number"), _NUMBER)
    yield Let(count("number_now"), Select(flag("is_first"), _ONE, moves_on))
    yield Let(flag("begins"), sp.And(sp.Or(flag("part_ends"), flag("start_ends")), sp.Not(flag("part_is_done"))))
    of_new_length = starts.is_new_length(lengths, count("number_now")) if lengths else sp.false
    yield Let(flag("seeks_length"), sp.And(flag("begins"), of_new_length))
    ends = (_PLACE, _PLACE + _WIDTH)
    place = starts.place_of(lengths, count("number_now"), ends, real("shortest_now"), real("aside_now"))
    yield Let(real("place_of_start"), Select(flag("seeks_length"), _PLACE, place))


def _ends(*, has_rounds: bool) -> Iterator[Let]:
    """What the search is at in the next pass, and whether it is over."""
    meets = sp.Or(flag("is_near"), flag("mirrors"), sp.And(_is_at(_MEETING), sp.Not(flag("steps_end"))))
    shortens = sp.Or(flag("seeks_length"), sp.And(_is_at(_SHORTENING), sp.Not(flag("is_shortest"))))
    going = sp.And(_is_at(_SETTLING), sp.Not(flag("is_settled")))
    settles = sp.Or(sp.And(flag("begins"), sp.Not(flag("seeks_length"))), flag("is_shortest"), going)
    stage = Select(meets, _MEETING, Select(shortens, _SHORTENING, Select(settles, _SETTLING, _LOOKING)))
    yield Let(count("next_stage"), stage)
    turns_back = sp.And(flag("way_ends"), sp.Not(ONWARD), sp.Gt(DIRECTION, 0))
    yield Let(flag("turns_back"), turns_back)
    is_done = sp.And(flag("way_ends"), sp.Not(flag("turns_back")))
    is_lost = sp.And(is_done, sp.Not(ONWARD), sp.Ge(real("nearest_now"), _FAR))
    yield rounds.goes_round(is_lost) if has_rounds else Let(rounds.GOES_ROUND, sp.false)
    yield Let(flag("begins_anew"), sp.Or(flag("turns_back"), rounds.GOES_ROUND))
    yield Let(flag("is_over"), sp.Or(sp.And(is_done, sp.Not(rounds.GOES_ROUND)), sp.Le(_PASSES_LEFT, 0)))


def _following(joints: Sequence[sp.Symbol], cost_of_a_stall: int) -> dict[sp.Symbol, sp.Expr]:
    """The state in the next pass."""
    looks, passes_by = _is_at(_LOOKING), sp.Gt(_WIDTH, 0)
    wider = Select(passes_by, Select(starts.is_narrow(_WIDTH), 8, 2) * _WIDTH, Select(IS_ROUNDING, FIRST, _ZERO))
    width = Select(flag("part_is_done"), _ZERO, Select(sp.And(looks, sp.Not(flag("part_ends"))), wider, _WIDTH))
    steps = sp.And(looks, sp.Not(passes_by), sp.Not(IS_ROUNDING))
    place = Select(flag("part_is_done"), _PLACE + _WIDTH, Select(steps, _PLACE + SAFE, _PLACE))
    begins = sp.Or(flag("begins"), flag("is_shortest"))
    first, onward = trials_begun(real("place_of_start")), trials_go_on(_is_at(_SHORTENING))
    stalls = sp.Gt(ERROR, STALLED * _BEFORE)
    step = Select(stalls, sp.Integer(cost_of_a_stall), _ONE)
    is_new = sp.Or(flag("is_near"), flag("mirrors"))
    found: dict[sp.Symbol, sp.Expr] = {
        _STAGE: count("next_stage"),
        DIRECTION: Select(flag("turns_back"), sp.Integer(-1), Select(flag("begins_anew"), _ONE, DIRECTION)),
        _PLACE: Select(flag("begins_anew"), _ZERO, place),
        _WIDTH: Select(flag("begins_anew"), _ZERO, width),
        SIDE: Select(flag("part_ends"), _ONE, Select(flag("side_ends"), sp.Integer(-1), SIDE)),
        _NUMBER: count("number_now"),
        _SHORTEST: real("shortest_now"),
        _ASIDE: real("aside_now"),
        _BEFORE: Select(is_new, _FAR, ERROR),
        _LEFT: Select(is_new, sp.Integer(PASSES), _LEFT - step),
        IS_NEWTON: sp.And(*map(sp.Not, (flag("is_near"), flag("mirrors"), IS_NEWTON)), sp.Gt(ERROR, SLOW * _BEFORE)),
        _MIRRORED: sp.And(sp.Not(flag("is_near")), sp.Or(flag("mirrors"), _MIRRORED)),
        _NEAREST: real("nearest_now"),
        _PASSES_LEFT: _PASSES_LEFT - 1,
    }
    found |= {n: Select(begins, first[n], value) for n, value in onward.items()}
    for known, before in zip(_SETTLED, (SETTLED, *_SETTLED), strict=False):
        found[known] = Select(flag("is_first"), _FAR, Select(flag("is_near"), before, known))
    for j in joints:
        mirrored = 2 * _begun(j) - j
        found[j] = Select(flag("is_near"), begun(j), Select(flag("mirrors"), mirrored, moved_to(j)))
        found[_begun(j)] = Select(flag("is_near"), begun(j), _begun(j))
        found[kept(j)] = kept_now(j)
    return found


def _begun(joint: sp.Symbol) -> sp.Symbol:
    return real(f"met_from_{joint.name}")
