"""The largest constant speed along a path that the limits of the axes allow.

The axes are differentiated along the path itself: on every machine, whatever of a commanded rotation it follows.
"""

from __future__ import annotations

from math import degrees, dist

import numpy as np

from softkin._accelerations import feeds_of, limits_of
from softkin._path import Path, line_of, solved
from softkin._slerp import angle_between
from softkin._types import Diagnosis, Numbers, Reals

_APART = 1e-4
"""The share of a line over which axes are differentiated."""


def along(path: Path, velocities: Numbers | None, accelerations: Numbers | None) -> Reals:
    """See `Path.feeds`."""
    robot = path.robot
    first = limits_of(robot, "feeds", velocities, "velocities")
    second = limits_of(robot, "feeds", accelerations, "accelerations")
    rates = np.array([_rates(path, number) for number in range(len(path.places))]).reshape(-1, 2, len(robot.AXES))
    return tuple(feeds_of(rates[:, 0], rates[:, 1], first, second).tolist())


def _rates(path: Path, number: int) -> tuple[Reals, Reals]:
    """The first and the second derivatives of the axes by the way along the line of a sample."""
    place, axes = path.places[number], path.axes[number]
    nothing = (0.0,) * len(axes)
    line = min(max(line_of(place), 0), max(len(path.corners) - 2, 0))
    end = min(line + 1.0, path.places[-1])
    step, way = min(_APART, 0.5 * (end - line)), _way(path, line)
    if not step * way > 0.0:
        return nothing, nothing
    middle = min(max(place, line + step), end - step)
    before, here, behind = (_solved(path, at, axes) for at in (middle - step, middle, middle + step))
    first = tuple([(b - a) / (2.0 * step * way) for a, b in zip(before, behind, strict=True)])
    turns = zip(before, here, behind, strict=True)
    return first, tuple([(c - 2.0 * b + a) / (step * way) ** 2 for a, b, c in turns])


def _solved(path: Path, place: float, near: Reals) -> Reals:
    found = solved(path, place, near)
    return (float("nan"),) * len(near) if isinstance(found, Diagnosis) else found


def _way(path: Path, line: int) -> float:
    """The length of a line; of one that only turns, its turn in degrees."""
    if len(path.corners) < 2:
        return 0.0
    start, goal = path.corners[line : line + 2]
    return dist(start.position, goal.position) or degrees(angle_between(start.rotation, goal.rotation))
