"""The arguments of methods: poses of a machine, and commands that may be far from them."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from itertools import product

import numpy as np
from numpy.random import Generator
from softkin import KinematicsError

from tests.catalogue.loci import coinciding as poses_where_singularities_coincide
from tests.catalogue.machines import Machine
from tests.text.limits import draw_inside

Reals = tuple[float, ...]
Rows = tuple[Reals, ...]
Bytes = tuple[int, ...]
MANY, SOME = 150, 100
"""A grid of more poses than MANY is thinned out to SOME: the package is tested on all of them."""
COINCIDING = 16
SAMPLES, OF_A_LOOP = 16, 36
"""Random samples of one machine."""
ANYWHERE = 16
"""Axis values of a loop, drawn without asking whether it closes."""
NO_TURN: Rows = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
HALF_TURN: Rows = ((1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0))
"""The tool points the opposite way."""


@dataclass(frozen=True)
class Sample:
    """A pose by its axis values, and other things to call a method with."""

    axes: Reals
    reference: Reals
    rotation: Rows
    offset: Reals
    data: Bytes
    """Any bytes, as many as a configuration has."""


@dataclass(frozen=True)
class Command:
    """The input of inverse kinematics."""

    position: Reals
    rotation: Rows
    configuration: Bytes
    reference: Reals


@cache
def regular(machine: Machine) -> tuple[Sample, ...]:
    """Random samples away from singular poses; where there are limits, checked or not, half of them inside."""
    count = OF_A_LOOP if machine.mechanism.rods else SAMPLES
    rng = np.random.default_rng(sum(machine.label.encode()))
    axes = machine.draw(count, rng)
    if any(machine.robot.parameters[f"upper_{j.key}"] for j in machine.mechanism.joints):
        axes = np.concatenate([axes[: count // 2], draw_inside(machine, count // 2, rng)])
    return tuple(_sample(machine, row, rng) for row in axes.tolist())


def samples_at(machine: Machine, axes: Iterable[Iterable[float]]) -> tuple[Sample, ...]:
    """Samples at axis values that are chosen, whatever they are."""
    rng = np.random.default_rng(17)
    return tuple(_sample(machine, list(map(float, row)), rng) for row in axes)


def grid(machine: Machine) -> tuple[Sample, ...]:
    """All joints at multiples of a quarter turn, or of a length: every singular pose among them."""
    rng = np.random.default_rng(90)
    angles = (-180.0, -90.0, 0.0, 90.0, 180.0, 540.0)
    sizes = (-machine.reach / 4, 0.0, machine.reach / 2)
    columns = []
    for joint in machine.mechanism.joints:
        low, high = joint.domain or (-np.inf, np.inf)
        columns.append([v for v in (angles if joint.is_angle else sizes) if low <= v <= high])
    joints = np.array(list(product(*columns)))
    if len(joints) > MANY:
        joints = joints[rng.choice(len(joints), SOME, replace=False)]
    units = machine.closure.units
    return tuple(_sample(machine, axes, rng) for axes in machine.closure.axes(joints * units).tolist())


def coinciding(machine: Machine) -> tuple[Sample, ...]:
    """A few of the poses where several singularities coincide, or nearly."""
    rng = np.random.default_rng(91)
    axes = np.concatenate(list(poses_where_singularities_coincide(machine)))
    return tuple(_sample(machine, row, rng) for row in axes[rng.choice(len(axes), COINCIDING)].tolist())


def near(samples: Iterable[Sample]) -> Iterator[Sample]:
    """The same samples, moved a little: a thousandth of a degree, or next to nothing."""
    rng = np.random.default_rng(13)
    for sample in samples:
        size = 10.0 ** rng.uniform(-13.0, -3.0)
        axes = np.array(sample.axes) + size * rng.uniform(-1.0, 1.0, len(sample.axes))
        yield replace(sample, axes=tuple(axes.tolist()))


def one_wrong_byte(own: Bytes, branches: int, sample: Sample) -> Bytes:
    """The configuration with some branch byte that means nothing."""
    if not branches:
        return own
    wrong = sample.data[-1] % branches
    return tuple(4 if i == wrong else byte for i, byte in enumerate(own))


def _sample(machine: Machine, axes: list[float], rng: Generator) -> Sample:
    count, scale = len(axes), np.where(machine.closure.angles, 400.0, machine.reach)
    aside = (0.05 if machine.mechanism.rods else 0.4) * machine.reach
    size = len(machine.robot.CONFIGURATION)
    return Sample(
        axes=tuple(axes),
        reference=tuple((np.array(axes) + rng.uniform(-1.0, 1.0, count) * scale).tolist()),
        rotation=tilted(rng),
        offset=tuple((rng.uniform(-1.0, 1.0, 3) * aside).tolist()),
        data=tuple(rng.integers(0, 256, size).tolist()),
    )


def tilted(rng: Generator) -> Rows:
    w, x, y, z = (q := rng.normal(size=4)) / np.linalg.norm(q)
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )


def commands(machine: Machine, sample: Sample) -> Iterator[Command]:
    """The pose of a sample with every kind of configuration and reference, and poses beside it."""
    robot = machine.robot
    try:
        frame, own = robot.forward(sample.axes)
    except KinematicsError:
        return
    position, rotation = frame
    branches, far = robot.BRANCHES, sample.reference
    turns = own[branches:]
    opened = (0,) * len(turns)
    others = tuple(3 - byte if byte in (1, 2) else byte for byte in own[:branches])
    for configuration, reference in (
        (own, sample.axes),
        (own, far),
        ((0,) * len(own), sample.axes),
        ((0,) * len(own), far),
        (own[:branches] + opened, far),
        ((0,) * branches + turns, far),
        ((3,) * branches + opened, far),
        (others + opened, far),
        (sample.data, far),
        (one_wrong_byte(own, branches, sample), far),
        (tuple(byte % 4 for byte in sample.data[:branches]) + sample.data[branches:], far),
    ):
        yield Command(position, rotation, configuration, reference)
    default = robot.DEFAULT_CONFIGURATION
    yield Command(position, sample.rotation, default, far)
    yield Command(position, HALF_TURN, default, far)
    yield Command(position, HALF_TURN, (0,) * len(own), far)
    yield Command(tuple(0.5 * v for v in position), NO_TURN, default, far)
    yield Command(tuple(3.0 * v for v in position), NO_TURN, (0,) * len(own), far)
    yield Command((0.0, 0.0, position[2]), rotation, (0,) * len(own), far)  # no branch may pass its own shoulder there
    for shift in (1e-8 * machine.reach, 1e-3 * machine.reach):
        yield Command((*position[:2], position[2] + shift), rotation, default, far)
