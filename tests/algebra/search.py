"""The search: every part of the circle is looked at from each of its starts, and what fits is compared.

The answer is the root nearest to the start; or the next one ahead of it, where all are asked for, one after the other.
From a start the joint is settled on the wanted branch, on both sides of a step whose roots may join there, then the
whole closure is met. If that leads to another branch, the joints are mirrored about the start: two solutions that meet
stand on both sides of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import sympy as sp

from derive.equations.axes import reference_value
from derive.ir.passes import normalise
from derive.ir.primitives import Select, Wrap
from derive.ir.program import Call, Iterate, Let, Output, Program
from derive.ir.symbols import SIDE, TRIED, called, count, flag, real
from derive.kinematics.scan.derivations import Scanned, wanted
from derive.kinematics.scan.margins import DETERMINANT, margins_wanted
from derive.kinematics.scan.programs import FITS, FOUND, GOAL, LOOKED_FOR, START
from tests.algebra.closure import IS_MET, begun, finish_program, joints_program, trial_on_branch
from tests.algebra.parts import AT, END, HIGH, IS_PART, LOW, MOST_STEPS, STEPS, part_program
from tests.algebra.settle import NUMBER, REMAINS, SETTLED, next_number, settle_program, try_program
from tests.algebra.wave import BEGIN, wave_program

ONWARD = flag("onward")
"""Whether the next root ahead of the start is wanted, not the nearest one."""
AWAY = real("away")
"""How far (radians) the root is away from the start."""
MOST_STARTS = 320
"""The starts, at most."""
AHEAD = sp.Float("1e-7")
"""The nearest root is the one nearest to a joint that is ahead of the start by this (radians). Where a machine is
symmetric about its start, roots are as far to both sides, and rounding would choose, in every language another one.
The next root ahead is further away than this.
"""
_NEAR = sp.Float("1e-3")
"""The closure is met only from where the residual of the branch is at most this."""
_TURN = 2 * sp.pi
_ZERO, _ONE, _FAR = sp.Integer(0), sp.Integer(1), sp.Integer(9)


def search_program(
    programs: tuple[Program, Program, Program, Program, Program, Program],
    joints: tuple[Sequence[sp.Symbol], Sequence[sp.Symbol]],
    searched: sp.Symbol,
    arguments: Sequence[sp.Symbol],
    is_always: bool,
) -> Program:
    """The search by its programs: wave, part, trial, settle, joints, finish. joints: those that are solved, and all."""
    wave, part, trial, settle, joints_at, finish = programs
    solved, every = joints
    begin, end = real("begin"), real("end_of_circle")
    state, following = _state(solved, every)
    waves = _call(wave, arguments)
    step = (
        *_place(part, waves.names, end),
        *_start(settle, joints_at, arguments, solved),
        *_answer(finish, arguments, trial, solved, every, searched),
    )
    first = [begin, begin, begin, *[_ZERO] * (len(state) - 3)]
    start = dict(zip(state, first, strict=True)) | {STEPS_LEFT: sp.Integer(MOST_STEPS), SIDE_NOW: _ONE}
    start |= {STARTS: sp.Integer(MOST_STARTS), NEAREST: _FAR}
    is_done = sp.Or(sp.Ge(PLACE, end), sp.Le(STARTS, 0), sp.And(ONWARD, sp.Lt(NEAREST, _FAR), sp.Eq(NUMBER_NOW, 0)))
    loop = Iterate(
        state=tuple(state),
        start=tuple(start[n] for n in state),
        step=step,
        following=tuple(following[n] for n in state),
        done=sp.Or(sp.Not(LOOKED_FOR), is_done),
        limit=2 * MOST_STARTS,
        otherwise=None,
        note="the parts of the circle, and their starts",
    )
    before: list[Let | Call | Iterate] = [
        replace(waves, wanted=sp.true if is_always else LOOKED_FOR),
        Let(begin, Select(ONWARD, START + AHEAD, BEGIN)),
        Let(end, begin + Select(ONWARD, _TURN - 2 * AHEAD, _TURN)),
    ]
    outputs = [
        Output(FOUND.name, sp.Lt(NEAREST, _FAR)),
        Output(AWAY.name, Select(sp.Lt(NEAREST, _FAR), NEAREST, _ZERO)),
    ]
    outputs += [Output(f"found_{j.name}", _kept(j)) for j in every]
    program = normalise("find_root", (*before, loop), outputs)
    return replace(
        program, summary="The joints at the root nearest to the start, or next ahead of it; zeros where there is none"
    )


PLACE, PART_LOW, PART_HIGH = real("place"), real("low_before"), real("high_before")
NUMBER_NOW, SIDE_NOW, STEPS_LEFT, STARTS = (
    count("start_before"),
    count("side_before"),
    count("steps_before"),
    count("starts_left"),
)
NEAREST, MIRRORED = real("nearest"), count("mirrored")


def _kept(joint: sp.Symbol) -> sp.Symbol:
    return real(f"kept_{joint.name}")


def _mirror(joint: sp.Symbol) -> sp.Symbol:
    return real(f"mirror_{joint.name}")


def _state(solved: Sequence[sp.Symbol], every: Sequence[sp.Symbol]) -> tuple[list[sp.Symbol], dict[sp.Symbol, sp.Expr]]:
    """The state of the search, and what follows."""
    goes_on = flag("goes_on")
    following: dict[sp.Symbol, sp.Expr] = {
        PLACE: Select(goes_on, PLACE, real("high_now")),
        PART_LOW: real("low_now"),
        PART_HIGH: real("high_now"),
        NUMBER_NOW: Select(goes_on, count("next_start"), _ZERO),
        SIDE_NOW: Select(goes_on, count("next_side"), _ONE),
        STEPS_LEFT: count("steps_now"),
        STARTS: STARTS - Select(flag("has_part"), _ONE, _ZERO),
        NEAREST: Select(flag("is_better"), real("distance"), NEAREST),
        MIRRORED: Select(flag("mirrors"), _ONE, _ZERO),
    }
    following |= {_kept(j): Select(flag("is_better"), real(f"joint_{j.name}"), _kept(j)) for j in every}
    following |= {_mirror(j): real(f"mirror_now_{j.name}") for j in solved}
    return list(following), following


def _call(program: Program, arguments: Sequence[sp.Symbol], given: dict[sp.Symbol, sp.Expr] | None = None) -> Call:
    """A call with arguments of the search as they are, and others."""
    own = {s: s for s in program.inputs if s in arguments} | (given or {})
    pairs = tuple((s, own[s]) for s in program.inputs if s in own)
    return Call(program, pairs, tuple(called(o.name, _like(program, o)) for o in program.outputs))


def _like(program: Program, output: Output) -> sp.Symbol:
    """A symbol of the type of an output."""
    if output.name in (FITS, IS_MET.name, IS_PART.name):
        return FOUND
    return STEPS if output.name.startswith("steps") else AT


def _place(part: Program, waves: Sequence[sp.Symbol], end: sp.Symbol) -> Iterator[Let | Call]:
    """The part that is looked at: the next one, where that before is done."""
    is_between = flag("is_between")
    yield Let(is_between, sp.Eq(NUMBER_NOW, 0))
    given: dict[sp.Symbol, sp.Expr] = {w: w for w in waves} | {AT: PLACE, END: end, STEPS: STEPS_LEFT}
    call = _call(part, (), {s: given[s] for s in part.inputs if s in given})
    yield replace(call, wanted=sp.And(is_between, sp.Lt(PLACE, end)))
    yield Let(real("low_now"), Select(is_between, LOW, PART_LOW))
    yield Let(real("high_now"), Select(is_between, HIGH, PART_HIGH))
    yield Let(count("steps_now"), Select(is_between, count("steps_still_left"), STEPS_LEFT))
    yield Let(count("number_now"), Select(is_between, _ONE, NUMBER_NOW))
    yield Let(flag("has_part"), sp.Or(sp.Not(is_between), IS_PART))


def _start(
    settle: Program, joints_at: Program, arguments: Sequence[sp.Symbol], solved: Sequence[sp.Symbol]
) -> Iterator[Let | Call]:
    """The joints from which the closure is met: those of a start, or mirrored ones."""
    is_new = flag("is_new")
    yield Let(is_new, sp.And(flag("has_part"), sp.Eq(MIRRORED, 0)))
    places = {LOW: real("low_now"), HIGH: real("high_now"), NUMBER: count("number_now"), SIDE: SIDE_NOW}
    given = {s: places[s] for s in settle.inputs if s in places}
    yield replace(_call(settle, arguments, given), wanted=is_new)
    given = {s: v for s, v in ((TRIED, SETTLED), (SIDE, SIDE_NOW)) if s in joints_at.inputs}
    yield Let(flag("is_near"), sp.And(is_new, sp.Le(REMAINS, _NEAR)))
    yield replace(_call(joints_at, arguments, given), wanted=flag("is_near"))
    yield Let(flag("is_tried"), sp.And(flag("has_part"), sp.Or(flag("is_near"), sp.Not(is_new))))
    for j in solved:
        yield Let(real(f"start_{j.name}"), Select(is_new, begun(j), _mirror(j)))


def _answer(
    finish: Program,
    arguments: Sequence[sp.Symbol],
    trial: Program,
    solved: Sequence[sp.Symbol],
    every: Sequence[sp.Symbol],
    searched: sp.Symbol,
) -> Iterator[Let | Call]:
    """Whether it fits, and is better than what was found; and what follows."""
    given = {begun(j): real(f"start_{j.name}") for j in solved}
    has_part, fits, mirrors = flag("has_part"), flag(FITS), flag("mirrors")
    yield replace(_call(finish, arguments, given), wanted=flag("is_tried"))
    ahead = real(f"joint_{searched.name}") - START - AHEAD
    distance = Select(ONWARD, Wrap(ahead - sp.pi) + sp.pi + AHEAD, sp.Abs(Wrap(ahead)))
    yield Let(real("distance"), distance)
    within = sp.Or(sp.Not(ONWARD), sp.And(sp.Gt(real("distance"), AHEAD), sp.Lt(real("distance"), _TURN - AHEAD)))
    yield Let(flag("is_better"), sp.And(fits, within, sp.Lt(real("distance"), NEAREST)))
    yield Let(mirrors, sp.And(flag("is_near"), IS_MET, sp.Not(fits)))
    for j in solved:
        yield Let(real(f"mirror_now_{j.name}"), 2 * real(f"start_{j.name}") - real(f"joint_{j.name}"))
    is_second = sp.Lt(SIDE_NOW, 0)
    width = real("high_now") - real("low_now")
    follows = next_number(trial, count("number_now"), width)
    yield Let(count("next_side"), Select(mirrors, SIDE_NOW, -SIDE_NOW))
    yield Let(count("next_start"), Select(sp.Or(mirrors, sp.Not(is_second)), count("number_now"), follows))
    yield Let(flag("goes_on"), sp.And(has_part, sp.Gt(count("next_start"), 0)))


def search_of(both: Scanned) -> Program:
    """The program that finds a root of a machine by algebra."""
    mechanism = both.mechanism
    assert mechanism.search is not None
    arguments = (*GOAL.values(), *map(wanted, mechanism.branches), *map(reference_value, mechanism.joints))
    wave, degree = wave_program(both)
    trial = trial_on_branch(both)
    tries = try_program(trial)
    settle = settle_program(tries, (*arguments, SIDE))
    finish = finish_program(mechanism, margins_wanted(both), DETERMINANT)
    programs = (wave, part_program(degree), tries, settle, joints_program(mechanism, trial), finish)
    joints = [j.symbol for j in mechanism.solved_joints], [j.symbol for j in mechanism.joints]
    return search_program(programs, joints, mechanism.search.joint.symbol, arguments, mechanism.search.where is None)
