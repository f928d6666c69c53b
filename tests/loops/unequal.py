"""Loops as they are drawn and with no two dimensions alike, in both assembly modes, with axis values all over their workspace."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import softkin

from derive.mechanism import Mechanism, Role
from tests.loops.equations import Array, Equations

DRAWN = 4000
REGULAR = 0.08
"""Indicators at a regular pose are at least this part of their largest value."""


@dataclass(frozen=True)
class Loop:
    """A machine, its equations, and poses chosen by the equations alone."""

    mechanism: Mechanism
    given: dict[str, float]
    robot: softkin.Mechanism
    equations: Equations
    drawn: Array
    """Random axis values, whether they can be assembled or not."""
    axes: Array
    """Those that can, away from every singularity: bounds of the inverse are not looked at."""
    positions: Array


@cache
def loops_of(mechanism: Mechanism) -> tuple[Loop, ...]:
    """Nominal and unequal, each in both assembly modes."""
    assert mechanism.assembly is not None
    generator = np.random.default_rng(23)
    found: list[Loop] = []
    for other in (False, True):
        mode = {mechanism.assembly.parameter: other}
        found.append(_loop(mechanism, {p.name: p.nominal for p in mechanism.parameters} | mode, generator))
        while len(found) % 2:
            try:
                found.append(_loop(mechanism, _unequal(mechanism, generator) | mode, generator))
            except softkin.KinematicsError as refused:
                assert refused.status is softkin.Status.NOT_INITIALIZED  # noqa: PT017 - dimensions that form no machine
    return tuple(found)


def _unequal(mechanism: Mechanism, generator: np.random.Generator) -> dict[str, float]:
    given: dict[str, float] = {}
    sizes = [p.nominal for p in mechanism.parameters if p.role is Role.LENGTH]
    for p in mechanism.parameters:
        if p.role is Role.FLAG:
            given[p.name] = float(generator.integers(2))
        elif p.role is Role.ANGLE:
            given[p.name] = float(np.clip(p.nominal + generator.uniform(-20.0, 20.0), p.low, p.high))
        else:
            shift = 0.1 * min(sizes) * generator.uniform(-1.0, 1.0) if p.role is Role.DISTANCE and p.low < 0 else 0.0
            given[p.name] = float(p.nominal * generator.uniform(0.8, 1.2) + shift)
    return given | {j.offset.name: float(generator.uniform(-30.0, 30.0)) for j in mechanism.joints}


def _loop(mechanism: Mechanism, given: dict[str, float], generator: np.random.Generator) -> Loop:
    robot = softkin.catalogue()[mechanism.name](**given)
    equations = Equations(mechanism, given)
    size = np.array([175.0 if j.is_angle else equations.reach for j in mechanism.joints])
    drawn = generator.uniform(-1.0, 1.0, (DRAWN, len(size))) * size + equations.offsets
    positions, _, _, statuses = robot.forward_batch(drawn)
    good = statuses == softkin.Status.OK
    joints = equations.joints(drawn[good])
    indicators = np.column_stack([equations.branches(joints, positions[good]), equations.side(joints, positions[good])])
    regular = (np.abs(indicators) > REGULAR * np.abs(indicators).max(axis=0)).all(axis=1)
    assert regular.sum() >= 30, (mechanism.name, given)
    return Loop(mechanism, given, robot, equations, drawn, drawn[good][regular], positions[good][regular])
