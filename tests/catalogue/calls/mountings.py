"""Machines of the whole catalogue on a base, with a tool that they can carry; and that a machine is its copies."""

import copy
import json
import pickle
from functools import cache

import softkin
from softkin import Frame, KinematicsError, Mechanism, Status

from tests.catalogue.calls.robots import NAMES, Axes, drawn_limits, poses, robots, with_limits
from tests.catalogue.mounted.machines import BASE, TOOL, couplings

__all__ = ["BASE", "EVERY", "confirm_copies", "limited", "machines", "radian", "tool_of"]

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
