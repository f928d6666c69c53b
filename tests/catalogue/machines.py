"""The machines on which every mechanism is tested, and the axis values at which they are."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from typing import TypeVar

import numpy as np
import softkin
from numpy.random import Generator
from numpy.typing import NDArray

from derive.description.mechanism import Joint, Mechanism, Parameter, Role
from derive.geometry.frames import Motion
from tests.catalogue.closure import Array, Closure
from tests.mechanisms import catalogue

MECHANISMS = tuple(m for _, m in catalogue() if not (m.rods or m.drives or m.is_orientation or m.search))
"""The serial mechanisms; loops, loops in chains, platforms and orientations have files of their own."""
WITHOUT_LENGTHS = 500.0
"""The reach assumed of a machine that has no lengths."""
TURNS = 1000.0
"""The range of an axis with several turns, in degrees."""
CLIMBING_TURNS = 720.0
"""The range of an axis with a pitch, which is limited."""
REGULAR = 0.05
"""Branch indicators (lengths: per their largest) and positive quantities (per reach) are at least this."""
UNEQUAL = (320.0, 80.0, 20.0)
M = TypeVar("M")
LENGTHS = (Role.LENGTH, Role.SIGNED_LENGTH)
"""What must be given; a distance need not be."""


@dataclass(frozen=True, eq=False)
class Machine:
    """A mechanism with parameters: the generated class, and the closure with which it is compared."""

    label: str
    mechanism: Mechanism
    given: Mapping[str, float]
    robot: softkin.Mechanism
    closure: Closure
    reach: float

    def draw(self, count: int, rng: Generator, farthest: float = TURNS) -> Array:
        """Random axis values of regular poses, over several turns where `farthest` (degrees) allows."""
        chosen: list[Array] = []
        while sum(map(len, chosen)) < count:
            axes = self._any(4 * count, rng, farthest)
            chosen.append(axes[self.is_regular(axes)])
        return np.concatenate(chosen)[:count]

    def sample(self, count: int) -> Array:
        """The same random axis values every time, singular or not."""
        return self._any(count, np.random.default_rng(0))

    def is_regular(self, axes: Array) -> Array:
        """Whether axis values are away from every singularity."""
        joints = self.closure.joints(axes)
        lengths = {j.symbol: self.reach for j in self.mechanism.joints if not j.is_angle}
        scales = np.array([lengths.get(p, 1.0) for p in self.mechanism.positive])
        away = np.all(np.abs(self.closure.indicators(joints)) > REGULAR * self.largest, axis=1)
        return away & np.all(self.closure.positive(joints) > REGULAR * scales, axis=1)

    @cached_property
    def largest(self) -> Array:
        """The largest value of every branch indicator: 1, or a length found with random joint values."""
        lengths = {p.symbol for p in self.mechanism.parameters if p.role in (*LENGTHS, Role.DISTANCE)}
        lengths |= {j.symbol for j in self.mechanism.joints if not j.is_angle}
        is_length = np.array([bool(b.indicator.free_symbols & lengths) for b in self.mechanism.branches], dtype=bool)
        joints = self.closure.joints(self.sample(2000))
        return np.where(is_length, np.abs(self.closure.indicators(joints)).max(axis=0), 1.0)

    @property
    def has_a_reach(self) -> bool:
        """Whether some positions are out of reach: not where slides move every coordinate, or without branches."""
        return self.robot.BRANCHES > 0 and int((~self.closure.angles & self.solved).sum()) < len(self.closure.task)

    @property
    def lowest_direction(self) -> float:
        """The least z of a direction of the tool: of an axis that is inclined to the pole, twice its angle away."""
        nutation = self.robot.parameters.get("nutation")
        return -1.0 if nutation is None else float(np.cos(2 * np.radians(nutation)))

    @property
    def solved(self) -> NDArray[np.bool_]:
        """Which joints the inverse solves for: not those that are held."""
        held = self.mechanism.held_joints
        return np.array([j not in held for j in self.mechanism.joints])

    @property
    def branches_meet_together(self) -> bool:
        """Whether every branch answers where one does: not of a loop, nor where several equations have a reach each."""
        return self.robot.BRANCHES <= 1 and not self.mechanism.rods

    @property
    def is_spatial(self) -> bool:
        """Whether a chain turns about more than one direction: no plane, no heading, no outer circle."""
        return is_spatial(self.mechanism)

    @property
    def has_an_elbow(self) -> bool:
        """Whether it has branches because of two links in a plane, which one circle around another bounds."""
        links = [p for p in self.mechanism.parameters if p.role in LENGTHS]
        return self.robot.BRANCHES > 0 and not self.is_spatial and len(links) > 1

    def answers(self, statuses: Array) -> Array:
        """Which rows a slot answers; a machine whose branches each have a reach may refuse some."""
        answered = statuses == softkin.Status.OK
        if self.branches_meet_together:
            assert answered.all()
        assert (answered | (statuses == softkin.Status.UNREACHABLE)).all()
        return answered

    def error(self, axes: Array, positions: Array, rotations: Array) -> Array:
        """The largest part of the closure's residual in every row, lengths over the size of the motion."""
        residual = np.abs(self.closure.residual(self.closure.joints(axes), positions, rotations))
        residual[:, :-9] /= self.size(axes)[:, None]
        return residual.max(axis=1)

    def miss(self, axes: Array, positions: Array, rotations: Array) -> Array:
        """The same of the commanded part of the closure: what the inverse must meet."""
        equations = np.abs(self.closure.equations(self.closure.joints(axes), positions, rotations))
        lengths = len(self.mechanism.task.position)
        equations[:, :lengths] /= self.size(axes)[:, None]
        return equations.max(axis=1)

    def size(self, axes: Array) -> Array:
        """The size of the motion in every row: the reach, and the extension of linear axes."""
        return self.reach + np.abs(axes - self.closure.offsets)[:, ~self.closure.angles].sum(axis=1)

    def is_possible(self, axes: Array) -> NDArray[np.bool_]:
        """Whether the machine can be at axis values, and the inverse brings it there: a serial one can be anywhere."""
        return np.ones(len(axes), dtype=bool)

    def is_own(self, joints: Array, position: Array, rotation: Array | None = None) -> NDArray[np.bool_]:
        """Which solutions of the closure are this machine's: of a serial one, all."""
        return np.ones(len(joints), dtype=bool)

    def leads_back(self, axes: Array) -> NDArray[np.bool_]:
        """Where forward kinematics leads from a solution back to the pose: everywhere, unless it iterates from home."""
        return np.ones(len(axes), dtype=bool)

    def placed(self, axis: int, value: float, count: int) -> tuple[Machine, Array]:
        """The machine, or one with another offset, and regular poses with one axis at a value."""
        return self, self.with_axis_at(axis, value, count)

    def own(self, axes: Array) -> NDArray[np.int8]:
        """The configurations of poses, with open periods."""
        configurations = self.robot.forward_batch(axes)[2]
        configurations[:, self.robot.BRANCHES :] = 0
        return configurations

    def with_axis_at(self, axis: int, value: float, count: int) -> Array:
        """Regular poses with one axis at a value; a loop cannot be closed at any."""
        axes = self.draw(20 * count, np.random.default_rng(2))
        axes[:, axis] = value
        found = axes[self.is_possible(axes)][:count]
        assert len(found) == count, f"{self.mechanism.name} {self.label}: {self.mechanism.joints[axis].name} = {value}"
        return found

    def changed(self, **parameters: float) -> softkin.Mechanism:
        """The same robot with other parameters."""
        return type(self.robot)(**{**self.given, **parameters})

    @property
    def open_robot(self) -> softkin.Mechanism:
        """The same robot, whose inverse refuses no solution of the closure in its assembly mode."""
        is_unchecked = {"check_limits"} | ({"check_forward"} if self.mechanism.is_platform else set())
        return self.changed(**dict.fromkeys(is_unchecked | ({"min_type2_margin"} if self.mechanism.rods else set()), 0))

    def _any(self, count: int, rng: Generator, farthest: float = TURNS) -> Array:
        columns = []
        for joint, offset in zip(self.mechanism.joints, self.closure.offsets, strict=True):
            low, high = self._range(joint, farthest)
            columns.append(rng.uniform(low, high, count) + (0.0 if joint.multi_turn else offset))
        return np.stack(columns, axis=1)

    def _range(self, joint: Joint, farthest: float) -> tuple[float, float]:
        if joint.multi_turn:
            size = min(farthest, CLIMBING_TURNS if joint.pitch != 0 else TURNS)
        else:
            size = 180.0 if joint.is_angle else self.reach
        low, high = joint.domain or (-size, size)
        return max(low, -size), min(high, size)


class Pooled(Machine):
    """A machine whose regular poses are found once, and drawn from these."""

    @property
    @abstractmethod
    def pool(self) -> Array:
        """Axis values of regular poses."""

    def draw(self, count: int, rng: Generator, farthest: float = TURNS) -> Array:
        """Random axis values of regular poses, over several turns where `farthest` (degrees) allows."""
        turning = np.array([j.multi_turn for j in self.mechanism.joints])
        pool = self.pool[np.abs(self.pool[:, turning]).max(axis=1, initial=0.0) < farthest]
        chosen = pool[rng.integers(len(pool), size=count)]
        return chosen if farthest < TURNS else chosen + 360.0 * turning * rng.integers(-2, 3, chosen.shape)


def few(machines: tuple[M, ...]) -> tuple[M, ...]:
    """Half of the machines of a mechanism, the plain and the strange among them: where each is asked the same."""
    return (*machines[:-1:3], machines[-1])


def is_spatial(mechanism: Mechanism) -> bool:
    """Whether its chain turns about more than one direction."""
    chain = mechanism.chain
    return chain is not None and len({f.axis for f in chain.factors if f.motion is Motion.TURN}) > 1


@cache
def machines_of(mechanism: Mechanism) -> tuple[Machine, ...]:
    """Plain, nominal, with equal and with very unequal lengths, and random machines with everything."""
    rng = np.random.default_rng(8)
    nominal = {p.name: p.nominal for p in mechanism.parameters}
    lengths = [p.name for p in mechanism.parameters if p.role in LENGTHS]
    found = {
        "plain": {p.name: p.nominal for p in mechanism.parameters if p.role in LENGTHS or p.default is None},
        "nominal": nominal,
        "equal": nominal | {name: np.copysign(250.0, nominal[name]) for name in lengths},
        "unequal": nominal | {name: np.copysign(v, nominal[name]) for name, v in zip(lengths, UNEQUAL, strict=False)},
    }
    found |= {f"random {k}": _random(mechanism, rng) for k in (1, 2)}
    return tuple(machine(mechanism, label, given) for label, given in found.items())


@cache
def bare_machine(mechanism: Mechanism) -> Machine:
    """Equal links and nothing else: folded, its reach is zero, and every angle that can be free is."""
    angles = {p.name: p.nominal for p in mechanism.parameters if p.role is Role.ANGLE}
    return machine(mechanism, "bare", angles | {p.name: 250.0 for p in mechanism.parameters if p.role in LENGTHS})


def machine(mechanism: Mechanism, label: str, given: Mapping[str, float]) -> Machine:
    """One machine; what is not given has its default."""
    robot = softkin.catalogue()[mechanism.name](**given)
    lengths = [abs(robot.parameters[p.name]) for p in mechanism.parameters if p.role in (*LENGTHS, Role.DISTANCE)]
    closure = Closure(mechanism, robot.parameters)
    return Machine(label, mechanism, given, robot, closure, sum(lengths) or WITHOUT_LENGTHS)


def _random(mechanism: Mechanism, rng: Generator) -> dict[str, float]:
    """Random parameters and offsets that meet the constraints."""
    while True:
        given = {p.name: _draw(p, rng) for p in mechanism.parameters}
        symbols = {p.symbol: given[p.name] for p in mechanism.parameters}
        if all(bool(c.condition.xreplace(symbols)) for c in mechanism.constraints):
            break
    for joint in mechanism.joints:
        low, high = joint.offset_range or (-200.0, 200.0)
        given[joint.offset.name] = rng.uniform(low, high)
    return given


def _draw(parameter: Parameter, rng: Generator) -> float:
    sizes = {Role.PITCH: 100.0, Role.GEAR: 0.3, Role.COUPLING: 1.5}
    if parameter.role is Role.SIGNED_LENGTH:
        return float(parameter.nominal * rng.uniform(0.4, 1.6) * rng.choice((-1, 1)))
    if parameter.role in (Role.LENGTH, Role.DISTANCE, Role.ANGLE):
        return float(parameter.nominal * rng.uniform(0.4, 1.6))
    if parameter.role is Role.FLAG:
        return float(rng.integers(2))
    if parameter.role is Role.SIGN:
        return float(rng.choice((-1, 1)))
    size = sizes[parameter.role]
    return float(rng.uniform(-size, size) if rng.random() < 0.7 else 0.0)
