"""The bodies and sites of an MJCF, the way between two of them, and their places as the file draws them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from xml.etree import ElementTree

import numpy as np

from derive.importing.formats.orientations import File, places_of
from derive.importing.robot import Array, Place, UnreadableRobot

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
