"""Machines of every mechanism with rods, as a block and in Python, and what every method of them must answer."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import islice

import numpy as np
import softkin
from numpy.random import Generator
from softkin import KinematicsError, Status

from derive.description.mechanism import Mechanism, Parameter, Role, Turning
from derive.kinematics.parameters import machine_parameters
from tests.mechanisms import catalogue
from tests.random_axes import random_axes
from tests.text.both import Both, Machine
from tests.text.comparisons import COMPARISONS as SERIAL
from tests.text.controller import OK, Controller, assert_same
from tests.text.samples import HALF_TURN, NO_TURN, Sample, tilted
from tests.text.units import compiled

LOOPS = tuple(m for _, m in catalogue() if m.rods)
POSES = 36
"""Regular poses of one machine."""
BROKEN = 12
"""Axis values of one machine, drawn without asking whether the loop closes."""


@dataclass(frozen=True)
class Loop(Both):
    machine: Machine
    regular: tuple[Sample, ...]
    """At a pose."""
    any: tuple[Sample, ...]
    """Anywhere: most of them cannot be assembled."""


@cache
def loops_of(mechanism: Mechanism) -> tuple[Loop, ...]:
    """Nominal dimensions; others, with offsets and the other assembly mode; the latter with limits."""
    rng = np.random.default_rng(11)
    nominal = _loop(_machine(mechanism, "nominal", {p.name: p.nominal for p in mechanism.parameters}), rng)
    other: Loop | None = None
    while other is None:
        other = _possible(mechanism, rng)
    columns = list(zip(*(sample.axes for sample in other.regular), strict=True))
    limits = {}
    for joint, column in zip(mechanism.joints, columns, strict=True):
        limits |= {
            f"lower_{joint.key}": float(np.quantile(column, 0.1)),
            f"upper_{joint.key}": float(np.quantile(column, 0.9)),
        }
    given = {**other.machine.given, **limits, "check_limits": True}
    return nominal, other, _loop(_machine(mechanism, "limited", given), rng)


def loop_of(mechanism: Mechanism, label: str, given: Mapping[str, float], axes: Iterable[tuple[float, ...]]) -> Loop:
    """A machine with samples at axis values that are chosen, whatever they are."""
    machine, rng = _machine(mechanism, label, given), np.random.default_rng(17)
    controller = Controller(compiled(mechanism), mechanism)
    assert controller.initialise(machine.robot.parameters) == OK
    return Loop(machine, controller, tuple(_sample(machine, list(values), rng) for values in axes), ())


def _possible(mechanism: Mechanism, rng: Generator) -> Loop | None:
    given = {p.name: _near(p, rng) for p in mechanism.parameters if p.role is not Role.FLAG}
    given |= {j.offset.name: float(rng.uniform(-15.0, 15.0)) for j in mechanism.joints}
    given |= {p.name: True for p in machine_parameters(mechanism) if p.role is Role.FLAG and p.name != "check_limits"}
    try:
        machine = _machine(mechanism, "other", given)
    except KinematicsError:
        return None  # dimensions that form no machine
    return _loop(machine, rng)


def _near(parameter: Parameter, rng: Generator) -> float:
    if parameter.role is Role.SIGN:
        return parameter.nominal
    size = 5.0 if parameter.role is Role.ANGLE else 0.12 * abs(parameter.nominal)
    return float(np.clip(parameter.nominal + rng.uniform(-size, size), parameter.low, parameter.high))


def _machine(mechanism: Mechanism, label: str, given: Mapping[str, float]) -> Machine:
    robot = softkin.catalogue()[mechanism.name](**given)
    lengths = [abs(robot.parameters[p.name]) for p in mechanism.parameters if p.role in (Role.LENGTH, Role.DISTANCE)]
    return Machine(label, mechanism, given, robot, min(sum(lengths), 3000.0))


def _loop(machine: Machine, rng: Generator) -> Loop:
    controller = Controller(compiled(machine.mechanism), machine.mechanism)
    assert controller.initialise(machine.robot.parameters) == OK
    drawn = _drawn(machine, 6000, rng)
    closed = [a for a, s in zip(drawn.tolist(), machine.robot.forward_batch(drawn)[3], strict=True) if s == Status.OK]
    regular = list(islice((a for a in closed if _is_regular(machine, tuple(a))), POSES))
    assert len(regular) == POSES, f"{machine.mechanism.name} {machine.label}: {len(regular)}"
    made = [_sample(machine, axes, rng) for axes in (*regular, *drawn[:BROKEN].tolist())]
    return Loop(machine, controller, tuple(made[:POSES]), tuple(made[POSES:]))


def _is_regular(machine: Machine, axes: tuple[float, ...]) -> bool:
    margins = machine.robot.singularity(axes).margins.values()
    return all(abs(m) > 0.01 for m in margins) and _returns(machine, axes)


def _returns(machine: Machine, axes: tuple[float, ...]) -> bool:
    """Whether the inverse accepts the pose: limits, and the swing of a ball joint, are the inverse's. Not asked without
    those.
    """
    if not machine.mechanism.bounds or machine.label == "limited":
        return True
    frame, configuration = machine.robot.forward(axes)
    try:
        machine.robot.inverse(frame, configuration, axes)
    except KinematicsError:
        return False
    return True


def _drawn(machine: Machine, count: int, rng: Generator) -> np.ndarray:
    """Axis values all over; those of a hexapod near its home pose, where its assembly mode is."""
    robot, joints = machine.robot, machine.mechanism.joints
    offsets = np.array([robot.parameters[j.offset.name] for j in joints])
    if machine.mechanism.home:
        near = np.array([j.nominal for j in joints]) + offsets
        return random_axes(robot, count, rng, 120.0, 120.0, near)
    return random_axes(robot, count, rng, 170.0, machine.reach, offsets)


def _sample(machine: Machine, axes: list[float], rng: Generator) -> Sample:
    far = [400.0 if j.is_angle else machine.reach for j in machine.mechanism.joints]
    return Sample(
        axes=tuple(axes),
        reference=tuple((np.array(axes) + rng.uniform(-1.0, 1.0, len(axes)) * far).tolist()),
        rotation=tilted(rng),
        offset=tuple((rng.uniform(-0.05, 0.05, 3) * machine.reach).tolist()),
        data=tuple(rng.integers(0, 256, len(machine.robot.CONFIGURATION)).tolist()),
    )


def image_with_orientation(loop: Loop, sample: Sample) -> None:
    """All rotations can be had: a space of the one that is asked for. One that turns about z has its headings."""
    if loop.mechanism.task.turning is not Turning.FULL:
        SERIAL["GetFlangeOrientationImageWithOri"](loop, sample)  # type: ignore[arg-type]
        return
    for rows in (sample.rotation, NO_TURN, HALF_TURN):
        status, (dof, zero, *_) = loop.controller.image_with_orientation(rows)
        assert (status, dof) == (OK, "zero")
        assert_same(zero, rows, loop)


COMPARISONS = SERIAL | {"GetFlangeOrientationImageWithOri": image_with_orientation}
"""By the name of the method."""
