"""Five thousand small steps, each with the last result as reference: continuous until a status, never a jump."""

from functools import cache

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from derive.description.mechanism import Mechanism
from tests.catalogue.closure import Array
from tests.catalogue.loci import Locus, loci
from tests.catalogue.machines import Machine, few
from tests.catalogue.references import held_at

BEND, BEND_OF_SEVERAL = 0.8, 0.5
"""How far an elbow bends along the way, as a share of the arc on which it neither stretches nor folds."""
BENT_A_LITTLE = -0.7
VENDOR = 60.0
"""Degrees or lengths that axes start inside of the vendor's ranges."""
LEAST_WAY = 12.0
"""Degrees or lengths that every axis can go from the start, either way."""


def tour(machine: Machine, steps: int, turns: int = 0) -> Array:
    """Axis values: turning axes go forward and back over several turns, everything else swings.

    `turns`: on which turn an elbow bends, which cannot turn through without changing its branch.
    """
    time = np.linspace(0.0, 1.0, steps)
    columns = []
    for i, joint in enumerate(machine.mechanism.joints):
        swing = np.sin(2 * np.pi * time * (i + 1) + 0.3 * i)
        if joint.multi_turn:
            size = 700.0 if joint.pitch != 0 else 900.0
            columns.append(size * np.sin(2 * np.pi * time + 0.8 * i))
        elif joint.domain is not None:
            columns.append((90.0 + 70.0 * swing) if joint.is_angle else machine.reach * (0.6 + 0.3 * swing))
            columns[-1] = columns[-1] + machine.closure.offsets[i]
        else:
            columns.append(machine.reach * 0.4 * swing)
    axes = np.stack(columns, axis=1)
    bending = _bending(machine)
    bend = BEND if len(bending) == 1 else BEND_OF_SEVERAL
    for k, locus in enumerate(bending):
        axes = locus.within(axes, bend * np.sin((6 + 2 * k) * np.pi * time), turns)
    return axes


@cache
def start(machine: Machine) -> Array:
    """Axis values on the first turn, every elbow bent a little, from which every axis can go some way."""
    axes = machine.draw(1000, np.random.default_rng(12), farthest=100.0)
    for i, joint in enumerate(machine.mechanism.joints):
        low, high = joint.limit_range or (-1e9, 1e9)
        axes = axes[(axes[:, i] > low + VENDOR) & (axes[:, i] < high - VENDOR)]
    for locus in _bending(machine):
        axes = locus.within(axes[locus.exists(axes)], BENT_A_LITTLE)
    free = np.ones(len(axes), dtype=bool)
    for i in range(axes.shape[1]):
        for shift in np.linspace(-LEAST_WAY, LEAST_WAY, 5):
            free &= machine.is_regular(axes + shift * np.eye(axes.shape[1])[i])
    found = axes[free][0]
    found.flags.writeable = False  # as for `straight`
    return found


def _bending(machine: Machine) -> list[Locus]:
    """One locus a branch, those that the fewest joints decide first: what is set later leaves them alone."""
    first = [locus for locus in loci(machine) if locus.branch is not None and not locus.second]
    return sorted(first, key=lambda locus: locus.joints)


@cache
def straight(machine: Machine, axis: int, steps: int, far: float = 400.0) -> Array:
    """From the start with one axis some way (degrees or lengths), as far as the way is regular."""
    axes = np.repeat(start(machine)[None], steps, axis=0)
    axes[:, axis] += np.linspace(0.0, far, steps)
    regular = machine.is_regular(axes)
    axes.flags.writeable = False  # all who ask for this motion get the same array
    return axes if regular.all() else axes[: int(regular.argmin())]


pytestmark = pytest.mark.serial

STEPS = 5_000
TOLERANCE = 1e-8
"""Degrees or lengths: the way is regular, and errors do not add up."""


def follow(
    robot: softkin.Mechanism, machine: Machine, axes: Array, branches: tuple[int, ...] | None = None
) -> tuple[Array, Array]:
    """The axis values of every step, and whether it was answered. The reference is the last result.

    A held axis is commanded along the way by its reference.
    Branches are those of the first pose, where they are not given.
    """
    if branches is None:
        branches = robot.forward(axes[0])[1][: robot.BRANCHES]
    positions, rotations = machine.closure.poses(axes)
    frames = zip(positions.tolist(), rotations.tolist(), strict=True)
    configuration = branches + (0,) * len(robot.PERIOD_AXES)
    last = tuple(axes[0].tolist())
    found = np.full(axes.shape, np.nan)
    for k, (position, rows) in enumerate(frames):
        reference = held_at(robot, axes[k], last) if robot.HELD else last
        try:
            last = robot.inverse((tuple(position), tuple(map(tuple, rows))), configuration, reference)
        except KinematicsError as error:
            assert error.status is Status.UNREACHABLE
        else:
            found[k] = last
    assert not np.isnan(last).any()
    return found, ~np.isnan(found[:, 0])


def chosen(machines: tuple[Machine, ...], label: str) -> Machine:
    (found,) = (m for m in machines if m.label == label)
    return found


@pytest.mark.long
def test_many_turns(machines: tuple[Machine, ...]) -> None:
    """Across every ±180 degrees, forward and back, turns counted; with branches named."""
    machine = chosen(machines, "random 1")
    axes = tour(machine, STEPS)
    found, answered = follow(machine.robot, machine, axes)
    assert answered.all()
    assert np.abs(found - axes).max() < TOLERANCE
    turning = [i for i, j in enumerate(machine.mechanism.joints) if j.multi_turn]
    periods = machine.robot.forward_batch(axes)[2][:, machine.robot.BRANCHES :]
    assert all(np.ptp(axes[:, i]) > 1000.0 for i in turning) or machine.robot.BRANCHES
    assert (np.ptp(periods, axis=0) >= 1).sum() >= len(turning) - machine.robot.BRANCHES


@pytest.mark.long
def test_an_automatic_branch_stays_on_a_regular_way(machines: tuple[Machine, ...]) -> None:
    for machine in few(machines)[:2]:
        axes = tour(machine, 1200, turns=-1)
        found, answered = follow(machine.robot, machine, axes, (0,) * machine.robot.BRANCHES)
        assert answered.all()
        assert np.abs(found - axes).max() < TOLERANCE


@pytest.mark.slow("800.0-")
@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("width", [340.0, 361.0, 800.0])
def test_through_a_limit(mechanism: Mechanism, machines: tuple[Machine, ...], width: float, direction: int) -> None:
    """Every axis out of either end: the first step outside is refused, and no later answer is outside.

    A step is 1.6.
    """
    machine = chosen(machines, "nominal")
    for i, joint in enumerate(mechanism.joints):
        axes = straight(machine, i, 250, far=400.0 * direction)
        end = float(axes[len(axes) // 10, i]) + 1e-4 * direction
        low, high = joint.limit_range or (-1e9, 1e9)
        lower, upper = sorted((end, min(max(end - width * direction, low), high)))
        robot = machine.changed(**{f"lower_{joint.key}": lower, f"upper_{joint.key}": upper})
        assert (lower <= axes[0, i] <= upper) and not (lower - 10.0 <= axes[-1, i] <= upper + 10.0)
        found, answered = follow(robot, machine, axes)
        outside = (axes[:, i] < lower) | (axes[:, i] > upper)
        assert outside.any()
        first = int(outside.argmax())
        assert answered[:first].all() and not answered[first]
        assert np.abs(found[:first] - axes[:first]).max() < TOLERANCE
        later = first + np.flatnonzero(answered[first:])  # a turn back it is inside again
        assert joint.multi_turn or not len(later)
        again = found[later, i]
        assert ((lower - 1e-6 <= again) & (again <= upper + 1e-6)).all()
        assert (np.abs(again - axes[later, i] + 360.0 * direction) < TOLERANCE).all()
