"""A serial chain with deviations: every joint turns about, or slides along, the z axis of a frame of its own.

The chain is a product of constant frames and of motions about or along z. A deviation moves the line of a joint and not
the pose at which the joint is zero: the joint moves by D M D^-1 for M, with D = Txy(shifts) Rx(tilt_x) Ry(tilt_y).
Numbers may be plain, or arrays with an entry for each row.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from softkin._frame import IDENTITY, ORIGIN, Frame
from softkin._scalar import DEGREE, cos, sin
from softkin._types import Axis, Rotation, Vector
from softkin._vectors import cross, plus, product, rates, turned

if TYPE_CHECKING:
    from softkin._core import Mechanism

Function: TypeAlias = Callable[[Any], Any]
Placed: TypeAlias = tuple[Vector, Rotation]
"""A position and a rotation; of plain numbers, or of arrays."""


class Link(NamedTuple):
    """One turn or shift of a chain as it is described, in radians and lengths."""

    motion: str
    """`turn` or `shift`."""
    axis: int
    """About or along x (0), y (1) or z (2)."""
    fixed: float
    """The part of the amount that no axis moves."""
    motors: tuple[tuple[int, float], ...]
    """The index of each axis that moves it, and what the axis adds per radian or length."""


class Joint(NamedTuple):
    """A turn about or a slide along the z axis of a frame."""

    name: str
    """The name with which its deviations begin."""
    turns: bool
    motors: tuple[tuple[int, float], ...]


class Chain(NamedTuple):
    """Constant frames and joints in turn: the first frame stands on the ground, the last one is that of the tool."""

    frames: tuple[Placed, ...]
    """One more than joints."""
    joints: tuple[Joint, ...]


def joints_of(links: Sequence[Link], axes: Sequence[Axis]) -> tuple[Joint, ...]:
    """The links that move, each named after the first axis that moves it and has no link yet; a further link of an axis
    has a number.
    """
    names: list[str] = []
    for link in (link for link in links if link.motors):
        own = [axes[i].name.lower() for i, _ in link.motors]
        free = (name for name in own if name not in names)
        numbered = (f"{own[0]}_{k}" for k in range(2, len(links) + 2) if f"{own[0]}_{k}" not in names)
        names.append(next(free, "") or next(numbered))
    moving = (link for link in links if link.motors)
    return tuple(Joint(n, link.motion == "turn", link.motors) for n, link in zip(names, moving, strict=True))


def true_chain(robot: Mechanism, deviations: Mapping[str, float], base: Placed, tool: Placed) -> Chain:
    """The chain of a machine on a base, with a tool, and with deviations by name, in degrees and lengths."""
    links = robot._chain() or ()
    joints = joints_of(links, robot.AXES)
    (of_base, of_tool), frames, waiting = true_ends(deviations), list[Placed](), iter(joints)
    here = placed(base, of_base)
    for link in links:
        if link.motors:
            joint, own = next(waiting), _own(link.axis)
            off = _off(joint, deviations)
            frames.append(placed(placed(here, own), off))
            here = placed(_inverse(off), _inverse(own))
        if link.fixed:
            here = placed(here, motion(link.motion == "turn", link.axis, link.fixed))
    return Chain((*frames, placed(placed(here, of_tool), tool)), joints)


def true_ends(deviations: Mapping[str, float]) -> tuple[Placed, Placed]:
    """The deviations of base and tool: shifts, then Rz(c) Ry(b) Rx(a)."""
    return _frame(deviations, "base"), _frame(deviations, "tool")


def passed(
    chain: Chain, motors: Sequence[Any], cosine: Function = cos, sine: Function = sin
) -> tuple[Placed, list[Placed]]:
    """The frame of the tool, and the frames of all joints before they move, at motor values in radians and lengths."""
    here, lines = chain.frames[0], []
    for joint, following in zip(chain.joints, chain.frames[1:], strict=True):
        amount = sum(share * motors[i] for i, share in joint.motors)
        lines.append(here)
        here = placed(moved_along(here, joint.turns, amount, cosine, sine), following)
    return here, lines


def moved_along(here: Placed, turns: bool, amount: Any, cosine: Function = cos, sine: Function = sin) -> Placed:
    """A frame, turned about or shifted along its z axis."""
    position, rotation = here
    if not turns:
        return plus(position, (rotation[0][2], rotation[1][2], rotation[2][2]), amount), rotation
    c, s = cosine(amount), sine(amount)
    (r11, r12, r13), (r21, r22, r23), (r31, r32, r33) = rotation
    return position, (
        (c * r11 + s * r12, c * r12 - s * r11, r13),
        (c * r21 + s * r22, c * r22 - s * r21, r23),
        (c * r31 + s * r32, c * r32 - s * r31, r33),
    )


def columns(chain: Chain, lines: Sequence[Placed], place: Vector, count: int) -> list[list[Any]]:
    """The twist of a point that moves with the tool, by the motors: a column (x, y, z, turn x, turn y, turn z) each."""
    found: list[list[Any]] = [[0.0] * 6 for _ in range(count)]
    for joint, (position, rotation) in zip(chain.joints, lines, strict=True):
        x, y, z = rotation[0][2], rotation[1][2], rotation[2][2]
        twist = (x, y, z, 0.0, 0.0, 0.0)
        if joint.turns:
            a, b, c = plus(place, position, -1.0)
            twist = (y * c - z * b, z * a - x * c, x * b - y * a, x, y, z)
        for i, share in joint.motors:
            found[i] = [total + share * part for total, part in zip(found[i], twist, strict=True)]
    return found


def bias(chain: Chain, lines: Sequence[Placed], place: Vector, speeds: tuple[Any, ...]) -> tuple[Any, ...]:
    """The acceleration of a point that moves with the tool, and that of the tool's turn, at constant speeds of motors.

    Every column of `columns` has a rate: its line moves with the joints before it, and the point with all of them.
    """
    found = columns(chain, lines, place, len(speeds))
    rows = tuple(zip(*found, strict=True)) if found else ((),) * 6
    moving, spin, shift, whole = rates(rows[:3], speeds), ORIGIN, ORIGIN, (ORIGIN, ORIGIN)
    for joint, (origin, rotation) in zip(chain.joints, lines, strict=True):
        along = rotation[0][2], rotation[1][2], rotation[2][2]
        speed = sum(share * speeds[i] for i, share in joint.motors)
        swung, carried = cross(spin, along), plus(shift, cross(spin, origin))
        if joint.turns:
            way = plus(cross(swung, plus(place, origin, -1.0)), cross(along, plus(moving, carried, -1.0)))
            whole = plus(whole[0], way, speed), plus(whole[1], swung, speed)
            spin, shift = plus(spin, along, speed), plus(shift, cross(origin, along), speed)
        else:
            whole, shift = (plus(whole[0], swung, speed), whole[1]), plus(shift, along, speed)
    return (*whole[0], *whole[1])


def placed(first: Placed, second: Placed) -> Placed:
    """The second frame, which is given in the first one."""
    return plus(first[0], turned(first[1], second[0])), product(first[1], second[1])


def _inverse(frame: Placed) -> Placed:
    made = Frame(*frame).inverse()
    return made.position, made.rotation


def motion(turns: bool, axis: int, amount: float) -> Placed:
    """A turn about (radians), or a shift along, x, y or z."""
    if not turns:
        x, y, z = (amount if k == axis else 0.0 for k in range(3))
        return (x, y, z), IDENTITY
    rows = [[1.0 if i == k else 0.0 for k in range(3)] for i in range(3)]
    first, second = (axis + 1) % 3, (axis + 2) % 3
    rows[first][first] = rows[second][second] = cos(amount)
    rows[second][first], rows[first][second] = sin(amount), -sin(amount)
    a, b, c = ((row[0], row[1], row[2]) for row in rows)
    return ORIGIN, (a, b, c)


def _own(axis: int) -> Placed:
    """The frame of a joint about or along x, y or z: its z is that axis, its x and y are the next two."""
    rows = [[1.0 if (axis + 1 + k) % 3 == i else 0.0 for k in range(3)] for i in range(3)]
    a, b, c = ((row[0], row[1], row[2]) for row in rows)
    return ORIGIN, (a, b, c)


def _off(joint: Joint, deviations: Mapping[str, float]) -> Placed:
    """Where the line of a joint is, seen from where it is drawn."""
    x, y, about_x, about_y = (
        deviations.get(f"{joint.name}_{k}", 0.0) for k in ("shift_x", "shift_y", "tilt_x", "tilt_y")
    )
    turn = product(motion(True, 0, DEGREE * about_x)[1], motion(True, 1, DEGREE * about_y)[1])
    return (x, y, 0.0), turn


def _frame(deviations: Mapping[str, float], end: str) -> Placed:
    x, y, z, a, b, c = (deviations.get(f"{end}_{k}", 0.0) for k in "xyzabc")
    turn = product(motion(True, 2, DEGREE * c)[1], motion(True, 1, DEGREE * b)[1])
    return (x, y, z), product(turn, motion(True, 0, DEGREE * a)[1])
