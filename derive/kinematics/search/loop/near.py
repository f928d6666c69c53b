"""The solution next to the reference: steps on the closure lead there from the reference, and nothing is searched.

A controller that follows a path asks for nothing else. Where several solutions have one value of the searched joint,
the other joints tell which one is meant.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import sympy as sp

from derive.description.mechanism import Joint, Mechanism
from derive.equations.axes import reference_value
from derive.ir.constants import BOUNDARY, CONVERGED, PASSES, STALLED
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, Wrap
from derive.ir.program import Call, Iterate, Let, Output, Program, Statement
from derive.ir.symbols import ROTATION_ENTRIES, SCALE, flag, real
from derive.kinematics.search.programs import ERROR, FITS, GOAL, IS_NEWTON, SLOW, begun, call_with, moved_to, posed

IS_NEAR = flag("is_near_reference")
"""Whether there is such a solution on the wanted branch."""
NEAR = sp.Float("0.1")
"""It is no further than this from the reference (radians and lengths of the machine, all joints added)."""
_BEFORE = real("error_before")
_FAR = sp.Integer(9)


def near_name(joint: Joint) -> sp.Symbol:
    """A joint of the solution next to the reference."""
    return real(f"followed_{joint.symbol.name}")


def near_program(mechanism: Mechanism, step: Program, fits: Program, arguments: Sequence[sp.Symbol]) -> Program:
    """The program that meets the pose from the reference. step, fits: as in the search; arguments: those of both that
    do not change.
    """
    joints = mechanism.solved_joints
    here: dict[sp.Symbol, sp.Expr] = {j.symbol: near_name(j) for j in joints}
    begins = [Let(begun(j.symbol), _value(j, reference_value(j))) for j in joints if not j.free]
    start = {near_name(j): _turn_of_tool() if j.free else begun(j.symbol) for j in joints}
    following: dict[sp.Symbol, sp.Expr] = {near_name(j): moved_to(j.symbol) for j in joints}
    newton_next = Let(flag("newton_next"), sp.And(sp.Not(IS_NEWTON), sp.Gt(ERROR, SLOW * _BEFORE)))
    following |= {_BEFORE: ERROR, IS_NEWTON: newton_next.name}
    ways = [sp.Abs(moved_to(j.symbol) - begun(j.symbol)) / (1 if j.is_angle else SCALE) for j in joints if not j.free]
    way = Let(real("way_from_reference"), sp.Add(*ways))
    is_far, is_last = sp.Gt(way.name, NEAR), sp.Gt(2 * ERROR, _BEFORE)
    is_met = sp.Or(sp.Le(ERROR, BOUNDARY / 100), sp.And(sp.Le(ERROR, CONVERGED), is_last))
    loop = Iterate(
        state=tuple(following),
        start=(*start.values(), _FAR, sp.false),
        step=(_call(step, arguments, {**here, IS_NEWTON: IS_NEWTON}), newton_next, way),
        following=tuple(following.values()),
        done=sp.Or(is_met, is_far, sp.Gt(ERROR, STALLED * _BEFORE)),
        limit=PASSES + 1,
        otherwise=None,
        note="one step towards the pose",
    )
    meets = sp.And(sp.Le(ERROR, CONVERGED), sp.Not(is_far))
    body: list[Statement] = [*begins]
    if any(j.free for j in joints):
        body += posed(mechanism, lambda joint: begun(joint.symbol))
    body.append(loop)
    body += [_call(fits, arguments, here, meets), Let(IS_NEAR, flag(FITS))]
    outputs = [
        Output(IS_NEAR.name, IS_NEAR),
        *(Output(near_name(j).name, _value(j, near_name(j))) for j in joints if not j.free),
    ]
    return replace(normalise("meet_from_reference", body, outputs), summary="The joints next to the reference")


def _value(joint: Joint, value: sp.Expr) -> sp.Expr:
    return Wrap(value) if joint.is_angle else value


def _turn_of_tool() -> sp.Expr:
    """How far the tool is turned about its line from where the arm has it to the commanded pose."""
    xs, ys = ROTATION_ENTRIES[::3], ROTATION_ENTRIES[1::3]
    along, across = (sp.Add(*(GOAL[x] * v for x, v in zip(xs, axis, strict=True))) for axis in (xs, ys))
    return Wrap(Atan2(across, along))


def _call(
    program: Program, arguments: Sequence[sp.Symbol], given: Mapping[sp.Symbol, sp.Expr], wanted: sp.Basic = sp.true
) -> Call:
    return call_with(program, arguments, given, lambda name: flag(name) if name == FITS else real(name), wanted)
