"""A mechanism with a search: closed form where a parameter is zero, one joint searched along where it is not.

Both derivations stand in one program, the names of the closed one ending in `_closed`, those of a trial in `_tried`; a
condition of the one that is not meant never refuses. Branches are steps of the derivations as everywhere; what no step of the
trial decides is asked of the root that was found. The crossing byte is the sign of the residual's slope, which is that of
det J over the slopes of the trial's steps: the determinant is the one margin, and needs no formula.
"""

from __future__ import annotations

from collections.abc import Container, Iterable
from dataclasses import dataclass, replace

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.algebra import cosine, sine
from derive.branching import Assignment, assign, steps_and_rest, with_branch_signs
from derive.closure import with_fixed_names
from derive.differential import jacobian_entries
from derive.edges import free
from derive.forward import Forward, derivation_at_axes, pose_at_axes
from derive.frames import Chain
from derive.inverse import Inverse, solve_at, solve_pose
from derive.mechanism import Branch, DescriptionError, Mechanism
from derive.parameters import SCALE
from derive.passes import assemble, renamed
from derive.program import (
    LIMIT,
    Let,
    Output,
    Require,
    Select,
    Solve,
    Statement,
    Status,
    binds,
    real,
    rewritten,
)
from derive.run import run
from derive.sampling import sample_axes, sample_machine
from derive.search import ACCEPTED, RANK, TRIED, Trial, search_loop
from derive.trigonometry import named_trigonometry

SEARCHED = real("searched")
DETERMINANT = real("determinant")
_HALF = sp.Rational(1, 2)
_SAMPLES = 64


@dataclass(frozen=True)
class Searching:
    """Both derivations of a mechanism with a search, and which of their steps are which branches."""

    mechanism: Mechanism
    forward: Forward
    closed: Inverse
    closed_branches: tuple[Assignment, ...]
    trial: Inverse
    trial_branches: tuple[Assignment, ...]
    asked: tuple[Branch, ...]
    """The branches that no step of a trial decides."""


def solve_both(mechanism: Mechanism) -> Searching:
    """Solve the closure without the parameter that needs a search, and with the searched joint known."""
    assert mechanism.search is not None
    forward = pose_at_axes(mechanism)
    simple = without_search(mechanism)
    closed = solve_pose(simple)
    trial = solve_at(mechanism, mechanism.search.joint)
    if (left := len(trial.derivation.residuals)) != 1:
        raise DescriptionError(f"with {mechanism.search.joint.name} known, {left} conditions are left, not one")
    if any(isinstance(s, Require) for s in trial.derivation.statements):
        raise DescriptionError(f"a trial along {mechanism.search.joint.name} must have a solution everywhere")
    found, asked = steps_and_rest(mechanism, trial, forward)
    return Searching(mechanism, forward, closed, assign(simple, closed, pose_at_axes(simple)), trial, found, asked)


def without_search(mechanism: Mechanism) -> Mechanism:
    """The mechanism whose parameter is zero."""
    assert mechanism.search is not None and mechanism.chain is not None
    gone = {mechanism.search.where.symbol: sp.Integer(0)}
    factors = (replace(f, amount=f.amount.xreplace(gone)) for f in mechanism.chain.factors)
    branches = tuple(replace(b, indicator=b.indicator.subs(gone)) for b in mechanism.branches if not b.is_crossing)
    chain = Chain(tuple(f for f in factors if f.amount != 0))
    return replace(mechanism, chain=chain, branches=branches, search=None)


def searched_flag(mechanism: Mechanism) -> Let:
    """Whether the parameter is not zero."""
    assert mechanism.search is not None
    is_given = sp.Gt(sp.Abs(mechanism.search.where.symbol), 0)
    return Let(SEARCHED, Select(is_given, sp.Integer(1), sp.Integer(0)), f"whether to search along {mechanism.search.joint.name}")


def branch_statements(both: Searching, *, is_ranked: bool) -> tuple[Statement, ...]:
    """The inverse of one branch, up to the cosine and sine of every joint; ranked, of its root number `rank` from 0."""
    mechanism = both.mechanism
    assert mechanism.search is not None
    crossing = next(b for b in mechanism.branches if b.is_crossing)
    sigma = real(f"sigma_{crossing.name}")
    is_searched = sp.Gt(SEARCHED, _HALF)
    solved = with_branch_signs(both.closed.derivation.statements, both.closed_branches)
    closed = _named_apart(_only(solved, is_searched), "closed")
    trial = _trial(both)
    loop = search_loop(trial, free(mechanism.search.joint), sigma, sp.Lt(SEARCHED, _HALF), is_ranked)
    bound = set(binds(loop))
    note = f"{mechanism.search.joint.name}: the search along it finds no root of this branch"
    rest = tuple(s for s in trial.statements if not (isinstance(s, Let) and s.name in bound))
    return (
        searched_flag(mechanism),
        *closed,
        Require(sp.Or(is_searched, sp.Gt(sigma, 0)), Status.UNREACHABLE, "without the offset there is no second crossing"),
        *(_first_only(is_searched) if is_ranked else ()),
        loop,
        Require(sp.Or(sp.Lt(SEARCHED, _HALF), sp.Gt(ACCEPTED, _HALF)), Status.UNREACHABLE, note),
        *rest,
        *_chosen(both, is_searched),
    )


def _first_only(is_searched: sp.Basic) -> tuple[Require, ...]:
    allowed = sp.Or(is_searched, sp.Lt(RANK, _HALF))
    return (Require(allowed, Status.UNREACHABLE, "without the offset a branch has one solution"),)


def _chosen(both: Searching, is_searched: sp.Basic) -> Iterable[Let]:
    for joint in both.mechanism.joints:
        for function in (cosine, sine):
            name = function(joint.symbol).name
            yield Let(real(name), Select(is_searched, real(f"{name}_tried"), real(f"{name}_closed")))


def _trial(both: Searching) -> Trial:
    """One trial of the wanted branch."""
    mechanism = both.mechanism
    assert mechanism.search is not None
    joint = mechanism.search.joint.symbol
    own = (Let(cosine(joint), sp.cos(TRIED)), Let(sine(joint), sp.sin(TRIED)))
    solved = with_branch_signs(both.trial.derivation.statements, both.trial_branches)
    lets, indicators = _indicators(both)
    asked = [real(f"indicator_{b.name}") for b in both.asked]
    solved_names = {s.name for s in (*own, *solved) if isinstance(s, Let)}
    if strange := [let.name.name for let in lets if let.name not in solved_names]:
        raise DescriptionError(f"a trial does not know {', '.join(strange)}")
    residual = real("residual")
    statements = _named_apart(
        (
            *own,
            *both.trial.closure.lets,
            *solved,
            *(Let(n, v / SCALE) for n, v in zip(asked, indicators, strict=True)),
            Let(residual, both.trial.derivation.residuals[0] / SCALE**2),
        ),
        "tried",
    )
    fits = [sp.Ge(real(f"sigma_{b.name}") * real(f"{n.name}_tried"), -LIMIT) for b, n in zip(both.asked, asked, strict=True)]
    return Trial(statements, real("residual_tried"), sp.And(*fits))


def _indicators(both: Searching) -> tuple[tuple[Let, ...], tuple[sp.Expr, ...]]:
    """What the branches that no step decides are asked by, and the sines and cosines in it."""
    lets, indicators = named_trigonometry(
        both.mechanism, [with_fixed_names(both.mechanism, b.indicator * b.signs[0]) for b in both.asked]
    )
    return tuple(lets), tuple(indicators)


def _named_apart(statements: Iterable[Statement], word: str, own: Container[sp.Symbol] = ()) -> tuple[Statement, ...]:
    """The statements with the word behind every name that they bind, but for own names."""
    kept = list(statements)
    table = {n: n if n in own else real(f"{n.name}_{word}") for s in kept for n in binds(s)}
    return tuple(renamed(rewritten(s, lambda e: e.xreplace(table)), lambda n: table[n]) for s in kept)


def _only(statements: Iterable[Statement], otherwise: sp.Basic) -> tuple[Statement, ...]:
    """The statements with conditions that refuse only where `otherwise` does not hold."""
    return tuple(replace(s, condition=sp.Or(otherwise, s.condition)) if isinstance(s, Require) else s for s in statements)


def margin_statements(both: Searching) -> tuple[tuple[Statement, ...], tuple[Let, ...]]:
    """At axis values: the statements and `branch_<name>` of every branch."""
    mechanism = both.mechanism
    is_searched = sp.Gt(SEARCHED, _HALF)
    statements: list[Statement] = [searched_flag(mechanism), *both.forward.statements]
    own = {name for s in both.forward.statements for name in binds(s)}
    margins: dict[str, dict[str, sp.Expr]] = {}
    for word, inverse, assignments in (("closed", both.closed, both.closed_branches), ("tried", both.trial, both.trial_branches)):
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
        Let(real(f"branch_{name}"), Select(is_searched, both_values["tried"], both_values["closed"]))
        for name, both_values in margins.items()
    ]
    return tuple(statements), (*found, _crossing_margin(both, scaled, margins, is_searched))


def _crossing_margin(
    both: Searching, determinant: sp.Expr, margins: dict[str, dict[str, sp.Expr]], is_searched: sp.Basic
) -> Let:
    crossing = next(b for b in both.mechanism.branches if b.is_crossing)
    slope = _orientation(both) * determinant
    for a in both.trial_branches:
        slope = slope * Select(sp.Ge(margins[a.branch.name]["tried"], 0), sp.Integer(1), sp.Integer(-1))
    return Let(real(f"branch_{crossing.name}"), Select(is_searched, slope, sp.Integer(1)))


def determinant_margin(both: Searching) -> tuple[tuple[Statement, ...], sp.Expr]:
    """The determinant of the Jacobian at a pose that forward kinematics has found, over the scales of the closed steps."""
    mechanism = both.mechanism
    lets, entries = jacobian_entries(mechanism)
    width = len(mechanism.joints)
    scaled = [v / (SCALE if k // width < len(mechanism.task.position) else 1) for k, v in enumerate(entries)]
    system = Solve((), tuple(scaled), (), DETERMINANT, "of the Jacobian, its positions in lengths of the machine")
    scale = sp.Mul(*[a.slope.scale for a in both.closed_branches])
    lengths = {s.name: s.value for s in both.closed.derivation.statements if isinstance(s, Let)}
    scale = scale.xreplace({name: lengths[name] for name in scale.free_symbols & lengths.keys()})
    return (*lets, system), DETERMINANT * SCALE ** len(mechanism.task.position) / scale


def _orientation(both: Searching) -> int:
    """+1 where the slope of the residual has the sign of det J over the slopes of the steps, else -1: the same at all poses."""
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
    values, _ = run(assemble("orientation_of_the_search", statements, outputs), {**machine, **axes})
    signs = np.unique(np.sign(values["slope"] * slope))
    if len(signs) != 1:
        raise DescriptionError("the slope of the residual is not the determinant over the slopes of the steps")
    return int(signs[0])


def _measured_slope(both: Searching, samples: dict[str, NDArray[np.float64]]) -> NDArray[np.float64]:
    """The slope of the residual at sampled axes, by a central difference along the searched joint."""
    mechanism = both.mechanism
    assert mechanism.search is not None
    joint = mechanism.search.joint
    names = [*(real(c) for c in "xyz"), *both.forward.rotation]
    outputs = [Output(n.name, n) for n in names]
    outputs += [Output(f"margin_{a.branch.name}", a.margin(mechanism)) for a in both.trial_branches]
    values, _ = run(assemble("pose", derivation_at_axes(mechanism, both.trial, both.forward), outputs), samples)
    trial = _trial(both)
    program = assemble("trial", trial.statements, [Output("value", trial.value)])
    known = {**samples, **values}
    for a in both.trial_branches:
        known[f"sigma_{a.branch.name}"] = np.where(values[f"margin_{a.branch.name}"] >= 0, 1.0, -1.0)
    for j in mechanism.joints:
        known[free(j).name] = np.zeros(_SAMPLES)
    ends = []
    for shift in (1e-6, -1e-6):
        tried = np.radians(samples[joint.axis.name] - samples[joint.offset.name]) + shift
        ends.append(run(program, {**known, TRIED.name: tried})[0]["value"])
    return np.asarray(ends[0] - ends[1])
