"""Every machine as a function block and in Python, whatever its kind."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from derive.description.mechanism import Mechanism
from tests.catalogue.driven_machines import DRIVEN, driven_machines_of
from tests.catalogue.loop_machines import loop_machines_of
from tests.catalogue.machines import MECHANISMS, Machine, machines_of
from tests.catalogue.turning_machines import turning_machines_of
from tests.mechanisms import catalogue
from tests.random_axes import random_axes
from tests.text.both import Both
from tests.text.controller import OK, Controller
from tests.text.limits import limited, limited_machines
from tests.text.samples import ANYWHERE, Sample, grid, regular, samples_at
from tests.text.units import compiled

__all__ = ["LOOPS", "MECHANISMS", "POSITION_KINEMATICS", "Pair", "pair_of", "pairs_of"]

LOOPS = tuple(m for _, m in catalogue() if m.rods)
POSITION_KINEMATICS = (*MECHANISMS, *DRIVEN, *LOOPS)
"""Serial mechanisms, with loops in their chains or without, and those with rods. Orientation kinematics have methods,
and a folder, of their own."""


@dataclass(frozen=True)
class Pair(Both):
    """A machine as a function block, and the same machine as a Python object."""

    machine: Machine

    @cached_property
    def regular(self) -> tuple[Sample, ...]:
        return regular(self.machine)

    @cached_property
    def grid(self) -> tuple[Sample, ...]:
        """All joints at multiples of a quarter turn."""
        return grid(self.machine)

    @cached_property
    def anywhere(self) -> tuple[Sample, ...]:
        """Axis values of a closed loop, whether it closes there or not."""
        if not self.mechanism.rods:
            return ()
        rng, about = np.random.default_rng(11), self.machine.closure.offsets
        return samples_at(self.machine, random_axes(self.robot, ANYWHERE, rng, 170.0, self.machine.reach, about))


@cache
def pairs_of(mechanism: Mechanism) -> tuple[Pair, ...]:
    """A pair for every machine of a mechanism, with limits and without."""
    return tuple(map(pair_of, _machines(mechanism)))


def _machines(mechanism: Mechanism) -> tuple[Machine, ...]:
    """Of a loop: as it is drawn; with other dimensions, in the other assembly mode; and the latter with limits."""
    if not (mechanism.rods or mechanism.drives):
        return *machines_of(mechanism), *limited_machines(mechanism)
    if mechanism.drives:
        machines: tuple[Machine, ...] = driven_machines_of(mechanism)
    else:
        every = (turning_machines_of if mechanism.is_platform else loop_machines_of)(mechanism)
        machines = every[0], every[-1]
    return *machines, limited(machines[-1], "limited")


def pair_of(one: Machine) -> Pair:
    controller = Controller(compiled(one.mechanism), one.mechanism)
    assert controller.initialise(one.robot.parameters) == OK
    return Pair(one, controller)
