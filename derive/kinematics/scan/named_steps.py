"""Branches for the two-root steps of a trial that the description does not name.

The compiler finds which joint is searched and by which steps the others are solved: no description can name those. The
indicator of such a branch is the determinant of the step at the axes, written out in the joints.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import sympy as sp
from sympy.simplify.fu import TR10i

from derive.algebra.normal_form import cancelled, polynomial
from derive.description.mechanism import Branch, Mechanism, branch
from derive.equations.closure import all_angles, fixed_angles, signs_of
from derive.equations.pose_at_axes import Forward
from derive.equations.problem import StepDeterminant
from derive.ir.constants import DEGREE
from derive.ir.program import Let
from derive.ir.symbols import SCALE, cosine, real, sine
from derive.kinematics.branch_assignment import steps_and_rest
from derive.kinematics.forward import derivation_at_axes
from derive.kinematics.inverse import Inverse

_FUNCTIONS = ((cosine, sp.cos), (sine, sp.sin))


def with_named_steps(mechanism: Mechanism, trial: Inverse, forward: Forward) -> Mechanism:
    """The mechanism with a branch for every step of a trial; these come first, the crossing comes last."""
    found, asked, unnamed = steps_and_rest(mechanism, trial, forward)
    indicators = _indicators(mechanism, trial, forward, unnamed)
    named = tuple(_branch(step, value) for step, value in zip(unnamed, indicators, strict=True))
    crossings = tuple(b for b in mechanism.branches if b.is_crossing)
    return replace(mechanism, branches=(*(a.branch for a in found), *named, *asked, *crossings))


def _branch(step: StepDeterminant, indicator: sp.Expr) -> Branch:
    return branch(f"side_{step.step.name}", indicator, positive=+1, negative=-1)


def _indicators(
    mechanism: Mechanism, trial: Inverse, forward: Forward, steps: Sequence[StepDeterminant]
) -> list[sp.Expr]:
    """The determinants of the steps, in the joints and the dimensions."""
    lets = {s.name: s.value for s in derivation_at_axes(mechanism, trial, forward) if isinstance(s, Let)}
    angles, signs = all_angles(mechanism), signs_of(mechanism)
    fixed_ones = fixed_angles(mechanism)  # these are in degrees
    functions = {f(a): g(a * DEGREE if a in fixed_ones else a) for a in angles for f, g in _FUNCTIONS}
    opened = {n: v for n, v in lets.items() if n not in functions and n not in angles}
    found = []
    for step in steps:
        factors = sp.Mul.make_args(step.scale.xreplace({SCALE: sp.Integer(1)}))
        scale = sp.Mul(*[f for f in factors if not f.free_symbols & opened.keys()])  # it only shortens
        written = _written_out(step.value, opened)
        fixed = _fixed_turns(written)
        plain = {g(t): f(a) for t, a in fixed.items() for f, g in _FUNCTIONS}
        value = cancelled(polynomial(written.xreplace(plain), (*angles, *fixed.values()), signs) / scale)
        found.append(_shorter(value.xreplace(functions | {n: v for v, n in plain.items()})))
    return found


def _fixed_turns(value: sp.Expr) -> dict[sp.Expr, sp.Symbol]:
    """Angles for the turns by numbers: sin 20 degrees is no polynomial of sin 1 degree."""
    turns = {node.args[0] for node in value.atoms(sp.sin, sp.cos) if node.free_symbols <= {DEGREE}}
    return {turn: real(f"fixed_{k}") for k, turn in enumerate(sorted(turns, key=sp.default_sort_key))}


def _written_out(value: sp.Expr, lets: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    """The value with every name replaced by what it is bound to."""
    while present := value.free_symbols & lets.keys():
        value = value.xreplace({name: lets[name] for name in present})
    return value


def _shorter(value: sp.Expr) -> sp.Expr:
    """With products of sines and cosines as those of sums, where that is shorter."""
    return min((value, TR10i(value)), key=sp.count_ops)
