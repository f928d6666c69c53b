"""Chains whose joints loops move: their closure with every loop closed by root finding, and poses that they have."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
import softkin
import sympy as sp
from numpy.random import Generator
from numpy.typing import NDArray

from derive.description.mechanism import Drive, Joint, Mechanism, Role
from derive.geometry.pose import pose_of
from derive.ir.constants import DEGREE
from tests.catalogue.closure import ONE_DEGREE, Array, Closure, Formula
from tests.catalogue.machines import TURNS, Machine
from tests.mechanisms import catalogue

DRIVEN = tuple(m for _, m in catalogue() if m.drives)
STEADY = 0.15
"""The derivatives of loops at a regular pose are at least this part of their largest values."""
GRID = 61
"""Values at which a root of a loop is looked for."""


class Loop:
    """One loop as the description states it: its equation, and the sides of its nominal values."""

    def __init__(self, mechanism: Mechanism, drive: Drive) -> None:
        self.symbols = drive.joint.symbol, drive.by.symbol
        self.turns = drive.joint.is_angle, drive.by.is_angle
        between = pose_of(drive.tip).position - pose_of(drive.start).position
        equation = between.dot(between) - drive.length**2
        values = [equation, *(sp.diff(equation, s) for s in self.symbols), drive.side, drive.by_side]
        parameters = [p.symbol for p in mechanism.parameters]
        self._formula: Formula = sp.lambdify([*self.symbols, *parameters, DEGREE], values, modules="numpy")
        nominal = [np.radians(j.nominal) if j.is_angle else j.nominal for j in (drive.joint, drive.by)]
        found = self._formula(*nominal, *(p.nominal for p in mechanism.parameters), ONE_DEGREE)
        self._nominal = np.sign(found[1:3])

    def at(self, moved: Array, by: Array, constants: list[float]) -> tuple[Array, Array, Array]:
        """The equation, and its derivatives by what moves and by what is moved, positive on the machine's side."""
        error, *slopes, side, by_side = self._formula(moved, by, *constants, ONE_DEGREE)
        return error, slopes[0] * self._nominal[0] * side, slopes[1] * self._nominal[1] * by_side

    def solved(self, sought: int, given: Array, constants: list[float], reach: float) -> Array:
        """The root on its side for every row, by sign changes and Newton's method; not a number where there is none."""
        ends = (-np.pi, np.pi) if self.turns[sought] else (-3.0 * reach, 3.0 * reach)
        grid = np.linspace(*ends, GRID)

        def of(values: Array, others: Array) -> tuple[Array, Array]:
            pair = (values, others) if sought == 0 else (others, values)
            found = self.at(*pair, constants)
            return found[0], found[1 + sought]

        error, slope = (np.broadcast_to(v, (len(given), GRID)) for v in of(grid[None, :], given.real[:, None]))
        own = self._sense(sought, constants)
        # between two roots that are nearer than the grid the error has an extremum, at which it is asked, too
        steep = np.where(slope[:, 1:] == slope[:, :-1], 1.0, slope[:, 1:] - slope[:, :-1])
        inside = np.clip(-slope[:, :-1] / steep, 0.0, 1.0) * (grid[1] - grid[0]) + grid[:-1]
        both = [(np.broadcast_to(grid, error.shape), error), (inside, of(inside, given.real[:, None])[0])]
        places, error = (np.empty((len(given), 2 * GRID - 1)) for _ in both)
        for k, (place, value) in enumerate(both):
            places[:, k::2], error[:, k::2] = place, value
        sense = np.sign(error[:, 1:] - error[:, :-1])
        crossing = (error[:, :-1] * error[:, 1:] <= 0) & (sense * own > 0)
        first = np.argmax(crossing, axis=1)[:, None]
        start = np.take_along_axis((places[:, 1:] + places[:, :-1]) / 2, first, axis=1)[:, 0]
        value = np.where(crossing.any(axis=1), start, np.nan).astype(given.dtype)
        for _ in range(12):
            error, slope = of(value, given)
            value = value - error / (own * slope)
        return value

    def _sense(self, sought: int, constants: list[float]) -> float:
        """The sign of the derivative on the machine's side."""
        found = self._formula(0.5, 0.5, *constants, ONE_DEGREE)
        return float(self._nominal[sought] * found[3 + sought])


class DrivenClosure(Closure):
    """The closure of a chain with loops: joints follow from their loops, which are closed numerically."""

    def __init__(self, mechanism: Mechanism, parameters: Mapping[str, float], reach: float) -> None:
        super().__init__(mechanism, parameters)
        self.reach = reach
        self.loops = {k: loops for k, j in enumerate(mechanism.joints) if (loops := _loops_of(mechanism, j))}

    def joints(self, axes: Array) -> Array:
        """Joint values; not numbers where a loop does not close, or where its actuator is beyond its dead point."""
        joints = (axes - self.offsets) * self.units
        for k, loops in self.loops.items():
            for loop in loops:
                moved = loop.solved(0, joints[:, k], self.constants, self.reach)
                beyond = loop.at(moved, joints[:, k], self.constants)[2].real <= 0
                joints[:, k] = np.where(beyond, np.nan, moved)
        return joints

    def axes(self, joints: Array) -> Array:
        """Axis values of joint values; not numbers where a loop does not close there."""
        motors = np.array(joints)
        for k, loops in self.loops.items():
            for loop in reversed(loops):
                by = loop.solved(1, motors[:, k], self.constants, self.reach)
                beyond = loop.at(motors[:, k], by, self.constants)[1] <= 0
                motors[:, k] = np.where(beyond, np.nan, by)
        return motors / self.units + self.offsets

    def closed(self, axes: Array, rng: Generator) -> Array:
        """Axis values with others where loops move joints: those of random joint values, at which the loops close."""
        found, sizes = np.array(axes), np.where(self.turning, np.pi, self.reach)
        missing = np.tile([k in self.loops for k in range(axes.shape[1])], (len(axes), 1))
        while missing.any():
            rows = missing.any(axis=1)
            tried = self.axes((rng.uniform(-1.0, 1.0, axes.shape) * sizes)[rows])
            found[rows] = np.where(missing[rows], tried, found[rows])
            missing[rows] &= ~np.isfinite(self.joints(found[rows]))
        return found

    def slopes(self, axes: Array) -> Array:
        """The derivatives of all loops by both values, a column each."""
        columns = []
        motors = (axes - self.offsets) * self.units
        for k, loops in self.loops.items():
            by = motors[:, k]
            for loop in loops:
                moved = loop.solved(0, by, self.constants, self.reach)
                columns += [s + np.zeros(len(axes)) for s in loop.at(moved, by, self.constants)[1:]]
                by = moved
        return np.stack(columns, axis=1)


def _loops_of(mechanism: Mechanism, joint: Joint) -> list[Loop]:
    """The loops from an actuator to its joint, as they are stated."""
    found: list[Drive] = []
    name = joint.name
    while (drive := next((d for d in mechanism.drives if d.by.name == name), None)) is not None:
        found.append(drive)
        name = drive.joint.name
    return [Loop(mechanism, drive) for drive in found]


@dataclass(frozen=True, eq=False)
class DrivenMachine(Machine):
    """A machine whose joints loops move: its axes have values at which these close."""

    closure: DrivenClosure

    def is_regular(self, axes: Array) -> Array:
        """Whether loops close, away from every singularity."""
        with np.errstate(invalid="ignore"):
            steady = np.all(self.closure.slopes(axes) > STEADY * self._steepest, axis=1)
            return steady & super().is_regular(axes)

    def is_possible(self, axes: Array) -> NDArray[np.bool_]:
        return self.is_regular(axes)

    @property
    def branches_meet_together(self) -> bool:
        """No: the other elbow may be where a loop does not close."""
        return False

    def is_own(self, joints: Array, position: Array, rotation: Array | None = None) -> NDArray[np.bool_]:
        """Which solutions are this machine's: those at which every loop closes on its side."""
        return np.isfinite(self.closure.axes(joints)).all(axis=1)

    @cached_property
    def _steepest(self) -> Array:
        return np.nanmax(self.closure.slopes(self.sample(500)), axis=0)

    def _any(self, count: int, rng: Generator, farthest: float = TURNS) -> Array:
        return self.closure.closed(super()._any(count, rng, farthest), rng)


@cache
def driven_machines_of(mechanism: Mechanism) -> tuple[DrivenMachine, ...]:
    """As it is drawn, and two with other dimensions and offsets."""
    rng = np.random.default_rng(31)
    nominal = {p.name: p.nominal for p in mechanism.parameters}
    others = [
        {name: float(value * rng.uniform(0.9, 1.1)) for name, value in nominal.items()}
        | {j.offset.name: float(rng.uniform(-30.0, 30.0)) for j in mechanism.joints}
        for _ in range(2)
    ]
    return tuple(
        driven_machine(mechanism, label, given)
        for label, given in zip(("nominal", "random 1", "random 2"), (nominal, *others), strict=True)
    )


def driven_machine(mechanism: Mechanism, label: str, given: Mapping[str, float]) -> DrivenMachine:
    """One machine; what is not given has its default."""
    robot = softkin.catalogue()[mechanism.name](**given)
    reach = reach_of(mechanism, robot)
    return DrivenMachine(label, mechanism, given, robot, DrivenClosure(mechanism, robot.parameters, reach), reach)


def reach_of(mechanism: Mechanism, robot: softkin.Mechanism) -> float:
    """The sum of the lengths of a machine."""
    return sum(abs(robot.parameters[p.name]) for p in mechanism.parameters if p.role in (Role.LENGTH, Role.DISTANCE))
