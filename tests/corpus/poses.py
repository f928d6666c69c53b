"""Axis values to ask about: all over the workspace, at right angles, where margins vanish, and where assembly ends."""

from collections.abc import Iterator
from itertools import combinations
from typing import Any

import numpy as np
import softkin

from tests.corpus.robots import Robot
from tests.random_axes import random_axes

Array = np.ndarray[Any, np.dtype[np.float64]]
Axes = tuple[float, ...]

REGULAR = 0.05
"""Margins of a regular pose are at least this."""
SHIFTS = (0.0, 1e-9, -1e-5)
"""How far a margin is from zero near a singular pose."""
DRAWN = 6000
RIGHT = (0.0, 90.0, -90.0, 180.0, -180.0, 270.0)


def regular(one: Robot, count: int, rng: np.random.Generator) -> list[Axes]:
    """Axis values of regular poses that the inverse accepts."""
    found: list[Axes] = []
    for axes in _possible(one, rng):
        if len(found) == count:
            break
        if np.all(np.abs(margins(one, axes)) > REGULAR) and _returns(one, axes):
            found.append(axes)
    return found


def right_angles(one: Robot, count: int, rng: np.random.Generator) -> list[Axes]:
    """Axis values at multiples of 90 degrees, and round lengths."""
    turns = rng.choice(RIGHT, (20 * count, len(one.is_angle)))
    rows = np.where(one.is_angle, turns, one.reach * rng.integers(-2, 3, (20 * count, 1)) / 4)
    return [axes for axes in dict.fromkeys(map(tuple, rows.tolist())) if _frame(one, axes)][:count]


def singular(one: Robot, count: int, rng: np.random.Generator) -> Iterator[Axes]:
    """Axis values where one margin, two or three vanish, and those beside them: `count` places of every combination."""
    starts = [axes for axes, _ in zip(_possible(one, rng), range(60), strict=False)]
    names = range(len(one.made.MARGINS))
    for size in (1, 2, 3):
        for chosen in combinations(names, size):
            places = 0
            for start in starts:
                place = _newton(one, list(chosen), np.array(start))
                if place is None:
                    continue
                yield from _beside(one, list(chosen), place)
                places += 1
                if places == count:
                    break


def ends(one: Robot, count: int, rng: np.random.Generator) -> list[Axes]:
    """Axis values just before and behind the end of what can be assembled."""
    inside = [axes for axes, _ in zip(_possible(one, rng), range(count), strict=False)]
    found: list[Axes] = []
    for start, end in zip(inside, random_axes(one.made, 400, rng, 178.0, one.reach).tolist(), strict=False):
        good, bad = np.array(start), np.array(end)
        if _frame(one, tuple(bad.tolist())):
            bad = bad + 3.0 * one.reach
        if _frame(one, tuple(bad.tolist())):
            continue
        for _ in range(40):
            middle = (good + bad) / 2.0
            good, bad = (middle, bad) if _frame(one, tuple(middle.tolist())) else (good, middle)
        along = (bad - good) / max(float(np.linalg.norm(bad - good)), 1e-300) * one.reach
        found += [tuple((good - step * along).tolist()) for step in (1e-6, -1e-6)]
    return found


def margins(one: Robot, axes: Axes) -> Array:
    return np.array(list(one.made.singularity(axes).margins.values()), dtype=float)


def _possible(one: Robot, rng: np.random.Generator) -> Iterator[Axes]:
    """Random axis values that have a pose."""
    if "home_z" in one.made.parameters:
        yield from _about_home(one, rng)
        return
    rows = random_axes(one.made, DRAWN, rng, 178.0, one.reach)
    with np.errstate(all="ignore"):
        status = one.made.forward_batch(rows)[3]
    yield from map(tuple, rows[status == 0].tolist())


def _about_home(one: Robot, rng: np.random.Generator) -> Iterator[Axes]:
    """Of a plate that moves with its whole pose: axis values of poses about its home."""
    known = one.made.parameters
    home = np.array([known["home_x"], known["home_y"], known["home_z"]])
    for _ in range(400):
        place = home + 0.3 * known["home_z"] * rng.uniform(-1.0, 1.0, 3)
        for found in one.made.inverse_all((place.tolist(), rotation(rng, 25.0).tolist())):
            if found.axes is not None:
                yield found.axes


def rotation(rng: np.random.Generator, most: float = 180.0) -> Array:
    """A random rotation by at most some degrees, by rows, to all digits."""
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    angle = np.radians(most) * rng.uniform(-1.0, 1.0)
    cross = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross)


def _units(one: Robot) -> Array:
    return np.where(one.is_angle, 180.0 / np.pi, one.reach)


def _slopes(one: Robot, chosen: list[int], axes: Array) -> Array:
    steps = 1e-6 * np.diag(_units(one))
    return np.stack([(_at(one, chosen, axes + s) - _at(one, chosen, axes - s)) / 2e-6 for s in steps], axis=1)


def _at(one: Robot, chosen: list[int], axes: Array) -> Array:
    return margins(one, tuple(axes.tolist()))[chosen]


def _newton(one: Robot, chosen: list[int], axes: Array) -> Array | None:
    """Where the margins vanish, from a start; None where this does not get there."""
    for _ in range(30):
        value = _at(one, chosen, axes)
        if not np.isfinite(value).all():
            return None
        if np.abs(value).max() < 1e-15:
            break
        slopes = _slopes(one, chosen, axes)
        if not np.isfinite(slopes).all():
            break
        step = np.linalg.pinv(slopes, rcond=1e-9) @ value
        axes = axes - _units(one) * step * min(1.0, 0.4 / max(float(np.abs(step).max()), 1e-30))
    at_end = _at(one, chosen, axes)
    return axes if np.isfinite(at_end).all() and np.abs(at_end).max() < 1e-7 else None


def _beside(one: Robot, chosen: list[int], place: Array) -> Iterator[Axes]:
    """A place, and others beside it: the margins together, and the first alone."""
    aside = place + 1e-5 * _units(one) * np.random.default_rng(1).uniform(-1.0, 1.0, len(place))
    ways = np.linalg.pinv(np.nan_to_num(_slopes(one, chosen, aside)), rcond=1e-2) * _units(one)[:, None]
    for shift in SHIFTS:
        yield tuple((place + ways @ np.full(len(chosen), shift)).tolist())
    if len(chosen) > 1:
        yield tuple((place + 1e-6 * ways[:, 0]).tolist())


def _frame(one: Robot, axes: Axes) -> softkin.Frame | None:
    try:
        return one.made.forward(axes)[0]
    except softkin.KinematicsError:
        return None


def _returns(one: Robot, axes: Axes) -> bool:
    try:
        frame, configuration = one.made.forward(axes)
        one.made.inverse(frame, configuration, axes)
    except softkin.KinematicsError:
        return False
    return True
