"""Loops that turn their platform: machines of each, and poses around home."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
import softkin
from numpy.random import Generator
from numpy.typing import NDArray

from derive.description.mechanism import Mechanism, Parameter, Role
from tests.catalogue.closure import Array
from tests.catalogue.machines import Machine, Pooled
from tests.catalogue.turning_closure import TurningClosure
from tests.mechanisms import catalogue

TURNING = tuple(m for _, m in catalogue() if m.is_platform)
REGULAR = 0.08
"""Indicators at a regular pose are at least this part of their largest value, det A of the one at home."""
POOL = 1200
"""Poses that are tried; of a platform that turns about every axis half as many."""
CONTROLLED = 0.25
"""Of det A at home: less may be lost on the way from there."""


@dataclass(frozen=True, eq=False)
class TurningMachine(Pooled):
    """A machine whose platform a loop turns; its poses are around home, regular, in its assembly mode."""

    closure: TurningClosure

    def is_regular(self, axes: Array) -> Array:
        """Whether axis values can be assembled, away from every singularity."""
        with np.errstate(invalid="ignore"):
            return (self._margins(axes) > REGULAR * self._scales).all(axis=1)

    def is_possible(self, axes: Array) -> NDArray[np.bool_]:
        """Whether axis values can be assembled, away from every singularity."""
        return np.asarray(self.is_regular(axes), dtype=bool)

    def is_own(self, joints: Array, position: Array, rotation: Array | None = None) -> NDArray[np.bool_]:
        """Which solutions of the closure are this machine's: those in its assembly mode."""
        assert rotation is not None
        where = (
            np.tile(position, (len(joints), 1)),
            np.tile(self.closure.reachable(rotation[None]), (len(joints), 1, 1)),
        )
        own = self.closure.side(joints, *where) > 0
        return np.asarray(own & (self.closure.positive_at(joints, *where) > 0).all(axis=1), dtype=bool)

    def miss(self, axes: Array, positions: Array, rotations: Array) -> Array:
        """The largest part of the closure's equations in every row, per size of the motion."""
        equations = np.abs(self.closure.equations(self.closure.joints(axes), positions, rotations))
        return np.asarray((equations / self.size(axes)[:, None]).max(axis=1))

    def leads_back(self, axes: Array) -> NDArray[np.bool_]:
        """Where forward leads back from a solution: where the platform at home is well in the mode of the machine."""
        at_home = (
            np.tile(self.closure.home_position, (len(axes), 1)),
            np.tile(self.closure.home_rotation, (len(axes), 1, 1)),
        )
        return np.asarray(
            self.closure.side(self.closure.joints(axes), *at_home) > CONTROLLED * self.closure.at_home, dtype=bool
        )

    def placed(self, axis: int, value: float, count: int) -> tuple[Machine, Array]:
        """A machine whose offset puts the axis at a value with the platform around home, and regular poses there."""
        middle = float(np.median(self.pool[: len(self.pool) // 2, axis]))
        near = self.pool[np.argsort(np.abs(self.pool[:, axis] - middle))[: 10 * count]].copy()
        near[:, axis] = middle
        near = near[self.is_possible(near)][:count]
        assert len(near) == count
        joint = self.mechanism.joints[axis]
        shift = value - middle
        near[:, axis] = value
        offset = float(self.robot.parameters[joint.offset.name]) + shift
        return turning_machine(self.mechanism, self.label, {**self.given, joint.offset.name: offset}), near

    @cached_property
    def pool(self) -> Array:
        """Axis values of regular poses around home: Newton's method from home leads back to the same pose."""
        rng = np.random.default_rng(29)
        count = POOL if len(self.closure.axes_of_turn) == 1 else POOL // 2
        positions, rotations = self.closure.around_home(count, rng)
        joints, closed = self.closure.joints_at(positions, rotations, rng)
        closed &= self.closure.side(joints, positions, rotations) > 0
        axes = self.closure.axes(joints[closed])
        with np.errstate(invalid="ignore"):
            back = np.abs(self.closure.poses(axes)[0] - positions[closed]).max(axis=1) < 1e-9 * self.reach
        axes = axes[back]
        axes = axes[self.leads_back(axes)]
        axes = axes[self.is_possible(axes)]
        assert len(axes) >= 30, (self.mechanism.name, self.given)
        return axes

    @cached_property
    def _scales(self) -> Array:
        rng = np.random.default_rng(31)
        where = self.closure.around_home(200, rng)
        joints, closed = self.closure.joints_at(*where, rng)
        sides = np.abs(self.closure.side(joints, *where))
        return np.column_stack([np.abs(self.closure.indicators_at(joints, *where)), sides])[closed].max(axis=0)

    def _margins(self, axes: Array) -> Array:
        joints, where = self.closure.joints(axes), self.closure.poses(axes)
        return np.column_stack([np.abs(self.closure.indicators_at(joints, *where)), self.closure.side(joints, *where)])


@cache
def turning_machines_of(mechanism: Mechanism) -> tuple[TurningMachine, ...]:
    """As it is drawn, in metres, and with no two dimensions alike; with home in other branches, and elsewhere."""
    rng = np.random.default_rng(23)
    nominal = {p.name: p.nominal for p in mechanism.parameters}
    known = {p.name for p in softkin.catalogue()[mechanism.name].PARAMETERS}
    found = [turning_machine(mechanism, "nominal", nominal)]
    flags = [f"home_{b.name}_{b.names[1]}" for b in mechanism.branches]
    while len(found) < 4:
        given = {p.name: _near(p, rng) for p in mechanism.parameters}
        given |= {j.offset.name: float(rng.uniform(-30.0, 30.0)) for j in mechanism.joints}
        told = {name: float(rng.integers(2)) for name in flags if name in known}
        try:
            found.append(turning_machine(mechanism, f"random {len(found)}", given | (told if len(found) > 1 else {})))
        except softkin.KinematicsError as refused:
            assert refused.status is softkin.Status.NOT_INITIALIZED  # noqa: PT017 - dimensions that form no machine
    return tuple(found)


def turning_machine(mechanism: Mechanism, label: str, given: Mapping[str, float]) -> TurningMachine:
    """One machine; what is not given has its default."""
    robot = softkin.catalogue()[mechanism.name](**given)
    closure = TurningClosure(mechanism, robot.parameters)
    return TurningMachine(label, mechanism, given, robot, closure, closure.reach)


def _near(parameter: Parameter, rng: Generator) -> float:
    if parameter.role is Role.FLAG:
        return float(rng.integers(2))
    if parameter.role is Role.SIGN:
        return parameter.nominal
    if parameter.role is Role.ANGLE:
        return float(np.clip(parameter.nominal + rng.uniform(-8.0, 8.0), parameter.low, parameter.high))
    size = 0.12 * abs(parameter.nominal) if parameter.nominal else 12.0
    return float(parameter.nominal + rng.uniform(-size, size))
