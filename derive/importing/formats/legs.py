"""The legs of the loops of an MJCF: a motor on the base, its arm, and a rod from there to the point where rods meet.

Links turn against each other at joints without a motor, and where a `connect` holds two points together. A rod is a
link with two such points, one at an arm. Points are in the frame of the base, as the file draws them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from derive.importing.formats.bodies import WORLD, Frame, link_of, own_joints
from derive.importing.formats.documents import numbers, shown
from derive.importing.formats.loops import Closed, Loops, is_followed
from derive.importing.robot import Array, Triple

_SAME = 1e-5
"""Points are the same that differ by less than this share of the size of the loops: files round angles."""
_PARALLEL = 1e-3
"""Hinges that differ by less (in radians) are parallel, and meant to be: otherwise they would jam."""
_COUNT = {True: (2, "in the plane"), False: (3, "in space")}


class NoRods(Exception):
    """Loops that are not rods which meet in the tip; says what keeps them from that."""


@dataclass(frozen=True, eq=False)
class Turning:
    """Two links that turn against each other about a point, which each of them carries; hinges have directions."""

    what: str
    links: tuple[str, str]
    points: tuple[Array, Array]
    directions: tuple[Array, ...] | None = None

    def is_at(self, other: Turning, near: float) -> bool:
        """Whether both are at the same point of a link."""
        mine, theirs = (dict(zip(one.links, one.points, strict=True)) for one in (self, other))
        return any(link in theirs and np.linalg.norm(mine[link] - theirs[link]) <= near for link in mine)


@dataclass(frozen=True)
class Leg:
    """A motor, the body that it moves, the place in that body where a rod hangs, and the rod."""

    motor: str
    arm: str
    elbow: Triple
    rod: str
    length: float


@dataclass(frozen=True)
class Meeting:
    """Legs whose rods meet in one point; plane and drawn as in `robot.Rods`."""

    legs: tuple[Leg, ...]
    plane: int | None
    drawn: Triple | None
    joints: frozenset[str]
    """All joints of the loops."""


def meeting_of(loops: Loops, tip: str | None) -> Meeting | None:
    """The legs that move a tip, or that of the one machine there is; None if no loop binds it. Raises `NoRods`."""
    closed = [c for c in loops.closed if c.joints and not is_followed(c.joints, loops.followers)]
    own = set(loops.way(tip) if tip else closed[0].joints if closed else ())
    bound: list[Closed] = []
    while more := [c for c in closed if c not in bound and own & set(c.joints)]:
        bound += more
        own |= {name for c in more for name in c.joints}
    if not bound:
        return None
    if tip is None and len(bound) < len(closed):
        raise NoRods("there are several machines")
    names = {name for c in bound for name in c.joints}
    if following := [name for name in names if name in loops.followers]:
        raise NoRods(f"joint {shown(min(following))} follows another one")
    if any(c.tag == "weld" for c in bound):
        raise NoRods("a weld holds the orientation, too: a connect holds a point")
    return _meeting(loops, bound, names, tip)


def _meeting(loops: Loops, bound: Sequence[Closed], names: set[str], tip: str | None) -> Meeting:
    bodies = {name: frame for frame in loops.frames.values() for name, _ in own_joints(frame) if name in names}
    motors = _motors(loops, bodies)
    plane = _plane(loops, bodies)
    turning = [*_passive(loops, bodies, motors), *(_connected(loops, one) for one in bound)]
    near = _SAME * float(np.ptp([p for t in turning for p in t.points], axis=0).max())
    turning = turning if plane is None else [_in_plane(one, plane, near) for one in turning]
    arms = _arms(loops, turning, motors)
    knots = _knots(turning, near)
    ends = [knot for knot in knots if not any(link in arms for one in knot for link in one.links)]
    if len(ends) != 1:
        raise NoRods(f"the links without a motor meet in {len(ends)} points beside the arms: it has to be one")
    legs = [
        leg for link in dict.fromkeys(n for t in turning for n in t.links) for leg in _leg(link, arms, knots, ends[0])
    ]
    legs.sort(key=lambda leg: [*bodies].index(leg.motor))
    _check_count(legs, motors, plane)
    if plane is None:
        _check_freedom(knots, ends[0], legs)
    if tip is not None:
        _check_tip(loops, tip, plane, ends[0], near)
    legs = [replace(leg, elbow=_seen(loops.pose(leg.arm), leg.elbow)) for leg in legs]
    apart = any(np.linalg.norm(one.points[0] - one.points[1]) > near for one in turning)
    return Meeting(tuple(legs), plane, None if apart else _triple(ends[0][0].points[0]), frozenset(names))


def _motors(loops: Loops, bodies: Mapping[str, Frame]) -> list[str]:
    """The joints that have a motor; in a file without actuators the first one of each leg."""
    if loops.file.root.find("actuator/*") is not None:
        return [name for name in bodies if name in loops.driven]
    ground = link_of(loops.frames, loops.base)
    return [name for name, body in bodies.items() if link_of(loops.frames, body.parent or WORLD) == ground]


def _plane(loops: Loops, bodies: Mapping[str, Frame]) -> int | None:
    """The axis of the base that is along all hinges, and square to all slides; None if there is none."""
    if any(loops.joints[name].get("type") == "ball" for name in bodies):
        return None
    for axis in (2, 1, 0):
        offs = []
        for name, body in bodies.items():
            direction, is_slide = _direction(loops, name, body), loops.joints[name].get("type") == "slide"
            offs.append(np.linalg.norm(direction[(np.arange(3) == axis) == is_slide]))
        if max(offs) <= _PARALLEL:
            return axis
    return None


def _direction(loops: Loops, name: str, body: Frame) -> Array:
    axis = loops.stated(name, "axis", (0.0, 0.0, 1.0))
    return np.asarray(loops.pose(body.name)[:3, :3] @ axis / max(float(np.linalg.norm(axis)), 1e-9))


def _passive(loops: Loops, bodies: Mapping[str, Frame], motors: Sequence[str]) -> Iterator[Turning]:
    """The bodies that turn without a motor."""
    for body in {frame.name: frame for frame in bodies.values()}.values():
        own = [name for name, _ in own_joints(body)]
        with_motor = [name for name in own if name in motors]
        kinds = [loops.joints[name].get("type", "hinge") for name in own]
        if with_motor and len(own) > len(with_motor):
            raise NoRods(f"body {shown(body.name)} has a motor, and joints without one")
        if not with_motor and "slide" in kinds:
            raise NoRods(f"joint {shown(own[kinds.index('slide')])} slides without a motor")
        if not with_motor:
            links = (link_of(loops.frames, body.parent or WORLD), body.name)
            at = [_moved(loops.pose(body.name), loops.stated(n, "pos", (0, 0, 0)) * loops.file.scale) for n in own]
            if np.ptp(at, axis=0).max() > 1e-6 * loops.file.scale:
                raise NoRods(f"the joints of body {shown(body.name)} are not about one point")
            directions = None if "ball" in kinds else tuple(_direction(loops, name, body) for name in own)
            yield Turning(f"joint {shown(own[0])}", links, (at[0], at[0]), directions)


def _connected(loops: Loops, one: Closed) -> Turning:
    links = (link_of(loops.frames, one.first), link_of(loops.frames, one.second))
    what = f"the connect of {shown(one.first)} and {shown(one.second)}"
    if one.element.get("site1"):
        return Turning(what, links, (loops.pose(one.first)[:3, 3], loops.pose(one.second)[:3, 3]))
    anchor = np.array(numbers(loops.file.path, one.element, "anchor", what, (0.0, 0.0, 0.0))) * loops.file.scale
    point = _moved(loops.pose(one.first), anchor)
    return Turning(what, links, (point, point))


def _moved(pose: Array, point: Array) -> Array:
    return np.asarray(pose[:3, :3] @ point + pose[:3, 3])


def _in_plane(one: Turning, axis: int, near: float) -> Turning:
    """The points without their heights, which have to be the same for both links."""
    first, second = one.points
    if abs(first[axis] - second[axis]) > near:
        raise NoRods(f"{one.what} holds points at different heights")
    kept = np.arange(3) != axis
    return replace(one, points=(first * kept, second * kept))


def _arms(loops: Loops, turning: Sequence[Turning], motors: Sequence[str]) -> dict[str, str]:
    """The links that motors move, each with its motor."""
    arms = {}
    for one in turning:
        for link in one.links:
            way = loops.way(link)
            if not way:
                raise NoRods(f"{one.what} is on the base: a rod hangs on an arm or a carriage with a motor")
            if all(name in motors or name in loops.driven for name in way):
                arms[link] = way[-1]
                if len(way) > 1:
                    raise NoRods(
                        f"{shown(link)} has {len(way)} motors ({', '.join(map(shown, way))}): choose its --base"
                    )
    return arms


def _knots(turning: Sequence[Turning], near: float) -> list[list[Turning]]:
    """The points at which links turn against each other, with all that turns there."""
    knots: list[list[Turning]] = []
    for one in turning:
        met = [knot for knot in knots if any(one.is_at(other, near) for other in knot)]
        knots = [knot for knot in knots if knot not in met] + [[one, *(other for knot in met for other in knot)]]
    return knots


def _point(knot: Sequence[Turning], link: str) -> Array:
    """The place of a knot, as a link carries it."""
    return next(point for one in knot for name, point in zip(one.links, one.points, strict=True) if name == link)


def _leg(link: str, arms: Mapping[str, str], knots: Sequence[list[Turning]], end: list[Turning]) -> Iterator[Leg]:
    """The leg of a link, if that is a rod: nothing for an arm, and for a small body at one point."""
    own = [knot for knot in knots if any(link in one.links for one in knot)]
    if link in arms or len(own) == 1:
        return
    held = dict.fromkeys(n for knot in own if knot is not end for one in knot for n in one.links if n in arms)
    if len(own) != 2 or end not in own or len(held) != 1:
        what = f"turns against others at {len(own)} points" if len(own) != 2 else "is not between one arm and the tip"
        raise NoRods(f"body {shown(link)} is no rod: it {what}")
    arm, elbow = next(iter(held)), own[own[0] is end]
    length = float(np.linalg.norm(_point(end, link) - _point(elbow, link)))
    yield Leg(arms[arm], arm, _triple(_point(elbow, arm)), link, length)


def _check_count(legs: Sequence[Leg], motors: Sequence[str], plane: int | None) -> None:
    hanging = [leg.motor for leg in legs]
    if idle := [name for name in motors if hanging.count(name) != 1]:
        raise NoRods(f"{hanging.count(idle[0])} rods hang on the arm of {shown(idle[0])}: it has to be one")
    count, where = _COUNT[plane is not None]
    if len(legs) != count:
        why = " (not all joints are parallel to x, y or z of the base)" if plane is None and len(legs) == 2 else ""
        raise NoRods(f"{len(legs)} rods meet {where}{why}, where {count} hold a point")


def _check_freedom(knots: Sequence[list[Turning]], end: list[Turning], legs: Sequence[Leg]) -> None:
    """In space a rod swings in every direction: at a ball, a connect, or two hinges that cross."""
    for leg in legs:
        knot = next(k for k in knots if k is not end and any(leg.rod in one.links for one in k))
        swings = [np.cross(d, _point(end, leg.rod) - _point(knot, leg.rod)) / leg.length for d in _hinges(knot)]
        if all(one.directions is not None for one in knot) and _rank(swings) < 2:
            raise NoRods(f"{knot[0].what} turns its rod about one axis: in space it needs a ball, or two hinges")
    small = {n for one in end for n in one.links} - {leg.rod for leg in legs}
    stiff = [one for one in end if one.directions is not None and _rank(one.directions) < 2]
    if len(stiff) > 1 or any(not small.intersection(one.links) for one in stiff):
        raise NoRods(f"{stiff[0].what} turns rods about one axis: in space they need a ball, or two hinges")


def _hinges(knot: Sequence[Turning]) -> list[Array]:
    return [direction for one in knot for direction in one.directions or ()]


def _rank(directions: Sequence[Array]) -> int:
    return int(np.linalg.matrix_rank(np.array(directions), tol=_PARALLEL)) if directions else 0


def _check_tip(loops: Loops, tip: str, plane: int | None, end: list[Turning], near: float) -> None:
    link, kept = link_of(loops.frames, tip), np.arange(3) != plane
    is_there = any(link in one.links for one in end)
    if not is_there or np.linalg.norm((loops.pose(tip)[:3, 3] - _point(end, link))[kept]) > near:
        raise NoRods(f"{shown(tip)} is not in the point where the rods meet: leave --tip out")


def _seen(pose: Array, point: Triple) -> Triple:
    """A point of the base, in a frame."""
    return _triple(pose[:3, :3].T @ (np.array(point) - pose[:3, 3]))


def _triple(point: Array) -> Triple:
    x, y, z = map(float, point)
    return x, y, z
