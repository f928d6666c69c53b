"""Robots of the whole catalogue, couplings among them, with poses that they reach and limits."""

from collections.abc import Mapping
from functools import cache

import numpy as np
import softkin
from softkin import Frame

from tests.corpus.dimensions import COUPLED, DIMENSIONS
from tests.corpus.poses import regular
from tests.corpus.robots import Robot, recipes, robot

NAMES = (*DIMENSIONS, *COUPLED)
Axes = tuple[float, ...]
Ends = tuple[float | None, float | None] | None
GEARED = {
    "link_length_1": 300.0, "link_length_2": 250.0, "link_length_3": 80.0, "coupling_12": -0.7, "coupling_13": 0.3,
    "coupling_23": 0.25,
}  # fmt: skip
"""An SCCC whose motors are no whole multiples of each other."""


@cache
def robots(name: str) -> tuple[Robot, ...]:
    """A machine as it is drawn, and an unequal one with offsets."""
    every = list(recipes(name))
    found = [robot(every[0]), *([robot(every[-2])] if len(every) > 1 else [])]
    if name == "Kin_SCCC":
        found.append(robot([{"name": name, "parameters": GEARED}]))
    return tuple(found)


@cache
def poses(name: str, number: int, count: int) -> tuple[Axes, ...]:
    """Axis values of regular poses of one of these machines."""
    return tuple(regular(robots(name)[number], count, np.random.default_rng(7)))


def frame_at(one: softkin.Mechanism, axes: Axes) -> Frame:
    return one.forward(axes)[0]


def with_limits(one: softkin.Mechanism, limits: Mapping[str, Ends]) -> softkin.Mechanism:
    """The machine with these limits; a coupling gives them to its parts."""
    if isinstance(one, softkin.Coupled):
        first, second = one.position_part, one.orientation_part
        count = len(first.AXES)
        own = {axis.name: limits[name.name] for axis, name in zip(second.AXES, one.AXES[count:], strict=True)}
        return softkin.Coupled(
            with_limits(first, {axis.name: limits[axis.name] for axis in first.AXES}), with_limits(second, own)
        )
    return one.changed(limits={name: ends for name, ends in limits.items() if allowed(one, name, ends)})


def allowed(one: softkin.Mechanism, name: str, ends: Ends) -> bool:
    """Whether the vendor's range of an axis has room for limits."""
    low, high = (next(p for p in one.PARAMETERS if p.name == f"{word}_{name.lower()}") for word in ("lower", "upper"))
    return ends is None or (
        (ends[0] is None or low.allows(ends[0])) and (ends[1] is None or high.allows(ends[1])) and ends[0] != ends[1]
    )


def drawn_limits(one: Robot, axes: Axes, rng: np.random.Generator) -> dict[str, Ends]:
    """Limits of every kind about axis values, some of which are outside."""
    found: dict[str, Ends] = {}
    for axis, value in zip(one.made.AXES, axes, strict=True):
        size = 1.0 if axis.unit == "deg" else one.reach / 300.0
        low, high = value - rng.uniform(-40.0, 400.0) * size, value + rng.uniform(-40.0, 500.0) * size
        kind = rng.integers(0, 5)
        if kind == 0 or not low < high:
            found[axis.name] = None
        else:
            found[axis.name] = (low, None) if kind == 1 else (None, high) if kind == 2 else (low, high)
    return found
