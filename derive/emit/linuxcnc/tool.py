"""The tool of a machine: the parameter that is its length, which way it points, and what a table turns."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from derive.description.mechanism import Role
from derive.emit.linuxcnc.words import Orientation, Words, flange_of
from derive.kinematics.kinematics import Kinematics

_FEWEST_AXES = 5
"""LinuxCNC itself adds the length of a tool along Z: that is right where the tool does not turn."""


@dataclass(frozen=True)
class Tool:
    """The tool, as a kinematics module tells of it."""

    length: str
    """The parameter that moves the position along the tool, of a machine with five or six axes; "" if there is none."""
    sense: sp.Expr
    """Of the z axis of the frame: 1 from the tip to the holder, -1 towards the work, or a constant of the machine."""
    on_table: tuple[bool, ...]
    """Of each joint, whether it turns the work."""


def tool_of(kin: Kinematics, words: Words) -> Tool:
    """What the chain says of the tool. Without a length along z, a flange points towards the work; where it stays
    along the machine's z, the tool hangs.
    """
    hanging = flange_of(kin)
    name, sense = _length(kin)
    if hanging is not None or not name:
        return Tool("", sp.Integer(-1) if hanging is None else hanging, _on_table(kin, words))
    turns = words.orientation is Orientation.AXES or "turn x" in kin.rows
    has_pin = turns and len(kin.mechanism.joints) >= _FEWEST_AXES and "Z" in words.position
    return Tool(name if has_pin else "", -sense, _on_table(kin, words))


def _length(kin: Kinematics) -> tuple[str, sp.Expr]:
    """The last parameter that shifts the end of the chain along its z axis: its name, and which way."""
    if kin.mechanism.chain is None:
        return "", sp.Integer(0)
    end = kin.mechanism.chain.matrix()
    signs = [p.symbol for p in kin.mechanism.parameters if p.role is Role.SIGN]
    for parameter in reversed(kin.mechanism.parameters):
        moved = end[:3, 3].diff(parameter.symbol)
        for sense in (sp.Integer(1), sp.Integer(-1), *signs):
            if all(sp.expand(a - sense * b) == 0 for a, b in zip(moved, end[:3, 2], strict=True)):
                return parameter.name, sense
    return "", sp.Integer(0)


def _on_table(kin: Kinematics, words: Words) -> tuple[bool, ...]:
    """On a five-axis machine, whose frame is that of the work, the joints of the table turn the ways of slides."""
    joints, chain = kin.mechanism.joints, kin.mechanism.chain
    if words.orientation is not Orientation.AXES or chain is None:
        return tuple(False for _ in joints)
    place = chain.matrix()[:3, 3]
    slides = [j.symbol for j, own in zip(joints, words.own, strict=True) if not own]
    turning = {symbol for slide in slides for entry in place.diff(slide) for symbol in sp.expand(entry).free_symbols}
    return tuple(joint.symbol in turning for joint in joints)
