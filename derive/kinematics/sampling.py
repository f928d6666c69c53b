"""Deterministic samples of machines and axis values, for the build's own numerical decisions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.description.mechanism import Joint, Mechanism, Role, Turning
from derive.equations.axes import axes_of_drives
from derive.ir.interpret import evaluate, run
from derive.ir.passes import normalise
from derive.ir.program import Output, Program, Status
from derive.ir.symbols import CHECK_FORWARD, SCALE, branch_sign
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.parameters import has_length, machine_parameters, machine_scale, unlimited_values
from derive.plate.turning import poses_around_home

Samples = dict[str, NDArray[np.float64]]
ENOUGH = 16
"""The number of possible poses from which a sign or an exponent is determined."""
_MANY = 1024
_JOINTS = 8
"""The values of a joint that are drawn for each one of its actuator: its loops close at some of them."""
_SHARES = (1.0, 0.5, 0.25, 0.1)
"""The shares of the ranges from which further poses are drawn."""


def sample_machine(mechanism: Mechanism, seed: int, optional_zero: bool = False) -> Samples:
    """Parameters near their nominal values, and the characteristic length, as scalars."""
    generator = np.random.default_rng(seed)
    values: Samples = {}
    nominal = unlimited_values(mechanism)
    needed = {s for j in mechanism.joints for loop in j.loops for s in loop.equation.free_symbols}
    for parameter in machine_parameters(mechanism):
        spread, value = generator.uniform(0.8, 1.2), nominal[parameter.name]
        value = value if parameter.role in (Role.FLAG, Role.SIGN) else value * spread
        if optional_zero and parameter.role is Role.DISTANCE and parameter.symbol not in needed:
            value = 0.0
        values[parameter.name] = np.asarray(value)
    return _with_scale(mechanism, values | fixed_values(mechanism))


def machine_at(mechanism: Mechanism) -> Samples:
    """The nominal machine without limits: its parameters, and its characteristic length."""
    values = {name: np.asarray(value) for name, value in unlimited_values(mechanism).items()}
    return _with_scale(mechanism, values | fixed_values(mechanism))


def _with_scale(mechanism: Mechanism, values: Samples) -> Samples:
    """The machine with its characteristic length."""
    if mechanism.is_platform:  # its length follows from its home pose, and is not needed here
        return {**values, SCALE.name: np.asarray(_coordinates(mechanism, values))}
    return {**values, SCALE.name: np.asarray(evaluate(machine_scale(mechanism), values), dtype=float)}


def _coordinates(mechanism: Mechanism, values: Samples) -> float:
    """The largest dimension that is a length."""
    return max([abs(float(values[p.name])) for p in mechanism.parameters if p.unit == "u"], default=1.0) or 1.0


def fixed_values(mechanism: Mechanism) -> Samples:
    """The values of the named numbers of a chain."""
    return {p.name: np.asarray(p.nominal) for p in mechanism.parameters if p.fixed is not None}


def size_of(mechanism: Mechanism, machine: Mapping[str, NDArray[np.float64]], otherwise: float = 1.0) -> float:
    """A length of the size of the machine. Without a length that is never zero, it is the sum of the distances; for a
    loop it is at least the largest coordinate that is a number or a distance.

    otherwise: what a machine without any length gets.
    """
    distances = [abs(_first(machine[p.name])) for p in mechanism.parameters if p.role is Role.DISTANCE]
    is_scaled = mechanism.is_platform or has_length(mechanism)
    size = _first(machine[SCALE.name]) if is_scaled else sum(distances) or otherwise
    if not mechanism.rods:
        return size
    ends = [sp.sympify(v) for rod in mechanism.rods for v in (*rod.base, *rod.plate)]
    numbers = [abs(float(t)) for end in ends for t in sp.Add.make_args(end) if t.is_number]
    return max(size, *distances, *numbers, 0.0)


def _first(values: NDArray[np.float64]) -> float:
    """The first of some equal values."""
    return float(np.ravel(values)[0])


def sample_axes(
    mechanism: Mechanism, machine: Samples, count: int, seed: int, share: float = 1.0, otherwise: float = 1.0
) -> Samples:
    """Axis values over the whole ranges of the joints, as arrays; the references are equal to the axes. An axis that
    moves a joint by loops has values at which these close.

    Those of a machine with the limits of its description are inside them. share: of the ranges, around the nominal
    values of the joints; otherwise: the size of a machine without any length.
    """
    size = size_of(mechanism, machine, otherwise)
    generator = np.random.default_rng(seed)
    values: Samples = {}
    for joint in mechanism.joints:
        if joint.loops:
            motor = _closing(mechanism, machine, joint, count, generator)
        else:
            turns = abs(float(evaluate(joint.ratio, machine))) if joint.is_geared and joint.is_angle else 1.0
            low, high = _inside_limits(joint, machine, _range_of(joint, size), 1.0 / turns)
            motor = generator.uniform(low, high, count) / turns
        drawn = joint.nominal + share * (motor - joint.nominal)
        values[joint.axis.name] = values[joint.reference.name] = drawn + float(machine[joint.offset.name])
    return values


def _closing(
    mechanism: Mechanism, machine: Samples, joint: Joint, count: int, generator: np.random.Generator
) -> NDArray[np.float64]:
    """Values of an actuator, without its offset, at which its loops close: those of random values of the joint."""
    others = {j.axis for j in mechanism.joints if j != joint}
    program = normalise("closing", axes_of_drives(mechanism, others), (Output(joint.axis.name, joint.axis),))
    size = np.pi if joint.is_angle else size_of(mechanism, machine)
    joints = generator.uniform(-size, size, _JOINTS * count)
    found, status = run(program, {**machine, joint.symbol.name: joints})
    motors = found[joint.axis.name] - float(machine[joint.offset.name])
    low, high = _inside_limits(joint, machine, (-np.inf, np.inf), 1.0)
    closed = motors[(status == Status.OK) & (motors >= low) & (motors <= high)]
    return np.resize(closed if closed.size else np.array([joint.nominal]), count)


def _inside_limits(joint: Joint, machine: Samples, values: tuple[float, float], unit: float) -> tuple[float, float]:
    """The part of a range, in some unit, that the limits of a joint allow: they, if they allow nothing of it.

    A machine that is measured has other limits than its description, or none: then it is the whole range.
    """
    low, high = values
    lower, upper = (_first(machine[f"{word}_{joint.key}"]) for word in ("lower", "upper"))
    if joint.limits != (lower, upper):
        return low, high
    first, last = ((end - _first(machine[joint.offset.name])) / unit for end in (lower, upper))
    inside = max(low, first), min(high, last)
    return inside if inside[0] < inside[1] else (first, last)


def _range_of(joint: Joint, size: float) -> tuple[float, float]:
    """The values of a joint that are tried: of a slide those up to once or twice the size of the machine."""
    if joint.is_angle:
        low, high = joint.domain or (-180.0, 180.0)
        return low, min(high, 1e3)
    if joint.domain is None:
        return -size, size
    low = max(joint.domain[0], -size)
    return low, min(joint.domain[1], max(2.0 * size, low + size))


def possible_axes(mechanism: Mechanism, machine: Samples, count: int, seed: int, program: Program) -> Samples:
    """The machine with axis values, of which the program accepts at least some: a loop closes at few random poses.

    Where fewer than `ENOUGH` of the first are possible, further ones are drawn, ever nearer to the nominal values of
    the joints; then only possible ones are kept.
    """
    first = {**machine, **sample_axes(mechanism, machine, count, seed)}
    if _possible(program, first, count).sum() >= ENOUGH:
        return first
    kept: list[Samples] = []
    for number, share in enumerate(_SHARES):
        drawn = sample_axes(mechanism, machine, _MANY, seed + 100 + number, share)
        good = _possible(program, {**machine, **drawn}, _MANY)
        kept.append({name: column[good] for name, column in drawn.items()})
    found = {name: np.concatenate([part[name] for part in kept]) for name in kept[0]}
    return {**machine, **found} if any(column.size for column in found.values()) else first


def _possible(program: Program, samples: Samples, count: int) -> NDArray[np.bool_]:
    _, status = run(program, samples)
    return np.asarray(np.broadcast_to(status == Status.OK, (count,)), dtype=bool)


_DRAWN, _MOST, _SEED = 16384, 1024, 53
"""The poses that are drawn; of those that the inverse reaches, at most so many are measured."""
_RANGES = (0.5, 1.0)
"""The shares of the largest distance from home: a characteristic length, and a turn about each axis."""


def with_share(kin: Kinematics) -> Kinematics:
    """The kinematics with a note on the share, if forward kinematics starts at home."""
    if not kin.starts:
        return kin
    near, far = (_in_words(*found_again(kin, share)) for share in _RANGES)
    most = _largest_turn(kin)
    note = (
        f"Forward kinematics starts at the home pose. Measured with nominal parameters, it finds {near} of the poses "
        f"again that the inverse reaches within {most // 2} degrees of home about each axis and half the mean leg and "
        f"platform radius, and {far} within twice as much. The inverse refuses the others, because a controller that "
        f"asks for the pose at power-up would get another one; without {CHECK_FORWARD} it accepts them, for callers "
        "that give forward kinematics a start."
    )
    return replace(kin, mechanism=replace(kin.mechanism, notes=(*kin.mechanism.notes, note)))


def found_again(kin: Kinematics, share: float) -> tuple[int, int]:
    """Of poses around home: how many forward kinematics from home finds again, and how many the inverse reaches. share:
    of the largest distance from home.
    """
    given = {name: np.asarray(value) for name, value in kin.unlimited_values.items()}
    constants, _ = run(kin.setup, given)
    within = (share, float(np.radians(share * _largest_turn(kin))))
    poses = poses_around_home(kin.mechanism, {**given, **constants}, np.random.default_rng(_SEED), within, _DRAWN)
    signs = np.random.default_rng(_SEED + 1).choice([-1, 1], (len(kin.branches), _DRAWN))
    poses |= {branch_sign(b.name).name: column for b, column in zip(kin.branches, signs, strict=True)}
    constants |= {s.name: np.asarray(0) for j in kin.mechanism.joints for s in (j.reference, j.turn)}
    _, status = run(kin.branch, {**constants, **poses, CHECK_FORWARD: np.asarray(False)})
    reached = np.flatnonzero(status == Status.OK)[:_MOST]
    kept = {name: column[reached] for name, column in poses.items()}
    _, status = run(kin.branch, {**constants, **kept, CHECK_FORWARD: np.asarray(True)})
    return int((status == Status.OK).sum()), len(reached)


def _largest_turn(kin: Kinematics) -> int:
    """The largest turn from home in degrees."""
    return 90 if kin.mechanism.motion.turning is Turning.FULL else 180


def _in_words(found: int, count: int) -> str:
    """A share that every computer rounds alike."""
    share = round(100.0 * found / count) if count else 0
    return "all" if found == count else "more than 99 %" if share == 100 else f"{share} %"
