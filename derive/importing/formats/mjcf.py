"""MJCF: the chain of bodies between two bodies or sites, with the joints in them.

Angles are degrees unless the file says radians. Defaults of joints and geometric frames are read; bodies below a
tip are not.
"""

from __future__ import annotations

import math
from collections.abc import Container, Iterator, Mapping, Sequence
from pathlib import Path
from xml.etree import ElementTree

from derive.description.joints import Kind
from derive.importing.formats.bodies import WORLD, File, Frame, frames_of, own_joints, passed, places_of
from derive.importing.formats.documents import (
    between,
    direction_rounding,
    limit,
    number,
    numbers,
    parsed,
    rounding,
    shown,
    whole,
)
from derive.importing.formats.legs import Meeting, NoRods, meeting_of
from derive.importing.formats.loops import Joints, Loop, Loops, loop_notes
from derive.importing.formats.transmissions import Follower, driven
from derive.importing.formats.trees import listed
from derive.importing.robot import (
    Axis,
    Moving,
    Robot,
    RodArm,
    Rods,
    Shifted,
    Step,
    Triple,
    UnreadableRobot,
    reversed_step,
)

Element = ElementTree.Element
_UNDEFINED = "undefined class"
_FREE = {"free": "moves freely in space", "ball": "turns freely about a point"}


def read_mjcf(path: Path, base: str | None, tip: str | None, scale: float) -> Robot:
    """The chain between two bodies (or sites), or the rods that meet in the tip; without a name from the world to the
    one end there is, or to the point in which rods meet.
    """
    file = _file(path, parsed(path), scale)
    frames = {frame.name: frame for frame in frames_of(file)}
    for word, name in (("base", base), ("tip", tip)):
        if name is not None and name not in frames:
            raise UnreadableRobot(
                f"{path}: no body or site is called {name!r} (--{word}); there are {listed(list(frames))}"
            )
    base = base or WORLD
    joints = _joints(file, frames)
    why = ""
    try:
        if (meeting := meeting_of(Loops(file, frames, joints, base), tip)) is not None:
            return _with_rods(file, frames, joints, base, tip, meeting)
    except NoRods as problem:
        why = f"; its loops are no rods that meet in the tip: {problem}"
    try:
        return _open(file, frames, joints, base, tip or _only_end(path, file.root, frames))
    except UnreadableRobot as problem:
        raise UnreadableRobot(f"{problem}{why}") from None


def _open(file: File, frames: Mapping[str, Frame], joints: Mapping[str, dict[str, str]], base: str, tip: str) -> Robot:
    """The chain from base to tip."""
    way = passed(frames, base, tip)
    if not way:
        raise UnreadableRobot(f"{file.path}: base and tip are the same body, {base!r}")
    own = {name for frame, _ in way for name, _ in own_joints(frames[frame])}
    followers = _followers(file, joints, own)
    steps = tuple(s for name, is_up in way for s in _steps(file, frames[name], joints, followers, is_up))
    used = dict.fromkeys(name for s in steps if s.moving for name, _ in s.moving.drives)
    axes = tuple(_axis(file, name, joints[name]) for name in used)
    notes = _notes(file, joints, {*used, *(s.name for s in steps if s.moving)})
    loops = _loop_notes(Loops(file, frames, joints, base), {*used, *own})
    return Robot(_title(file), _source(file), base, tip, steps, axes, (*notes, *loops))


def _with_rods(
    file: File,
    frames: Mapping[str, Frame],
    joints: Mapping[str, dict[str, str]],
    base: str,
    tip: str | None,
    meeting: Meeting,
) -> Robot:
    """The arms from the base to the rods that meet in the tip."""
    arms = []
    for leg in meeting.legs:
        steps = [s for n, is_up in passed(frames, base, leg.arm) for s in _steps(file, frames[n], joints, {}, is_up)]
        arms.append(RodArm((*steps, Step(leg.rod, (Shifted(leg.elbow),))), leg.rod, leg.length))
    axes = tuple(_axis(file, leg.motor, joints[leg.motor]) for leg in meeting.legs)
    notes = [*_notes(file, joints, meeting.joints)]
    if stops := [n for n in joints if n in meeting.joints - {a.name for a in axes} and joints[n].get("range")]:
        notes.append(f"Not read: the limits of joints without a motor: {listed(stops)}.")
    rods = Rods(tuple(arms), meeting.plane, meeting.drawn)
    return Robot(_title(file), _source(file), base, tip or "the joint of the rods", (), axes, tuple(notes), rods)


def _title(file: File) -> str:
    return file.root.get("model") or file.path.stem


def _source(file: File) -> str:
    return f"{file.path.name} (MJCF)"


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
    """The attributes of a joint, with those of its default class; the name of a class that is not defined."""
    name = joint.get("class") or body_class
    classes = _classes(file.root, name)
    found = {} if classes is not None else {_UNDEFINED: name or ""}
    for default in classes or ():
        element = default.find("joint")
        found |= dict(element.attrib) if element is not None else {}
    return found | dict(joint.attrib)


def _classes(root: Element, name: str | None) -> Sequence[Element] | None:
    """The default classes that hold for a class, outermost first; None if there is no such class."""
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

    found = below(top, ()) if name else None
    return tuple(top) if found is None and name in (None, "", "main") else found


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


def _steps(
    file: File, frame: Frame, joints: Mapping[str, dict[str, str]], followers: Mapping[str, Follower], is_up: bool
) -> list[Step]:
    """The frame on its parent, then its joints, each about its own point; or the way back over them."""
    places = places_of(file, frame.element, f"{frame.element.tag} {frame.name!r}")
    steps = [Step(frame.name, (*frame.before, *places))]
    if frame.element.find("freejoint") is not None:
        raise UnreadableRobot(f"{file.path}: body {frame.name!r} {_FREE['free']}: choose a base that it carries")
    for name, _ in own_joints(frame):
        steps += _joint_steps(file, name, joints[name], followers)
    return [back for s in reversed(steps) for back in reversed_step(s)] if is_up else steps


def _joint_steps(file: File, name: str, stated: Mapping[str, str], followers: Mapping[str, Follower]) -> list[Step]:
    element = Element("joint", dict(stated))
    if _UNDEFINED in stated:
        raise UnreadableRobot(
            f"{file.path}: joint {name!r}: its class {stated[_UNDEFINED]!r} is not defined: import the model that "
            "includes this file"
        )
    kind = _kind(file, name, stated)
    x, y, z = (v * file.scale for v in numbers(file.path, element, "pos", f"joint {name!r}", (0.0, 0.0, 0.0)))
    direction = numbers(file.path, element, "axis", f"joint {name!r}", (0.0, 0.0, 1.0))
    size = math.sqrt(sum(v * v for v in direction))
    if size < 1e-9:
        raise UnreadableRobot(f"{file.path}: joint {name!r}: its axis has no direction")
    by = driven(file.path, name, followers)
    along: Triple = (direction[0] / size, direction[1] / size, direction[2] / size)
    off = by.rounding + _start_rounding(file, name, stated)
    moving = Moving(
        kind, along, by.drives, by.offset - _start(file, name, stated), off, direction_rounding(element, "axis", size)
    )
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
        for name, joint in own_joints(frame):
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
        notes.append("Not in the description, because kinematics does not need them: masses, meshes, collision bodies.")
    if file.root.find("tendon") is not None:
        notes.append("Not read: tendons. Axis values are the joint values of the file.")
    return tuple(notes)


def _loop_notes(loops: Loops, moving: Container[str]) -> Iterator[str]:
    """The notes on the loops that equalities close. moving: the joints that move the chain."""
    inside = [(Loop(f"a {c.tag} of {c.first!r} and {c.second!r}", c.first, c.second), c.joints) for c in loops.closed]
    yield from loop_notes(loops.file.path, inside, Joints(moving, loops.followers, loops.driven))
