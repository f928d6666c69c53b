"""URDF: the chain of joints between two links.

It is read with the standard library: kinematics needs few elements, while existing readers depend on meshes, graphs and
a viewer, and accept a file with a wrong number or an unknown joint type without a message.
"""

from __future__ import annotations

import math
from collections.abc import Container, Iterator, Mapping, Sequence
from pathlib import Path
from shlex import quote
from xml.etree import ElementTree

from derive.description.joints import Kind
from derive.importing.formats.documents import (
    between,
    direction_rounding,
    limit,
    number,
    numbers,
    parsed,
    required,
    rounding,
    roundings,
    shown,
    without_namespace,
)
from derive.importing.formats.loops import Joints, Loop, loop_notes
from derive.importing.formats.transmissions import Follower, driven, transmission_notes
from derive.importing.formats.trees import Edge, ends_of, listed, path_between, tree_of
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
    refuse_macros(path, root, (base, tip))
    edges = [edge_of(path, joint) for joint in root.findall("joint")]
    links = [required(path, link, "name") for link in root.findall("link")]
    if not links:
        raise UnreadableRobot(f"{path}: has no links")
    base, tip = ends_of(path, edges, links, base, tip)
    joints = {required(path, j, "name"): j for j in root.findall("joint")}
    above, loops = tree_of(edges)
    passed = path_between(path, above, base, tip)
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
        *transmission_notes(root, used),
        *_loop_notes(path, root, (*loops, *_loops(root)), above, {*used, *(s.name for s in steps if s.moving)}),
        *macro_notes(root),
    )
    return Robot(root.get("name") or path.stem, f"{path.name} (URDF)", base, tip, steps, axes, notes)


def _loops(root: Element) -> Iterator[Loop]:
    """The loops that simulators let a file close: the loop joints of Drake, and joints for Gazebo."""
    for element in root:
        if element.tag.rpartition("}")[2] == "loop_joint":
            ends = [end.get("link", "") if (end := element.find(tag)) is not None else "" for tag in ("link1", "link2")]
            yield Loop(f"loop joint {element.get('name')!r}", ends[0], ends[1])
        for joint in element.findall("joint") if element.tag == "gazebo" else ():
            first, second = ((joint.findtext(tag) or "").strip() for tag in ("parent", "child"))
            yield Loop(f"joint {joint.get('name')!r} of Gazebo", first, second)


def _loop_notes(
    path: Path, root: Element, loops: Sequence[Loop], above: Mapping[str, Edge], moving: Container[str]
) -> Iterator[str]:
    """The notes on loops. moving: the joints that move the chain."""
    joints = {j.get("name", ""): j for j in root.findall("joint")}
    links = {link.get("name") for link in root.findall("link")}
    inside = []
    for loop in loops:
        if loop.first != loop.second and {loop.first, loop.second} <= links:
            passed = [edge.name for edge, _ in path_between(path, above, loop.first, loop.second)]
            inside.append((loop, [name for name in passed if joints[name].get("type") != "fixed"]))
    driven = {
        j.get("name") for tag in ("transmission", "ros2_control") for e in root.iter(tag) for j in e.iter("joint")
    }
    followers = [name for name, joint in joints.items() if joint.find("mimic") is not None]
    yield from loop_notes(path, inside, Joints(moving, followers, driven))


def edge_of(path: Path, joint: Element) -> Edge:
    """The joint between its two links."""
    name = required(path, joint, "name")
    ends = []
    for tag in ("parent", "child"):
        end = joint.find(tag)
        if end is None or not end.get("link"):
            raise UnreadableRobot(f"{path}: joint {name!r} names no {tag} link")
        ends.append(end.get("link", ""))
    return Edge(name, ends[0], ends[1])


def _step(path: Path, joint: Element, followers: Mapping[str, Follower], scale: float) -> Step:
    refuse_macros_inside(path, joint)
    name = joint.get("name", "")
    places = places_of(path, joint, f"joint {name!r}", scale)
    kind = _kind(path, joint)
    if kind is None:
        return Step(name, places)
    by = driven(path, name, followers)
    along, aslant = _direction(path, joint, name)
    return Step(name, places, Moving(kind, along, by.drives, by.offset, by.rounding, aslant))


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


def places_of(path: Path, element: Element, what: str, scale: float) -> tuple[Place, ...]:
    """The origin of a joint or of a shape; `what` names it in a message."""
    origin = element.find("origin")
    if origin is None:
        return ()
    x, y, z = numbers(path, origin, "xyz", what, (0.0, 0.0, 0.0))
    angles = numbers(path, origin, "rpy", what, (0.0, 0.0, 0.0))
    rounded = roundings(origin, "rpy", 3, with_coarse=True)
    turns = tuple(Turned(k, angles[k], rounded[k]) for k in (2, 1, 0) if angles[k] != 0.0)
    return (Shifted((x * scale, y * scale, z * scale)), *turns)


def _direction(path: Path, joint: Element, name: str) -> tuple[Triple, float]:
    """The direction of a joint, and the angle by which the file has rounded it."""
    axis = joint.find("axis")
    stated = (1.0, 0.0, 0.0) if axis is None else numbers(path, axis, "xyz", f"joint {name!r}", (1.0, 0.0, 0.0))
    size = math.sqrt(sum(v * v for v in stated))
    if size < 1e-9:
        raise UnreadableRobot(f"{path}: joint {name!r}: its axis has no direction")
    rounded = 0.0 if axis is None else direction_rounding(axis, "xyz", size)
    return (stated[0] / size, stated[1] / size, stated[2] / size), rounded


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
    refuse_macros_inside(path, joint)
    name, kind = joint.get("name", ""), _kind(path, joint)
    if kind is None:
        raise UnreadableRobot(f"{path}: a joint mimics {name!r}, which is fixed")
    limits = joint.find("limit")
    if joint.get("type") == "continuous" or limits is None:
        return Axis(name, kind)
    unit = scale if kind is Kind.LINEAR else 1.0
    low, high = (limit(path, limits.get(end, "0"), f"joint {name!r}, {end} limit") for end in ("lower", "upper"))
    return Axis(name, kind, between(path, f"joint {name!r}", low, high, unit))


def _left_out(root: Element, passed: list[str], used: Mapping[str, None]) -> tuple[str, ...]:
    names = {*passed, *used}
    left = [j.get("name", "") for j in root.findall("joint") if j.get("type") != "fixed" and j.get("name") not in names]
    return (f"Left out, because they are not between base and tip: {listed(left)}.",) if left else ()


def _ignored(root: Element) -> tuple[str, ...]:
    tags = {
        "inertial": "masses",
        "visual": "meshes (`--meshes` takes them to the viewer)",
        "collision": "collision bodies",
    }
    found = [word for tag, word in tags.items() if root.find(f"link/{tag}") is not None]
    notes = [f"Not in the description, because kinematics does not need them: {', '.join(found)}."] if found else []
    return tuple(notes)


_NO_LINKS = ("property", "arg", "macro")
"""Macros that only state values, or that do nothing unless they are called."""
_NEEDED = ("parent", "child", "origin", "axis", "mimic", "limit")


def refuse_macros(path: Path, root: Element, ends: tuple[str | None, str | None]) -> None:
    """Refuse macros that may add links, unless base and tip say which links count."""
    adding = [_name(e) for e in root if (_is_macro(e) and _name(e) not in _NO_LINKS) or e.tag == "include"]
    if root.find("link") is None:
        adding += [_name(e) for e in root if _is_macro(e)]
    if adding and None in ends:
        raise UnreadableRobot(f"{path}: {adding[0]!r} may add links: {_expanded(path)}, or name --base and --tip")


def refuse_macros_inside(path: Path, joint: Element) -> None:
    """Refuse a joint whose place, axis, limits, or links are an expression."""
    read = [joint, *(e for e in joint if e.tag in _NEEDED)]
    texts = [text for e in read for key, text in e.attrib.items() if key not in ("effort", "velocity")]
    found = [text for text in texts if "${" in text or "$(" in text] or [_name(e) for e in joint.iter() if _is_macro(e)]
    if found:
        raise UnreadableRobot(
            f"{path}: joint {joint.get('name')!r} holds the macro {shown(found[0])}: {_expanded(path)}"
        )


def macro_notes(root: Element) -> Iterator[str]:
    """A note on the macros that were not read."""
    names = dict.fromkeys(_name(e) for e in root.iter() if _is_macro(e))
    if names:
        yield f"Not read, because nothing between base and tip needs them: macros ({', '.join(names)})."


def _is_macro(element: Element) -> bool:
    return "xacro" in element.tag


def _name(element: Element) -> str:
    return element.tag.rpartition("}")[2]


def _expanded(path: Path) -> str:
    """The advice for a file with macros; what the command writes is never the file itself."""
    stem = path.name.partition(".")[0]
    return f"expand it, `xacro {quote(path.name)} > {quote(f'{stem}_expanded.urdf')}`, and import that"
