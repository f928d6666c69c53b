"""Lines and arcs about a pose of a machine, as a program and as points, and what the axes do along them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import softkin

from derive.description.mechanism import Mechanism

Array = np.ndarray[Any, np.dtype[np.float64]]
SIZES = (40.0, 20.0, 8.0, 3.0)
SPACING = 0.002
"""Of the points, mm."""
LEAST = 0.08
"""Margins on the way are at least this."""
_SPEED = 600
"""mm in a minute."""


@dataclass(frozen=True)
class Way:
    """A program from a pose, with the axes (N, axes) along it."""

    robot: softkin.Mechanism
    sizes: Mapping[str, float]
    home: tuple[float, ...]
    configuration: tuple[int, ...]
    program: str
    axes: Array


def way_of(mechanism: Mechanism) -> Way:
    """A way that the machine can go with the dimensions of its pictures, as large as possible."""
    sizes = {p.name: p.nominal for p in mechanism.parameters if p.nominal != p.default}
    robot = softkin.catalogue()[mechanism.name](**sizes)
    letters = list(mechanism.task.position)
    for size in SIZES:
        for home in _homes(mechanism):
            try:
                frame, configuration = robot.forward(home)
            except softkin.KinematicsError:
                continue
            program, points = _drawn(np.array(frame.position), size, letters)
            axes, statuses = robot.inverse_batch(points, None, _branches(robot, configuration), home)
            if not statuses.any() and _is_regular(robot, axes[:: len(axes) // 100]):
                return Way(robot, sizes, home, configuration, program, axes)
    raise ValueError(f"{mechanism.name}: no way is found")


def _homes(mechanism: Mechanism) -> Iterator[tuple[float, ...]]:
    """Axis values farther and farther from those of the pictures."""
    rng = np.random.default_rng(3)
    drawn = np.array([joint.nominal for joint in mechanism.joints])
    for count in range(400):
        yield tuple(np.round(drawn + (10.0 + 0.4 * count) * rng.uniform(-1.0, 1.0, len(drawn)), 3).tolist())


def _branches(robot: softkin.Mechanism, configuration: tuple[int, ...]) -> tuple[int, ...]:
    return (*configuration[: robot.BRANCHES], *(0,) * (len(configuration) - robot.BRANCHES))


def _is_regular(robot: softkin.Mechanism, axes: Array) -> bool:
    return all(abs(m) > LEAST for row in axes for m in robot.singularity(row.tolist()).margins.values())


def _drawn(start: Array, size: float, letters: list[str]) -> tuple[str, Array]:
    """A line in every letter, an arc each way, a line back; the points of all of it."""
    moved = np.array([1.0 if letter in letters else 0.0 for letter in "xyz"]) * size
    first, second = start + moved * (1.0, 0.3, -0.4), start + moved * (0.6, 1.0, 0.2)
    lines, points = [], []

    def line(to: Array, begin: Array) -> None:
        lines.append(f"G1 {_words(to, letters)} F{_SPEED}")
        count = int(np.linalg.norm(to - begin) / SPACING)
        points.append(begin + np.linspace(0.0, 1.0, count)[1:, None] * (to - begin))

    def arc(begin: Array, centre: Array, turn: float) -> Array:
        """An arc in the plane of X and Y, by degrees; where it ends."""
        arm = begin - centre
        count = int(np.radians(abs(turn)) * np.linalg.norm(arm) / SPACING)
        angles = np.radians(turn) * np.linspace(0.0, 1.0, count)[1:]
        x = arm[0] * np.cos(angles) - arm[1] * np.sin(angles)
        y = arm[0] * np.sin(angles) + arm[1] * np.cos(angles)
        way = centre + np.stack((x, y, np.zeros_like(x)), axis=1)
        code, offset = "G3" if turn > 0.0 else "G2", centre - begin
        lines.append(f"{code} {_words(way[-1], letters)} I{offset[0]:.9f} J{offset[1]:.9f} F{_SPEED}")
        points.append(way)
        return np.asarray(way[-1])

    line(first, start)
    end = arc(first, first + (-0.3 * size, 0.1 * size, 0.0), 120.0)
    end = arc(end, end + (0.1 * size, 0.25 * size, 0.0), -200.0)
    line(second, end)
    line(start, second)
    return "\n".join(lines), np.concatenate(points)


def _words(at: Array, letters: list[str]) -> str:
    return " ".join(f"{letter.upper()}{at['xyz'.index(letter)]:.9f}" for letter in letters)
