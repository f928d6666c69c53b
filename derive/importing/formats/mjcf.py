"""MJCF: the chain of bodies between two bodies or sites, with the joints in them.

Angles are degrees unless the file says radians. Defaults of joints and geometric frames are read; bodies below a
tip are not.
"""

from __future__ import annotations

import math
from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from xml.etree import ElementTree

from derive.description.joints import Kind
from derive.importing.formats.documents import between, limit, number, numbers, parsed, rounding, shown
from derive.importing.formats.loops import Joints, Loop, loop_notes
from derive.importing.formats.mimics import Follower, driven
from derive.importing.formats.orientations import File, places_of
from derive.importing.formats.trees import listed
from derive.importing.formats.whole import whole
from derive.importing.robot import Axis, Moving, Place, Robot, Shifted, Step, Triple, UnreadableRobot, reversed_step

Element = ElementTree.Element
WORLD = "world"
_FREE = {"free": "moves freely in space", "ball": "turns freely about a point"}


@dataclass(frozen=True)
class Frame:
    """A body or a site, below another body; a `<frame>` between them only shifts and turns."""

    name: str
    element: Element
    parent: str | None
    body_class: str | None
    before: tuple[Place, ...] = ()


def read_mjcf(path: Path, base: str | None, tip: str | None, scale: float) -> Robot:
    """The chain between two bodies (or sites); without a name from the world to the one end there is."""
    file = _file(path, parsed(path), scale)
    frames = {frame.name: frame for frame in _frames(file)}
    for word, name in (("base", base), ("tip", tip)):
        if name is not None and name not in frames:
            raise UnreadableRobot(
                f"{path}: no body or site is called {name!r} (--{word}); there are {listed(list(frames))}"
            )
    base = base or WORLD
    tip = tip or _only_end(path, file.root, frames)
    passed = _passed(frames, base, tip)
    if not passed:
        raise UnreadableRobot(f"{path}: base and tip are the same body, {base!r}")
    joints = _joints(file, frames)
    own = {name for frame, _ in passed for name, _ in _own_joints(frames[frame])}
    followers = _followers(file, joints, own)
    steps = tuple(s for name, is_up in passed for s in _steps(file, frames[name], joints, followers, is_up))
    used = dict.fromkeys(name for s in steps if s.moving for name, _ in s.moving.drives)
    axes = tuple(_axis(file, name, joints[name]) for name in used)
    title = file.root.get("model") or path.stem
    notes = _notes(file, joints, {*used, *(s.name for s in steps if s.moving)})
    loops = _loop_notes(file, frames, joints, {*used, *own})
    return Robot(title, f"{path.name} (MJCF)", base, tip, steps, axes, (*notes, *loops))


def _passed(frames: Mapping[str, Frame], base: str, tip: str) -> list[tuple[str, bool]]:
    """The bodies from the base to the tip, each with whether it is passed from itself to its parent."""
    up, down = _to_world(frames, base), _to_world(frames, tip)
    while up and down and up[-1] == down[-1]:
        up.pop()
        down.pop()
    return [*((name, True) for name in up), *((name, False) for name in reversed(down))]


def _own_joints(frame: Frame) -> list[tuple[str, Element]]:
    """The joints in a body, with their names."""
    joints = frame.element.findall("joint")
    return [(joint.get("name") or f"{frame.name}.{index}", joint) for index, joint in enumerate(joints)]


def _file(path: Path, root: Element, scale: float) -> File:
    if root.tag != "mujoco":
        raise UnreadableRobot(f"{path}: its root is <{root.tag}>, not <mujoco>: this is no MJCF")
    root = whole(path, root)
    settings: dict[str, str] = {}
    for compiler in root.findall("compiler"):
        settings |= dict(compiler.attrib)
    if settings.get("coordinate", "local") != "local":
        raise UnreadableRobot(
            f"{path}: gives global coordinates, which MuJoCo reads no longer: save it with local ones"
        )
    angle = settings.get("angle", "degree")
    if angle not in ("degree", "radian"):
        raise UnreadableRobot(f"{path}: angles in {angle!r}: there are degree and radian")
    degree = math.pi / 180.0 if angle == "degree" else 1.0
    return File(path, root, degree, settings.get("eulerseq", "xyz"), settings.get("autolimits") != "false", scale)


def _defaults(file: File, joint: Element, body_class: str | None) -> dict[str, str]:
    """The attributes of a joint, with those of its default class."""
    found: dict[str, str] = {}
    for default in _classes(file.root, joint.get("class") or body_class):
        element = default.find("joint")
        found |= dict(element.attrib) if element is not None else {}
    return found | dict(joint.attrib)


def _classes(root: Element, name: str | None) -> Sequence[Element]:
    """The default classes that hold for a class, outermost first."""
    top = root.findall("default")

    def below(defaults: Sequence[Element], before: tuple[Element, ...]) -> tuple[Element, ...] | None:
        for default in defaults:
            here = (*before, default)
            if default.get("class") == name:
                return here
            found = below(default.findall("default"), here)
            if found is not None:
                return found
        return None

    return (below(top, ()) if name else None) or tuple(top)


def _frames(file: File) -> Iterator[Frame]:
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


def _only_end(path: Path, root: Element, frames: Mapping[str, Frame]) -> str:
    if root.find(".//replicate//body") is not None or root.find(".//attach") is not None:
        raise UnreadableRobot(
            f"{path}: replicates or attaches bodies: save the expanded model and import that, or choose with --tip"
        )
    parents = {frame.parent for frame in frames.values() if frame.element.tag == "body"}
    ends = [f.name for f in frames.values() if f.element.tag == "body" and f.name not in parents]
    if len(ends) == 1:
        return ends[0]
    if not ends:
        raise UnreadableRobot(f"{path}: has no bodies")
    raise UnreadableRobot(f"{path}: has {len(ends)} possible tips: choose with --tip: {listed(ends)}")


def _to_world(frames: Mapping[str, Frame], name: str) -> list[str]:
    found = []
    while (parent := frames[name].parent) is not None:
        found.append(name)
        name = parent
    return found


def _steps(
    file: File, frame: Frame, joints: Mapping[str, dict[str, str]], followers: Mapping[str, Follower], is_up: bool
) -> list[Step]:
    """The frame on its parent, then its joints, each about its own point; or the way back over them."""
    places = places_of(file, frame.element, f"{frame.element.tag} {frame.name!r}")
    steps = [Step(frame.name, (*frame.before, *places))]
    if frame.element.find("freejoint") is not None:
        raise UnreadableRobot(f"{file.path}: body {frame.name!r} {_FREE['free']}: choose a base that it carries")
    for name, _ in _own_joints(frame):
        steps += _joint_steps(file, name, joints[name], followers)
    return [back for s in reversed(steps) for back in reversed_step(s)] if is_up else steps


def _joint_steps(file: File, name: str, stated: Mapping[str, str], followers: Mapping[str, Follower]) -> list[Step]:
    element = Element("joint", dict(stated))
    kind = _kind(file, name, stated)
    x, y, z = (v * file.scale for v in numbers(file.path, element, "pos", f"joint {name!r}", (0.0, 0.0, 0.0)))
    direction = numbers(file.path, element, "axis", f"joint {name!r}", (0.0, 0.0, 1.0))
    size = math.sqrt(sum(v * v for v in direction))
    if size < 1e-9:
        raise UnreadableRobot(f"{file.path}: joint {name!r}: its axis has no direction")
    by = driven(file.path, name, followers)
    along: Triple = (direction[0] / size, direction[1] / size, direction[2] / size)
    off = by.rounding + _start_rounding(file, name, stated)
    moving = Moving(kind, along, by.drives, by.offset - _start(file, name, stated), off)
    return [Step(name, (Shifted((x, y, z)),), moving), Step(name, (Shifted((-x, -y, -z)),))]


def _start(file: File, name: str, stated: Mapping[str, str]) -> float:
    """The value of a joint as the file draws it."""
    unit = file.scale if _kind(file, name, stated) is Kind.LINEAR else file.degree
    return number(file.path, stated.get("ref", "0"), f"joint {name!r}, ref") * unit


def _start_rounding(file: File, name: str, stated: Mapping[str, str]) -> float:
    """The largest distance of that value from the exact one; zero in degrees, in which 15 is written exactly."""
    is_radian = _kind(file, name, stated) is Kind.ROTARY and file.degree == 1.0
    return rounding(stated.get("ref", "0")) if is_radian else 0.0


def _kind(file: File, name: str, stated: Mapping[str, str]) -> Kind:
    word = stated.get("type", "hinge")
    if word in _FREE:
        raise UnreadableRobot(f"{file.path}: joint {name!r} {_FREE[word]}: choose a base that it carries")
    if word not in ("hinge", "slide"):
        raise UnreadableRobot(f"{file.path}: joint {name!r} has the unknown type {word!r}; there are hinge and slide")
    return Kind.ROTARY if word == "hinge" else Kind.LINEAR


def _joints(file: File, frames: Mapping[str, Frame]) -> dict[str, dict[str, str]]:
    """Every joint of the file, by its name, with its defaults."""
    found: dict[str, dict[str, str]] = {}
    for frame in frames.values():
        for name, joint in _own_joints(frame):
            if name in found:
                raise UnreadableRobot(f"{file.path}: two joints are called {name!r}")
            found[name] = _defaults(file, joint, frame.body_class)
    return found


def _followers(file: File, joints: Mapping[str, Mapping[str, str]], passed: Container[str]) -> dict[str, Follower]:
    """Joints that an equality makes follow another one: y - y0 = a0 + a1 (x - x0), in radians and lengths; those that
    are passed, and those that they follow. Others may follow by a curve.
    """
    stated = {e.get("joint1", ""): e for e in file.root.findall("equality/joint") if e.get("active") != "false"}
    found: dict[str, Follower] = {}
    left = [own for own in stated if own in passed]
    while left:
        own = left.pop()
        found[own] = _follower(file, joints, own, stated[own])
        if found[own].leader in stated and found[own].leader not in found:
            left.append(found[own].leader)
    return found


def _follower(file: File, joints: Mapping[str, Mapping[str, str]], own: str, equality: Element) -> Follower:
    leader = equality.get("joint2")
    words = equality.get("polycoef", "0 1").split()
    a0, a1, *rest = (*(number(file.path, w, f"equality of {own!r}") for w in words), 0.0, 0.0)
    if any(rest) or leader is None or leader not in joints:
        raise UnreadableRobot(
            f"{file.path}: joint {own!r} follows no joint, or by a curve: only `joint1 = a0 + a1 * joint2` is known"
        )
    sizes = [file.scale if _kind(file, n, joints[n]) is Kind.LINEAR else 1.0 for n in (own, leader)]
    multiplier = a1 * sizes[0] / sizes[1]
    start = _start(file, own, joints[own]) - multiplier * _start(file, leader, joints[leader])
    roundings = [_start_rounding(file, n, joints[n]) for n in (own, leader)]
    off = (rounding(words[0]) if words else 0.0) + roundings[0] + abs(multiplier) * roundings[1]
    return Follower(leader, multiplier, a0 * sizes[0] + start, off)


def _axis(file: File, name: str, stated: Mapping[str, str]) -> Axis:
    kind = _kind(file, name, stated)
    words = stated.get("range", "").split()
    is_limited = stated.get("limited", "auto")
    if not words or is_limited == "false" or (is_limited == "auto" and not file.limits_by_range):
        return Axis(name, kind)
    unit = file.scale if kind is Kind.LINEAR else file.degree
    if len(words) != 2:
        raise UnreadableRobot(f"{file.path}: joint {name!r}, range: {shown(stated['range'])} is not two numbers")
    low, high = (limit(file.path, word, f"joint {name!r}, range") for word in words)
    return Axis(name, kind, between(file.path, f"joint {name!r}", low, high, unit))


def _notes(file: File, joints: Mapping[str, object], passed: Container[str]) -> tuple[str, ...]:
    left = [name for name in joints if name not in passed]
    notes = [f"Left out, because they are not between base and tip: {listed(left)}."] if left else []
    if file.root.find(".//geom") is not None:
        notes.append("Not read, because kinematics does not need them: masses, meshes, collision bodies.")
    if file.root.find("tendon") is not None:
        notes.append("Not read: tendons. Axis values are the joint values of the file.")
    return tuple(notes)


def _loop_notes(
    file: File, frames: Mapping[str, Frame], joints: Mapping[str, Mapping[str, str]], moving: Container[str]
) -> Iterator[str]:
    """The notes on the loops that equalities close. A body that moves freely, or that a program moves (mocap), is bound
    by one, and closes none. moving: the joints that move the chain.
    """
    inside = []
    for tag in ("connect", "weld"):
        for equality in file.root.findall(f"equality/{tag}"):
            first, second = (equality.get(f"body{k}") or equality.get(f"site{k}") or WORLD for k in (1, 2))
            if equality.get("active") == "false" or first not in frames or second not in frames:
                continue
            passed = [frames[name] for name, _ in _passed(frames, first, second)]
            if not any(_is_free(frame, joints) for frame in passed):
                names = [name for frame in passed for name, _ in _own_joints(frame)]
                inside.append((Loop(f"a {tag} of {first!r} and {second!r}", first, second), names))
    driven = {e.get("joint") for e in file.root.findall("actuator/*")}
    followers = [e.get("joint1") for e in file.root.findall("equality/joint") if e.get("active") != "false"]
    yield from loop_notes(file.path, inside, Joints(moving, followers, driven))


def _is_free(frame: Frame, joints: Mapping[str, Mapping[str, str]]) -> bool:
    element = frame.element
    is_free = element.find("freejoint") is not None or element.get("mocap") == "true"
    return is_free or any(joints[name].get("type") == "free" for name, _ in _own_joints(frame))
