"""Closed loops: their closure with positions as unknowns, machines of each, and poses of those."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
import softkin
import sympy as sp
from numpy.random import Generator
from numpy.typing import NDArray

from derive.description.mechanism import Mechanism, Role
from derive.ir.symbols import POSITION
from tests.catalogue.closure import Array, Closure, Formula, derivative
from tests.catalogue.machines import Pooled
from tests.mechanisms import catalogue
from tests.random_axes import random_axes

LOOPS = tuple(m for _, m in catalogue() if m.rods and not m.is_platform)
"""Loops whose plate keeps its orientation; those whose plate turns are in `turning_machines.py`."""
CANDIDATES = 6000
REGULAR = 0.08
"""Indicators at a regular pose are at least this part of their largest value."""
FAR = 4.0
"""Where Newton's method starts, in reaches: beyond everything, once on either side."""
DIRECTIONS = np.array([[0.36, 0.48, 0.8], [-0.48, 0.8, 0.36], [0.8, 0.36, -0.48], [0.6, -0.8, 0.0]])
PASSES = 20
TURNED = np.array([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]])
"""The rotation that is commanded of a loop with a tool that turns."""


class LoopClosure(Closure):
    """The closure of a closed loop. The assembly's indicator alone decides which solution is this machine's."""

    def __init__(self, mechanism: Mechanism, parameters: Mapping[str, float], reach: float) -> None:
        super().__init__(mechanism, parameters)
        assert mechanism.assembly is not None
        self.reach = reach
        self._mode = mechanism.assembly.signs[bool(parameters[mechanism.assembly.parameter])]
        self._side = mechanism.assembly.indicator * sp.sign(mechanism.assembly.handedness)
        self._room = tuple(b.largest - sp.Abs(b.value) for b in mechanism.bounds)
        self._indicators = tuple(b.signs[0] * b.indicator for b in mechanism.branches)
        self._commanded = tuple(POSITION[i] for i in self.task)
        self._equations = (*(r.equation / r.length for r in mechanism.rods), *mechanism.closure)

    def poses(self, axes: Array) -> tuple[Array, Array]:
        """Position and rotation at axis values; not a number where nothing closes on this machine's side."""
        joints = self.joints(axes)
        found = np.full((len(axes), 3), np.nan)
        wanted = (self.positive(joints) > 0).all(axis=1)
        for direction in (*DIRECTIONS, *-DIRECTIONS):
            rows = np.flatnonzero(np.isnan(found[:, 0]) & wanted)
            if not rows.size:
                break
            positions, closed = self.assembly_from(joints[rows], direction)
            mine = closed & (self.side(joints[rows], positions) > 0)
            found[rows[mine]] = positions[mine]
        return found, self.turns(joints)

    def assembly_from(self, joints: Array, direction: Array) -> tuple[Array, Array]:
        """The end of Newton's method from a far start in a direction, and whether the loop closes there."""
        positions = np.zeros((len(joints), 3))
        positions[:, self.task] = FAR * self.reach * direction[self.task]
        moving = np.arange(len(joints))
        for _ in range(PASSES):
            if not moving.size:
                break
            here, there = joints[moving], positions[moving]
            stated, slopes = self._with_slopes(here, there)
            step = np.linalg.solve(slopes + 1e-15 * np.eye(len(self.task)), stated[:, :, None])[:, :, 0]
            there[:, self.task] -= np.clip(step, -FAR * self.reach, FAR * self.reach)
            positions[moving] = there
            moving = moving[np.abs(step).max(axis=1) > 1e-13 * self.reach]
        return positions, np.abs(self._stated(joints, positions)).max(axis=1, initial=0.0) < 1e-10 * self.reach

    def _with_slopes(self, joints: Array, positions: Array) -> tuple[Array, Array]:
        """The equations, and the same as `by_position`, from their derivatives: Newton's method asks often."""
        count = len(self._equations)
        found = self._evaluate(self._formula_with_slopes, np.hstack([joints, positions]))
        return found[:, :count], found[:, count:].reshape(len(joints), -1, len(self.task))

    @cached_property
    def _formula_with_slopes(self) -> Formula:
        slopes = slopes_of(self._equations, self._commanded)
        return self._formulas.at_pose((*self._equations, *slopes))

    def by_position(self, joints: Array, positions: Array) -> Array:
        """A = ∂Φ/∂x: equations by commanded coordinates."""
        return derivative(lambda p, q: self._stated(q, p), positions, joints)[:, :, self.task]

    def by_joints(self, joints: Array, positions: Array) -> Array:
        """B = ∂Φ/∂q: equations by joint values; last the heading, where joints tell it."""
        return derivative(lambda q, p: np.hstack([self._stated(q, p), *self._heading(q)]), joints, positions)

    def _heading(self, joints: Array) -> list[Array]:
        return [] if self.mechanism.heading is None else [self.at_joints([self.mechanism.heading], joints)]

    def side(self, joints: Array, positions: Array) -> Array:
        """Positive in the assembly mode of this machine."""
        return self._mode * self.at(joints, positions, [self._side])[:, 0]

    def room(self, joints: Array, positions: Array) -> Array:
        """The distance from the nearest bound (the swing of a ball joint); 1 where there is none."""
        return self.at(joints, positions, self._room).min(axis=1, initial=1.0)

    def indicators(self, joints: Array) -> Array:
        """The indicator of every branch at a pose, positive where its byte is 1."""
        return self.indicators_at(joints, self.poses(self.axes(joints))[0])

    def indicators_at(self, joints: Array, positions: Array) -> Array:
        """The same at any joint values and position."""
        return self.at(joints, positions, self._indicators)

    def at(self, joints: Array, positions: Array, expressions: Sequence[sp.Expr]) -> Array:
        """Expressions of the description in joints and position: a column each."""
        return self._evaluate(self._formulas.at_pose(tuple(expressions)), np.hstack([joints, positions]))

    def _stated(self, joints: Array, positions: Array) -> Array:
        return self.at(joints, positions, self._equations)


@cache
def slopes_of(equations: tuple[sp.Expr, ...], commanded: tuple[sp.Symbol, ...]) -> tuple[sp.Expr, ...]:
    """The derivatives of equations by the commanded coordinates, equation by equation."""
    return tuple(sp.diff(e, p) for e in equations for p in commanded)


def facing(robot: softkin.Mechanism) -> Array | None:
    """A rotation to command, of a loop with a tool that turns; None where none is read."""
    return None if robot.FREEDOM == "zero" else TURNED


def facings(robot: softkin.Mechanism, count: int) -> Array | None:
    """The same, a row each."""
    return None if robot.FREEDOM == "zero" else np.tile(TURNED, (count, 1, 1))


@dataclass(frozen=True, eq=False)
class LoopMachine(Pooled):
    """A machine that is a closed loop; its poses are regular, on its side and inside its bounds."""

    closure: LoopClosure

    def is_regular(self, axes: Array) -> Array:
        """Whether axis values can be assembled, away from every singularity."""
        with np.errstate(invalid="ignore"):
            return (self._indicators(axes) > REGULAR * self._scales).all(axis=1)

    def candidates(self, count: int, rng: Generator) -> Array:
        """Random axis values of one turn, whether they can be assembled or not."""
        return random_axes(self.robot, count, rng, 175.0, self.reach, self.closure.offsets)

    def is_possible(self, axes: Array) -> NDArray[np.bool_]:
        """Whether axis values can be assembled, away from every singularity and inside every bound."""
        possible = self.is_regular(axes)
        joints = self.closure.joints(axes[possible])
        possible[possible] = self.closure.room(joints, self.closure.poses(axes[possible])[0]) > 1e-3
        return possible

    def is_own(self, joints: Array, position: Array, rotation: Array | None = None) -> NDArray[np.bool_]:
        """Which solutions of the closure are this machine's: those on its side, inside its bounds."""
        there = np.tile(position, (len(joints), 1))
        return (self.closure.side(joints, there) > 0) & (self.closure.room(joints, there) >= 0)

    @cached_property
    def pool(self) -> Array:
        """Axis values of regular poses inside every bound."""
        joints, positions = self._closed
        with np.errstate(invalid="ignore"):
            regular = (self._indicators_at(joints, positions) > REGULAR * self._scales).all(axis=1)
            axes = self._assembled[regular & (self.closure.room(joints, positions) > 1e-3)]
        assert len(axes) >= 30, (self.mechanism.name, self.given)
        return axes

    @cached_property
    def _assembled(self) -> Array:
        """The axis values that the package can close: only a short cut, because the closure decides afterwards."""
        axes = self.candidates(CANDIDATES, np.random.default_rng(23))
        return axes[self.robot.forward_batch(axes)[3] == softkin.Status.OK][:600]

    @cached_property
    def _closed(self) -> tuple[Array, Array]:
        """Joint values and positions there, by the closure."""
        return self.closure.joints(self._assembled), self.closure.poses(self._assembled)[0]

    @cached_property
    def _scales(self) -> Array:
        return np.nanmax(self._indicators_at(*self._closed), axis=0)

    def _indicators(self, axes: Array) -> Array:
        return self._indicators_at(self.closure.joints(axes), self.closure.poses(axes)[0])

    def _indicators_at(self, joints: Array, positions: Array) -> Array:
        sides = self.closure.side(joints, positions)
        return np.column_stack([np.abs(self.closure.indicators_at(joints, positions)), sides])


@cache
def loop_machines_of(mechanism: Mechanism) -> tuple[LoopMachine, ...]:
    """As it is drawn, and two with no two dimensions alike; each in both assembly modes."""
    assert mechanism.assembly is not None
    rng = np.random.default_rng(23)
    modes = [{mechanism.assembly.parameter: mode} for mode in (False, True)]
    found = [loop_machine(mechanism, f"nominal{' other' * k}", _nominal(mechanism) | m) for k, m in enumerate(modes)]
    while len(found) < 4:
        try:
            given = _unequal(mechanism, rng) | modes[len(found) - 2]
            found.append(loop_machine(mechanism, f"random {len(found) - 1}", given))
        except softkin.KinematicsError as refused:
            assert refused.status is softkin.Status.NOT_INITIALIZED  # noqa: PT017 - dimensions that form no machine
    return tuple(found)


def loop_machine(mechanism: Mechanism, label: str, given: Mapping[str, float]) -> LoopMachine:
    """One machine; what is not given has its default."""
    robot = softkin.catalogue()[mechanism.name](**given)
    lengths = [abs(robot.parameters[p.name]) for p in mechanism.parameters if p.role in (Role.LENGTH, Role.DISTANCE)]
    closure = LoopClosure(mechanism, robot.parameters, sum(lengths))
    return LoopMachine(label, mechanism, given, robot, closure, sum(lengths))


def _nominal(mechanism: Mechanism) -> dict[str, float]:
    return {p.name: p.nominal for p in mechanism.parameters}


def _unequal(mechanism: Mechanism, rng: Generator) -> dict[str, float]:
    """Dimensions of which no two are alike, and offsets."""
    given: dict[str, float] = {}
    lengths = [p.nominal for p in mechanism.parameters if p.role is Role.LENGTH]
    smallest = min(lengths or (abs(p.nominal) for p in mechanism.parameters if p.nominal))  # or coordinates alone
    for p in mechanism.parameters:
        if p.role is Role.FLAG:
            given[p.name] = float(rng.integers(2))
        elif p.role is Role.ANGLE:
            given[p.name] = float(np.clip(p.nominal + rng.uniform(-20.0, 20.0), p.low, p.high))
        else:
            shift = 0.1 * smallest * rng.uniform(-1.0, 1.0) if p.role is Role.DISTANCE and p.low < 0 else 0.0
            given[p.name] = float(p.nominal * rng.uniform(0.8, 1.2) + shift)
    return given | {j.offset.name: float(rng.uniform(-30.0, 30.0)) for j in mechanism.joints}
