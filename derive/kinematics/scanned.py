"""A mechanism with a root scan: closed form where a parameter is zero, a scan along one joint where it is not.

Both derivations stand in one program. Names of the closed form end in `_closed`, names of a trial in `_tried`. The
conditions of the closed form refuse nothing where a scan is made. Branches are two-root steps of both derivations, as
everywhere. A branch that no step of the trial decides is read off the root that was found. The last byte of the
configuration says whether the residual rises or falls at the root. The sign of this slope is that of det J over the
product of the determinants of the trial's steps. So det J is the only margin, and no formula is derived for it.
"""

from __future__ import annotations

from collections.abc import Container, Iterable
from dataclasses import dataclass, replace

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.description.mechanism import (
    Branch,
    DescriptionError,
    Mechanism,
    Role,
)
from derive.equations.axes import axis_lets, finite, reference_value
from derive.equations.closure import with_fixed_names
from derive.equations.pose_at_axes import (
    Forward,
)
from derive.equations.trigonometry import named_trigonometry
from derive.geometry.frames import Chain
from derive.ir.interpret import run
from derive.ir.passes import normalise, renamed
from derive.ir.primitives import (
    Atan2,
    Select,
    ToReal,
)
from derive.ir.program import (
    Call,
    Let,
    Output,
    Program,
    Require,
    Solve,
    Statement,
    Status,
    binds,
    rewritten,
)
from derive.ir.reason import Why, about_joint, about_machine
from derive.ir.symbols import (
    COORDINATE_NAMES,
    FREED,
    FREED_ANGLE,
    ROTATION_ENTRIES,
    SCALE,
    SIDE,
    TRIED,
    branch_sign,
    called,
    cosine,
    count,
    flag,
    real,
    sine,
)
from derive.kinematics.branch_assignment import Assignment, assign, steps_and_rest, with_branch_signs
from derive.kinematics.differential import jacobian_entries
from derive.kinematics.forward import (
    derivation_at_axes,
    pose_at_axes,
)
from derive.kinematics.inverse import Inverse, of_angle, solve_at, solve_pose
from derive.kinematics.root_scan import (
    FOUND,
    GOAL,
    LOOKED_FOR,
    START,
    Trial,
    find_program,
    finish_program,
    trial_of,
    try_program,
    with_goal,
)
from derive.kinematics.sampling import sample_axes, sample_machine

SEARCHED = flag("searched")
DETERMINANT = real("determinant")
_SAMPLES = 64


@dataclass(frozen=True)
class Scanned:
    """Both derivations of a mechanism with a root scan, and the branches of their steps."""

    mechanism: Mechanism
    forward: Forward
    closed: Inverse
    closed_branches: tuple[Assignment, ...]
    trial: Inverse
    trial_branches: tuple[Assignment, ...]
    asked: tuple[Branch, ...]
    """The branches that no step of a trial decides."""


def solve_both(mechanism: Mechanism) -> Scanned:
    """Solve the closure without the parameter that needs a scan, and with the scanned joint known."""
    assert mechanism.search is not None
    forward = pose_at_axes(mechanism)
    simple = without_search(mechanism)
    closed = solve_pose(simple)
    trial = solve_at(mechanism, mechanism.search.joint)
    if (left := len(trial.derivation.residuals)) != 1:
        raise DescriptionError(f"with {mechanism.search.joint.name} known, {left} conditions are left, not one")
    guards = [s.condition for s in trial.derivation.statements if isinstance(s, Require)]
    if len(guards) > 1 or not all(isinstance(g, sp.Ge) or isinstance(g.args[0], sp.Abs) for g in guards):
        raise DescriptionError(f"a trial along {mechanism.search.joint.name} may be out of reach in one step only")
    found, asked = steps_and_rest(mechanism, trial, forward)
    return Scanned(mechanism, forward, closed, assign(simple, closed, pose_at_axes(simple)), trial, found, asked)


def without_search(mechanism: Mechanism) -> Mechanism:
    """The mechanism with its parameter zero, which has a closed form."""
    assert mechanism.search is not None and mechanism.chain is not None
    gone = {mechanism.search.where.symbol: sp.Integer(0)}
    factors = (replace(f, amount=f.amount.xreplace(gone)) for f in mechanism.chain.factors)
    branches = tuple(replace(b, indicator=b.indicator.subs(gone)) for b in mechanism.branches if not b.is_crossing)
    chain = Chain(tuple(f for f in factors if f.amount != 0))
    return replace(mechanism, chain=chain, branches=branches, search=None)


def searched_flag(mechanism: Mechanism) -> Let:
    """The flag that the parameter is not zero."""
    assert mechanism.search is not None
    is_given = sp.Gt(sp.Abs(mechanism.search.where.symbol), 0)
    return Let(SEARCHED, is_given, f"whether to scan {mechanism.search.joint.name} for a root")


def branch_statements(both: Scanned) -> tuple[Statement, ...]:
    """The inverse of one branch, up to the axis values of every joint."""
    mechanism = both.mechanism
    assert mechanism.search is not None
    crossing = next(b for b in mechanism.branches if b.is_crossing)
    solved = with_branch_signs(both.closed.derivation.statements, both.closed_branches)
    closed = _named_apart(_only(solved, SEARCHED), "closed")
    program = search_of(both)
    arguments = _arguments(both, program)
    names = (FOUND, *(real(f"found_{j.symbol.name}") for j in mechanism.joints))
    no_root = about_joint(mechanism.search.joint.symbol, Why.NO_ROOT)
    return (
        searched_flag(mechanism),
        *closed,
        Require(
            sp.Or(SEARCHED, sp.Gt(_sigma(crossing), 0)),
            Status.UNREACHABLE,
            reason=about_machine(Why.FIRST_CROSSING_ONLY),
        ),
        Call(program, arguments, names, f"root scan along {mechanism.search.joint.name}"),
        Require(sp.Or(sp.Not(SEARCHED), FOUND), Status.UNREACHABLE, reason=no_root),
        *_chosen(both),
    )


def _arguments(both: Scanned, program: Program) -> tuple[tuple[sp.Symbol, sp.Expr], ...]:
    """What the search of a branch is given."""
    mechanism = both.mechanism
    assert mechanism.search is not None
    given: dict[sp.Symbol, sp.Expr] = {name: commanded for commanded, name in GOAL.items()}
    given |= {START: reference_value(mechanism.search.joint), LOOKED_FOR: SEARCHED}
    given |= {_wanted(b): _sigma(b) for b in mechanism.branches}
    given |= {reference_value(j): reference_value(j) for j in mechanism.joints}
    return tuple((name, given[name]) for name in program.inputs if name in given)


def search_given(both: Scanned) -> Program:
    """The arguments of the scan for all roots of a pose."""
    arguments = _arguments(both, search_of(both))
    read = [*(real(c) for c in COORDINATE_NAMES), *ROTATION_ENTRIES, *(j.reference for j in both.mechanism.joints)]
    statements = (*finite(read), *both.closed.naming, searched_flag(both.mechanism))
    return normalise("search_given", statements, [Output(name.name, value) for name, value in arguments])


def from_joints(mechanism: Mechanism) -> Program:
    """The axis values of known joints."""
    known = {j.symbol for j in mechanism.joints}
    lets = [of_angle(let, j, known) for j in mechanism.joints for let in axis_lets(j)]
    return normalise("from_joints", lets, [Output(j.axis.name, j.axis) for j in mechanism.joints])


def search_of(both: Scanned) -> Program:
    """The program that finds the root of a branch, with the programs that it calls."""
    mechanism = both.mechanism
    trial = _trial(both)
    finish = finish_program(mechanism, trial, _margins_wanted(both), DETERMINANT)
    arguments = (*GOAL.values(), *map(_wanted, mechanism.branches), *map(reference_value, mechanism.joints))
    return find_program(mechanism, try_program(trial), finish, arguments)


def _sigma(branch: Branch) -> sp.Symbol:
    """The sign of a branch."""
    return branch_sign(branch.name)


def _wanted(branch: Branch) -> sp.Symbol:
    """The same sign as an argument of the scan."""
    return count(f"wanted_{branch.name}")


def _margins_wanted(both: Scanned) -> list[sp.Expr]:
    """The scaled margins of all branches at the joints, each positive on the wanted branch."""
    mechanism = both.mechanism
    functions = {f(j.symbol): g(j.symbol) for j in mechanism.joints for f, g in ((cosine, sp.cos), (sine, sp.sin))}
    found = []
    for b in (b for b in mechanism.branches if not b.is_crossing):
        value = with_fixed_names(mechanism, b.indicator * b.signs[0])
        found.append(ToReal(_wanted(b)) * value / (SCALE if _is_length(mechanism, b) else 1))
    lets, values = named_trigonometry(mechanism, found)
    known = {let.name: let.value for let in lets}
    values = [v.xreplace(known).xreplace(functions) for v in values]
    crossing = next(b for b in mechanism.branches if b.is_crossing)
    slope = _orientation(both) * DETERMINANT * _determinant_scale(both)
    signs = sp.Mul(_wanted(crossing), *[_wanted(a.branch) for a in both.trial_branches])
    return [*values, ToReal(signs) * slope]


def _is_length(mechanism: Mechanism, branch: Branch) -> bool:
    """Whether an indicator is a length: it vanishes with all lengths of the machine."""
    gone = {p.symbol: 0 for p in mechanism.parameters if p.role is not Role.ANGLE}
    return bool(sp.sympify(branch.indicator).subs(gone) == 0)


def _chosen(both: Scanned) -> Iterable[Let]:
    """The angle of every joint, from the scan or in closed form."""
    for joint in both.mechanism.joints:
        name = joint.symbol.name
        closed = Atan2(real(f"{sine(joint.symbol).name}_closed"), real(f"{cosine(joint.symbol).name}_closed"))
        yield Let(joint.symbol, Select(SEARCHED, real(f"found_{name}"), closed))


def _trial(both: Scanned) -> Trial:
    """One trial on the wanted branch; SIDE = -1 takes the other solution of its two-root step."""
    mechanism = both.mechanism
    assert mechanism.search is not None
    joint = mechanism.search.joint.symbol
    own = (Let(cosine(joint), sp.cos(TRIED)), Let(sine(joint), sp.sin(TRIED)))
    solved = with_branch_signs(both.trial.derivation.statements, both.trial_branches)
    signs = {a.sigma: _wanted(a.branch) * (SIDE if a.determinant.reach is not None else 1) for a in both.trial_branches}
    residual = real("residual")
    left = Let(residual, both.trial.derivation.residuals[0])
    statements = with_goal(_named_apart((*own, *both.trial.closure.lets, *solved, left), "tried"))
    statements = tuple(rewritten(s, lambda e: e.xreplace(signs)) for s in statements)
    angles = [m.angle for m in both.trial.derivation.conditionings]
    joints = {j.symbol: j for j in mechanism.joints}
    trial = trial_of(statements, real("residual_tried"), [(a, reference_value(joints[a])) for a in angles])
    return replace(trial, angles=tuple(real(f"{a.name}_tried") for a in angles))


def _indicators(both: Scanned) -> tuple[tuple[Let, ...], tuple[sp.Expr, ...]]:
    """The statements for, and the indicators of, the branches that no step decides."""
    lets, indicators = named_trigonometry(
        both.mechanism, [with_fixed_names(both.mechanism, b.indicator * b.signs[0]) for b in both.asked]
    )
    return tuple(lets), tuple(indicators)


def _named_apart(statements: Iterable[Statement], word: str, own: Container[sp.Symbol] = ()) -> tuple[Statement, ...]:
    """The statements with the word appended to every name that they bind, except `own` names."""
    kept = list(statements)
    table = {n: n if n in own else called(f"{n.name}_{word}", n) for s in kept for n in binds(s)}
    return tuple(renamed(rewritten(s, lambda e: e.xreplace(table)), lambda n: table[n]) for s in kept)


def _only(statements: Iterable[Statement], otherwise: sp.Basic) -> tuple[Statement, ...]:
    """The statements with conditions that refuse only where `otherwise` is false."""
    return tuple(
        replace(s, condition=sp.Or(otherwise, s.condition)) if isinstance(s, Require) else s for s in statements
    )


def margin_statements(both: Scanned) -> tuple[tuple[Statement, ...], tuple[Let, ...]]:
    """The statements at given axis values, and `branch_<name>` of every branch."""
    mechanism = both.mechanism
    statements: list[Statement] = [searched_flag(mechanism), *both.forward.statements]
    own = {name for s in both.forward.statements for name in binds(s)}
    margins: dict[str, dict[str, sp.Expr]] = {}
    for word, inverse, assignments in (
        ("closed", both.closed, both.closed_branches),
        ("tried", both.trial, both.trial_branches),
    ):
        values = [Let(real(f"margin_{a.branch.name}"), a.margin(mechanism)) for a in assignments]
        at_axes = derivation_at_axes(mechanism, inverse, both.forward)
        apart = _named_apart((*at_axes, *values), word, own)
        statements += [s for s in apart if not set(binds(s)) & own]
        for a in assignments:
            margins.setdefault(a.branch.name, {})[word] = real(f"margin_{a.branch.name}_{word}")
    lets, indicators = _indicators(both)
    statements += [let for let in lets if let.name not in own]
    for b, value in zip(both.asked, indicators, strict=True):
        margins[b.name]["tried"] = value / SCALE
    determinant, scaled = determinant_margin(both)
    statements += determinant
    found = [
        Let(real(f"branch_{name}"), Select(SEARCHED, both_values["tried"], both_values["closed"]))
        for name, both_values in margins.items()
    ]
    return tuple(statements), (*found, _crossing_margin(both, scaled, margins))


def _crossing_margin(both: Scanned, determinant: sp.Expr, margins: dict[str, dict[str, sp.Expr]]) -> Let:
    crossing = next(b for b in both.mechanism.branches if b.is_crossing)
    slope = _orientation(both) * determinant
    for a in both.trial_branches:
        slope = slope * Select(sp.Ge(margins[a.branch.name]["tried"], 0), sp.Integer(1), sp.Integer(-1))
    return Let(real(f"branch_{crossing.name}"), Select(SEARCHED, slope, sp.Integer(1)))


def determinant_margin(both: Scanned) -> tuple[tuple[Statement, ...], sp.Expr]:
    """The determinant of the Jacobian at a pose that forward kinematics has found, over the scales
    of the closed steps.
    """
    mechanism = both.mechanism
    lets, entries = jacobian_entries(mechanism)
    width = len(mechanism.joints)
    scaled = [v / (SCALE if k // width < len(mechanism.task.position) else 1) for k, v in enumerate(entries)]
    system = Solve(
        (), tuple(scaled), (), DETERMINANT, "determinant of the Jacobian, positions in characteristic lengths"
    )
    return (*lets, system), DETERMINANT * _determinant_scale(both)


def _determinant_scale(both: Scanned) -> sp.Expr:
    scale = sp.Mul(*[a.determinant.scale for a in both.closed_branches])
    lengths = {s.name: s.value for s in both.closed.derivation.statements if isinstance(s, Let)}
    scale = scale.xreplace({name: lengths[name] for name in scale.free_symbols & lengths.keys()})
    return SCALE ** len(both.mechanism.task.position) / scale


def _orientation(both: Scanned) -> int:
    """+1 where the slope of the residual has the sign of det J over the determinants of the steps, else -1. All poses
    must agree.
    """
    mechanism = both.mechanism
    assert mechanism.search is not None
    machine = sample_machine(mechanism, 51)
    axes = sample_axes(mechanism, machine, _SAMPLES, 52)
    slope = _measured_slope(both, {**machine, **axes})
    determinant, scaled = determinant_margin(both)
    trial = {a.branch.name: a.margin(mechanism) for a in both.trial_branches}
    lets = [Let(real(f"margin_{n}"), v) for n, v in trial.items()]
    statements = (*derivation_at_axes(mechanism, both.trial, both.forward), *determinant, *lets)
    outputs = [Output("slope", scaled * sp.Mul(*[let.name for let in lets]))]
    values, _ = run(normalise("orientation_of_the_scan", statements, outputs), {**machine, **axes})
    signs = np.unique(np.sign(values["slope"] * slope))
    if len(signs) != 1:
        raise DescriptionError("the slope of the residual is not det J over the determinants of the steps")
    return int(signs[0])


def _measured_slope(both: Scanned, samples: dict[str, NDArray[np.float64]]) -> NDArray[np.float64]:
    """The slope of the residual at sampled axes, by a central difference along the searched joint."""
    mechanism = both.mechanism
    assert mechanism.search is not None
    joint = mechanism.search.joint
    names = [*(real(c) for c in "xyz"), *both.forward.rotation]
    outputs = [Output(n.name, n) for n in names]
    outputs += [Output(f"margin_{a.branch.name}", a.margin(mechanism)) for a in both.trial_branches]
    values, _ = run(normalise("pose", derivation_at_axes(mechanism, both.trial, both.forward), outputs), samples)
    trial = _trial(both)
    program = normalise("trial", trial.statements, [Output("value", trial.value)])
    known = {**samples, **{GOAL[real(n)].name: v for n, v in values.items() if real(n) in GOAL}}
    for a in both.trial_branches:
        known[_wanted(a.branch).name] = np.where(values[f"margin_{a.branch.name}"] >= 0, 1.0, -1.0)
    for j in mechanism.joints:
        known[reference_value(j).name] = np.zeros(_SAMPLES)
    known |= {SIDE.name: np.ones(_SAMPLES), FREED.name: -np.ones(_SAMPLES), FREED_ANGLE.name: np.zeros(_SAMPLES)}
    ends = []
    for shift in (1e-6, -1e-6):
        tried = np.radians(samples[joint.axis.name] - samples[joint.offset.name]) + shift
        ends.append(run(program, {**known, TRIED.name: tried})[0]["value"])
    return np.asarray(ends[0] - ends[1])
