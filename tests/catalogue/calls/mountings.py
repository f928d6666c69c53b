"""Robots of several kinds, with tools and on bases."""

import copy
import json
import pickle
from collections.abc import Mapping
from functools import cache

import numpy as np
import softkin
from softkin import Frame, KinematicsError, Mechanism, Status

from tests.catalogue.mounted.machines import BASE, TOOL, couplings
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


__all__ = ["BASE", "EVERY", "confirm_copies", "limited", "machines", "mounted", "radian", "tool_of"]

COUPLINGS = couplings()
EVERY = (*NAMES, *COUPLINGS)
_STRAIGHT = Frame.from_euler(50.0, 0.0, 0.0, (0.0, 0.0, 44.0))
_COUPLED_AT = (20.0, 30.0, 40.0, 25.0, 35.0, -50.0)


@cache
def machines(name: str) -> tuple[tuple[softkin.Mechanism, Axes, float], ...]:
    """The machines of a name without base and tool, axis values of each, and its size."""
    if name in COUPLINGS:
        one = COUPLINGS[name]
        return ((one, _COUPLED_AT[: len(one.AXES)], 1000.0),)
    return tuple((one.made, poses(name, number, 1)[0], one.reach) for number, one in enumerate(robots(name)))


def limited(name: str, rng: object) -> list[tuple[softkin.Mechanism, Axes, float]]:
    """The same machines with drawn limits, some of which exclude the axis values."""
    if name in COUPLINGS:
        return list(machines(name))
    return [
        (with_limits(one.made, drawn_limits(one, axes, rng)), axes, size)  # type: ignore[arg-type]
        for one, (_, axes, size) in zip(robots(name), machines(name), strict=True)
    ]


@cache
def tool_of(robot: softkin.Mechanism) -> Frame:
    """An inclined tool to the side, or what the machine can carry: straight, along the axis of its turn, in place."""
    axis = robot.orientation_image().flange_axis
    along = (44.0 * axis[0], 44.0 * axis[1], 44.0 * axis[2])
    for tool in (TOOL, _STRAIGHT, Frame(along, TOOL.rotation)):
        try:
            robot.with_tool(tool)
        except KinematicsError as error:
            assert error.status is Status.INVALID_COUPLING
        else:
            return tool
    return Frame((0.0, 0.0, 0.0), TOOL.rotation)


def mounted(robot: softkin.Mechanism) -> softkin.Mounted:
    """The machine on the base, with its tool."""
    return robot.with_base(BASE).with_tool(tool_of(robot))


def radian(robot: softkin.Mechanism, axes: Axes) -> Axes:
    """Axis values of a machine in degrees, in radians."""
    turn = 3.141592653589793 / 180.0
    return tuple(a * turn if axis.unit == "deg" else a for a, axis in zip(axes, robot.AXES, strict=True))


def confirm_copies(one: Mechanism, axes: Axes, *more: Mechanism) -> None:
    """Copies of every kind, written down and read again too, are equal and answer alike; and so are those given."""
    written = json.loads(json.dumps(one.to_dict(), allow_nan=False))
    read = [Mechanism.from_dict(written), Mechanism.from_json(one.to_json()), eval(repr(one), vars(softkin))]
    for other in (copy.copy(one), copy.deepcopy(one), pickle.loads(pickle.dumps(one)), *read, one.changed(), *more):
        assert other == one and hash(other) == hash(one) and {one: 1}[other] == 1
        assert type(other) is type(one) and repr(other) == repr(one) and other.limits == one.limits
        assert other.forward(axes) == one.forward(axes)
