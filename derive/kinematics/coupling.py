"""Coupling of a position and an orientation kinematics: which offsets of the orientation kinematics are allowed.

The end point of an orientation kinematics is a sum of shifts. A shift along the axis of all rotations before it is
fixed to the flange; a shift along the axis of all rotations behind it is fixed to the tool; any other lies in the wrist
between its axes. A flange that keeps its orientation allows all of them. If the position axes turn the flange, its
orientation is not known before they are solved. Then two parts are allowed: the part fixed to the flange along the axis
about which the flange turns, and the part fixed to the tool along directions that the commanded rotation gives.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from derive.description.mechanism import Mechanism, Turning
from derive.equations.axes import finite
from derive.equations.closures.commanded import flange_rotation
from derive.geometry.frames import Factor, Motion
from derive.geometry.pose import pose_of
from derive.ir.constants import HELD
from derive.ir.passes import normalise
from derive.ir.primitives import Root
from derive.ir.program import Let, Output, Program, Require, Statement, Status
from derive.ir.reason import Why, about_machine
from derive.ir.symbols import BASE_AXIS, COORDINATE_NAMES, FLANGE_AXIS, ROTATION_ENTRIES, real

_ALONG = real("flange_along")
_UNNOTICED = real("unnoticed_shift")
_ACROSS = "distance of the flange's part from the axis about which the flange turns"
_BETWEEN = "offset between the axes of the wrist: allowed where the flange keeps its orientation"
_UNMET = "part of the tool in directions that are not commanded"
_ROTATION = sp.Matrix(3, 3, list(ROTATION_ENTRIES))
_MET: dict[Turning, tuple[int, ...]] = {
    Turning.NONE: (),
    Turning.ABOUT_Z: (),
    Turning.DIRECTION: (2,),
    Turning.FULL: (0, 1, 2),
}
"""The columns of the commanded rotation that are reached exactly for every turn of the flange."""


@dataclass(frozen=True)
class EndPoint:
    """The end point in parts: one fixed to the flange, one fixed to the tool, and the size of the offset between the
    axes.
    """

    flange: tuple[sp.Expr, ...]
    tool: tuple[sp.Expr, ...]
    wrist: sp.Expr


def end_point_of(mechanism: Mechanism) -> EndPoint:
    """The parts of the end point of a chain."""
    assert mechanism.chain is not None
    factors = mechanism.chain.factors
    flange, tool = [sp.Integer(0)] * 3, [sp.Integer(0)] * 3
    between: list[sp.Expr] = []
    for i, factor in enumerate(factors):
        if factor.motion is not Motion.SHIFT:
            continue
        if _all_about(factors[:i], factor.axis):
            flange[factor.axis] += factor.amount
        elif _all_about(factors[i:], factor.axis):
            tool[factor.axis] += factor.amount
        else:
            between.append(factor.amount)
    return EndPoint(tuple(flange), tuple(tool), _size(between))


def coupling_programs(mechanism: Mechanism) -> tuple[Program, ...]:
    """The programs that a coupling calls of an orientation kinematics: see `Kinematics`."""
    found = (_compatible(mechanism), _end_point_shift(mechanism))
    return found if _MET[mechanism.task.turning] else (*found, _total_image(mechanism))


def _compatible(mechanism: Mechanism) -> Program:
    parts = end_point_of(mechanism)
    across = [s - a * _ALONG for s, a in zip(parts.flange, FLANGE_AXIS, strict=True)]
    unmet = [s for k, s in enumerate(parts.tool) if k not in _MET[mechanism.task.turning]]
    lengths = [p.symbol for p in mechanism.parameters if p.unit == "u"]
    body: list[Statement] = [
        Let(_UNNOTICED, HELD * sp.Add(*map(sp.Abs, lengths)), "offsets up to this length count as zero")
    ]
    if any(parts.flange):
        body += [*finite(FLANGE_AXIS), *_along(parts), Let(real("flange_offset"), _size(across), _ACROSS)]
        body.append(_unnoticed("flange_offset"))
    for name, value, note in (("wrist_offset", parts.wrist, _BETWEEN), ("unmet_offset", _size(unmet), _UNMET)):
        if value != 0:
            body += [Let(real(name), value, note), _unnoticed(name)]
    return normalise("compatible", body, [])


def _unnoticed(name: str) -> Require:
    """The condition that the shift with this name is so small that it counts as zero."""
    return Require(
        sp.Le(real(name), _UNNOTICED), Status.INVALID_COUPLING, reason=about_machine(Why.TURNS_WITH_THE_FLANGE)
    )


def _end_point_shift(mechanism: Mechanism) -> Program:
    parts, met = end_point_of(mechanism), _MET[mechanism.task.turning]
    tool = sp.Matrix([s if k in met else 0 for k, s in enumerate(parts.tool)])
    place = _ROTATION * tool
    body: list[Statement] = []
    if any(parts.flange):
        place += sp.Matrix(BASE_AXIS) * _ALONG
        body += [*finite((*FLANGE_AXIS, *BASE_AXIS)), *_along(parts)]
    return normalise("end_point_shift", body, [Output(c, v) for c, v in zip(COORDINATE_NAMES, place, strict=True)])


def _total_image(mechanism: Mechanism) -> Program:
    """The orientations that tool and flange can take together, and the distance between both axes of rotation."""
    assert mechanism.chain is not None
    without_joints = mechanism.task.turning is Turning.NONE  # then the tool may be inclined by any angle
    own = sp.Matrix(pose_of(mechanism.chain).rotation if without_joints else flange_rotation(mechanism.chain))
    outputs = [Output(f"zero_{r.name}", v) for r, v in zip(ROTATION_ENTRIES, _ROTATION * own, strict=True)]
    read = [*FLANGE_AXIS]
    axis = sp.Matrix([0, 0, 1])
    rot, u, apart = sp.Matrix(BASE_AXIS), own.T * sp.Matrix(FLANGE_AXIS), sp.Integer(0)
    if mechanism.task.turning is Turning.NONE:
        read += BASE_AXIS
    else:
        rot, u, apart = _ROTATION * axis, own.T * axis, _size(list(axis.cross(sp.Matrix(FLANGE_AXIS))))
    outputs += [Output(f"rot_{c}", v) for c, v in zip(COORDINATE_NAMES, rot, strict=True)]
    outputs += [Output(f"u_{c}", v) for c, v in zip(COORDINATE_NAMES, u, strict=True)]
    return normalise("total_image", finite(read), [*outputs, Output("apart", apart)])


def _along(parts: EndPoint) -> tuple[Let, ...]:
    along = sp.Add(*[s * a for s, a in zip(parts.flange, FLANGE_AXIS, strict=True)])
    return (Let(_ALONG, along, "the flange's part along the axis about which the flange turns"),)


def _size(values: Sequence[sp.Expr]) -> sp.Expr:
    """The length of a vector; with a single entry its absolute value."""
    found = [v for v in values if v != 0]
    if len(found) < 2:
        return sp.Abs(found[0]) if found else sp.Integer(0)
    return Root(sp.Add(*[v**2 for v in found]))


def _all_about(factors: Sequence[Factor], axis: int) -> bool:
    return all(f.axis == axis for f in factors if f.motion is not Motion.SHIFT)
