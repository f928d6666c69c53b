"""The margins of a mechanism with a root search.

The last byte of the configuration says whether the residual rises or falls at the root. The sign of this slope is that
of det J over the product of the determinants of the trial's steps. So det J is the only margin, and no formula is
derived for it.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.description.mechanism import Branch, Mechanism, Role
from derive.equations.axes import reference_value
from derive.equations.closures.fixed_names import with_fixed_names
from derive.equations.trigonometry import named_trigonometry
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Select, ToReal
from derive.ir.program import Let, Output, Solve, Statement
from derive.ir.symbols import SCALE, SIDE, TRIED, cosine, real, sine
from derive.ir.verify import BrokenProgram
from derive.kinematics.branches.assignment import Assignment
from derive.kinematics.differential import scaled_entries, solved_entries
from derive.kinematics.forward import derivation_at_axes
from derive.kinematics.inverse import Inverse
from derive.kinematics.sampling import sample_axes, sample_machine
from derive.kinematics.search.derivations import SEARCHED, Searched, named_apart, searched_flag, trial_on_branch, wanted
from derive.kinematics.search.loop.rounds import ROUND
from derive.kinematics.search.programs import GOAL
from derive.work import stage

DETERMINANT = real("determinant")
_SAMPLES = 64


@stage("the distance from singular poses")
def margin_statements(both: Searched) -> tuple[tuple[Statement, ...], tuple[Let, ...]]:
    """The statements at given axis values, and `branch_<name>` of every branch."""
    mechanism = both.arm
    statements: list[Statement] = [*searched_flag(both), *both.forward.statements]
    own = {name for s in both.forward.statements for name in s.bound()}
    margins: dict[str, dict[str, sp.Expr]] = {}
    for word, inverse, assignments in _solved(both):
        values = [Let(real(f"margin_{a.branch.name}"), a.margin(mechanism)) for a in assignments]
        at_axes = derivation_at_axes(mechanism, inverse, both.forward)
        apart = named_apart((*at_axes, *values), word, own)
        statements += [s for s in apart if not set(s.bound()) & own]
        for a in assignments:
            margins.setdefault(a.branch.name, {})[word] = real(f"margin_{a.branch.name}_{word}")
    lets, indicators = _indicators(both)
    statements += [let for let in lets if let.name not in own]
    for b, value in zip(both.asked, indicators, strict=True):
        has_no_unit = both.closed is None and not _is_length(mechanism, b)
        margins.setdefault(b.name, {})["tried"] = value if has_no_unit else value / SCALE
    determinant, scaled = determinant_margin(both)
    statements += determinant
    found = [
        Let(real(f"branch_{name}"), _on_either(both, both_values["tried"], both_values.get("closed")))
        for name, both_values in margins.items()
    ]
    return tuple(statements), (*found, _crossing_margin(both, scaled, margins))


def _solved(both: Searched) -> Iterator[tuple[str, Inverse, tuple[Assignment, ...]]]:
    """The derivations, each with the word that its names end in, and with its branches."""
    if both.closed is not None:
        yield "closed", both.closed, both.closed_branches
    yield "tried", both.trial, both.trial_branches


def _on_either(both: Searched, tried: sp.Expr, closed: sp.Expr | None) -> sp.Expr:
    """The value where the joint is searched, and that of the closed form where it is not."""
    return tried if both.closed is None or closed is None else Select(SEARCHED, tried, closed)


def _indicators(both: Searched) -> tuple[tuple[Let, ...], tuple[sp.Expr, ...]]:
    """The statements for, and the indicators of, the branches that no step decides."""
    lets, indicators = named_trigonometry(
        both.arm, [with_fixed_names(both.arm, b.indicator * b.signs[0]) for b in both.asked]
    )
    return tuple(lets), tuple(indicators)


def _crossing_margin(both: Searched, determinant: sp.Expr, margins: dict[str, dict[str, sp.Expr]]) -> Let:
    crossing = next(b for b in both.arm.branches if b.is_crossing)
    slope = _orientation(both) * determinant
    for a in both.trial_branches:
        slope = slope * Select(sp.Ge(margins[a.branch.name]["tried"], 0), sp.Integer(1), sp.Integer(-1))
    return Let(real(f"branch_{crossing.name}"), _on_either(both, slope, sp.Integer(1)))


@stage("the distance from singular poses")
def determinant_margin(both: Searched) -> tuple[tuple[Statement, ...], sp.Expr]:
    """The determinant of the Jacobian at a pose that forward kinematics has found, over the scales
    of the closed steps.
    """
    mechanism = both.arm
    lets, entries = solved_entries(mechanism)
    note = "determinant of the Jacobian, positions in characteristic lengths"
    system = Solve((), scaled_entries(mechanism, entries), (), DETERMINANT, note)
    return (*lets, system), DETERMINANT * _determinant_scale(both)


def _determinant_scale(both: Searched) -> sp.Expr:
    if both.closed is None:
        return sp.Integer(1)
    scale = sp.Mul(*[a.determinant.scale for a in both.closed_branches])
    lengths = {s.name: s.value for s in both.closed.derivation.statements if isinstance(s, Let)}
    scale = scale.xreplace({name: lengths[name] for name in scale.free_symbols & lengths.keys()})
    return SCALE ** len(both.arm.task.position) / scale


def margins_wanted(both: Searched) -> list[sp.Expr]:
    """The scaled margins of all branches at the joints, each positive on the wanted branch."""
    mechanism = both.arm
    functions = {f(j.symbol): g(j.symbol) for j in mechanism.joints for f, g in ((cosine, sp.cos), (sine, sp.sin))}
    found = []
    for b in (b for b in mechanism.branches if not b.is_crossing):
        value = with_fixed_names(mechanism, b.indicator * b.signs[0])
        found.append(ToReal(wanted(b)) * value / (SCALE if _is_length(mechanism, b) else 1))
    lets, values = named_trigonometry(mechanism, found)
    known = {let.name: let.value for let in lets}
    values = [v.xreplace(known).xreplace(functions) for v in values]
    crossing = next(b for b in mechanism.branches if b.is_crossing)
    slope = _orientation(both) * DETERMINANT * _determinant_scale(both)
    signs = sp.Mul(wanted(crossing), *[wanted(a.branch) for a in both.trial_branches])
    return [*values, ToReal(signs) * slope]


def _is_length(mechanism: Mechanism, branch: Branch) -> bool:
    """Whether an indicator is a length: it then vanishes where all lengths of the machine are zero."""
    gone = {p.symbol: 0 for p in mechanism.parameters if p.role is not Role.ANGLE}
    return bool(sp.sympify(branch.indicator).subs(gone) == 0)


def _orientation(both: Searched) -> int:
    """+1 where the slope of the residual has the sign of det J over the determinants of the steps, else -1. All poses
    must agree.
    """
    mechanism = both.arm
    assert mechanism.search is not None
    if both.eliminated is not None:  # no residual rises or falls: the side is that of det J
        return 1
    machine = sample_machine(mechanism, 51)
    axes = sample_axes(mechanism, machine, _SAMPLES, 52)
    slope = _measured_slope(both, {**machine, **axes})
    determinant, scaled = determinant_margin(both)
    trial = {a.branch.name: a.margin(mechanism) for a in both.trial_branches}
    lets = [Let(real(f"margin_{n}"), v) for n, v in trial.items()]
    statements = (*derivation_at_axes(mechanism, both.trial, both.forward), *determinant, *lets)
    outputs = [Output("slope", scaled * sp.Mul(*[let.name for let in lets]))]
    values, _ = run(normalise("orientation_of_the_search", statements, outputs), {**machine, **axes})
    signs = np.unique(np.sign(values["slope"] * slope))
    if len(signs) != 1:
        raise BrokenProgram("the slope of the residual is not det J over the determinants of the steps")
    return int(signs[0])


def _measured_slope(both: Searched, samples: dict[str, NDArray[np.float64]]) -> NDArray[np.float64]:
    """The slope of the residual at sampled axes, by a central difference along the searched joint."""
    mechanism = both.arm
    assert mechanism.search is not None
    joint = mechanism.search.joint
    names = [*(real(c) for c in "xyz"), *both.forward.rotation]
    outputs = [Output(n.name, n) for n in (*names, *(j.symbol for j in mechanism.held_joints))]
    outputs += [Output(f"margin_{a.branch.name}", a.margin(mechanism)) for a in both.trial_branches]
    values, _ = run(normalise("pose", derivation_at_axes(mechanism, both.trial, both.forward), outputs), samples)
    trial = trial_on_branch(both)
    program = normalise("trial", trial.statements, [Output("value", trial.value)])
    known = {**samples, **{GOAL[real(n)].name: v for n, v in values.items() if real(n) in GOAL}}
    for a in both.trial_branches:
        known[wanted(a.branch).name] = np.where(values[f"margin_{a.branch.name}"] >= 0, 1.0, -1.0)
    held = mechanism.held_joints
    for j in mechanism.joints:
        known[reference_value(j).name] = values[j.symbol.name] if j in held else np.zeros(_SAMPLES)
    known |= {SIDE.name: np.ones(_SAMPLES), ROUND.name: np.zeros(_SAMPLES)}
    ends = []
    for shift in (1e-6, -1e-6):
        tried = np.radians(samples[joint.axis.name] - samples[joint.offset.name]) + shift
        ends.append(run(program, {**known, TRIED.name: tried})[0]["value"])
    return np.asarray(ends[0] - ends[1])
