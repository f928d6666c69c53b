"""Limits that a drive hands over: as arguments, and together with those of a machine."""

from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np
import softkin
from softkin import KinematicsError, Status

from derive.description.mechanism import Joint, Mechanism, Role
from tests.harness.library import Library
from tests.mechanisms import catalogue
from tests.random_axes import random_axes
from tests.text import values

Range = tuple[float, float] | None
"""A lower and an upper limit; None where there is none."""

TURNING = tuple(m for _, m in catalogue() if m.period_joints)
"""The mechanisms whose blocks take settings."""
SETTINGS_TYPE = "TRAFO.Axis_Settings"
REGULAR = 0.05
DRAWN = 4000


def settings(library: Library, limits: Range) -> Any:
    """An argument of AxisSettings. The ends of no limits are no numbers: nobody may look at them."""
    made = values.new(library, SETTINGS_TYPE)
    made.limits.xUnlimited = limits is None
    made.limits.dLower, made.limits.dUpper = (float("nan"),) * 2 if limits is None else limits
    return made


def own_limits(mechanism: Mechanism, parameters: Mapping[str, float], joint: Joint) -> Range:
    """The limits of an axis of a machine: given, of its closure, or of the pitch that it carries."""
    lower, upper = parameters[f"lower_{joint.key}"], parameters[f"upper_{joint.key}"]
    if (lower, upper) != (0.0, 0.0):
        return lower, upper
    if joint.domain is not None:
        low, high = (end + parameters[joint.offset.name] for end in joint.domain)
        return low, high
    numbers = {p.symbol: parameters[p.name] for p in mechanism.parameters}
    return joint.limit_range if joint.limit_range is not None and joint.pitch.xreplace(numbers) != 0 else None


def together(mechanism: Mechanism, parameters: Mapping[str, float], drives: Sequence[Range]) -> dict[str, float] | None:
    """The parameters with the limits that machine and drives have in common; None where they have nothing in common."""
    found = dict(parameters)
    for joint, drive in zip(mechanism.joints, drives, strict=True):
        own = own_limits(mechanism, parameters, joint)
        if drive is not None:
            low, high = (drive[0], drive[1]) if own is None else (max(own[0], drive[0]), min(own[1], drive[1]))
            if low > high:
                return None
            found |= {f"lower_{joint.key}": low, f"upper_{joint.key}": high}
    return found


def robot_of(mechanism: Mechanism, **given: float) -> softkin.Mechanism:
    """The nominal machine, with some parameters otherwise."""
    lengths = {p.name: p.nominal for p in mechanism.parameters if p.role is not Role.FLAG}
    return softkin.catalogue()[mechanism.name](**{**lengths, **given})


@cache
def poses(mechanism: Mechanism, count: int = 3) -> tuple[tuple[float, ...], ...]:
    """Joint values of regular poses of the nominal machine, to which its inverse returns."""
    robot = robot_of(mechanism)
    rng = np.random.default_rng(17)
    about = [0.0 if joint.axis_is_angle else joint.nominal + 55.0 for joint in mechanism.joints]
    drawn = random_axes(robot, DRAWN, rng, 150.0, 35.0, about)
    chosen: list[tuple[float, ...]] = []
    for row in drawn[robot.forward_batch(drawn)[3] == Status.OK].tolist():
        if len(chosen) < count and _is_regular(robot, tuple(row)):
            chosen.append(tuple(row))
    assert len(chosen) == count, mechanism.name
    return tuple(chosen)


def _is_regular(robot: softkin.Mechanism, axes: tuple[float, ...]) -> bool:
    if any(abs(m) < REGULAR for m in robot.singularity(axes).margins.values()):
        return False
    frame, configuration = robot.forward(axes)
    try:
        back = robot.inverse(frame, configuration, axes)
    except KinematicsError:
        return False
    return bool(np.abs(np.subtract(back, axes)).max() < 1e-6)
