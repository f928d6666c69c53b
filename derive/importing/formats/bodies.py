"""The bodies and sites of an MJCF, the way between two of them, and their places as the file draws them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from derive.importing.formats.documents import numbers, roundings
from derive.importing.robot import Array, Oriented, Place, Shifted, Turned, UnreadableRobot, about

Element = ElementTree.Element
WORLD = "world"


@dataclass(frozen=True)
class Frame:
    """A body or a site, below another body; a `<frame>` between them only shifts and turns."""

    name: str
    element: Element
    parent: str | None
    body_class: str | None
    before: tuple[Place, ...] = ()


def frames_of(file: File) -> Iterator[Frame]:
    """The world, every body, and every site with a name."""
    world = file.root.find("worldbody")
    if world is None:
        raise UnreadableRobot(f"{file.path}: has no worldbody")
    names: set[str] = set()
    for frame in (Frame(WORLD, world, None, None), *_below(file, world, Frame(WORLD, world, None, None), WORLD)):
        if frame.name in names:
            raise UnreadableRobot(f"{file.path}: two bodies or sites are called {frame.name!r}")
        names.add(frame.name)
        yield frame


def _below(file: File, parent: Element, body: Frame, label: str) -> Iterator[Frame]:
    """The bodies and sites in a body, or in a frame of it. label: the beginning of names for those without a name."""
    for number_, element in enumerate(parent):
        inner = element.get("childclass") or body.body_class
        own = element.get("name") or f"{label}.{number_}"
        if element.tag == "frame":
            if element.find("joint") is not None or element.find("freejoint") is not None:
                raise UnreadableRobot(
                    f"{file.path}: a frame in body {body.name!r} holds a joint: write the joint into the body"
                )
            places = (*body.before, *places_of(file, element, f"frame {own!r}"))
            yield from _below(file, element, replace(body, body_class=inner, before=places), own)
        if element.tag == "site" and element.get("name"):
            yield Frame(own, element, body.name, body.body_class, body.before)
        if element.tag == "body":
            yield (frame := Frame(own, element, body.name, inner, body.before))
            yield from _below(file, element, replace(frame, before=()), own)


def passed(frames: Mapping[str, Frame], base: str, tip: str) -> list[tuple[str, bool]]:
    """The bodies from the base to the tip, each with whether it is passed from itself to its parent."""
    up, down = _to_world(frames, base), _to_world(frames, tip)
    while up and down and up[-1] == down[-1]:
        up.pop()
        down.pop()
    return [*((name, True) for name in up), *((name, False) for name in reversed(down))]


def own_joints(frame: Frame) -> list[tuple[str, Element]]:
    """The joints in a body, with their names."""
    joints = frame.element.findall("joint")
    return [(joint.get("name") or f"{frame.name}.{index}", joint) for index, joint in enumerate(joints)]


def _to_world(frames: Mapping[str, Frame], name: str) -> list[str]:
    found = []
    while (parent := frames[name].parent) is not None:
        found.append(name)
        name = parent
    return found


def link_of(frames: Mapping[str, Frame], name: str) -> str:
    """The body, at or above a body or site, that moves with it: the first one with joints, or the world."""
    while (parent := frames[name].parent) is not None and not own_joints(frames[name]):
        name = parent
    return name


def drawn(file: File, frames: Mapping[str, Frame], name: str) -> Array:
    """The pose of a body or site in the world (4 x 4), as the file draws it."""
    pose = np.eye(4)
    for above in reversed(_to_world(frames, name)):
        frame = frames[above]
        for place in (*frame.before, *places_of(file, frame.element, f"{frame.element.tag} {above!r}")):
            pose = pose @ place.matrix()
    return pose


_AXES = 0.71
"""The largest angular error of an axis whose numbers are rounded by half a unit, in units: slightly more than 1/√2."""
_QUATERNION = 2.0 * _AXES
"""The largest angular error of a quaternion, whose numbers belong to half the turn."""


@dataclass(frozen=True)
class File:
    """A file with its compiler settings and defaults."""

    path: Path
    root: Element
    degree: float
    """One unit of its angles, in radians."""
    sequence: str
    limits_by_range: bool
    scale: float


def places_of(file: File, element: Element, place: str) -> tuple[Place, ...]:
    if element.tag == "worldbody":
        return ()
    x, y, z = (v * file.scale for v in numbers(file.path, element, "pos", place, (0.0, 0.0, 0.0)))
    given = [a for a in ("quat", "axisangle", "euler", "xyaxes", "zaxis") if element.get(a)]
    if len(given) > 1:
        raise UnreadableRobot(f"{file.path}: {place} gives its orientation twice: {' and '.join(given)}")
    turned = _ORIENTATIONS[given[0]](file, element, place) if given else ()
    return (Shifted((x, y, z)), *turned)


def _euler(file: File, element: Element, place: str) -> tuple[Place, ...]:
    angles = numbers(file.path, element, "euler", place, (0.0, 0.0, 0.0))
    sequence = file.sequence
    if len(sequence) != 3 or set(sequence.lower()) - set("xyz") or sequence not in (sequence.lower(), sequence.upper()):
        raise UnreadableRobot(f"{file.path}: its sequence of angles {sequence!r} is not three of xyz, or of XYZ")
    rounded = roundings(element, "euler", 3, with_coarse=True) if file.degree == 1.0 else (0.0, 0.0, 0.0)
    turns = [
        Turned("xyz".index(c.lower()), a * file.degree, r) for c, a, r in zip(sequence, angles, rounded, strict=True)
    ]
    return tuple(turns if sequence.islower() else turns[::-1])


def _quaternion(file: File, element: Element, place: str) -> tuple[Place, ...]:
    w, x, y, z = _unit(file, numbers(file.path, element, "quat", place, (1.0, 0.0, 0.0, 0.0)), place)
    return (
        _oriented(
            np.array(
                [
                    [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
                ]
            ),
            _QUATERNION * max(roundings(element, "quat", 4)),
        ),
    )


def _axis_angle(file: File, element: Element, place: str) -> tuple[Place, ...]:
    x, y, z, angle = numbers(file.path, element, "axisangle", place, (1.0, 0.0, 0.0, 0.0))
    rounded = roundings(element, "axisangle", 4)[3] if file.degree == 1.0 else 0.0
    axis = _unit(file, (x, y, z), place)
    along = int(np.argmax(np.abs(axis)))
    if np.count_nonzero(axis) == 1:
        return (Turned(along, float(axis[along]) * angle * file.degree, rounded),)
    return (_oriented(about(axis, angle * file.degree), 0.0),)


def _two_axes(file: File, element: Element, place: str) -> tuple[Place, ...]:
    stated = numbers(file.path, element, "xyaxes", place, (1.0, 0.0, 0.0, 0.0, 1.0, 0.0))
    x = _unit(file, stated[:3], place)
    y = np.array(stated[3:])
    y = _unit(file, tuple(y - x * float(x @ y)), place)
    return (_oriented(np.column_stack([x, y, np.cross(x, y)]), _AXES * max(roundings(element, "xyaxes", 6))),)


def _one_axis(file: File, element: Element, place: str) -> tuple[Place, ...]:
    z = _unit(file, numbers(file.path, element, "zaxis", place, (0.0, 0.0, 1.0)), place)
    rounded = _AXES * max(roundings(element, "zaxis", 3))
    across = np.cross([0.0, 0.0, 1.0], z)
    sine = float(np.linalg.norm(across))
    if sine < 1e-10:
        return () if z[2] > 0.0 else (Turned(0, math.pi),)
    return (_oriented(about(across / sine, math.atan2(sine, float(z[2]))), rounded),)


_ORIENTATIONS: Mapping[str, Callable[[File, Element, str], tuple[Place, ...]]] = {
    "quat": _quaternion,
    "axisangle": _axis_angle,
    "euler": _euler,
    "xyaxes": _two_axes,
    "zaxis": _one_axis,
}


def _unit(file: File, stated: Sequence[float], place: str) -> Array:
    size = math.sqrt(sum(v * v for v in stated))
    if size < 1e-9:
        raise UnreadableRobot(f"{file.path}: {place}: its orientation has no direction")
    return np.array(stated) / size


def _oriented(rotation: Array, rounding: float) -> Oriented:
    first, second, third = (tuple(map(float, row)) for row in rotation)
    return Oriented((first, second, third), rounding)  # type: ignore[arg-type]
