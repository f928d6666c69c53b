"""The five ways in which MJCF gives an orientation, and the compiler settings for them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from derive.importing.formats.documents import numbers, roundings
from derive.importing.robot import Array, Oriented, Place, Shifted, Turned, UnreadableRobot, about

Element = ElementTree.Element
_AXES = 0.71
"""The largest angular error of an axis whose numbers are rounded by half a unit, in units: slightly more than 1/√2."""
_QUATERNION = 2.0 * _AXES
"""The largest angular error of a quaternion, whose numbers belong to half the turn."""


@dataclass(frozen=True)
class File:
    """A file with its compiler settings and defaults."""

    path: Path
    root: Element
    degree: float
    """One unit of its angles, in radians."""
    sequence: str
    limits_by_range: bool
    scale: float


def places_of(file: File, element: Element, place: str) -> tuple[Place, ...]:
    if element.tag == "worldbody":
        return ()
    x, y, z = (v * file.scale for v in numbers(file.path, element, "pos", place, (0.0, 0.0, 0.0)))
    given = [a for a in ("quat", "axisangle", "euler", "xyaxes", "zaxis") if element.get(a)]
    if len(given) > 1:
        raise UnreadableRobot(f"{file.path}: {place} gives its orientation twice: {' and '.join(given)}")
    turned = _ORIENTATIONS[given[0]](file, element, place) if given else ()
    return (Shifted((x, y, z)), *turned)


def _euler(file: File, element: Element, place: str) -> tuple[Place, ...]:
    angles = numbers(file.path, element, "euler", place, (0.0, 0.0, 0.0))
    sequence = file.sequence
    if len(sequence) != 3 or set(sequence.lower()) - set("xyz") or sequence not in (sequence.lower(), sequence.upper()):
        raise UnreadableRobot(f"{file.path}: its sequence of angles {sequence!r} is not three of xyz, or of XYZ")
    rounded = roundings(element, "euler", 3, with_coarse=True) if file.degree == 1.0 else (0.0, 0.0, 0.0)
    turns = [
        Turned("xyz".index(c.lower()), a * file.degree, r) for c, a, r in zip(sequence, angles, rounded, strict=True)
    ]
    return tuple(turns if sequence.islower() else turns[::-1])


def _quaternion(file: File, element: Element, place: str) -> tuple[Place, ...]:
    w, x, y, z = _unit(file, numbers(file.path, element, "quat", place, (1.0, 0.0, 0.0, 0.0)), place)
    return (
        _oriented(
            np.array(
                [
                    [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
                ]
            ),
            _QUATERNION * max(roundings(element, "quat", 4)),
        ),
    )


def _axis_angle(file: File, element: Element, place: str) -> tuple[Place, ...]:
    x, y, z, angle = numbers(file.path, element, "axisangle", place, (1.0, 0.0, 0.0, 0.0))
    rounded = roundings(element, "axisangle", 4)[3] if file.degree == 1.0 else 0.0
    axis = _unit(file, (x, y, z), place)
    along = int(np.argmax(np.abs(axis)))
    if np.count_nonzero(axis) == 1:
        return (Turned(along, float(axis[along]) * angle * file.degree, rounded),)
    return (_oriented(about(axis, angle * file.degree), 0.0),)


def _two_axes(file: File, element: Element, place: str) -> tuple[Place, ...]:
    stated = numbers(file.path, element, "xyaxes", place, (1.0, 0.0, 0.0, 0.0, 1.0, 0.0))
    x = _unit(file, stated[:3], place)
    y = np.array(stated[3:])
    y = _unit(file, tuple(y - x * float(x @ y)), place)
    return (_oriented(np.column_stack([x, y, np.cross(x, y)]), _AXES * max(roundings(element, "xyaxes", 6))),)


def _one_axis(file: File, element: Element, place: str) -> tuple[Place, ...]:
    z = _unit(file, numbers(file.path, element, "zaxis", place, (0.0, 0.0, 1.0)), place)
    rounded = _AXES * max(roundings(element, "zaxis", 3))
    across = np.cross([0.0, 0.0, 1.0], z)
    sine = float(np.linalg.norm(across))
    if sine < 1e-10:
        return () if z[2] > 0.0 else (Turned(0, math.pi),)
    return (_oriented(about(across / sine, math.atan2(sine, float(z[2]))), rounded),)


_ORIENTATIONS: Mapping[str, Callable[[File, Element, str], tuple[Place, ...]]] = {
    "quat": _quaternion,
    "axisangle": _axis_angle,
    "euler": _euler,
    "xyaxes": _two_axes,
    "zaxis": _one_axis,
}


def _unit(file: File, stated: Sequence[float], place: str) -> Array:
    size = math.sqrt(sum(v * v for v in stated))
    if size < 1e-9:
        raise UnreadableRobot(f"{file.path}: {place}: its orientation has no direction")
    return np.array(stated) / size


def _oriented(rotation: Array, rounding: float) -> Oriented:
    first, second, third = (tuple(map(float, row)) for row in rotation)
    return Oriented((first, second, third), rounding)  # type: ignore[arg-type]
