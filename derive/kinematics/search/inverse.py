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
from derive.kinematics.search.find import ONWARD, Steps, search_program
from derive.kinematics.search.margins import DETERMINANT, margins_wanted
from derive.kinematics.search.parts import look_program
from derive.kinematics.search.programs import (
    FOUND,
    GOAL,
    LOOKED_FOR,
    START,
    fits_program,
    joints_program,
    step_program,
)
from derive.kinematics.search.tried import try_program
from derive.kinematics.search.wave import wave_program


def branch_statements(both: Searched) -> tuple[Statement, ...]:
    """The inverse of one branch, up to the axis values of every joint."""
    mechanism = both.mechanism
    assert mechanism.search is not None
    program = search_of(both)
    names = (FOUND, *(real(f"found_{j.symbol.name}") for j in mechanism.joints))
    call = Call(program, _arguments(both, program), names, f"root search along {mechanism.search.joint.name}")
    no_root = about_joint(mechanism.search.joint.symbol, Why.NO_ROOT)
    if both.closed is None:
        return (_wave(both), call, Require(FOUND, Status.UNREACHABLE, reason=no_root), *_chosen(both))
    return (
        *searched_flag(both),
        *_closed(both, both.closed),
        _wave(both),
        call,
        Require(sp.Or(sp.Not(SEARCHED), FOUND), Status.UNREACHABLE, reason=no_root),
        *_chosen(both),
    )


def _wave(both: Searched) -> Call:
    """The wave, which is the same for all branches."""
    program, _ = wave_program(both)
    return Call(program, _arguments(both, program), tuple(real(o.name) for o in program.outputs))


def _closed(both: Searched, closed: Inverse) -> tuple[Statement, ...]:
    """The closed form, which has the first crossing alone."""
    crossing = next(b for b in both.mechanism.branches if b.is_crossing)
    solved = with_branch_signs(closed.derivation.statements, both.closed_branches)
    is_first = sp.Or(SEARCHED, sp.Gt(sigma(crossing), 0))
    only = Require(is_first, Status.UNREACHABLE, reason=about_machine(Why.FIRST_CROSSING_ONLY))
    return (*named_apart(_only(solved, SEARCHED), "closed"), only)


def _arguments(both: Searched, program: Program) -> tuple[tuple[sp.Symbol, sp.Expr], ...]:
    """What the search of a branch is given."""
    mechanism = both.mechanism
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
    mechanism = both.mechanism
    assert mechanism.search is not None
    wave, degree = wave_program(both)
    if both.eliminated is not None:
        tries, joints = eliminated_trial(mechanism, both.eliminated), None
    else:
        trial = trial_on_branch(both)
        tries, joints = try_program(trial), joints_program(mechanism, trial)
    steps = Steps(
        look=look_program(degree),
        trial=tries,
        joints_at=joints,
        step=step_program(mechanism),
        fits=fits_program(mechanism, margins_wanted(both), DETERMINANT),
    )
    given = (*GOAL.values(), *map(wanted, mechanism.branches), *map(reference_value, mechanism.joints))
    return search_program(mechanism, steps, (*given, *(real(o.name) for o in wave.outputs)))


def _chosen(both: Searched) -> Iterable[Let]:
    """The angle of every joint, from the search or in closed form."""
    for joint in both.mechanism.solved_joints:
        name = joint.symbol.name
        if both.closed is None:
            yield Let(joint.symbol, real(f"found_{name}"))
            continue
        closed = Atan2(real(f"{sine(joint.symbol).name}_closed"), real(f"{cosine(joint.symbol).name}_closed"))
        yield Let(joint.symbol, Select(SEARCHED, real(f"found_{name}"), closed))


def _only(statements: Iterable[Statement], otherwise: sp.Basic) -> tuple[Statement, ...]:
    """The statements with conditions that refuse only where `otherwise` is false."""
    return tuple(
        replace(s, condition=sp.Or(otherwise, s.condition)) if isinstance(s, Require) else s for s in statements
    )
