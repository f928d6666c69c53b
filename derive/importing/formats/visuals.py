"""The shapes of a URDF's links: where each stands at joint values of zero, and how many joints of the chain move it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from derive.importing.arms.lines import motion
from derive.importing.formats.documents import Element, numbers, parsed, required, without_namespace
from derive.importing.formats.trees import Edge, path_between, tree_of
from derive.importing.formats.urdf import edge_of, places_of
from derive.importing.robot import Array, Place, Robot, UnreadableRobot

Colour = tuple[float, float, float]


@dataclass(frozen=True)
class Visual:
    """One shape of a link."""

    link: str
    place: Array
    """Its frame in that of the base, all joints at zero (4 x 4)."""
    movers: int
    """The number of moving joints of the chain between the base and the link."""
    geometry: Element
    """The element that states the shape: `mesh`, `box`, `cylinder`, `sphere`."""
    colour: Colour | None
    """Red, green and blue from 0 to 1, as the file states them for a screen."""


def visuals_of(path: Path, robot: Robot, scale: float) -> tuple[tuple[Visual, ...], tuple[str, ...]]:
    """The shapes of all links that hang on the chain of a robot, and sentences on what was left out.

    A joint that is not between base and tip stands at zero. scale: our unit in metres.
    """
    root = without_namespace(parsed(path))
    tree = _Tree(path, root, robot, scale)
    tree.walk()
    colours = {m.get("name"): found for m in root.findall("material") if (found := _colour(path, m)) is not None}
    visuals: list[Visual] = []
    for link in root.findall("link"):
        name = link.get("name", "")
        for visual in link.findall("visual") if name in tree.frames else ():
            frame, movers = tree.frames[name]
            try:
                visuals += _visual(path, visual, Visual(name, frame, movers, visual, None), colours, scale)
            except UnreadableRobot as problem:
                tree.left.append(f"Left out: a shape of link {name!r}: {str(problem).removeprefix(f'{path}: ')}.")
    return tuple(visuals), tuple(tree.left)


def _visual(
    path: Path, element: Element, on: Visual, colours: Mapping[str | None, Colour], scale: float
) -> Iterator[Visual]:
    place = on.place @ _matrix(places_of(path, element, "its visual", scale))
    material = element.find("material")
    stated = None if material is None else _colour(path, material) or colours.get(material.get("name"))
    for geometry in element.findall("geometry/*"):
        yield Visual(on.link, place, on.movers, geometry, stated)


def _colour(path: Path, material: Element) -> Colour | None:
    color = material.find("color")
    if color is None:
        return None
    try:
        red, green, blue, _ = numbers(path, color, "rgba", "its colour", (0.5, 0.5, 0.5, 1.0))
    except UnreadableRobot:
        return None
    return (min(max(red, 0.0), 1.0), min(max(green, 0.0), 1.0), min(max(blue, 0.0), 1.0))


class _Tree:
    """The links of a file, found from its base over the chain, then over all other joints."""

    def __init__(self, path: Path, root: Element, robot: Robot, scale: float) -> None:
        self.path, self.robot, self.scale = path, robot, scale
        self.joints = {required(path, j, "name"): j for j in root.findall("joint")}
        self.edges = [edge_of(path, joint) for joint in self.joints.values()]
        self.frames: dict[str, tuple[Array, int]] = {robot.base: (np.eye(4), 0)}
        self.left: list[str] = []

    def walk(self) -> None:
        """Find the frames of all links that hang on the chain."""
        above, _ = tree_of(self.edges)
        passed = path_between(self.path, above, self.robot.base, self.robot.tip)
        self._over_chain(passed)
        names = {edge.name for edge, _ in passed}
        beside: dict[str, list[Edge]] = {}
        for edge in self.edges:
            if edge.name not in names:
                beside.setdefault(edge.parent, []).append(edge)
                beside.setdefault(edge.child, []).append(edge)
        known = list(self.frames)
        for link in known:  # it grows
            for edge in beside.get(link, ()):
                if not {edge.parent, edge.child} <= self.frames.keys():
                    known += self._over_other(edge, link)

    def _over_chain(self, passed: Sequence[tuple[Edge, bool]]) -> None:
        steps = iter(self.robot.steps)
        frame, movers = np.eye(4), 0
        for edge, is_up in passed:
            is_moving = self.joints[edge.name].get("type") != "fixed"
            for step in [next(steps) for _ in range(2 if is_up and is_moving else 1)]:
                frame = frame @ _matrix(step.places)
                if step.moving is not None:
                    frame = frame @ motion(step.moving, step.moving.offset)
                    movers += bool(step.moving.drives)
            self.frames[edge.parent if is_up else edge.child] = (frame, movers)

    def _over_other(self, edge: Edge, link: str) -> list[str]:
        """The link on the other side of a joint that is not between base and tip; none if it cannot be placed."""
        joint = self.joints[edge.name]
        other = edge.child if link == edge.parent else edge.parent
        mimic = joint.find("mimic")
        if mimic is not None and mimic.get("joint") in {axis.name for axis in self.robot.axes}:
            self.left.append(
                f"Left out: the shapes behind joint {edge.name!r}, which follows an axis beside the chain."
            )
            return []
        try:
            place = _matrix(places_of(self.path, joint, f"joint {edge.name!r}", self.scale))
        except UnreadableRobot as problem:
            self.left.append(f"Left out: the shapes behind {str(problem).removeprefix(f'{self.path}: ')}.")
            return []
        frame, movers = self.frames[link]
        self.frames[other] = (frame @ (place if link == edge.parent else np.linalg.inv(place)), movers)
        return [other]


def _matrix(places: Sequence[Place]) -> Array:
    frame = np.eye(4)
    for place in places:
        frame = frame @ place.matrix()
    return frame
