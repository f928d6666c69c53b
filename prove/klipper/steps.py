"""The steps that Klipper wrote, decoded, and compared with the axes of a way."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from prove.klipper.path import Array

STEEP = 0.2
_MESSAGE = re.compile(r"^\s*(?:\S+: )?(queue_step|set_next_step_dir|reset_step_clock|config_stepper) (.*)$")


@dataclass(frozen=True)
class Steps:
    """Of one stepper the times (s) and the directions."""

    times: Array
    directions: Array

    def between(self, begin: float, end: float) -> Steps:
        """Those in a time."""
        is_inside = (self.times >= begin) & (self.times < end)
        return Steps(self.times[is_inside], self.directions[is_inside])


def decoded(text: str, pins: dict[str, int], frequency: float) -> list[Steps]:
    """The steps of every axis. text: Klipper's messages; pins: the axis of each step pin."""
    axes: dict[int, int] = {}
    clocks: dict[int, int] = {}
    directions: dict[int, int] = {}
    found: dict[int, list[tuple[int, int]]] = {}
    for line in text.splitlines():
        match = _MESSAGE.match(line)
        if match is None:
            continue
        given = dict(re.findall(r"(\w+)=(\S+)", match[2]))
        one = int(given["oid"])
        if match[1] == "config_stepper":
            axes[one] = pins[given["step_pin"].rpartition("/")[2]]
        elif match[1] == "reset_step_clock":
            clocks[one] = int(given["clock"])
        elif match[1] == "set_next_step_dir":
            directions[one] = 1 if int(given["dir"]) else -1
        else:
            found.setdefault(one, []).extend(_queued(given, one, clocks, directions))
    by_axis = {axes[one]: np.array(steps, dtype=float).reshape(-1, 2) for one, steps in found.items()}
    every = [by_axis.get(axis, np.zeros((0, 2))) for axis in range(len(pins))]
    return [Steps(steps[:, 0] / frequency, steps[:, 1]) for steps in every]


def _queued(
    given: dict[str, str], one: int, clocks: dict[int, int], directions: dict[int, int]
) -> Iterator[tuple[int, int]]:
    interval, count, add = (int(given[word]) for word in ("interval", "count", "add"))
    for _ in range(count):
        clocks[one] = clocks.get(one, 0) + interval
        yield clocks[one], directions[one]
        interval += add


def crossings(values: Array) -> tuple[Array, Array]:
    """Where on a way (in points) a stepper steps, whose position has these values in steps from where it begins, and in
    which direction: it steps when half a step is behind it.
    """
    places: list[float] = []
    directions: list[int] = []
    count = 0
    for point in np.flatnonzero(np.diff(np.floor(values + 0.5))):
        end = int(np.floor(values[point + 1] + 0.5))
        while count != end:
            direction = 1 if end > count else -1
            border = count + direction / 2
            slope = values[point + 1] - values[point]
            places.append(point + float(np.clip((border - values[point]) / slope, 0.0, 1.0)))
            directions.append(direction)
            count += direction
    return np.array(places), np.array(directions, dtype=float)


def _made(places: Array, directions: Array, made: Array) -> Array | None:
    """The places of the steps that were made; None if there are others. Klipper leaves out a step that the next one
    takes back within 0.75 ms.
    """
    kept: list[float] = []
    at = 0
    while at < len(places):
        if len(kept) < len(made) and directions[at] == made[len(kept)]:
            kept.append(float(places[at]))
            at += 1
        elif at + 1 < len(places) and directions[at] == -directions[at + 1]:
            at += 2
        else:
            return None
    return np.array(kept) if len(kept) == len(made) else None


@dataclass(frozen=True)
class Compared:
    """What the comparison found."""

    count: int
    """How many steps."""
    farthest: float
    """The largest distance, in steps, of an axis of the package from its stepper, when another stepper steps."""
    fault: str
    """Which stepper makes other steps than those of the way; empty if none does."""


def compared(steps: list[Steps], ideal: Array) -> Compared:
    """ideal: the axes along the way (N, axes), in steps from where they begin."""
    fault, places = "", []
    for axis, one in enumerate(steps):
        found = _made(*crossings(ideal[:, axis]), one.directions)
        if found is None:
            fault = fault or f"axis {axis}: its {len(one.directions)} steps are not those of the way"
        places.append(np.zeros(0) if found is None else found)
    count = sum(len(one.times) for one in steps)
    if fault:
        return Compared(count, np.inf, fault)
    farthest = 0.0
    points, slopes = np.arange(len(ideal)), np.abs(np.gradient(ideal, axis=0))
    for axis, one in enumerate(steps):
        at = places[axis].astype(int)
        for other, seen in enumerate(steps):
            # Where an axis hardly moves its step says little about where the machine is.
            tells = slopes[at, axis] > STEEP * slopes[at, other]
            if other == axis or not tells.any():
                continue
            counts = np.concatenate(([0.0], np.cumsum(seen.directions)))
            stands = counts[np.searchsorted(seen.times, one.times, "right")]
            apart = np.abs(np.interp(places[axis], points, ideal[:, other]) - stands)
            farthest = max(farthest, float(apart[tells].max()))
    return Compared(count, farthest, fault)
