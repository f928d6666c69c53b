"""The samples of the witness: the nominal machine and random ones, with regular poses of each.

Everything is drawn from a fixed seed, so that a build says the same every time.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import sympy as sp
from numpy.random import Generator
from numpy.typing import NDArray

from derive.description.mechanism import Joint, Mechanism, Parameter, Role
from derive.geometry.frames import Motion
from derive.ir.constants import LARGEST
from derive.ir.interpret import Array, evaluate, run
from derive.ir.program import Program, Require, Status
from derive.ir.symbols import CHECK_FORWARD, MAX_MISS, MIN_TYPE2_MARGIN, SCALE
from derive.kinematics.kinematics import Kinematics
from derive.witness.closure import LEAST_MARGIN, POSE, Closure
from derive.witness.disagreement import Disagreement, NoPose
from derive.witness.home_samples import axes_near_home
from derive.witness.surplus import at_axes

SEED = 20260
MACHINES = 6
POSES = 24
"""Regular poses of each machine."""
REGULAR = 0.05
"""The least singular value of the scaled Jacobian at a regular pose."""
_LEAST_REGULAR = 5e-5
"""The same where a machine has no pose that is more regular: one of its links is a thousandth of the others."""
WITHOUT_LENGTHS = 500.0
"""The reach assumed of a machine that has no lengths (a gantry)."""
_CANDIDATES = 100
_FIRST = 2 * POSES
"""Candidates of each machine of which nearly always enough are regular."""
_NEAR_CANDIDATES = 400
"""Poses near home to try where branches have assembly modes of their own."""
_LOOP_CANDIDATES = 2500
"""Random axis values to try: few of them close a loop."""
_LARGER = (1.0, 4.0, 16.0)
"""The ranges of slides that are tried in turn, in reaches, until a loop closes: cords are longer than their share of
the base."""
_SHIFT = 0.05
"""The largest random value of a length whose nominal value is zero, in reaches."""
_SPREAD = {Role.GEAR: 0.1, Role.COUPLING: 0.5, Role.ANGLE: 200.0}
"""The largest random value of another parameter whose nominal value is zero."""


_EVERY_POSE = {MIN_TYPE2_MARGIN: LEAST_MARGIN, CHECK_FORWARD: False, MAX_MISS: float(LARGEST)}
"""Settings with which every regular solution counts: also one that home does not find again, or fits none."""


@dataclass(frozen=True)
class Samples:
    """Rows of samples, ordered by machine: by the names that programs read, and as arrays."""

    values: dict[str, Array]
    """The values that programs read, by name: parameters, constants, axis values, the pose."""
    machine: NDArray[np.int64]
    parameters: Array
    axes: Array
    joints: Array
    pose: Array
    reach: Array
    """A length of the size of the machine."""
    jacobian: Array
    """∂ task / ∂ axes per radian, by automatic differentiation of the closure."""
    ease: Array
    """How many times more rounding joints show that are found from the pose than at a regular pose: near a type 1
    singularity."""
    pose_ease: Array
    """The same of a pose that is found from the joints: near a type 2 singularity."""

    def __len__(self) -> int:
        return len(self.axes)

    def take(self, chosen: NDArray[np.bool_] | NDArray[np.int64]) -> Samples:
        """The chosen rows."""
        rows = {
            f: getattr(self, f)[chosen]
            for f in ("machine", "parameters", "axes", "joints", "pose", "reach", "jacobian", "ease", "pose_ease")
        }
        return replace(self, values={k: v[chosen] for k, v in self.values.items()}, **rows)


def regular_samples(kin: Kinematics, closure: Closure) -> Samples:
    """Regular poses of the nominal and of several random machines."""
    rng = np.random.default_rng(SEED)
    machines = random_machines(kin, rng)
    count = len(next(iter(machines.values())))
    for larger in _LARGER:
        samples, status = _drawn(kin, closure, machines, larger, rng)
        inside = _inside(closure, samples)
        if not kin.mechanism.rods or (inside & (status == Status.OK))[samples.machine == 0].any():
            break
    if refused := np.flatnonzero(inside & (status != Status.OK) & (kin.mechanism.chain is not None)).tolist():
        raise Disagreement(f"forward kinematics refuses a possible pose: {describe(kin, samples, refused[0])}")
    if not inside.any():
        raise NoPose("no sampled pose closes: check the nominal values of parameters and joints")
    samples = samples.take(inside & np.asarray(status == Status.OK, dtype=bool))
    chosen = _first_regular(closure, samples)
    possible = len(np.unique(chosen.machine))  # random dimensions may form a loop that never closes, or is singular
    if possible < min(2 if kin.mechanism.rods else 3, count) or chosen.machine[0] != 0:
        raise Disagreement("a machine has no regular pose: is the mechanism always singular?")
    return chosen


def _drawn(
    kin: Kinematics, closure: Closure, machines: dict[str, Array], larger: float, rng: Generator
) -> tuple[Samples, NDArray[np.object_]]:
    """Candidates of every machine, and what forward kinematics answers. larger: the range of slides, in reaches."""
    machine = np.repeat(np.arange(len(next(iter(machines.values())))), _tried(kin.mechanism))
    values = {name: column[machine] for name, column in machines.items()}
    reach = _reach(kin.mechanism, values)
    parameters = np.stack([values[name] for name in closure.parameters], axis=1)
    if kin.mechanism.is_platform:
        axes = axes_near_home(kin.mechanism, closure, values, parameters, reach, rng)
    else:
        axes = _axes(kin.mechanism, values, larger * reach, rng)
        _move_loops(kin.mechanism, closure, axes, (parameters, reach), rng)
    axes, outputs, status = at_axes(kin, closure, values, parameters, axes)
    values |= {j.axis.name: axes[:, i] for i, j in enumerate(kin.mechanism.joints)} | outputs
    joints = closure.joints(axes, parameters)[:, :, 0]
    pose = np.stack([outputs[name] for name in POSE], axis=1)
    nothing, easy = np.empty((len(axes), 0)), np.ones(len(axes))
    found = Samples(values, machine, parameters, axes, joints, pose, reach, nothing, easy, easy)
    return found, np.asarray(np.broadcast_to(status, (len(axes),)), dtype=object)


def _first_regular(closure: Closure, samples: Samples) -> Samples:
    """The first regular poses of every machine, with their Jacobians: looked for among the first candidates, and among
    all where these are too few.
    """
    order = _rank_within(samples.machine, np.ones(len(samples), dtype=bool))
    for part in (samples.take(order <= _FIRST), samples):
        found = replace(part, jacobian=jacobian_of(closure, part))
        largest, least = _singular_values(closure, found)
        ease = np.maximum(1.0, REGULAR / np.maximum(least, _LEAST_REGULAR))
        found = replace(found, ease=ease, pose_ease=np.maximum(1.0, REGULAR * largest))
        regular = least > _regular(found.machine, least)
        chosen = regular & (_rank_within(found.machine, regular) <= POSES)
        wanted = np.minimum(np.bincount(samples.machine), POSES)
        if np.all(np.bincount(found.machine[chosen], minlength=len(wanted)) >= wanted):
            break
    return found.take(chosen)


def _regular(machine: NDArray[np.int64], least: Array) -> Array:
    """The least singular value that is regular, of each row: less where its machine has no pose above `REGULAR`."""
    best = np.zeros(machine.max(initial=0) + 1)
    np.maximum.at(best, machine, least)
    return np.where(best > REGULAR, REGULAR, np.maximum(best / 2, _LEAST_REGULAR))[machine]


def _tried(mechanism: Mechanism) -> int:
    """How many axis values of a machine are tried."""
    if mechanism.is_platform:
        return _NEAR_CANDIDATES if mechanism.branches else _CANDIDATES
    return _LOOP_CANDIDATES if mechanism.rods or mechanism.drives else _CANDIDATES


def jacobian_of(closure: Closure, samples: Samples) -> Array:
    """J = -A⁻¹ B: the rows of the task."""
    return moved_by_axes(closure, samples)[:, : len(closure.task)]


def moved_by_axes(closure: Closure, samples: Samples) -> Array:
    """J = -A⁻¹ B: the rows of the task, then those of what the loop moves besides."""
    by_joints = closure.by_joints(samples.joints, samples.pose, samples.parameters)
    return solved_for_pose(closure, samples, by_joints) @ closure.gearing(samples.axes, samples.parameters)


def solved_for_pose(closure: Closure, samples: Samples, right: Array) -> Array:
    """-A⁻¹ right, by least squares where Φ has more rows than the task.

    Rows of Φ are squares of lengths, lengths and numbers: each over its size, or a number has the rounding of a square;
    entries of a rotation have the size 1, however little they change. Lengths of the pose are measured in reaches, so
    that the unit of length changes no digit.
    """
    state, units = (samples.joints, samples.pose, samples.parameters), closure.row_scale(samples.reach)
    a, b = closure.by_pose(*state) * units[:, None, :], closure.by_joints(*state)
    scaled = b * closure.joint_scale(samples.reach, samples.joints, samples.parameters)[:, None, :]
    sizes = np.linalg.norm(np.concatenate([a, scaled], axis=2), axis=2, keepdims=True)
    sizes[sizes == 0.0] = 1.0
    sizes[:, closure.equations :] = 1.0
    return np.asarray(-np.linalg.pinv(a / sizes) @ (right / sizes) * units[:, :, None])


def describe(kin: Kinematics, samples: Samples, row: int) -> str:
    """One sample, for a message."""
    axes = ", ".join(f"{j.name}={samples.axes[row, i]:.6g}" for i, j in enumerate(kin.mechanism.joints))
    machine = ", ".join(
        f"{p.given_name}={samples.values[p.name][row]:.6g}" for p in kin.mechanism.parameters if p.fixed is None
    )
    return f"at {axes}" + (f" of the machine {machine}" if machine else "")


def random_machines(kin: Kinematics, rng: Generator) -> dict[str, Array]:
    """Parameters and constants of the machines that `setup` accepts, the nominal one first."""
    count = 8 * MACHINES
    names = {p.name for p in kin.mechanism.parameters} | {j.offset.name for j in kin.mechanism.joints}
    names |= {kin.mechanism.assembly.parameter} if kin.mechanism.assembly else set()
    names |= {b.home_flag for b in kin.branches} if kin.mechanism.is_platform else set()
    cones = [c for rod in kin.mechanism.rods for c in (rod.base_cone, rod.plate_cone) if c is not None]
    refusing = {s.name for value in (*cones, *kin.mechanism.load) for s in value.free_symbols}
    names -= refusing  # they refuse poses, and change no answer
    values = {}
    nominal = kin.unlimited_values
    largest = _SHIFT * float(_reach(kin.mechanism, _nominal(kin))[0])
    for parameter in kin.parameters:
        own = nominal[parameter.name]
        drawn = _draw(parameter, count, rng, largest) if parameter.name in names else np.full(count, own)
        drawn[0] = own
        values[parameter.name] = drawn
    values |= {name: np.full(count, value) for name, value in _EVERY_POSE.items() if name in values}
    values.setdefault("", np.zeros(count))  # a machine without parameters still has rows
    constants, status = run(kin.setup, values)
    if status[0] != Status.OK:
        first = {name: column[:1] for name, column in values.items()}
        raise Disagreement(f"Initialize refuses the nominal parameters{_refused(kin.setup, first)}")
    accepted = np.flatnonzero(status == Status.OK)[:MACHINES]
    return {name: column[accepted] for name, column in (values | constants).items()}


def _refused(setup: Program, values: dict[str, Array]) -> str:
    """What the first condition wants that they do not meet; empty if it gives no reason."""
    for place, statement in enumerate(setup.body):
        if isinstance(statement, Require) and statement.reason is not None:
            _, status = run(replace(setup, body=setup.body[: place + 1], outputs=()), values)
            if status[0] != Status.OK:
                return f": it wants {statement.reason.words}"
    return ""


def _nominal(kin: Kinematics) -> dict[str, Array]:
    """The values of the nominal machine without limits."""
    numbers = {p.name: p.nominal for p in kin.mechanism.parameters}
    given = {name: np.full(1, value) for name, value in (numbers | kin.unlimited_values).items()}
    constants, _ = run(kin.setup, given)
    return given | {name: np.broadcast_to(value, (1,)) for name, value in constants.items()}


def _draw(parameter: Parameter, count: int, rng: Generator, largest: float) -> Array:
    """Random values of one parameter; a parameter with a default keeps it in half of the machines."""
    size = abs(parameter.tested) or _SPREAD.get(parameter.role, largest)
    if parameter.role is Role.LENGTH:
        drawn = parameter.nominal * rng.uniform(0.5, 1.5, count)
    elif parameter.role in (Role.SIGNED_LENGTH, Role.TRANSMISSION):
        drawn = abs(parameter.nominal) * rng.uniform(0.5, 1.5, count) * rng.choice([-1.0, 1.0], count)
    elif parameter.role is Role.FLAG:
        drawn = np.ones(count)
    elif parameter.role is Role.SIGN:
        drawn = -np.ones(count)
    else:
        drawn = parameter.tested + size * rng.uniform(-1.0, 1.0, count)
    drawn = np.clip(drawn, parameter.low, parameter.high)
    return drawn if parameter.default is None else np.where(rng.random(count) < 0.5, parameter.default, drawn)


def _reach(mechanism: Mechanism, values: dict[str, Array]) -> Array:
    if mechanism.is_platform:  # the sum of all its coordinates says little
        return values[SCALE.name]
    roles = (Role.LENGTH, Role.SIGNED_LENGTH, Role.DISTANCE)
    own = (p for p in mechanism.parameters if p.role in roles and p.deviation is None)
    lengths = [np.abs(values[p.name]) for p in own]
    total = np.sum(lengths, axis=0) if lengths else np.zeros_like(next(iter(values.values())))
    total = total + sum(_numbers(mechanism))
    legs = max(1, len(mechanism.rods))  # one leg of a loop
    return np.where(total > 0, total / legs, WITHOUT_LENGTHS)


def _numbers(mechanism: Mechanism) -> Iterator[float]:
    """The sizes of shifts of a chain and of rods that are stated as numbers."""
    factors = mechanism.chain.factors if mechanism.chain is not None else ()
    shifts = [f.amount for f in factors if f.motion is Motion.SHIFT]
    terms = (t for v in (*shifts, *(r.length for r in mechanism.rods)) for t in sp.Add.make_args(sp.sympify(v)))
    return (abs(float(t)) for t in terms if t.is_number)


def _axes(mechanism: Mechanism, values: dict[str, Array], reach: Array, rng: Generator) -> Array:
    """Random axis values: several turns where the axis has a period, the reach where it is linear."""
    columns = []
    for joint in mechanism.joints:
        size = reach if not joint.is_angle else (540.0 if joint.multi_turn else 175.0) / turns_of(joint, values)
        low, high = joint.domain or (-np.inf, np.inf)
        drawn = rng.random(len(reach))
        motor = np.maximum(-size, low) * (1 - drawn) + np.minimum(size, high) * drawn
        columns.append(motor + (0.0 if joint.multi_turn else values[joint.offset.name]))
    return np.stack(columns, axis=1)


def _move_loops(
    mechanism: Mechanism, closure: Closure, axes: Array, machines: tuple[Array, Array], rng: Generator
) -> None:
    """Give axes whose joints loops move values at which these close, where they do: those of random joint values.

    machines: their parameters, and their reaches.
    """
    driven = [i for i, j in enumerate(mechanism.joints) if j.loops]
    if not driven:
        return
    parameters, reach = machines
    sizes = np.where(closure.angles, np.pi, reach[:, None])
    motors = closure.motors(rng.uniform(-1.0, 1.0, axes.shape) * sizes, parameters)[:, :, 0]
    for i in driven:
        offset = parameters[:, closure.parameters.index(mechanism.joints[i].offset.name)]
        turned = (np.degrees(motors[:, i]) + 180.0) % 360.0 - 180.0
        axes[:, i] = offset + (turned if mechanism.joints[i].in_degrees else motors[:, i])


def turns_of(joint: Joint, values: dict[str, Array]) -> Array:
    """The turns of a joint per turn of its axis."""
    return np.asarray(np.abs(np.asarray(evaluate(joint.ratio, values), dtype=float)))


def _inside(closure: Closure, samples: Samples) -> NDArray[np.bool_]:
    """Whether joints keep to their domains and the positive quantities are positive."""
    inside = np.all(closure.positive(samples.joints, samples.pose, samples.parameters)[:, :, 0] > 0, axis=1)
    for i, joint in enumerate(closure.described.joints):
        low, high = joint.domain or (-np.inf, np.inf)
        value = samples.joints[:, i] / (np.pi / 180.0 if joint.is_angle else 1.0)
        inside &= (value >= low) & (value <= high)
    return np.asarray(inside, dtype=bool)


def _singular_values(closure: Closure, samples: Samples) -> tuple[Array, Array]:
    """The largest and the least singular value of the Jacobian of the joints that are solved for, with lengths in
    reaches: the least is small near a type 1 singularity, the largest is large near a type 2 singularity.
    """
    columns = closure.joint_scale(samples.reach, samples.joints, samples.parameters)
    rows = closure.row_scale(samples.reach)[:, : len(closure.task)]
    gears = np.diagonal(closure.gearing(samples.axes, samples.parameters), axis1=1, axis2=2)
    columns = columns / np.abs(gears)  # per radian of the joint, however slow a gear makes it
    scaled = np.nan_to_num(samples.jacobian * columns[:, None, :] / rows[:, :, None], posinf=0.0, neginf=0.0)
    sizes = np.linalg.svd(scaled[:, :, closure.solved], compute_uv=False)
    return np.asarray(sizes[:, 0]), np.asarray(sizes[:, -1])


def _rank_within(group: NDArray[np.int64], chosen: NDArray[np.bool_]) -> NDArray[np.int64]:
    """The number of each chosen row within its group, from 1; groups stand in order."""
    total = np.cumsum(chosen)
    _, first, index = np.unique(group, return_index=True, return_inverse=True)
    return np.asarray(total - (total - chosen)[first][index])
