"""The comment at the top of a module: joints, letters, flags and pins of the machine."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from textwrap import wrap

from derive.description.mechanism import Parameter, Role
from derive.emit.braces import harmless
from derive.emit.c.description import in_words
from derive.emit.linuxcnc.words import Orientation, Words
from derive.kinematics.kinematics import Kinematics

_WIDTH = 104
"""The most columns of a line, behind its star."""
_ROTATION = {
    Orientation.NONE: "no angle",
    Orientation.COUNTED: "C, the angle about Z in degrees, a sum of joints that counts full turns",
    Orientation.NEAREST: "C, the angle about Z in degrees, on the turn that is nearest to the pose before",
    Orientation.AXES: "the values of the rotary joints themselves, in degrees: a program says where these stand",
    Orientation.ANGLES: "A, B, C in degrees: R = Rz(C) Ry(B) Rx(A), those that are nearest to the pose before",
}
_OUT = (
    ("parameters-refused (bit)", "the parameters are not allowed: the last ones that were allowed hold"),
    ("parameter-refused (s32)", "the number of the first one at fault, in the order above, from 1; 0: none"),
    ("is-singular (bit)", "the joints of the last forward kinematics are near a singularity, or have no pose"),
    ("forward-status, softkin.inverse-status (s32)", "0, or why the last call refused: 1 parameters, 2 numbers, "
     "3 out of reach or beyond a limit, 4 no assembly"),
    ("missing (float)", "by how much the last inverse kinematics is refused, in degrees or machine units"),
)  # fmt: skip


def head_of(kin: Kinematics, words: Words, pins: Mapping[str, str]) -> list[str]:
    """The lines of the comment behind those that say how to build and load it. pins: by the names of parameters."""
    return [harmless(line) for line in _lines(kin, words, pins)]


def _lines(kin: Kinematics, words: Words, pins: Mapping[str, str]) -> Iterator[str]:
    yield "joints, each with its letter in identity mode (motion.switchkins-type = 1):"
    for i, (joint, letter) in enumerate(zip(kin.mechanism.joints, words.of_joints, strict=True)):
        unit = "deg" if joint.in_degrees else "machine unit"
        yield from _item(f"{i} {joint.name} ({unit}) {letter}", joint.meaning)
    yield ""
    yield f"pose: {', '.join(words.position) or 'no position'} (machine units, as lengths below),"
    yield f"  {_ROTATION[words.orientation]}"
    for i, joint in enumerate(kin.mechanism.joints):
        if joint in kin.mechanism.held_joints and words.own[i]:
            yield f"  {words.own[i]}, the value of joint {i}, which no other letter moves"
    yield "  Other letters are written as 0, and not read."
    yield ""
    yield "flags, two bits a branch; 0: the branch nearest to the joints, 3: both branches meet:"
    for i, branch in enumerate(kin.branches):
        yield from _item(f"bits {2 * i}, {2 * i + 1} {branch.name}", f"1 {branch.names[0]}, 2 {branch.names[1]}")
    if not kin.branches:
        yield "  none: there is one solution"
    yield ""
    yield "pins that are read at the begin of every call:"
    for i, parameter in enumerate(kin.parameters, 1):
        kind = "bit" if parameter.role is Role.FLAG else "float"
        yield from _item(f"{i} softkin.{pins[parameter.name]} ({kind})", _described(parameter))
    yield "pins that are written:"
    for name, meaning in _OUT:
        yield from _item(f"softkin.{name}", meaning)
    yield from _item("kinstype.is-0, kinstype.is-1 (bit)", "this machine's kinematics; identity")


def _item(name: str, text: str) -> list[str]:
    return wrap(f"{name}: {text}", _WIDTH, initial_indent="  ", subsequent_indent="      ", break_on_hyphens=False)


def _described(p: Parameter) -> str:
    return f"{p.meaning}: {in_words(p)}; {'must be set' if p.default is None else f'{p.default:g} at first'}"
