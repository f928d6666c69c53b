"""Deterministic samples of machines and axis values, for the build's own numerical decisions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from derive.description.mechanism import Mechanism, Role
from derive.ir.interpret import evaluate
from derive.ir.symbols import (
    SCALE,
)
from derive.kinematics.parameters import (
    has_length,
    machine_parameters,
    machine_scale,
)

Samples = dict[str, NDArray[np.float64]]


def sample_machine(mechanism: Mechanism, seed: int, optional_zero: bool = False) -> Samples:
    """Parameters near their nominal values, and the characteristic length, as scalars."""
    generator = np.random.default_rng(seed)
    values: Samples = {}
    parameters = machine_parameters(mechanism)
    for parameter in parameters:
        spread = generator.uniform(0.8, 1.2)
        value = parameter.nominal if parameter.role in (Role.FLAG, Role.SIGN) else parameter.nominal * spread
        if optional_zero and parameter.role is Role.DISTANCE:
            value = 0.0
        values[parameter.name] = np.asarray(value)
    values[SCALE.name] = np.asarray(evaluate(machine_scale(mechanism), values), dtype=float)
    return values


def _reach(mechanism: Mechanism, machine: Samples) -> float:
    """A length of the size of the machine: of one without a length that is never zero, the sum of its distances."""
    distances = [abs(float(machine[p.name])) for p in mechanism.parameters if p.role is Role.DISTANCE]
    return float(machine[SCALE.name]) if has_length(mechanism) else sum(distances) or 1.0


def sample_axes(mechanism: Mechanism, machine: Samples, count: int, seed: int) -> Samples:
    """Axis values over the whole ranges of the joints, as arrays; the references are equal to the axes."""
    generator = np.random.default_rng(seed)
    values: Samples = {}
    for joint in mechanism.joints:
        low, high = joint.domain or ((-180.0, 180.0) if joint.is_angle else (-1.0, 1.0))
        reach = 1.0 if joint.is_angle else _reach(mechanism, machine)
        high = min(high, 1e3 if joint.is_angle else 2.0)
        drawn = generator.uniform(low, high, count) * reach + float(machine[joint.offset.name])
        values[joint.axis.name] = values[joint.reference.name] = drawn
    return values
