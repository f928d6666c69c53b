"""The point on its line at which every axis is placed, so that the fewest shifts remain between the axes.

A point of a rotary axis may move along the axis; a slide has only a direction. Candidates are the points at which lines
meet or come nearest to their neighbours, those of the file, and their projections on parallel neighbours.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from derive.description.joints import Kind
from derive.importing.arms.headings import Heading
from derive.importing.arms.lines import Arm, feet, projected
from derive.importing.robot import Array

_FAR = 20.0
"""Candidates farther away than this many times the machine, with its base, are feet of nearly parallel axes."""
Cost = tuple[int, int, int, int, float]
"""Shifts that remain, lines that miss the points, shifts between axes, places with a shift, and their length."""


@dataclass(frozen=True)
class Search:
    """The data for rating candidates: frames of the lines and of the tip, and the size below which a shift is zero."""

    arm: Arm
    frames: tuple[Array, ...]
    """The frames of the base, of every line, and of the tip."""
    limit: float

    def shifts(self, index: int, between: Array) -> int:
        """The shifts from the place before a line to it, in the frame where they are fewest."""
        return min(int(np.sum(np.abs(frame.T @ between) > self.limit)) for frame in self.frames[index : index + 2])

    def cost(self, index: int, start: Array, end: Array, missed: int) -> Cost:
        """The cost of the way from one point to the next, which so many lines miss."""
        between = end - start
        shifts = self.shifts(index, between)
        inner = shifts if 0 < index < len(self.arm.lines) else 0
        return shifts, missed, inner, int(shifts > 0), round(float(np.abs(between).sum()) / self.arm.size, 6)

    def missed(self, index: int, point: Array) -> int:
        """The rotary axes that do not pass through a point, counted from an axis on to both sides; points of the first
        and the last axes (a shoulder, a wrist) come before an elbow.
        """
        lines = self.arm.lines
        if index == len(lines):
            return 0
        passed = [
            line.kind is Kind.ROTARY
            and float(np.linalg.norm(np.cross(point - line.point, line.direction))) <= self.limit
            for line in lines
        ]
        up = next((k for k in range(index, len(lines)) if not passed[k]), len(lines))
        down = next((k for k in range(index, -1, -1) if not passed[k]), -1)
        is_end = up == len(lines) or down == -1
        return 2 * (len(lines) - (up - down - 1)) - int(is_end)


def points(arm: Arm, ways: tuple[Heading, ...], tip_frame: Array, limit: float) -> list[Array]:
    """A point for every line, by dynamic programming over the candidates, so that the whole way costs least."""
    search = Search(arm, (np.eye(3), *(w.frame for w in ways), tip_frame), limit)
    best: list[tuple[Cost, list[Array]]] = [((0, 0, 0, 0, 0.0), [np.zeros(3)])]
    for index, candidates in enumerate([*_candidates(arm, limit), [arm.tip[:3, 3]]]):
        missed = [search.missed(index, end) for end in candidates]
        best = [
            min((_extended(search, index, way, end, miss) for way in best), key=_cost)
            for end, miss in zip(candidates, missed, strict=True)
        ]
    return best[0][1][1:-1]


def _cost(way: tuple[Cost, list[Array]]) -> Cost:
    return way[0]


def _extended(
    search: Search, index: int, way: tuple[Cost, list[Array]], end: Array, missed_here: int
) -> tuple[Cost, list[Array]]:
    cost = search.cost(index, way[1][-1], end, missed_here)
    shifts, missed, inner, places, length = (a + b for a, b in zip(way[0], cost, strict=True))
    return (int(shifts), int(missed), int(inner), int(places), float(length)), [*way[1], end]


def _candidates(arm: Arm, limit: float) -> list[list[Array]]:
    """The points that a line may be placed at, for every line."""
    lines = arm.lines
    far = _FAR * max(arm.size, *(float(np.linalg.norm(line.point)) for line in lines))
    rotary = [k for k, line in enumerate(lines) if line.kind is Kind.ROTARY]
    found: dict[int, list[Array]] = {k: [lines[k].point] for k in rotary}
    for k, other in zip(rotary, rotary[1:], strict=False):
        near = feet(lines[k], lines[other])
        if near is not None:
            found[k].append(near[0])
            found[other].append(near[1])
    ends = {0: np.zeros(3), len(rotary) - 1: arm.tip[:3, 3]}
    for place, point in ends.items():
        if rotary:
            found[rotary[place]].append(projected(lines[rotary[place]], point))
    for _ in range(2):
        before = {k: list(some) for k, some in found.items()}
        for k, other in zip(rotary, rotary[1:], strict=False):
            found[k] += [projected(lines[k], p) for p in before[other]]
            found[other] += [projected(lines[other], p) for p in before[k]]
        found = {k: _distinct(some, far, limit) for k, some in found.items()}
    every = _distinct([np.zeros(3), *(p for some in found.values() for p in some), arm.tip[:3, 3]], far, limit)
    return [sorted(found.get(k, every), key=partial(_place, arm.size)) for k in range(len(lines))]


def _place(size: float, point: Array) -> tuple[float, ...]:
    """The order of candidates: of ways that cost the same the first is taken, wherever the file has its frames."""
    shares = point / size
    return tuple(np.round([np.linalg.norm(shares), *shares], 6).tolist())


def _distinct(some: list[Array], far: float, limit: float) -> list[Array]:
    """The points that differ, without those that are far away."""
    kept: list[Array] = []
    for point in some:
        if np.linalg.norm(point) <= far and all(np.linalg.norm(point - k) > limit for k in kept):
            kept.append(point)
    return kept
