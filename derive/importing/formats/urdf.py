"""URDF, with its macros expanded: the chain of joints between two links.

It is read with the standard library: kinematics needs few elements, while existing readers depend on meshes, graphs and
a viewer, and accept a file with a wrong number or an unknown joint type without a message.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from xml.etree import ElementTree

from derive.description.joints import Kind
from derive.importing.formats.documents import (
    limit,
    number,
    numbers,
    parsed,
    required,
    rounding,
    roundings,
    without_namespace,
)
from derive.importing.formats.mimics import Follower, driven
from derive.importing.formats.transmissions import transmission_notes
from derive.importing.formats.trees import Edge, ends_of, path_between
from derive.importing.robot import (
    Axis,
    Moving,
    Place,
    Robot,
    Shifted,
    Step,
    Triple,
    Turned,
    UnreadableRobot,
    reversed_step,
)

Element = ElementTree.Element
_KINDS = {"revolute": Kind.ROTARY, "continuous": Kind.ROTARY, "prismatic": Kind.LINEAR}
_NOT_SERIAL = {"floating": "moves freely in space", "planar": "moves freely in a plane"}


def read_urdf(path: Path, base: str | None, tip: str | None, scale: float) -> Robot:
    """The chain between two links; without a name the root, and the one end there is. scale: our unit in metres."""
    root = without_namespace(parsed(path))
    if root.tag != "robot":
        raise UnreadableRobot(f"{path}: its root is <{root.tag}>, not <robot>: this is no URDF")
    _refuse_macros(path, root)
    edges = [_edge(path, joint) for joint in root.findall("joint")]
    links = [required(path, link, "name") for link in root.findall("link")]
    base, tip = ends_of(path, edges, links, base, tip)
    joints = {required(path, j, "name"): j for j in root.findall("joint")}
    passed = path_between(path, edges, links, base, tip)
    followers = _followers(path, joints, [edge.name for edge, _ in passed], scale)
    steps = tuple(
        step
        for edge, is_up in passed
        for step in reversed_step(_step(path, joints[edge.name], followers, scale), is_up)
    )
    used = dict.fromkeys(name for s in steps if s.moving for name, _ in s.moving.drives)
    axes = tuple(_axis(path, _commanded(path, joints, name), scale) for name in used)
    notes = (
        *_left_out(root, [edge.name for edge, _ in passed], used),
        *_ignored(root),
        *transmission_notes(path, root, used),
    )
    return Robot(root.get("name") or path.stem, f"{path.name} (URDF)", base, tip, steps, axes, notes)


def _refuse_macros(path: Path, root: Element) -> None:
    for element in root.iter():
        if "xacro" in element.tag or any("${" in value or "$(" in value for value in element.attrib.values()):
            raise UnreadableRobot(
                f"{path}: its macros are not expanded: write `xacro {path.name} > {path.stem}.urdf` and import that"
            )
        if element.tag.rpartition("}")[2] == "include":
            raise UnreadableRobot(f"{path}: includes another file, which URDF does not know: expand it with xacro")


def _edge(path: Path, joint: Element) -> Edge:
    name = required(path, joint, "name")
    ends = []
    for tag in ("parent", "child"):
        end = joint.find(tag)
        if end is None or not end.get("link"):
            raise UnreadableRobot(f"{path}: joint {name!r} names no {tag} link")
        ends.append(end.get("link", ""))
    return Edge(name, ends[0], ends[1])


def _step(path: Path, joint: Element, followers: Mapping[str, Follower], scale: float) -> Step:
    name = joint.get("name", "")
    places = _places(path, joint, name, scale)
    kind = _kind(path, joint)
    if kind is None:
        return Step(name, places)
    by = driven(path, name, followers)
    return Step(name, places, Moving(kind, _direction(path, joint, name), by.drives, by.offset, by.rounding))


def _kind(path: Path, joint: Element) -> Kind | None:
    name, stated = joint.get("name", ""), required(path, joint, "type")
    if stated == "fixed":
        return None
    if stated in _NOT_SERIAL:
        raise UnreadableRobot(
            f"{path}: joint {name!r} is {stated}: it {_NOT_SERIAL[stated]}; choose a base behind it or a tip before it"
        )
    if stated not in _KINDS:
        raise UnreadableRobot(
            f"{path}: joint {name!r} has the unknown type {stated!r}; there are {', '.join(_KINDS)}, fixed"
        )
    return _KINDS[stated]


def _places(path: Path, joint: Element, name: str, scale: float) -> tuple[Place, ...]:
    origin = joint.find("origin")
    if origin is None:
        return ()
    x, y, z = numbers(path, origin, "xyz", f"joint {name!r}", (0.0, 0.0, 0.0))
    angles = numbers(path, origin, "rpy", f"joint {name!r}", (0.0, 0.0, 0.0))
    rounded = roundings(origin, "rpy", 3)
    turns = tuple(Turned(k, angles[k], rounded[k]) for k in (2, 1, 0) if angles[k] != 0.0)
    return (Shifted((x * scale, y * scale, z * scale)), *turns)


def _direction(path: Path, joint: Element, name: str) -> Triple:
    axis = joint.find("axis")
    stated = (1.0, 0.0, 0.0) if axis is None else numbers(path, axis, "xyz", f"joint {name!r}", (1.0, 0.0, 0.0))
    size = math.sqrt(sum(v * v for v in stated))
    if size < 1e-9:
        raise UnreadableRobot(f"{path}: joint {name!r}: its axis has no direction")
    return (stated[0] / size, stated[1] / size, stated[2] / size)


def _followers(path: Path, joints: Mapping[str, Element], passed: Sequence[str], scale: float) -> dict[str, Follower]:
    """The followers among some joints, and among the joints that they follow; other mimics are not read."""
    found: dict[str, Follower] = {}
    left = list(passed)
    while left:
        name = left.pop()
        follower = None if name in found else _follower(path, joints, joints[name], scale)
        if follower is not None:
            found[name] = follower
            left.append(follower.leader)
    return found


def _follower(path: Path, joints: Mapping[str, Element], joint: Element, scale: float) -> Follower | None:
    mimic = joint.find("mimic")
    if mimic is None or joint.get("type") == "fixed":
        return None
    place = f"the mimic of joint {joint.get('name')!r}"
    leader = mimic.get("joint")
    if not leader:
        raise UnreadableRobot(f"{path}: {place} names no joint")
    unit, of_leader = (
        scale if _kind(path, j) is Kind.LINEAR else 1.0 for j in (joint, _commanded(path, joints, leader))
    )
    return Follower(
        leader,
        number(path, mimic.get("multiplier", "1"), f"{place}, multiplier") * unit / of_leader,
        number(path, mimic.get("offset", "0"), f"{place}, offset") * unit,
        rounding(mimic.get("offset", "0")) if unit == 1.0 else 0.0,
    )


def _commanded(path: Path, joints: Mapping[str, Element], name: str) -> Element:
    if name not in joints:
        raise UnreadableRobot(f"{path}: a joint mimics {name!r}, which is no joint of the file")
    return joints[name]


def _axis(path: Path, joint: Element, scale: float) -> Axis:
    name, kind = joint.get("name", ""), _kind(path, joint)
    if kind is None:
        raise UnreadableRobot(f"{path}: a joint mimics {name!r}, which is fixed")
    limits = joint.find("limit")
    if joint.get("type") == "continuous" or limits is None:
        return Axis(name, kind)
    unit = scale if kind is Kind.LINEAR else 1.0
    low, high = (limit(path, limits.get(end, "0"), f"joint {name!r}, {end} limit") * unit for end in ("lower", "upper"))
    if low > high:
        raise UnreadableRobot(f"{path}: joint {name!r}: its lower limit {low:g} is above its upper limit {high:g}")
    return Axis(name, kind, (low, high) if low < high else None)


def _left_out(root: Element, passed: list[str], used: Mapping[str, None]) -> tuple[str, ...]:
    names = {*passed, *used}
    left = [j.get("name", "") for j in root.findall("joint") if j.get("type") != "fixed" and j.get("name") not in names]
    return (f"Left out, because they are not between base and tip: {', '.join(left)}.",) if left else ()


def _ignored(root: Element) -> tuple[str, ...]:
    tags = {
        "inertial": "masses",
        "visual": "meshes",
        "collision": "collision bodies",
    }
    found = [word for tag, word in tags.items() if root.find(f"link/{tag}") is not None]
    notes = [f"Not read, because kinematics does not need them: {', '.join(found)}."] if found else []
    return tuple(notes)
