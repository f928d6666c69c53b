"""Which tools a machine can carry.

The inverse of a mounted machine commands its flange. So the flange must be known before the axes are; what it follows
says which tools are possible (`Mechanism._follows`):

    fixed        the flange keeps its rotation: every tool
    whole        it follows the commanded rotation: every tool
    turn         it takes the nearest turn about one axis, which the rotation alone says: every tool
    direction    the turn about the tool is passive: tools along it, and not inclined
    pitch        the nearest pitch depends on the position: every tool, by iteration to the point that is commanded
    one axis     the position alone turns it about one axis: tools along that axis
    several axes the position alone turns it: no shift
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import hypot
from typing import Any

from softkin._constants import EXACT, HELD
from softkin._core import DIRECTION, FIXED, ONE_AXIS, SEVERAL_AXES, TWIST, Mechanism
from softkin._frame import ORIGIN, Frame
from softkin._types import KinematicsError, Rotation, Status, Vector
from softkin._vectors import dot, transposed, turned

UNNOTICED = HELD
"""A shift of a tool is not noticed where it is at most this share of the tool."""
TILTS = ("tilt x", "tilt y")
"""The rows of a Jacobian about the axes of the tool."""
_TRANSLATIONS, _ROTATIONS = TWIST[:3], TWIST[3:]


def check_tool(robot: Mechanism, tool: Frame) -> None:
    """Refuse a tool with which a commanded frame does not determine the flange."""
    kind, shift, noticed = robot._follows(), tool.position, UNNOTICED * sum(map(abs, tool.position))
    why = ""
    if kind == DIRECTION and hypot(tool.rotation[0][2], tool.rotation[1][2], tool.rotation[2][2] - 1.0) > UNNOTICED:
        why = "the turn about the direction that it follows is passive: the tool may not be inclined"
    elif {*"xyz"}.isdisjoint(robot.JACOBIAN_ROWS):  # it follows rotations, and no position
        return
    elif kind == DIRECTION and hypot(shift[0], shift[1]) > noticed:
        why = "the turn about the direction that it follows is passive: the tool may be shifted along z only"
    elif kind == ONE_AXIS:
        (axis, _), along = _axes_of(robot), 0.0
        along = sum(a * s for a, s in zip(axis, shift, strict=True))
        if hypot(*(s - along * a for a, s in zip(axis, shift, strict=True))) > noticed:
            why = "its position axes alone turn the flange about one axis: the tool may be shifted along that axis only"
    elif kind == SEVERAL_AXES and hypot(*shift) > 0.0:
        why = "its position axes alone turn the flange: the tool may not be shifted"
    if why:
        message = f"{robot.NAME} cannot carry a tool at {shift}: {why}; a commanded frame does not determine the flange"
        raise KinematicsError(Status.INVALID_COUPLING, message)


def _axes_of(robot: Mechanism) -> tuple[Vector, Vector]:
    """The axis about which the flange turns, in the frames of flange and machine."""
    image = robot.orientation_image()
    return image.flange_axis, image.base_axis


def known_shift(robot: Mechanism, shift: Vector) -> Vector | None:
    """The vector from the flange to the tool, where it is the same for all frames."""
    kind = robot._follows()
    if shift == ORIGIN or kind == SEVERAL_AXES:
        return ORIGIN
    if kind == FIXED:
        return turned(robot.orientation_image().rotation, shift)
    if kind == ONE_AXIS:
        axis, fixed = _axes_of(robot)
        along = sum(a * s for a, s in zip(axis, shift, strict=True))
        return fixed[0] * along, fixed[1] * along, fixed[2] * along
    return None


def rows_of(bare: Mechanism, base: Frame, tool: Frame) -> tuple[str, ...]:
    """The rows of the bare machine, where base and tool turn none of them into others; else all six of a twist."""
    rows = bare.JACOBIAN_ROWS
    keeps = TILTS[0] not in rows or abs(tool.rotation[2][2] - 1.0) <= UNNOTICED
    for names in (_TRANSLATIONS, _ROTATIONS):
        inside = [i for i, name in enumerate(names) if name in rows]
        outside = [i for i in range(3) if i not in inside]
        keeps = keeps and all(abs(base.rotation[o][i]) <= EXACT for o in outside for i in inside)
    return rows if keeps else TWIST


def rows_by_name(
    names: Sequence[str], twist: Sequence[Any], rotation: Rotation, others: Iterable[tuple[str, Any]] = ()
) -> tuple[Any, ...]:
    """The rows of these names: of a twist, its turns about the axes of the tool, and others that are known.

    twist: six rows with an entry an axis; of an acceleration each is one number. An entry may be an array.
    """
    turns = twist[3:]
    known = {**dict(others), **dict(zip(TWIST, twist, strict=True))}
    for name, along in zip(TILTS, transposed(rotation), strict=False):
        has_entries = isinstance(turns[0], tuple)
        known[name] = tuple([dot(along, t) for t in zip(*turns, strict=True)]) if has_entries else dot(along, turns)
    return tuple([known[name] for name in names])
