"""All poses of a machine at its axes: in every assembly mode, and of a platform those that a search finds."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from softkin._constants import FEWEST_STARTS, MOST_STARTS, OFTEN, SAME_POSE
from softkin._frame import Frame
from softkin._types import Configuration, Reals, Status

if TYPE_CHECKING:
    from softkin._array import Rotation, Vector
    from softkin._core import EveryPose, Mechanism
    from softkin._start import IterativeForward

_Array: TypeAlias = NDArray[np.float64]
_STEPS = 1.1127756842787055 ** -np.arange(1.0, 7.0)
"""Irrational steps that fill a space of six dimensions evenly: powers of 1 / g, where g^7 = g + 1."""
_CUBE = 1.5
"""The starts are in a cube with sides of so many sizes of the machine."""


class ForwardSolution(NamedTuple):
    """One pose that a machine has at given axes, as `forward` returns it, and its assembly mode."""

    frame: Frame
    configuration: Configuration
    is_other: bool
    """Whether it is in the assembly mode that the machine is not in: `forward` and `inverse` of the machine refuse it.
    """


def forward_all(machine: Mechanism, axes: Reals) -> tuple[ForwardSolution, ...]:
    """All poses at axis values."""
    return tuple(
        ForwardSolution(Frame(position, rotation), machine._written(margins, axes), is_other)
        for (position, rotation, margins), is_other in machine._every_pose(axes)
    )


def searched(machine: IterativeForward, axes: Reals) -> EveryPose:
    """The poses of a platform: that of `forward`, further ones of its assembly mode, those of the other mode."""
    pose = machine._forward(axes)
    if pose is Status.BAD_INPUT:
        return ()
    present = _home(machine) if isinstance(pose, Status) else Frame(*pose[:2])
    centre, size = _extent(machine, axes, present)
    first = [] if isinstance(pose, Status) else [(_row(present), 0)]
    modes = ((machine, first), (machine._in_other_assembly(), list[tuple[_Array, int]]()))
    for begun in range(0, MOST_STARTS, FEWEST_STARTS):
        starts = _starts(machine, np.arange(begun + 1.0, begun + FEWEST_STARTS + 1.0), centre, size, present)
        for mode, found in modes:
            _count(found, _ends(mode, axes, *starts), size)
        if all(count >= OFTEN for _, found in modes for _, count in found):
            break
    polished = [
        (mode._started((x, y, z), ((a, b, c), (d, e, f), (g, h, i)))._forward(axes), mode is not machine)
        for mode, found in modes
        for x, y, z, a, b, c, d, e, f, g, h, i in (row.tolist() for row, _ in found)
    ]
    return tuple((one, is_other) for one, is_other in polished if not isinstance(one, Status))


def _home(machine: IterativeForward) -> Frame:
    """The frame from which forward kinematics starts; what the machine does not turn or move is left out of it."""
    known = vars(machine._constants)
    x, y, z = (known.get(f"start_{letter}", 0.0) for letter in "xyz")
    rows = ((known.get(f"start_r{i}{j}", float(i == j)) for j in (1, 2, 3)) for i in (1, 2, 3))
    (a, b, c), (d, e, f), (g, h, i) = rows
    return Frame((x, y, z), ((a, b, c), (d, e, f), (g, h, i)))


def _extent(machine: IterativeForward, axes: Reals, frame: Frame) -> tuple[_Array, float]:
    """The middle of the points between which the machine is drawn, and twice the largest distance from it."""
    drawn = machine._points(axes, *frame)
    points = np.reshape((*(() if isinstance(drawn, Status) else drawn), *frame.position), (-1, 3))
    centre = points.mean(axis=0)
    return centre, 2.0 * float(np.linalg.norm(points - centre, axis=1).max())


def _starts(
    machine: IterativeForward, numbers: _Array, centre: _Array, size: float, present: Frame
) -> tuple[Vector, Rotation]:
    """Starts spread evenly over places and rotations, as the viewer takes them: for each number one."""
    parts = (0.5 + numbers[:, None] * _STEPS) % 1.0
    spread = centre + _CUBE * size * (parts[:, :3] - 0.5)
    place = (
        spread[:, k] if letter in machine.JACOBIAN_ROWS else np.full(len(numbers), present.position[k])
        for k, letter in enumerate("xyz")
    )
    x, y, z = place
    u, v, w = parts[:, 3:].T
    if machine.FREEDOM == "one":
        cosine, sine, none = np.cos(2.0 * pi * u), np.sin(2.0 * pi * u), np.zeros(len(u))
        return (x, y, z), ((cosine, -sine, none), (sine, cosine, none), (none, none, none + 1.0))
    a, b = np.sqrt(1.0 - u), np.sqrt(u)
    i, j, k, r = a * np.sin(2.0 * pi * v), a * np.cos(2.0 * pi * v), b * np.sin(2.0 * pi * w), b * np.cos(2.0 * pi * w)
    return (x, y, z), (
        (1.0 - 2.0 * (j * j + k * k), 2.0 * (i * j - r * k), 2.0 * (i * k + r * j)),
        (2.0 * (i * j + r * k), 1.0 - 2.0 * (i * i + k * k), 2.0 * (j * k - r * i)),
        (2.0 * (i * k - r * j), 2.0 * (j * k + r * i), 1.0 - 2.0 * (i * i + j * j)),
    )


def _ends(machine: IterativeForward, axes: Reals, position: Vector, rotation: Rotation) -> _Array:
    """The poses to which Newton's method comes from starts: rows of twelve."""
    count = len(position[0])
    with np.errstate(all="ignore"):
        given = tuple(np.full(count, axis) for axis in axes)
        (place, turn, _), status = machine._array_programs().started(position, rotation).forward(given)
    rows = [np.broadcast_to(entry, count) for entry in (*place, *(entry for row in turn for entry in row))]
    return np.asarray(np.stack(rows, axis=1)[np.broadcast_to(status, count) == Status.OK])


def _count(found: list[tuple[_Array, int]], rows: _Array, size: float) -> None:
    """Count to which poses these rows belong, and add those that are new."""
    for index, (known, count) in enumerate(found):
        same = _are_same(rows, known, size)
        found[index] = known, count + int(same.sum())
        rows = rows[~same]
    while len(rows):
        same = _are_same(rows, rows[0], size)
        found.append((rows[0], int(same.sum())))
        rows = rows[~same]


def _are_same(rows: _Array, row: _Array, size: float) -> NDArray[np.bool_]:
    """Which rows are one pose with another."""
    apart = np.abs(rows - row)
    return np.asarray((apart[:, :3] < SAME_POSE * size).all(axis=1) & (apart[:, 3:] < SAME_POSE).all(axis=1))


def _row(frame: Frame) -> _Array:
    return np.array([*frame.position, *np.ravel(frame.rotation)])
