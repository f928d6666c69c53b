"""The loops of an MJCF, closed by `connect` and `weld`, and its joints as seen from a base."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from derive.importing.formats.bodies import WORLD, Element, Frame, drawn, own_joints, passed
from derive.importing.formats.documents import numbers
from derive.importing.formats.orientations import File
from derive.importing.robot import Array, Triple


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
