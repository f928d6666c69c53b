"""Closed loops of a file: an arm is not imported without one that binds its joints."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from derive.importing.formats.bodies import WORLD, Element, File, Frame, drawn, own_joints, passed
from derive.importing.formats.documents import numbers, shown
from derive.importing.robot import Array, Triple, UnreadableRobot


@dataclass(frozen=True)
class Loop:
    """What closes a loop, and the two links that it joins."""

    closed_by: str
    first: str
    second: str


@dataclass(frozen=True)
class Joints:
    """Names of joints: those that move the chain, those that follow others, and those that have a motor."""

    used: Container[str]
    followers: Container[str | None]
    driven: Container[str | None]


def loop_notes(path: Path, loops: Iterable[tuple[Loop, Sequence[str]]], joints: Joints) -> Iterator[str]:
    """A note on each loop that may be left out. loops: each with its moving joints.

    Raises `UnreadableRobot` for a loop that binds a joint of the chain: as an open arm it would be another machine.
    """
    for loop, inside in loops:
        closed = f"{loop.closed_by} closes a loop of the joints {', '.join(map(shown, inside))}"
        if is_followed(inside, joints.followers):
            yield f"Not read, because its joints follow each other: {closed}."
        elif any(name in joints.used for name in inside):
            raise UnreadableRobot(f"{path}: {closed}{_passive(inside, joints)}: {_REMEDY}")
        elif inside:
            yield f"Not read, because no joint between base and tip is in it: {closed}."


def is_followed(inside: Sequence[str], followers: Container[str | None]) -> bool:
    """Whether the joints of a loop follow each other, so that one alone moves it."""
    following = [name for name in inside if name in followers]
    return bool(following) and len(following) >= len(inside) - 1


_REMEDY = (
    "as an open arm it would be another machine; describe it with rods (docs/OWN_MACHINE.md, `rod`), whose lengths are "
    "distances of joints in the file"
)


def _passive(inside: Sequence[str], joints: Joints) -> str:
    """Which joints of a loop have no motor, where some have one."""
    names = [name for name in inside if name not in joints.driven]
    if not names or len(names) == len(inside):
        return ""
    return f", of which {', '.join(map(shown, names))} {'is' if len(names) == 1 else 'are'} passive"


@dataclass(frozen=True)
class Closed:
    """An equality that closes a loop, the two bodies or sites that it holds together, and the joints in the loop."""

    element: Element
    first: str
    second: str
    joints: tuple[str, ...]

    @property
    def tag(self) -> str:
        """Its kind: `connect` or `weld`."""
        return self.element.tag


@dataclass(frozen=True)
class Loops:
    """A file with its joints (with their defaults) and loops, seen from a base."""

    file: File
    frames: Mapping[str, Frame]
    joints: Mapping[str, Mapping[str, str]]
    base: str

    @cached_property
    def closed(self) -> tuple[Closed, ...]:
        """The loops that equalities close. A body that moves freely, or that a program moves (mocap), is bound by one,
        and closes none.
        """
        found = []
        for element in (e for tag in ("connect", "weld") for e in self.file.root.findall(f"equality/{tag}")):
            first, second = (element.get(f"body{k}") or element.get(f"site{k}") or WORLD for k in (1, 2))
            if element.get("active") != "false" and first in self.frames and second in self.frames:
                way = [self.frames[name] for name, _ in passed(self.frames, first, second)]
                if not any(self._is_free(frame) for frame in way):
                    names = tuple(name for frame in way for name, _ in own_joints(frame))
                    found.append(Closed(element, first, second, names))
        return tuple(found)

    def _is_free(self, frame: Frame) -> bool:
        element = frame.element
        is_free = element.find("freejoint") is not None or element.get("mocap") == "true"
        return is_free or any(self.joints[name].get("type") == "free" for name, _ in own_joints(frame))

    @cached_property
    def driven(self) -> frozenset[str | None]:
        """The joints that actuators move."""
        actuators = self.file.root.findall("actuator/*")
        return frozenset(e.get(word) for e in actuators for word in ("joint", "jointinparent"))

    @cached_property
    def followers(self) -> frozenset[str | None]:
        """The joints that an equality makes follow others."""
        equalities = self.file.root.findall("equality/joint")
        return frozenset(e.get("joint1") for e in equalities if e.get("active") != "false")

    def way(self, name: str) -> list[str]:
        """The joints between the base and a body or site."""
        return [joint for n, _ in passed(self.frames, self.base, name) for joint, _ in own_joints(self.frames[n])]

    def pose(self, name: str) -> Array:
        """The pose of a body or site in the base (4 x 4), as the file draws it."""
        there = drawn(self.file, self.frames, name)
        return np.asarray(np.linalg.inv(drawn(self.file, self.frames, self.base)) @ there)

    def stated(self, name: str, attribute: str, default: Triple) -> Array:
        """Three numbers of a joint."""
        element = Element("joint", dict(self.joints[name]))
        return np.array(numbers(self.file.path, element, attribute, f"joint {name!r}", default))
