"""Corners: poses where two or three singular factors vanish together, and poses beside them at every decade of
distance.

The factors are the determinants and the conditioning of the steps of the inverse, by which it divides or of which it
takes roots. Here they are functions of axis values whose zeros Newton's method finds. They do not decide whether an
answer is right.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial
from itertools import combinations

import numpy as np
import sympy as sp
from numpy.random import Generator
from numpy.typing import NDArray

from derive.description.mechanism import Mechanism
from derive.ir.constants import DEGREE
from derive.ir.interpret import evaluate
from derive.ir.passes import normalise
from derive.ir.program import Output, Program
from derive.ir.symbols import SCALE
from derive.kinematics.branches.assembly import assembled
from derive.kinematics.forward import derivation_at_axes, pose_at_axes
from derive.kinematics.inverse import solve_pose
from derive.kinematics.parameters import machine_scale
from derive.kinematics.search.derivations import solve_both
from tests.catalogue.closure import Array
from tests.catalogue.machines import Machine

Factors = Callable[[Array], Array]
Places = NDArray[np.intp]
DISTANCES = (0.0, *(sign * 10.0**-k for k in range(2, 17) for sign in (1, -1)))
"""Distances of a factor from zero."""
STARTS, PASSES = 24, 32
AT = 1e-14
"""A factor smaller than this is zero."""
STEP = 1e-6
LONGEST = 0.4
"""Radians, or reaches, of one step of Newton's method."""
CONTROLLED = 2e-3
"""A pose of a loop is refused where its type 2 margin is below 1e-3: such poses are no corners."""
ENDS = 1e-6
"""Quantities with a boundary keep this distance from it, per reach: there the workspace ends."""


@dataclass(frozen=True)
class Corner:
    """Axis values at which factors vanish, and the motions by which each of them leaves zero at unit rate."""

    names: tuple[str, ...]
    axes: Array
    """(n, joints)"""
    ways: Array
    """(n, joints, factors), in units of the axes"""

    def beside(self, distances: Array) -> Array:
        """The axis values where every factor is at one of the distances (factors,) or (n, factors)."""
        away = np.broadcast_to(distances, (len(self.axes), len(self.names)))
        return self.axes + np.einsum("njf,nf->nj", self.ways, away)


@cache
def factor_program(mechanism: Mechanism) -> Program:
    """The determinant and the conditioning of every step of the inverse, over their scales, at axis values."""
    forward = assembled(mechanism, pose_at_axes(mechanism)).forward
    inverse = solve_both(mechanism).closed if mechanism.search is not None else solve_pose(mechanism)
    determinants = [
        Output(s.sigma.name.removeprefix("sigma_"), s.value / s.scale) for s in inverse.derivation.determinants
    ]
    conditionings = [Output(m.name, m.value / m.scale) for m in inverse.derivation.conditionings]
    return normalise("factors", derivation_at_axes(mechanism, inverse, forward), [*determinants, *conditionings])


@cache
def _compiled(mechanism: Mechanism) -> tuple[tuple[str, tuple[str, ...], Callable[..., Array]], ...]:
    """Every statement of the program: the name that it binds, the names that it reads, and its value in NumPy."""
    primitives = {"Root": lambda x: np.sqrt(np.maximum(x, 0.0)), "Select": np.where, "Atan2": np.arctan2}
    program = factor_program(mechanism)
    values = [(let.name.name, let.value) for let in program.lets()] + [
        (f"factor {o.name}", o.value) for o in program.outputs
    ]
    found = []
    for name, value in values:
        read = sorted(value.free_symbols, key=lambda s: s.name)
        found.append((name, tuple(s.name for s in read), sp.lambdify(read, value, modules=[primitives, "numpy"])))
    return tuple(found)


def factors(machine: Machine) -> Factors:
    """The factors of a machine (n, factors) as a function of axis values (n, joints)."""
    mechanism = machine.mechanism
    constants = {k: np.asarray(v, dtype=float) for k, v in machine.robot.parameters.items()}
    constants[SCALE.name] = np.asarray(evaluate(machine_scale(mechanism), constants), dtype=float)
    constants[DEGREE.name] = np.asarray(np.pi / 180.0)
    names = [f"factor {o.name}" for o in factor_program(mechanism).outputs]

    def at(axes: Array) -> Array:
        known = dict(constants)
        for joint, column in zip(mechanism.joints, axes.T, strict=True):
            known[joint.axis.name] = known[joint.reference.name] = column
        with np.errstate(all="ignore"):
            for name, read, value in _compiled(mechanism):
                known[name] = value(*(known[r] for r in read))
        found = np.empty((len(axes), len(names)))
        for place, name in enumerate(names):
            found[:, place] = known[name]
        return found

    return at


def corners(machine: Machine, count: int, rng: Generator, *, of: int = 2) -> Iterator[Corner]:
    """Every combination of factors that vanish together somewhere, at some places each."""
    every, names = factors(machine), [o.name for o in factor_program(machine.mechanism).outputs]
    combined = list(combinations(range(len(names)), of))
    for chosen, found in zip(combined, _places(machine, every, combined, count, rng), strict=True):
        if len(found):
            ways = _ways(machine, partial(_picked, every, np.array([chosen])), found)
            yield Corner(tuple(names[k] for k in chosen), found, ways)


def _picked(every: Factors, chosen: Places, axes: Array) -> Array:
    """The factors at places (n, of) or (1, of) of every row."""
    return np.take_along_axis(every(axes), np.broadcast_to(chosen, (len(axes), chosen.shape[1])), axis=1)


def _units(machine: Machine) -> Array:
    """One radian, or one reach, in the units of the axes."""
    return np.where(machine.closure.angles, 180.0 / np.pi, machine.reach)


def _slopes(machine: Machine, functions: Factors, axes: Array) -> Array:
    """(n, factors, joints), per radian or reach."""
    steps = STEP * np.diag(_units(machine))
    beside = axes + np.concatenate([steps, -steps])[:, None]
    values = functions(beside.reshape(-1, axes.shape[1])).reshape(2, len(steps), len(axes), -1)
    return np.moveaxis((values[0] - values[1]) / (2 * STEP), 0, 2)


def _places(
    machine: Machine, every: Factors, combined: list[tuple[int, ...]], count: int, rng: Generator
) -> Iterator[Array]:
    """Of every combination: the end of Newton's method, if all its factors vanish there on this machine."""
    if not combined:
        return
    axes = np.concatenate([_starts(machine, rng) for _ in combined])
    chosen = np.repeat(np.array(combined), STARTS, axis=0)
    moving = np.arange(len(axes))
    for _ in range(PASSES):
        values = _picked(every, chosen[moving], axes[moving])
        is_away = (values != 0.0).any(axis=1)
        moving, values = moving[is_away], values[is_away]
        if not len(moving):
            break
        shifted = partial(_picked, every, np.tile(chosen[moving], (2 * axes.shape[1], 1)))
        step = _least(_slopes(machine, shifted, axes[moving]), values)
        length = np.minimum(1.0, LONGEST / np.maximum(np.abs(step).max(axis=1), 1e-30))
        axes[moving] -= _units(machine) * step * length[:, None]
    good = (np.abs(_picked(every, chosen, axes)) < AT).all(axis=1)
    good[good] &= can_be_at(machine, axes[good])
    for start in range(0, len(axes), STARTS):
        group = slice(start, start + STARTS)
        yield axes[group][good[group]][:count]


def _ways(machine: Machine, functions: Factors, axes: Array) -> Array:
    """The pseudo-inverse of the slopes close to the corner: at the corner itself a length has no slope."""
    aside = axes + 1e-5 * _units(machine) * np.random.default_rng(1).uniform(-1.0, 1.0, axes.shape)
    return np.linalg.pinv(np.nan_to_num(_slopes(machine, functions, aside)), rcond=1e-2) * _units(machine)[:, None]


def _least(slopes: Array, values: Array) -> Array:
    usable = np.isfinite(slopes).all(axis=(1, 2)) & np.isfinite(values).all(axis=1)
    step = np.zeros((len(slopes), slopes.shape[2]))
    step[usable] = (np.linalg.pinv(slopes[usable], rcond=1e-9) @ values[usable][:, :, None])[:, :, 0]
    return step


def _starts(machine: Machine, rng: Generator) -> Array:
    """Random axis values; for a loop, values that close it."""
    if machine.mechanism.rods:
        return machine.draw(STARTS, rng, farthest=360.0)
    ranges = [machine._range(j, 170.0) for j in machine.mechanism.joints]
    low, high = np.array(ranges).T
    return rng.uniform(low, high, (STARTS, len(low))) + machine.closure.offsets


def can_be_at(machine: Machine, axes: Array) -> Array:
    """Whether the machine can be at axis values: closed, controlled, and away from every boundary."""
    with np.errstate(all="ignore"):
        status = machine.robot.forward_batch(axes)[3]
    possible = status == 0
    joints = machine.closure.joints(axes)
    possible &= (machine.closure.positive(joints) >= 0.0).all(axis=1)
    if machine.mechanism.rods:
        name = machine.mechanism.assembly.margin
        margins = [
            machine.robot.singularity(row).margins[name] if ok else 0.0 for row, ok in zip(axes, possible, strict=True)
        ]
        possible &= np.abs(margins) > CONTROLLED
        positions = machine.robot.forward_batch(axes)[0]
        possible &= machine.closure.room(joints, positions) > ENDS
    return possible
