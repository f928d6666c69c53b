"""Straight lines of the plate through a type 2 singularity: in one working mode, from one assembly mode into the
other."""

from dataclasses import dataclass

import numpy as np
import softkin
from softkin import Status

from tests.catalogue.closure import Array
from tests.catalogue.loop_machines import LoopMachine, facings

POINTS = np.linspace(0.0, 1.0, 101)
PARTNERS = 3000
TRIES = 150
HALVINGS = 60


@dataclass(frozen=True)
class Crossing:
    """A line from a pose of a machine to one of its other assembly mode; every leg reaches all of it in one working
    mode.
    """

    machine: LoopMachine
    unlimited: softkin.Mechanism
    """The machine with no least margin."""
    other: softkin.Mechanism
    """The same, in the other assembly mode."""
    axes: Array
    """At the start."""
    configuration: tuple[int, ...]
    start: Array
    end: Array
    at: float
    """The place of the singularity on the line, from 0 to 1, where the assembly mode changes."""

    def positions(self, shares: Array) -> Array:
        return self.start + (self.end - self.start) * np.asarray(shares)[:, None]


def crossing_of(machine: LoopMachine) -> Crossing | None:
    """The first line that is found; None where no working mode has poses of both assembly modes."""
    assembly = machine.mechanism.assembly
    assert assembly is not None
    unlimited = machine.changed(min_type2_margin=0.0)
    other = machine.changed(**{assembly.parameter: not machine.given[assembly.parameter]}, min_type2_margin=0.0)
    far, modes = _poses(other, machine.candidates(PARTNERS, np.random.default_rng(5)), machine)
    near, configurations = _poses(unlimited, machine.pool, machine)
    for axes, start, configuration in list(zip(machine.pool, near, configurations, strict=True))[:TRIES]:
        same = np.flatnonzero((modes == configuration).all(axis=1))
        if len(same) == 0:
            continue
        end = far[same[np.linalg.norm(far[same] - start, axis=1).argmin()]]
        code = (*configuration.tolist(), *(0,) * len(machine.robot.PERIOD_AXES))
        line = Crossing(machine, unlimited, other, axes, code, start, end, 1.0)
        mine, theirs = (_answers(robot, line, POINTS) for robot in (unlimited, other))
        if (mine ^ theirs).all() and mine[0] and theirs[-1] and (np.diff(mine.astype(int)) != 0).sum() == 1:
            return Crossing(machine, unlimited, other, axes, code, start, end, _lost(line))
    return None


def _poses(robot: softkin.Mechanism, axes: Array, machine: LoopMachine) -> tuple[Array, Array]:
    positions, _, configurations, statuses = robot.forward_batch(axes)
    there = statuses == Status.OK
    return positions[there], configurations[there][:, : machine.robot.BRANCHES]


def _answers(robot: softkin.Mechanism, line: Crossing, shares: Array) -> Array:
    return (
        robot.inverse_batch(line.positions(shares), facings(robot, len(shares)), line.configuration, line.axes)[1]
        == Status.OK
    )


def _lost(line: Crossing) -> float:
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if _answers(line.unlimited, line, np.array([middle]))[0] else (low, middle)
    return low
