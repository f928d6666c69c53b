"""Machines with limits, and poses inside them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.random import Generator

from derive.description.mechanism import Joint, Mechanism
from tests.catalogue.machines import Array, Machine, machine, machines_of

WIDE = (0.1, 0.9)
"""Limits stand at these quantiles of random axis values, so that some poses are beyond them."""
NARROW = (0.55, 0.75)
"""The same for limits that leave an axis one turn at most, and not the one around 0."""
LESS_THAN_A_TURN = 350.0
EXACTLY_A_TURN = "limited to exactly a turn"
TURN = {"lower": -180.0, "upper": 180.0}


def limited_machines(mechanism: Mechanism) -> tuple[Machine, ...]:
    """The last random machine with limits on everything that can have them, and one whose axes have just one turn."""
    plain = machines_of(mechanism)[0].given
    turns = {f"{end}_{j.key}": value for j in mechanism.joints if j.is_angle for end, value in TURN.items()}
    free = machines_of(mechanism)[-1]
    return (
        machine(mechanism, EXACTLY_A_TURN, plain | turns),
        limited(free, "limited"),
        limited(free, "limited to a turn", NARROW),
        limited(free, "limits not checked", checked=False),
    )


def has_limits(machine: Machine) -> bool:
    """Whether limits are given and checked."""
    return machine.robot.checks_limits and any(
        machine.robot.parameters[f"upper_{j.key}"] for j in machine.mechanism.joints
    )


def is_inside(machine: Machine, axes: Array) -> Array:
    """Whether axis values, and what has limits of its own, are inside the given limits."""
    inside = np.ones(len(axes), dtype=bool)
    columns = {joint.key: column for joint, column in zip(machine.mechanism.joints, axes.T, strict=True)}
    quantities = machine.closure.limited(machine.closure.joints(axes))
    columns |= {q.name: column for q, column in zip(machine.mechanism.limited, quantities.T, strict=True)}
    for name, column in columns.items():
        lower, upper = (machine.robot.parameters[f"{end}_{name}"] for end in ("lower", "upper"))
        if (lower, upper) != (0.0, 0.0):
            inside &= (lower <= column) & (column <= upper)
    return inside


def draw_inside(machine: Machine, count: int, rng: Generator) -> Array:
    axes = machine.draw(max(2000, 100 * count), rng)
    for column, joint in zip(axes.T, machine.mechanism.joints, strict=True):
        lower, upper = (machine.robot.parameters[f"{end}_{joint.key}"] for end in ("lower", "upper"))
        if (lower, upper) != (0.0, 0.0):
            column[:] = rng.uniform(lower, upper, len(column))
    return axes[machine.is_regular(axes) & is_inside(machine, axes)][:count]


def limited(free: Machine, label: str, share: tuple[float, float] = WIDE, checked: bool = True) -> Machine:
    """A machine with limits on everything that can have them, between two quantiles of its axis values."""
    mechanism = free.mechanism
    axes = free.draw(200, np.random.default_rng(3))
    limits: dict[str, float] = {}
    for joint, column in zip(mechanism.joints, axes.T, strict=True):
        ends = np.quantile(column, share)
        if share == NARROW and joint.is_angle:
            ends[1] = min(ends[1], ends[0] + LESS_THAN_A_TURN)
        limits |= _between(joint.key, ends, joint)
    quantities = free.closure.limited(free.closure.joints(axes))
    for quantity, column in zip(mechanism.limited, quantities.T, strict=True):
        limits |= _between(quantity.name, np.quantile(column, WIDE), None)
    given = {**free.given, **limits, "check_limits": checked}
    return replace(free, label=label, given=given, robot=type(free.robot)(**given))


def _between(key: str, ends: Array, joint: Joint | None) -> dict[str, float]:
    low, high = (joint.limit_range if joint is not None else None) or (-1e9, 1e9)
    return {f"lower_{key}": float(np.clip(ends[0], low, high)), f"upper_{key}": float(np.clip(ends[1], low, high))}
