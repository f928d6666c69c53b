"""Assembly modes: the sign of the determinant of forward kinematics that belongs to each mode, and the poses that the
inverse must refuse.

Let Phi be the equations of a loop and x the position. Its two solutions for x, at given joints, have opposite signs of
det dPhi/dx: of two rods the cross product, of three rods the triple product, each rod from its base to the tool. So a
choice that the description does not name is named by this determinant.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.algebra.normal_form import polynomial
from derive.description.branches import assembly
from derive.description.mechanism import Assembly, Bound, DescriptionError, Mechanism, Rod
from derive.equations.axes import Forward
from derive.equations.closures.fixed_names import all_angles, signs_of, with_fixed_names
from derive.equations.trigonometry import named_trigonometry
from derive.ir.constants import BOUNDARY, DEGREE
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select, angle_of_sine
from derive.ir.program import Let, Output, Program, Require, Statement, Status
from derive.ir.reason import Reason, Unit, Why, about
from derive.ir.symbols import (
    ASSEMBLY_SIGN,
    COORDINATE_NAMES,
    DETERMINANT,
    HEADING,
    MIN_TYPE2_MARGIN,
    SCALE,
    cosine,
    real,
    sine,
)
from derive.kinematics.forward import pose_at_axes, solve_for_position
from derive.kinematics.refusals.no_pose import why_no_pose
from derive.kinematics.sampling import Samples, machine_at, possible_axes, sample_axes, sample_machine
from derive.plate.legs import MARGIN, is_driven
from derive.plate.plate import platform_checks
from derive.plate.surplus import sign_at_nominal
from derive.work import stage

_SAMPLES = 256
_NAME = "assembly"
_MARGINS = {2: "rods_aligned", 3: "rods_coplanar"}
"""The name of the singularity at which the two solutions meet, by the number of rods that hold the tool."""
_CLOSURE = "loop_singular"
"""The name of this singularity for equations that are no rods."""


@dataclass(frozen=True)
class Assembled:
    """Forward kinematics with its assembly mode chosen by a parameter, and the margin whose sign is the mode."""

    forward: Forward
    margin: sp.Expr | None
    """The determinant over its scale, in the names of the forward derivation; None if forward has one solution."""
    name: str = ""
    """The name of the margin."""


@stage("the choice of the assembly mode")
def with_derived_assembly(mechanism: Mechanism) -> Mechanism:
    """The mechanism with named assembly modes, where it has two positions at the same axes and names none. Raises
    `DescriptionError` where one name does not tell them apart, or where there is only one position.
    """
    if mechanism.chain is not None or mechanism.is_platform:
        return mechanism
    choices = len(solve_for_position(mechanism).determinants)
    if choices > 1:
        raise DescriptionError(f"forward kinematics has {choices} two-root steps: one assembly names one")
    if choices == 0 and mechanism.assembly is not None:
        raise DescriptionError(
            f"assembly {mechanism.assembly.name!r}: the loop can be assembled in one way alone: leave it out"
        )
    if choices == 0 or mechanism.assembly is not None:
        return mechanism
    return replace(mechanism, assembly=_derived(mechanism))


def _derived(mechanism: Mechanism) -> Assembly:
    """The assembly choice by the sign of the determinant."""
    coordinates = [real(c) for c in mechanism.task.position]
    slopes = sp.Matrix([[sp.diff(e, c) for c in coordinates] for e in mechanism.closure]).reshape(
        len(mechanism.closure), len(coordinates)
    )
    rods = sp.Matrix([_along(rod, coordinates) for rod in mechanism.holding_rods]).reshape(
        len(mechanism.holding_rods), len(coordinates)
    )
    held = _without_held(sp.Matrix.vstack(slopes, rods))
    is_of_rods = held.rows == len(mechanism.holding_rods)
    margin = _MARGINS.get(held.rows, _CLOSURE) if is_of_rods else _CLOSURE
    meanings = _meanings(mechanism, held.rows if is_of_rods else 0)
    lower, nominal = _lower(mechanism, held.det()), sign_at_nominal(mechanism, held.det())
    if lower == 0:
        named = assembly(_NAME, held.det(), margin=margin, **_with_first({"positive": +1, "negative": -1}, nominal))
        return replace(named, meanings=meanings if named.signs[0] > 0 else (meanings[1], meanings[0]))
    names = {"below": lower, "above": -lower}
    # The tool hangs from arms, carriages and cables, and stands on other legs.
    hangs = all(rod.only_pulls for rod in mechanism.holding_rods)
    if not hangs and not is_driven(mechanism, [v for rod in mechanism.holding_rods for v in rod.base]):
        names = dict(reversed(names.items()))
    named = assembly(_NAME, held.det(), margin=margin, **_with_first(names, nominal))
    return replace(named, meanings=meanings if named.signs[0] > 0 else (meanings[1], meanings[0]))


def _with_first(names: dict[str, int], sign: int) -> dict[str, int]:
    """The names of the modes with that of a sign first; 0 leaves them as they are."""
    return dict(sorted(names.items(), key=lambda named: named[1] == -sign))


def _lower(mechanism: Mechanism, determinant: sp.Expr) -> int:
    """The sign of the determinant at the lower of the two positions of the nominal pose; 0 where the two are not above
    each other. A loop that does not close at the nominal joints is asked at the poses around them.
    """
    if "z" not in mechanism.task.position:
        return 0
    program, machine = _position_program(mechanism, pose_at_axes(mechanism), determinant), machine_at(mechanism)
    either = {**machine, ASSEMBLY_SIGN.name: np.asarray(1.0)}
    nominal = {**machine, **sample_axes(mechanism, machine, 1, 33, share=0.0)}
    for samples in (nominal, possible_axes(mechanism, either, _SAMPLES, 33, program)):
        (first, one), (second, other) = _in_both_modes(program, samples)
        both = one & other
        if both.any():
            apart = {c: (first[c] - second[c])[both] for c in mechanism.task.position}
            rise = np.median(np.abs(apart["z"]))
            is_vertical = all(np.median(np.abs(way)) <= rise for way in apart.values())
            return int(np.sign(-np.sum(np.sign(apart["z"] * first["indicator"][both])))) if is_vertical else 0
    return 0


def _along(rod: Rod, coordinates: list[sp.Symbol]) -> list[sp.Expr]:
    """Half the derivatives of a rod's equation: the vector of the rod, where the position shifts one of its ends."""
    between = [p - b for p, b in zip(rod.plate, rod.base, strict=True)]
    return [sp.Add(*[v * sp.diff(v, c) for v in between]) for c in coordinates]


def _without_held(matrix: sp.Matrix) -> sp.Matrix:
    """The matrix without equations that alone fix one coordinate (z of a quill), and without that coordinate."""
    for row in range(matrix.rows):
        own = [column for column in range(matrix.cols) if matrix[row, column] != 0]
        if len(own) == 1 and matrix[row, own[0]].is_number:
            rest = matrix.copy()
            rest.row_del(row)
            rest.col_del(own[0])
            return _without_held(rest)
    return matrix


def _meanings(mechanism: Mechanism, rods: int) -> tuple[str, str]:
    """The meanings of both signs."""
    names = [rod.name for rod in mechanism.holding_rods]
    if rods == 2:
        text = f"from its base to the tool, rod {names[1]} points to the {{}} of rod {names[0]}"
        return text.format("left"), text.format("right")
    if rods == 3:
        text = f"the rods {', '.join(names)}, from their bases to the tool, are a {{}}-handed frame"
        return text.format("right"), text.format("left")
    what = f"the determinant of the closure by {', '.join(c for c in COORDINATE_NAMES if c in mechanism.task.position)}"
    return f"{what} is positive", f"{what} is negative"


@stage("the assembly mode")
def assembled(mechanism: Mechanism, forward: Forward) -> Assembled:
    """Bind the assembly sign to the parameter of the machine, by the indicator of the description."""
    if mechanism.is_platform:
        return Assembled(forward, DETERMINANT, MARGIN)
    if mechanism.assembly is None or forward.determinant is None:
        return Assembled(forward, None)
    first = mechanism.assembly.signs[0] * _orientation(mechanism, forward)
    chosen: sp.Expr = first * (1 - 2 * real(mechanism.assembly.parameter))
    if mechanism.assembly.handedness != 1:
        chosen = Select(sp.Gt(with_fixed_names(mechanism, mechanism.assembly.handedness), 0), chosen, -chosen)
    sign = Let(ASSEMBLY_SIGN, chosen, "assembly mode of this machine: the sign of the determinant of its rods")
    margin = forward.determinant.value / forward.determinant.scale
    return Assembled(replace(forward, statements=(sign, *forward.statements)), margin, mechanism.assembly.margin)


def _orientation(mechanism: Mechanism, forward: Forward) -> int:
    """+1 where the sign of the determinant is that of the indicator, -1 where it is the opposite."""
    assert mechanism.assembly is not None
    program = _position_program(mechanism, forward, mechanism.assembly.indicator * mechanism.assembly.handedness)
    either = {**sample_machine(mechanism, 31), ASSEMBLY_SIGN.name: np.asarray(1.0)}
    first, second = _in_both_modes(program, possible_axes(mechanism, either, _SAMPLES, 32, program))
    found: set[int] = set()
    for side, (values, good) in ((1.0, first), (-1.0, second)):
        found |= {int(s) for s in np.sign(side * values["indicator"][good])}
    if not found:
        raise DescriptionError(f"assembly {mechanism.assembly.name!r}: {why_no_pose(mechanism)}")
    if len(found) != 1 or 0 in found:
        raise DescriptionError(
            f"assembly {mechanism.assembly.name!r}: its indicator does not tell the two solutions apart"
        )
    return found.pop()


def _position_program(mechanism: Mechanism, forward: Forward, described: sp.Expr) -> Program:
    """The position at axis values, and an indicator there; the assembly mode is an input."""
    lets, (indicator,) = named_trigonometry(mechanism, [with_fixed_names(mechanism, described)])
    position = [Output(c, v) for c, v in zip(COORDINATE_NAMES, forward.position, strict=True)]
    return normalise("assembly", (*forward.statements, *lets), [Output("indicator", indicator), *position])


def _in_both_modes(
    program: Program, samples: Samples
) -> tuple[tuple[Samples, NDArray[np.bool_]], tuple[Samples, NDArray[np.bool_]]]:
    """The outputs in both assembly modes, and where there is a position."""
    count = max(column.size for column in samples.values())

    def run_in(side: float) -> tuple[Samples, NDArray[np.bool_]]:
        values, status = run(program, {**samples, ASSEMBLY_SIGN.name: np.asarray(side)})
        spread = {name: np.broadcast_to(value, (count,)) for name, value in values.items()}
        return spread, np.asarray(np.broadcast_to(status == Status.OK, (count,)), dtype=bool)

    return run_in(1.0), run_in(-1.0)


def assembly_checks(
    mechanism: Mechanism, done: Assembled, solved: tuple[Statement, ...], offset: bool
) -> tuple[Statement, ...]:
    """The checks of a solved branch: the assembly mode of this machine, and the least distance from a type 2
    singularity.
    """
    if mechanism.is_platform:
        return platform_checks(mechanism, solved)
    if done.margin is None or mechanism.assembly is None:
        return ()
    bound = {s.name for s in solved if isinstance(s, Let)} | {real(c) for c in "xyz"}
    bound |= {s for j in mechanism.joints for s in (j.symbol, j.motor)} | {cosine(HEADING), sine(HEADING)}
    seen = {real(c): real(f"flange_{c}") for c in "xyz"} if offset else {}
    own = tuple(
        replace(s, value=s.value.xreplace(seen))
        for s in done.forward.statements
        if isinstance(s, Let) and s.name not in bound
    )
    margin = done.margin.xreplace(seen)
    name = real(f"type2_{mechanism.assembly.margin}")
    least = real(MIN_TYPE2_MARGIN)
    reason = about(mechanism.assembly.margin, Why.NEAR_TYPE_2, least - name)
    return (*own, Let(name, margin * ASSEMBLY_SIGN), Require(sp.Ge(name, least), Status.UNREACHABLE, reason=reason))


def bound_checks(mechanism: Mechanism, offset: bool) -> tuple[Statement, ...]:
    """The bounds that the description sets on quantities, checked at the solution."""
    seen = {real(c): real(f"flange_{c}") for c in "xyz"} if offset else {}
    checks: list[Statement] = []
    for b in mechanism.bounds:
        value, largest = (
            polynomial(with_fixed_names(mechanism, v), all_angles(mechanism), signs_of(mechanism)).xreplace(seen)
            for v in (b.value, b.largest)
        )
        reason = _beyond(b, sp.Abs(value), largest)
        checks.append(Require(sp.Le(sp.Abs(value), largest), Status.UNREACHABLE, b.meaning, reason))
    return tuple(checks)


def mirror_checks(mechanism: Mechanism, solved: tuple[Statement, ...]) -> tuple[Statement, ...]:
    """The checks that lengths are positive where the description says so and the step that solves for the length does
    not guarantee it.
    """
    values = {s.name: s.value for s in solved if isinstance(s, Let)}
    checks: list[Statement] = []
    for joint in mechanism.joints:
        value = values.get(joint.symbol)
        while value in values:
            value = values[value]
        if joint.is_angle or joint.symbol not in mechanism.positive or value is None or isinstance(value, Root):
            continue
        inside = sp.Ge(joint.symbol, -BOUNDARY * SCALE)
        reason = about(joint.name, Why.NO_POSE, -joint.symbol)
        checks.append(Require(inside, Status.UNREACHABLE, reason=reason))
    return tuple(checks)


def _beyond(bound: Bound, size: sp.Expr, largest: sp.Expr) -> Reason:
    """The reason of a bound; for the sine of an angle its amount is in degrees of the angle."""
    if isinstance(bound.largest, sp.sin):
        beyond = (angle_of_sine(size) - angle_of_sine(largest)) / DEGREE
        return about(bound.meaning, Why.BEYOND_LARGEST_ANGLE, beyond, Unit.ANGLE)
    return about(bound.meaning, Why.TOO_LARGE, size - largest)
