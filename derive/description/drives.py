"""Loops that move joints of a chain: an actuator outside the chain, a cylinder or a rod, and the joint that follows.

The joint stands in the chain, the actuator among the joints of the mechanism. Of two solutions, for the joint and for
the actuator, the machine has those on the side of its nominal values.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import sympy as sp

from derive.description.dimensions import Parameter
from derive.description.errors import DescriptionError
from derive.description.joints import Joint, Loop
from derive.geometry.frames import Chain
from derive.ir.constants import DEGREE
from derive.ir.interpret import evaluate

_Nominal = dict[sp.Symbol, sp.Float]
_OPEN = 0.02
"""The largest share of its length by which a loop may be open at nominal values."""


@dataclass(frozen=True)
class Drive:
    """A joint of the chain that a loop moves; see `driven`."""

    joint: Joint
    by: Joint
    start: Chain
    tip: Chain
    length: sp.Expr
    side: sp.Expr
    by_side: sp.Expr


def driven(
    joint: Joint,
    *,
    by: Joint,
    start: Chain,
    tip: Chain,
    length: object | None = None,
    side: object = 1,
    by_side: object = 1,
) -> Drive:
    """A joint of the chain that moves as a loop says: the distance from `start` to `tip` is `length`.

    Both ends are frames of the frame in which the joint stands. A cylinder has the length of its actuator, which need
    not be given: `driven(A2, by=S2, start=Tx(D), tip=Ry(A2) * Tx(L))`. A crank with a rod moves the start:
    `driven(A2, by=M2, start=Tx(D) * Ry(M2) * Tx(CRANK), tip=Ry(A2) * Tx(L), length=ROD)`.

    side, by_side: 1 if the joint (the actuator) is on the side of its nominal value, -1 if it is on the other one; or a
    parameter, `sign(...)`, which decides it.
    """
    for word, end in (("start", start), ("tip", tip)):
        if not isinstance(end, Chain):
            raise DescriptionError(f"driven({joint.name}, ...): {word}= must be a frame: as in {word}=Tx(L1) * Tz(L2)")
    size = sp.sympify(by if length is None else length)
    return Drive(joint, by, start, tip, size, sp.sympify(side), sp.sympify(by_side))


def with_loops(
    joints: tuple[Joint, ...], drives: Sequence[Drive], parameters: Sequence[Parameter]
) -> tuple[Joint, ...]:
    """The actuators, each with the loops between it and the joint of the chain, whose symbol it then has."""
    if not drives or any(joint.loops for joint in joints):
        return joints
    _refuse(joints, drives)
    known = {j.symbol: _nominal(j) for j in joints} | {d.joint.symbol: _nominal(d.joint) for d in drives}
    moving = {*known}
    known |= {p.symbol: sp.Float(p.nominal) for p in parameters}
    following = {d.by.symbol: d for d in drives}
    found = []
    for joint in joints:
        way: list[Drive] = []
        while (drive := following.get((way[-1].joint if way else joint).symbol)) is not None and drive not in way:
            way.append(drive)
        loops = tuple(_loop(drive, known, moving, joint) for drive in way)
        symbol = way[-1].joint.symbol if way else joint.symbol
        found.append(replace(joint, symbol=symbol, loops=loops, multi_turn=joint.multi_turn and not loops))
    return tuple(found)


def _refuse(joints: Sequence[Joint], drives: Sequence[Drive]) -> None:
    """Refuse drives of which no joint or more than one joint follows, and those of which more than one is asked."""
    actuators, moved = {j.symbol for j in joints}, Counter(d.joint.name for d in drives)
    moving = Counter(d.by.name for d in drives)
    passive = {d.joint.symbol for d in drives}
    for drive in drives:
        name, by = drive.joint.name, drive.by.name
        if moved[name] > 1:
            raise DescriptionError(f"joint {name!r} is driven {moved[name]} times: one loop decides it")
        if moving[by] > 1:
            raise DescriptionError(f"{by!r} drives {moving[by]} joints: give each an actuator of its own")
        if drive.joint.symbol in actuators:
            raise DescriptionError(f"joint {name!r} is driven by {by!r}: leave it out of joints=, it has no motor")
        if drive.by.symbol not in actuators | passive:
            raise DescriptionError(f"joint {name!r} is driven by {by!r}, which is no joint of this mechanism")


def _nominal(joint: Joint) -> sp.Float:
    return sp.Float(np.radians(joint.nominal) if joint.is_angle else joint.nominal)


def _number(value: sp.Expr, known: _Nominal) -> float:
    """A value at nominal joints and parameters: by symbols, as a joint may have the name of a parameter."""
    return float(evaluate(value.xreplace(known), {}))


def _loop(drive: Drive, known: _Nominal, moving: set[sp.Symbol], actuator: Joint) -> Loop:
    """The loop of a drive, with the sides of its nominal values; the actuator's own symbol is that of its motor.

    moving: the symbols of all joints.
    """
    table, name, ends = {actuator.symbol: actuator.motor}, drive.joint.name, (drive.start, drive.tip)
    turns, sides = (drive.joint.is_angle, drive.by.is_angle), (drive.side, drive.by_side)
    plain = Loop(drive.joint.symbol, drive.by.symbol, turns, sides, *ends, drive.length, name)
    read = plain.equation.free_symbols
    for joint in (drive.joint, drive.by):
        if joint.symbol not in read:
            raise DescriptionError(f"the loop of joint {name!r} does not read {joint.name!r}")
    if unknown := sorted(s.name for s in read - {DEGREE} if s not in known):
        raise DescriptionError(
            f"the loop of joint {name!r} reads {unknown[0]!r}, which is not a joint or a parameter of this mechanism"
        )
    if others := sorted(s.name for s in (read & moving) - {plain.moved, plain.by}):
        raise DescriptionError(
            f"the loop of joint {name!r} reads {others[0]!r}: only {name!r} and {drive.by.name!r} may move its ends"
        )
    _refuse_open(drive, plain, known)
    signs = [np.sign(_number(sp.diff(plain.equation, s), known)) for s in (plain.moved, plain.by)]
    if 0.0 in signs:
        raise DescriptionError(f"the loop of joint {name!r} is at a dead point with nominal values")
    moved, motor = (int(sign) * stated for sign, stated in zip(signs, sides, strict=True))
    start, tip = (Chain(tuple(replace(f, amount=f.amount.xreplace(table)) for f in end.factors)) for end in ends)
    by = table.get(plain.by, plain.by)
    return replace(plain, by=by, sides=(moved, motor), start=start, tip=tip, length=plain.length.xreplace(table))


def _refuse_open(drive: Drive, loop: Loop, known: _Nominal) -> None:
    distance = _number(sp.sqrt(loop.vector.dot(loop.vector)), known)
    length = _number(loop.length, known)
    if abs(distance - length) > _OPEN * max(distance, length):
        raise DescriptionError(
            f"the loop of joint {drive.joint.name!r} is open at the nominal values of {drive.joint.name} "
            f"({drive.joint.nominal:g}) and {drive.by.name} ({drive.by.nominal:g}): its ends are {distance:g} apart, "
            f"and its length is {length:g}"
        )
