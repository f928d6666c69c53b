"""Lines and arcs about a pose of a machine, with G28s, as a program and as points, and what the axes do along them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
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
SHORT = 0.004
"""Of very short lines, mm."""
MADE = "SOFTKIN_STEPS_MADE"
REFUSED = "SOFTKIN_REFUSED"
"""Commands of our extension, `softkin_written`: the first is behind every line, also the last one of a part."""
_SPEED = 600
"""mm in a minute."""


@dataclass(frozen=True)
class Part:
    """What follows a G28, which says that the machine stands at home, wherever it is."""

    program: str
    axes: Array
    """(N, axes) along it."""


@dataclass(frozen=True)
class Way:
    """A program for a machine."""

    robot: softkin.Mechanism
    sizes: Mapping[str, float]
    home: tuple[float, ...]
    configuration: tuple[int, ...]
    parts: tuple[Part, ...]


def way_of(mechanism: Mechanism) -> Way:
    """A way that the machine can go with the dimensions of its pictures, as large as possible."""
    sizes = {p.name: p.nominal for p in mechanism.parameters if p.nominal != p.default}
    robot = softkin.catalogue()[mechanism.name](**sizes)
    for size in SIZES:
        for home in _homes(mechanism):
            try:
                frame, configuration = robot.forward(home)
            except softkin.KinematicsError:
                continue
            parts = []
            for drawing in _drawn(np.array(frame.position), size, list(mechanism.task.position)):
                points = np.concatenate(drawing.points)
                axes, statuses = robot.inverse_batch(points, None, _branches(robot, configuration), home)
                if statuses.any() or not _is_regular(robot, axes[:: len(axes) // 100]):
                    break
                parts.append(Part("\n".join(drawing.lines), axes))
            else:
                return Way(robot, sizes, home, configuration, tuple(parts))
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


class _Drawing:
    """Lines of a program, and the points that they pass."""

    def __init__(self, start: Array, letters: list[str], *begin: str) -> None:
        self.at, self.letters, self.zero = start, letters, np.zeros(3)
        self.lines, self.points = list(begin), [start[None]]

    def line(self, *apart: float, further: Sequence[str] = (MADE,)) -> None:
        """A line by so much, in every letter that the machine has, and further commands."""
        begin, self.at = self.at, self._beside(apart)
        self.lines += [f"G1 {self.words(self.at)} F{_SPEED}", *further]
        count = max(2, int(np.linalg.norm(self.at - begin) / SPACING))
        self.points.append(begin + np.linspace(0.0, 1.0, count)[1:, None] * (self.at - begin))

    def arc(self, turn: float, *centre: float) -> None:
        """An arc in the plane of X and Y, by degrees, about a point that is so far from here."""
        offset = np.array(centre)
        count = int(np.radians(abs(turn)) * np.linalg.norm(offset) / SPACING)
        angles = np.radians(turn) * np.linspace(0.0, 1.0, count)[1:]
        x = -offset[0] * np.cos(angles) + offset[1] * np.sin(angles)
        y = -offset[0] * np.sin(angles) - offset[1] * np.cos(angles)
        way = self.at + offset + np.stack((x, y, np.zeros_like(x)), axis=1)
        code, self.at = "G3" if turn > 0.0 else "G2", way[-1]
        self.lines += [f"{code} {self.words(self.at)} I{offset[0]:.9f} J{offset[1]:.9f} F{_SPEED}", MADE]
        self.points.append(way)

    def zeroed(self) -> None:
        """G92: from here words count from this point."""
        self.lines.append("G92 " + " ".join(f"{letter.upper()}0" for letter in self.letters))
        self.zero = self.at

    def refused(self) -> None:
        """A line beyond what Klipper allows, and one that extrudes without an extruder: nothing moves."""
        for apart, further in ((20_000.0, 0.0), (1.0, 1.0)):
            words = " ".join(f"{letter.upper()}={apart}" for letter in self.letters)
            self.lines.append(f"{REFUSED} {words} E={further}")

    def words(self, at: Array) -> str:
        """The words of a position."""
        return " ".join(f"{letter.upper()}{(at - self.zero)['xyz'.index(letter)]:.9f}" for letter in self.letters)

    def _beside(self, apart: Sequence[float]) -> Array:
        return self.at + [by if letter in self.letters else 0.0 for letter, by in zip("xyz", apart, strict=True)]


def _drawn(start: Array, size: float, letters: list[str]) -> list[_Drawing]:
    """Lines in every letter and an arc each way, and back; the same behind a G28, and away; what is refused or very
    short, behind a G28 of one letter and a G92; and a line behind an M84 and a G28 of others, which ends the G92.
    """
    first, again = _Drawing(start, letters, "G28"), _Drawing(start, letters, "G28")
    for drawing, long in ((first, size), (again, size / 2.0)):
        drawing.line(long, 0.3 * long, -0.4 * long)
        drawing.arc(120.0, -0.3 * long, 0.1 * long, 0.0)
        drawing.arc(-200.0, 0.1 * long, 0.25 * long, 0.0)
        drawing.line(*(start + np.array((0.6, 1.0, 0.2)) * long - drawing.at))
    first.line(*(start - first.at))
    short = _Drawing(start, letters, "G28 X")
    short.zeroed()
    short.line(0.2 * size, -0.1 * size, 0.1 * size)
    short.refused()
    for turn in (0.0, 0.7, -0.7) * 8:
        short.line(SHORT * np.cos(turn), SHORT * np.sin(turn), SHORT, further=())
    short.refused()
    short.line(-0.3 * size, 0.2 * size, 0.2 * size)
    last = _Drawing(start, letters, "M84", "G28 Y Z")
    last.line(0.3 * size, 0.3 * size, -0.3 * size)
    return [first, again, short, last]
