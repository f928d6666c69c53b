"""A belt that two fixed motors share: its path on the frame, and the sense in which a drive turns its motor.

The belt neither stretches nor slips. From the change of its strands with the carriage follows, for each drive, the
length of belt that runs past each motor; no sign of a machine is assumed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np
import sympy as sp

from derive.description.mechanism import DescriptionError
from derive.drawing.scene import Belt, Body, Motor, Segment, point
from derive.ir.interpret import Array

_WIDE, _HIGH, _RADIUS, _TRACK = 0.6, 0.45, 0.03, 0.035
"""Of the drawn size: half of the width and of the height of the frame, the radius of a wheel, half the width between
the two strands of a belt along a beam."""
_STEP = 0.01
_STILL = 1e-6

_Drive = TypeVar("_Drive")
Wheel = tuple[Array, float, float]
"""A wheel that the belt goes around: its centre, and the angles in degrees at which the belt arrives and leaves."""


def _at(x: float, y: float) -> Array:
    return np.array([x, y])


def _of_h(x: float, y: float) -> tuple[list[Wheel], tuple[Array, Array]]:
    """Two fixed rails along y, a beam across them at y, the carriage on it at x: both ends are held by the carriage."""
    w, h, r, d = _WIDE, _HIGH, _RADIUS, _TRACK
    left, right = -w + 2 * r, w - 2 * r
    wheels = [
        (_at(left, y + d + r), -90.0, -180.0), (_at(-w, h), 0.0, 180.0), (_at(-w, -h), 180.0, 360.0),
        (_at(left, y - d - r), 180.0, 90.0), (_at(right, y - d - r), 90.0, 0.0),
        (_at(w, -h), 180.0, 360.0), (_at(w, h), 0.0, 180.0), (_at(right, y + d + r), 0.0, -90.0),
    ]  # fmt: skip
    return wheels, (_at(x, y + d), _at(x, y + d))


def _of_t(x: float, y: float) -> tuple[list[Wheel], tuple[Array, Array]]:
    """A fixed beam along x, the carriage on it at x, an arm through the carriage at y: its lower end holds both
    ends.
    """
    w, h, r = _WIDE, _HIGH, _RADIUS
    left, right = x - 2 * r, x + 2 * r
    wheels = [
        (_at(left, -2 * r), 0.0, 90.0), (_at(-w, 0.0), -90.0, -270.0), (_at(left, 2 * r), -90.0, 0.0),
        (_at(x, y + h), 180.0, 0.0), (_at(right, 2 * r), 180.0, 270.0), (_at(w, 0.0), 90.0, -90.0),
        (_at(right, -2 * r), 90.0, 180.0),
    ]  # fmt: skip
    return wheels, (_at(x - r, y - h), _at(x + r, y - h))


_LAYOUTS: dict[str, tuple[Callable[[float, float], tuple[list[Wheel], tuple[Array, Array]]], tuple[int, int]]] = {
    "H": (_of_h, (2, 5)),
    "T": (_of_t, (1, 5)),
}
"""For each layout: the function of its wheels at a place of the carriage, and the wheels that the motors turn."""


def belt_of(layout: str, size: float, axes: Sequence[Array], drives: dict[sp.Symbol, Array]) -> Belt:
    """The belt on its frame.

    `axes` are the directions of the machine in which the carriage goes (first the one along the beam), `drives` how a
    unit of each drive moves the carriage. Raises `DescriptionError` if a drive runs the belt past both motors.
    """
    if layout not in _LAYOUTS:
        raise DescriptionError(f"belt must be one of {', '.join(map(repr, _LAYOUTS))}, not {layout!r}")
    wheels, ends = _LAYOUTS[layout][0](0.0, 0.0)
    motors = _LAYOUTS[layout][1]
    plane = size * np.stack(axes, axis=1)
    normal = np.cross(axes[0], axes[1])
    moves = {name: np.array([move @ axis for axis in axes]) for name, move in drives.items()}
    found = []
    for index, (name, rate) in zip(motors, _drives_of_motors(layout, moves), strict=True):
        centre, arrives, leaves = wheels[index]
        found.append(Motor(name, point(plane @ centre), point(float(np.sign(rate * (leaves - arrives))) * normal)))
    return Belt(
        path=tuple(point(plane @ p) for p in _path(wheels, ends)),
        wheels=tuple(point(plane @ centre) for k, (centre, _, _) in enumerate(wheels) if k not in motors),
        motors=tuple(found),
        radius=size * _RADIUS,
        normal=point(normal),
        frame=tuple(Segment(point(plane @ a), point(plane @ b), body) for a, b, body in _frame(layout, 0.0, 0.0)),
        tips=(
            point(plane @ _at(_WIDE if layout == "H" else 0.6 * _WIDE, 0.0)),
            point(plane @ _at(_WIDE if layout == "H" else 0.0, _HIGH)),
        ),
    )


def _drives_of_motors(layout: str, moves: Mapping[_Drive, Array]) -> Iterator[tuple[_Drive, float]]:
    """For each motor its drive, and the length of belt that a unit of it pulls past the motor."""
    rates = {name: _past_motors(layout, move) for name, move in moves.items()}
    for number in range(len(_LAYOUTS[layout][1])):
        driving = [(name, rate[number]) for name, rate in rates.items() if abs(rate[number]) > _STILL]
        if len(driving) != 1:
            raise DescriptionError(f"one drive turns each motor of a belt in {layout} layout, and here not")
        yield driving[0]


def layout_of(layout: str, moves: Mapping[str, Array]) -> dict[str, Any]:
    """The belt and its frame at any place of the carriage, as plain data: for a frame of size one.

    `moves` is how a unit of each drive moves the carriage along both directions; a wheel has the name of its drive.
    A point is three pairs: where it is at the place (0, 0), and how it moves with both coordinates of the place. "held"
    is the carriage, or the end of the arm, at the place (0, 0).
    """
    of, motors = _LAYOUTS[layout]
    names = dict(zip(motors, (name for name, _ in _drives_of_motors(layout, moves)), strict=True))
    found, frames = [of(*place) for place in _PLACES], [_frame(layout, *place) for place in _PLACES]
    wheels = [
        {"at": _moving([one[k][0] for one, _ in found]), "from": arrives, "to": leaves, "joint": names.get(k, "")}
        for k, (_, arrives, leaves) in enumerate(found[0][0])
    ]
    frame = [
        {"ends": [_moving([one[k][0] for one in frames]), _moving([one[k][1] for one in frames])], "body": body.value}
        for k, (_, _, body) in enumerate(frames[0])
    ]
    ends = [_moving([both[k] for _, both in found]) for k in (0, 1)]
    held = _at(0.0, 0.0) if layout == "H" else _at(0.0, -_HIGH)
    return {"wheels": wheels, "ends": ends, "frame": frame, "held": held.tolist(), "radius": _RADIUS}


_PLACES = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))


def _moving(points: Sequence[Array]) -> list[list[float]]:
    """A point at each of `_PLACES`: where it is at the first, and how far it moves to the others."""
    return [np.round(p, 12).tolist() for p in (points[0], points[1] - points[0], points[2] - points[0])]


def _past_motors(layout: str, rate: Array) -> tuple[float, float]:
    """The length of belt that runs past each motor, in the direction from its first end to its last."""
    lengths = [_strands(layout, *(side * _STEP * rate)) for side in (1.0, -1.0)]
    first, _, last = (lengths[0] - lengths[1]) / (2.0 * _STEP)
    return -first, last


def _strands(layout: str, x: float, y: float) -> Array:
    """The lengths of the belt from its first end to the first motor, from there to the second one, and to its end."""
    of, (one, other) = _LAYOUTS[layout]
    wheels, ends = of(x, y)
    stops = [ends[0], *(p for w in wheels for p in (_on(w, 1), _on(w, 2))), ends[1]]
    pieces = [float(np.linalg.norm(b - a)) for a, b in zip(stops[::2], stops[1::2], strict=True)]
    return np.array([sum(pieces[: one + 1]), sum(pieces[one + 1 : other + 1]), sum(pieces[other + 1 :])])


def _on(wheel: Wheel, side: int) -> Array:
    angle = np.radians(wheel[side])
    return np.asarray(wheel[0] + _RADIUS * np.array([np.cos(angle), np.sin(angle)]))


def _path(wheels: Sequence[Wheel], ends: tuple[Array, Array]) -> list[Array]:
    path = [ends[0]]
    for centre, arrives, leaves in wheels:
        path += [_on((centre, angle, angle), 1) for angle in np.linspace(arrives, leaves, 13)]
    return [*path, ends[1]]


def _frame(layout: str, x: float, y: float) -> list[tuple[Array, Array, Body]]:
    """The fixed rails and the beam or arm that moves on them."""
    w, h = _WIDE, _HIGH
    if layout == "H":
        rails = [(_at(side, -h), _at(side, h), Body.BASE) for side in (-w, w)]
        return [*rails, (_at(-w, y), _at(w, y), Body.LINK)]
    return [(_at(-w, 0.0), _at(w, 0.0), Body.BASE), (_at(x, y - h), _at(x, y + h), Body.LINK)]
