"""The loops, machines of each, and axis values at which they can be assembled."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import softkin
import sympy as sp
from numpy.typing import NDArray

from derive.catalogue import catalogue
from derive.mechanism import Mechanism, Role, Turning
from derive.parameters import machine_parameters
from derive.program import DEGREE

Array = NDArray[np.float64]
LOOPS = tuple(m for _, m in catalogue() if m.rods and m.task.turning is not Turning.FULL)


@dataclass(frozen=True)
class Machine:
    """A loop with its dimensions, in Python."""

    mechanism: Mechanism
    given: dict[str, float]
    robot: softkin.Mechanism
    axes: Array
    """Axis values with a pose away from every singularity."""

    def residual(self, axes: Array, positions: Array) -> Array:
        """Φ, as the description states it: rows of samples, columns of equations, in lengths squared or lengths."""
        joints = [j.symbol for j in self.mechanism.joints]
        coordinates = [sp.Symbol(c, real=True) for c in "xyz"]
        known = {p.symbol: float(self.given.get(p.name, p.default or 0.0)) for p in self.mechanism.parameters}
        known[DEGREE] = float(np.pi / 180)
        equations = [sp.sympify(e).subs(known) for e in self.mechanism.equations]
        function = sp.lambdify([*joints, *coordinates], equations, "numpy")
        units = [np.pi / 180 if j.is_angle else 1.0 for j in self.mechanism.joints]
        offsets = [self.given.get(j.offset.name, 0.0) for j in self.mechanism.joints]
        values = [(axes[:, i] - o) * u for i, (u, o) in enumerate(zip(units, offsets, strict=True))]
        return np.stack([np.broadcast_to(v, len(axes)) for v in function(*values, *positions.T)], axis=1)


@cache
def machines_of(mechanism: Mechanism) -> tuple[Machine, ...]:
    """The nominal machine, and two with unequal dimensions, offsets and the other assembly mode."""
    generator = np.random.default_rng(7)
    found = [_machine(mechanism, {p.name: p.nominal for p in mechanism.parameters}, generator)]
    while len(found) < 3:
        given = {p.name: p.nominal * generator.uniform(0.85, 1.15) for p in mechanism.parameters if p.role is not Role.FLAG}
        given |= {p.name: min(v, p.high) for p in mechanism.parameters for v in [given.get(p.name)] if v is not None}
        given |= {j.offset.name: float(generator.uniform(-20.0, 20.0)) for j in mechanism.joints}
        flags = [p.name for p in machine_parameters(mechanism) if p.role is Role.FLAG and p.name != "check_limits"]
        given |= {name: len(found) == 2 for name in flags}
        try:
            found.append(_machine(mechanism, given, generator))
        except softkin.KinematicsError:
            continue  # dimensions that form no machine
    return tuple(found)


def _machine(mechanism: Mechanism, given: dict[str, float], generator: np.random.Generator) -> Machine:
    robot = softkin.catalogue()[mechanism.name](**given)
    reach = sum(v for p in mechanism.parameters if p.role is Role.LENGTH for v in [given.get(p.name, p.nominal)])
    size = [170.0 if j.is_angle else reach for j in mechanism.joints]
    offsets = [given.get(j.offset.name, 0.0) for j in mechanism.joints]
    drawn = generator.uniform(-1.0, 1.0, (6000, len(size))) * size + offsets
    statuses = robot.forward_batch(drawn)[3]
    possible = drawn[statuses == softkin.Status.OK][:1200]
    regular = [a for a in possible if all(abs(m) > 0.05 for m in robot.singularity(tuple(a)).margins.values())]
    reachable = [a for a in regular if _swings(robot, a)]
    assert len(reachable) >= 20, (mechanism.name, len(reachable), given)
    return Machine(mechanism, given, robot, np.array(reachable[:120]))


def _swings(robot: softkin.Mechanism, axes: Array) -> bool:
    """Whether the inverse accepts the pose: bounds such as the swing of a ball joint are the inverse's."""
    frame, configuration = robot.forward(tuple(axes))
    try:
        robot.inverse(frame, configuration, tuple(axes))
    except softkin.KinematicsError:
        return not robot.__class__.__name__.startswith("Tripod")
    return True
