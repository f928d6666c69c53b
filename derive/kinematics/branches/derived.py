"""Names for branches that the description does not name, from the determinants of the steps that decide them.

The indicator of such a branch is its determinant as an expression of the joints, without the factors that are
positive for every machine. So a reader sees the meaning of both signs, and can choose a better name.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
import sympy as sp

from derive.algebra.normal_form import factored, polynomial
from derive.description.mechanism import ROTATION, Branch, Mechanism, Role, Turning, branch
from derive.equations.axes import Forward
from derive.equations.closures.fixed_names import all_angles, fixed_lets, signs_of
from derive.equations.problem import StepDeterminant
from derive.geometry.frames import Motion
from derive.ir.constants import DEGREE
from derive.ir.program import Let
from derive.ir.symbols import HEADING, POSITION, ROTATION_ENTRIES, cosine, names_in, sine
from derive.kinematics.branches.assignment import steps_and_rest, steps_without_branch
from derive.kinematics.forward import derivation_at_axes
from derive.kinematics.inverse import Inverse
from derive.plate.turning import given_pose
from derive.work import stage

_PARALLEL = 0.999999


@stage("the choice of branches")
def with_derived_branches(mechanism: Mechanism, inverse: Inverse, forward: Forward) -> Mechanism:
    """The mechanism with a further branch for every two-root step that none of its own branches names."""
    unnamed = steps_without_branch(mechanism, inverse, forward)
    named = _branches_of(mechanism, inverse, forward, unnamed)
    return replace(mechanism, branches=(*mechanism.branches, *named)) if named else mechanism


def with_named_steps(mechanism: Mechanism, trial: Inverse, forward: Forward) -> Mechanism:
    """The mechanism of a root search with a branch for every step of a trial: these come first, then the branches that
    no step decides, and the crossing comes last.
    """
    decided, asked, unnamed = steps_and_rest(mechanism, trial, forward)
    named = _branches_of(mechanism, trial, forward, unnamed)
    crossings = tuple(b for b in mechanism.branches if b.is_crossing)
    return replace(mechanism, branches=(*(a.branch for a in decided), *named, *asked, *crossings))


def _branches_of(
    mechanism: Mechanism, inverse: Inverse, forward: Forward, steps: Sequence[StepDeterminant]
) -> tuple[Branch, ...]:
    """A branch for each of the steps."""
    taken = {b.name.lower() for b in mechanism.branches}
    found: list[Branch] = []
    for step in steps:
        indicator = _shorter(mechanism, _in_joints(mechanism, inverse, forward, step))
        word = _word(mechanism, step, indicator)
        number = next(n for n in range(1, 99) if f"{word}_{n}" not in taken)
        taken.add(f"{word}_{number}")
        named = branch(f"{word}_{number}", indicator, positive=+1, negative=-1)
        found.append(replace(named, meanings=_meanings(mechanism, indicator)))
    return tuple(found)


def _in_joints(mechanism: Mechanism, inverse: Inverse, forward: Forward, step: StepDeterminant) -> sp.Expr:
    """The determinant of a step in the joints (for a loop also in the commanded pose), as a description writes it."""
    pose = given_pose(mechanism) if mechanism.is_platform else forward
    statements = derivation_at_axes(mechanism, inverse, pose)
    lets = {s.name: s.value for s in statements if isinstance(s, Let)}
    angles = all_angles(mechanism)
    if mechanism.chain is not None:
        lets |= {n: v for n, v in zip(POSITION, forward.position, strict=False) if n != v}
        lets |= {n: v for n, v in zip(ROTATION_ENTRIES, forward.rotation, strict=True) if n != v}
    named = {f(a) for a in angles for f in (sine, cosine)}
    kept = named | {j.symbol for j in mechanism.joints} | ({*POSITION} if mechanism.chain is None else set())
    value = step.value
    while names := [n for n in names_in(value) if n in lets and n not in kept]:
        value = value.xreplace({n: lets[n] for n in names})
    value = _without_positive_factors(factored(polynomial(value, angles, signs_of(mechanism))), mechanism)
    return value.xreplace(_written(mechanism, angles))


def _written(mechanism: Mechanism, angles: Sequence[sp.Symbol]) -> dict[sp.Expr, sp.Expr]:
    """The names of sines, cosines and roots, as a description writes them."""
    moving = {j.symbol for j in mechanism.joints}
    table: dict[sp.Expr, sp.Expr] = {let.name: let.value for let in fixed_lets(mechanism)}
    table |= {f(a): g(a) for a in angles if a in moving for f, g in ((sine, sp.sin), (cosine, sp.cos))}
    if mechanism.is_platform and mechanism.task.turning is Turning.ABOUT_Z:
        table |= {cosine(HEADING): ROTATION[0, 0], sine(HEADING): ROTATION[1, 0]}
    return table


def _without_positive_factors(value: sp.Expr, mechanism: Mechanism) -> sp.Expr:
    own = {p.name: p.symbol for p in mechanism.parameters}
    value = value.xreplace({s: own[s.name] for s in value.free_symbols if s.name in own})
    rest = sp.Mul(*[f for f in sp.Mul.make_args(value) if not f.is_positive and not f.is_Number])
    return rest.as_content_primitive()[1]


def _shorter(mechanism: Mechanism, value: sp.Expr) -> sp.Expr:
    """The value, or its negative if that reads better; the sine or cosine of a sum where it is one."""
    angles = [j.symbol for j in mechanism.joints if j.is_angle]
    own = polynomial(value, all_angles(mechanism), signs_of(mechanism))
    for one, other in combinations([a for a in angles if a in value.free_symbols], 2):
        for candidate in (f(one + s * other) for f in (sp.sin, sp.cos) for s in (1, -1)):
            if polynomial(candidate, all_angles(mechanism), ()) in (own, sp.expand(-own)):
                return candidate
    return -value if value.could_extract_minus_sign() else value


def _word(mechanism: Mechanism, step: StepDeterminant, indicator: sp.Expr) -> str:
    """The usual word for such a choice."""
    joints = {j.symbol for j in mechanism.joints}
    if step.step in {j.symbol for j in mechanism.joints if not j.is_angle}:
        return "slide"
    if mechanism.chain is None:
        return "elbow"
    if len(indicator.free_symbols & joints) > 1 and not isinstance(indicator, sp.sin | sp.cos):
        return "shoulder"
    return "elbow" if _is_elbow(mechanism, indicator) else "wrist"


def _meanings(mechanism: Mechanism, indicator: sp.Expr) -> tuple[str, str]:
    """The meanings of the positive and the negative sign of an indicator."""
    joints = {j.symbol: j.moved_name for j in mechanism.joints}
    if indicator in joints:
        return f"{joints[indicator]} is positive", f"{joints[indicator]} is negative"
    if not isinstance(indicator, sp.sin | sp.cos):
        text = in_words(mechanism, indicator)
        return f"{text} > 0", f"{text} < 0"
    angle = in_words(mechanism, indicator.args[0])
    if isinstance(indicator, sp.sin):
        return f"{angle} is between 0 and 180 degrees", f"{angle} is between -180 and 0 degrees"
    return f"{angle} is between -90 and 90 degrees", f"{angle} is beyond 90 degrees on either side"


def in_words(mechanism: Mechanism, value: sp.Expr, variables: Mapping[str, str] | None = None) -> str:
    """An expression in the names of the description, or in the variables of its file where they are given."""
    written = variables or {}
    own = {j.name for j in mechanism.joints}
    names = {s: sp.Symbol(s.name.upper()) for s in POSITION if s.name.upper() not in own}
    names |= {j.symbol: sp.Symbol(written.get(j.moved_name, j.moved_name)) for j in mechanism.joints}
    given = {p.symbol: written.get(p.given_name, p.given_name) for p in mechanism.parameters}
    angles = {
        DEGREE * p.symbol: sp.Symbol(f"radians({given[p.symbol]})")
        for p in mechanism.parameters
        if p.role is Role.ANGLE
    }
    names |= {p.symbol: sp.Symbol(given[p.symbol]) for p in mechanism.parameters if p.given or p.given_name in written}
    return str(sp.sympify(value).subs(angles).xreplace(names))


def _is_elbow(mechanism: Mechanism, indicator: sp.Expr) -> bool:
    """Whether a neighbour of the joint is parallel to it: both then bend the arm in one plane."""
    moved = indicator.free_symbols & {j.symbol for j in mechanism.joints}
    if len(moved) > 1:
        return True
    axes = list(_axes(mechanism))
    place = next((k for k, (symbols, _) in enumerate(axes) if moved <= symbols), None)
    if place is None:
        return False
    beside = [axes[k][1] for k in (place - 1, place + 1) if 0 <= k < len(axes)]
    return any(abs(float(axes[place][1] @ other)) > _PARALLEL for other in beside)


def _axes(mechanism: Mechanism) -> Iterator[tuple[set[sp.Symbol], np.ndarray]]:
    """The rotary joints of the chain with the directions of their axes, all joints at zero."""
    joints = {j.symbol for j in mechanism.joints}
    nominal: dict[sp.Basic, float] = {p.symbol: p.nominal for p in mechanism.parameters}
    nominal |= {DEGREE: np.pi / 180, **dict.fromkeys(joints, 0.0)}
    rotation = np.eye(3)
    for factor in mechanism.chain.factors if mechanism.chain is not None else ():
        moving = factor.amount.free_symbols & joints
        if factor.motion is Motion.TURN and moving:
            yield moving, rotation[:, factor.axis]
        matrix = factor.matrix().subs(nominal)[:3, :3]
        rotation = rotation @ np.array(matrix.tolist(), dtype=float)
