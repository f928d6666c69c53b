"""Slices through the workspace of the nominal machine: at each point the number of solutions, and the distance of the
best of them from a singularity."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from derive.ir.interpret import run
from derive.ir.program import Status
from derive.ir.symbols import branch_sign
from derive.kinematics.kinematics import Reals
from derive.kinematics.sampling import sample_axes, size_of
from derive.report.reference_calls import FRAME, Machine, are_inside, with_any_miss

_POINTS, _MANY_SLOTS, _SEARCHED = 96, 36, 20
"""The points along a side: for few solutions, for more than `_FEW` branches, for a machine with a root search."""
_FEW = 8
_SAMPLES, _SEED = 2000, 9
_SHARE, _ROOM = (2.0, 98.0), 0.15
"""The percentiles of sampled positions between which a slice extends, and the room added beside them."""
_SAME = 1e-6
_AROUND = 0.5
"""The extent from home of the slice of a loop that turns its platform, in lengths of the machine."""

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Slice:
    """A plane of the workspace: columns along the first coordinate, rows along the second."""

    along: tuple[str, str]
    """The coordinates of the plane."""
    at: tuple[tuple[str, float], ...]
    """The other coordinates."""
    ends: tuple[tuple[float, float], tuple[float, float]]
    solutions: Array
    """The number of solutions: 0 where the machine cannot reach the point."""
    margin: Array
    """The smallest margin in size, for the solution with the largest one; NaN if there is no solution."""
    tool: tuple[float, float]
    """The position of the tool in the drawn pose."""

    @property
    def is_everywhere(self) -> bool:
        """Whether the machine reaches all of it."""
        return bool(np.all(self.solutions > 0))


def slices(machine: Machine, frame: Reals, axes: Reals) -> Iterator[Slice]:
    """The slices through the position of a frame, with its rotation: one for a plane; in space along x and z, and along
    x and y; none for a machine that commands fewer than two coordinates.

    axes: the reference.
    """
    letters = machine.kinematics.mechanism.task.position
    planes = [("x", "z"), ("x", "y")] if letters == "xyz" else list(combinations(letters, 2))[:1]
    ends = _ends(machine, frame)
    for first, second in planes:
        yield _slice(machine, frame, axes, (first, second), ends)


def _ends(machine: Machine, frame: Reals) -> dict[str, tuple[float, float]]:
    """The extent of the slices."""
    kinematics = machine.kinematics
    if kinematics.mechanism.is_platform:
        reach = _AROUND * size_of(kinematics.mechanism, machine.values)
        return {c: (v - reach, v + reach) for c, v in zip("xyz", frame, strict=False)}
    drawn = sample_axes(kinematics.mechanism, dict(machine.values), _SAMPLES, _SEED)
    found, status = run(kinematics.forward, {**with_any_miss(machine).values, **drawn})
    good = np.asarray(np.broadcast_to(status == Status.OK, (_SAMPLES,)), dtype=bool)
    ends = {}
    for place, name in enumerate("xyz"):
        values = np.broadcast_to(found[name], (_SAMPLES,))[good]
        low, high = np.percentile(values, _SHARE) if values.size else (0.0, 0.0)
        low, high = min(low, frame[place]), max(high, frame[place])
        ends[name] = (float(low), float(high))
    widest = max(high - low for low, high in ends.values()) or 1.0
    return {c: (low - _ROOM * widest, high + _ROOM * widest) for c, (low, high) in ends.items()}


def _slice(
    machine: Machine, frame: Reals, axes: Reals, along: tuple[str, str], ends: dict[str, tuple[float, float]]
) -> Slice:
    kinematics = machine.kinematics
    slots = 2 ** len(kinematics.branches)
    searched = kinematics.search_given is not None
    count = _SEARCHED if searched else _MANY_SLOTS if slots > _FEW else _POINTS
    columns, rows = (_middles(ends[c], count) for c in along)
    grid = dict(zip(along, np.meshgrid(columns, rows), strict=True))
    values = {n: np.full(count * count, v) for n, v in zip(FRAME, frame, strict=True)}
    values |= {c: part.ravel() for c, part in grid.items()}
    found = [_solved(machine, values, axes, signs) for signs in product((1.0, -1.0), repeat=len(kinematics.branches))]
    known = [c for c in kinematics.mechanism.task.position if c not in along]
    place = dict(zip("xyz", frame, strict=False))
    return Slice(
        along,
        tuple((c, place[c]) for c in known),
        (ends[along[0]], ends[along[1]]),
        _different([axes for axes, _, _ in found], [good for _, good, _ in found]).reshape(count, count),
        _best([margin for _, _, margin in found]).reshape(count, count),
        (place[along[0]], place[along[1]]),
    )


def _middles(ends: tuple[float, float], count: int) -> Array:
    low, high = ends
    return low + (np.arange(count) + 0.5) * (high - low) / count


def _solved(
    machine: Machine, values: dict[str, Array], axes: Reals, signs: tuple[float, ...]
) -> tuple[Array, NDArray[np.bool_], Array]:
    """For one branch: the axis values by rows, whether it has a solution inside the limits, and its smallest margin."""
    kinematics = machine.kinematics
    joints, count = kinematics.mechanism.joints, values["x"].size
    given = {**machine.values, **values}
    given |= {j.reference.name: np.full(count, v) for j, v in zip(joints, axes, strict=True)}
    given |= {branch_sign(b.name).name: np.full(count, s) for b, s in zip(kinematics.branches, signs, strict=True)}
    given |= {j.turn.name: np.zeros(count) for j in kinematics.period_joints}
    given |= {"cos_heading": values["r11"], "sin_heading": values["r21"]}
    found, status = run(kinematics.branch, given)
    solution = np.stack([np.broadcast_to(found[j.axis.name], (count,)) for j in joints])
    good = np.asarray(np.broadcast_to(status == Status.OK, (count,)), dtype=bool)
    named = {**machine.values, **{j.axis.name: row for j, row in zip(joints, solution, strict=True)}}
    good = good & are_inside(machine, {j.axis.name: row for j, row in zip(joints, solution, strict=True)})
    names = [m.name for m in kinematics.margins if m.length is None]
    if not names:
        return solution, good, np.where(good, 1.0, np.nan)
    there = {f"start_{n}": values[n] for n in FRAME} if kinematics.starts else {}
    margins, at = run(kinematics.singularity, named | there)
    least = np.min(np.abs(np.stack([np.broadcast_to(margins[n], (count,)) for n in names])), axis=0)
    has_margin = good & np.asarray(np.broadcast_to(at == Status.OK, (count,)), dtype=bool)
    return solution, good, np.where(has_margin, least, np.nan)


def _different(solutions: list[Array], good: list[NDArray[np.bool_]]) -> Array:
    """The number of different solutions at each point."""
    total = np.zeros(good[0].size)
    for k, (own, is_good) in enumerate(zip(solutions, good, strict=True)):
        is_new = is_good.copy()
        for other, was_good in zip(solutions[:k], good[:k], strict=True):
            is_same = np.max(np.abs(own - other), axis=0, initial=0.0) < _SAME
            is_new = is_new & ~(was_good & is_same)
        total += is_new
    return total


def _best(margins: list[Array]) -> Array:
    """The largest of the margins at each point; NaN if there is none."""
    stacked = np.stack(margins)
    best = np.max(np.where(np.isnan(stacked), -1.0, stacked), axis=0)
    return np.asarray(np.where(best < 0.0, np.nan, best))
