"""The inverse of a mechanism with a root search: one program with the closed form and the search.

The conditions of the closed form refuse nothing where a root is searched.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import sympy as sp

from derive.equations.axes import finite, reference_value
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, Select, Wrap
from derive.ir.program import Call, Let, Output, Program, Require, Statement, Status
from derive.ir.reason import Why, about_joint, about_machine
from derive.ir.symbols import COORDINATE_NAMES, ROTATION_ENTRIES, cosine, real, sine
from derive.kinematics.branches.assignment import with_branch_signs
from derive.kinematics.inverse import Inverse
from derive.kinematics.search.derivations import (
    SEARCHED,
    Searched,
    named_apart,
    naming_of,
    searched_flag,
    sigma,
    trial_on_branch,
    wanted,
)
from derive.kinematics.search.elimination.vanishing import eliminated_trial
from derive.kinematics.search.loop.find import ONWARD, Steps, search_program
from derive.kinematics.search.loop.near import IS_NEAR, near_name, near_program
from derive.kinematics.search.loop.parts import look_program
from derive.kinematics.search.loop.tried import try_program
from derive.kinematics.search.margins import DETERMINANT, margins_wanted
from derive.kinematics.search.programs import FOUND, GOAL, LOOKED_FOR, START, fits_program, joints_program, step_program
from derive.kinematics.search.wave import wave_program


def branch_statements(both: Searched) -> tuple[Statement, ...]:
    """The inverse of one branch, up to the axis values of every joint."""
    mechanism = both.arm
    assert mechanism.search is not None
    program = search_of(both)
    names = (FOUND, *(real(f"found_{j.symbol.name}") for j in both.mechanism.joints))
    is_asked = sp.true if both.closed is None else SEARCHED
    is_searched = sp.And(is_asked, sp.Not(IS_NEAR))
    note = f"root search along {mechanism.search.joint.name}"
    found = sp.Or(IS_NEAR, FOUND) if both.closed is None else sp.Or(sp.Not(SEARCHED), IS_NEAR, FOUND)
    return (
        *(() if both.closed is None else (*searched_flag(both), *_closed(both, both.closed))),
        _near(both, is_asked),
        _wave(both, is_searched),
        Call(program, _arguments(both, program), names, note, is_searched, is_usual=True),
        Require(found, Status.UNREACHABLE, reason=about_joint(mechanism.search.joint.symbol, Why.NO_ROOT)),
        *_chosen(both),
    )


def _near(both: Searched, is_asked: sp.Basic) -> Call:
    """The solution next to the reference."""
    step, fits = _steps(both)
    program = near_program(both.arm, step, fits, _given(both))
    names = (IS_NEAR, *(near_name(j) for j in both.mechanism.solved_joints))
    return Call(
        program, _arguments(both, program), names, "the solution next to the reference", is_asked, is_usual=True
    )


def _wave(both: Searched, is_asked: sp.Basic = sp.true) -> Call:
    """The wave, which is the same for all branches."""
    program, _ = wave_program(both)
    return Call(
        program, _arguments(both, program), tuple(real(o.name) for o in program.outputs), "", is_asked, is_usual=True
    )


def _steps(both: Searched) -> tuple[Program, Program]:
    """A step on the closure, and whether joints are on a branch."""
    return step_program(both.arm), fits_program(both.arm, margins_wanted(both), DETERMINANT)


def _given(both: Searched) -> tuple[sp.Symbol, ...]:
    """What does not change in a search, besides the wave."""
    return (*GOAL.values(), *map(wanted, both.arm.branches), *map(reference_value, both.arm.joints))


def _closed(both: Searched, closed: Inverse) -> tuple[Statement, ...]:
    """The closed form, which has the first crossing alone."""
    crossing = next(b for b in both.arm.branches if b.is_crossing)
    solved = with_branch_signs(closed.derivation.statements, both.closed_branches)
    is_first = sp.Or(SEARCHED, sp.Gt(sigma(crossing), 0))
    only = Require(is_first, Status.UNREACHABLE, reason=about_machine(Why.FIRST_CROSSING_ONLY))
    return (*named_apart(_only(solved, SEARCHED), "closed"), only)


def _arguments(both: Searched, program: Program) -> tuple[tuple[sp.Symbol, sp.Expr], ...]:
    """What the search of a branch is given."""
    mechanism = both.arm
    assert mechanism.search is not None
    given: dict[sp.Symbol, sp.Expr] = {name: commanded for commanded, name in GOAL.items()}
    given |= {START: Wrap(reference_value(mechanism.search.joint)), LOOKED_FOR: SEARCHED, ONWARD: sp.false}
    given |= {wanted(b): sigma(b) for b in mechanism.branches}
    given |= {reference_value(j): reference_value(j) for j in mechanism.joints}
    given |= {real(o.name): real(o.name) for o in wave_program(both)[0].outputs}
    return tuple((name, given[name]) for name in program.inputs if name in given)


def search_given(both: Searched) -> Program:
    """The arguments of the search for all roots of a pose."""
    arguments = _arguments(both, search_of(both))
    read = [*(real(c) for c in COORDINATE_NAMES), *ROTATION_ENTRIES, *(j.reference for j in both.mechanism.joints)]
    statements = (*finite(read), *naming_of(both), *searched_flag(both), _wave(both))
    return normalise("search_given", statements, [Output(name.name, value) for name, value in arguments])


def search_of(both: Searched) -> Program:
    """The program that finds the root of a branch, with the programs that it calls."""
    mechanism = both.arm
    assert mechanism.search is not None
    wave, degree = wave_program(both)
    if both.eliminated is not None:
        tries, joints = eliminated_trial(mechanism, both.eliminated), None
    else:
        trial = trial_on_branch(both)
        tries, joints = try_program(trial), joints_program(mechanism, trial)
    step, fits = _steps(both)
    steps = Steps(look_program(degree), tries, joints, step, fits)
    return search_program(mechanism, steps, (*_given(both), *(real(o.name) for o in wave.outputs)))


def _chosen(both: Searched) -> Iterable[Let]:
    """The angle of every joint, from the search or in closed form."""
    for joint in both.mechanism.solved_joints:
        name = joint.symbol.name
        found = Select(IS_NEAR, near_name(joint), real(f"found_{name}"))
        if both.closed is None:
            yield Let(joint.symbol, found)
            continue
        closed = Atan2(real(f"{sine(joint.symbol).name}_closed"), real(f"{cosine(joint.symbol).name}_closed"))
        yield Let(joint.symbol, Select(SEARCHED, found, closed))


def _only(statements: Iterable[Statement], otherwise: sp.Basic) -> tuple[Statement, ...]:
    """The statements with conditions that refuse only where `otherwise` is false."""
    return tuple(
        replace(s, condition=sp.Or(otherwise, s.condition)) if isinstance(s, Require) else s for s in statements
    )
