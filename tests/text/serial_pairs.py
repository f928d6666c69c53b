"""Serial pairs: a machine of a serial mechanism as a function block, and the same machine as a Python object."""

from dataclasses import dataclass
from functools import cache, cached_property

from derive.description.mechanism import Mechanism
from tests.catalogue.machines import MECHANISMS, Machine, machines_of
from tests.text.both import Both
from tests.text.controller import OK, Controller
from tests.text.limits import limited_machines
from tests.text.samples import Sample, grid, regular
from tests.text.units import compiled

__all__ = ["MECHANISMS", "SerialPair", "serial_pairs_of"]


@dataclass(frozen=True)
class SerialPair(Both):
    """A machine of a serial mechanism."""

    machine: Machine

    @cached_property
    def regular(self) -> tuple[Sample, ...]:
        return regular(self.machine)

    @cached_property
    def grid(self) -> tuple[Sample, ...]:
        """All joints at multiples of a quarter turn."""
        return grid(self.machine)


@cache
def serial_pairs_of(mechanism: Mechanism) -> tuple[SerialPair, ...]:
    """A pair for every machine of a mechanism, with limits and without."""
    machines = (*machines_of(mechanism), *limited_machines(mechanism))
    return tuple(map(serial_pair, machines))


def serial_pair(one: Machine) -> SerialPair:
    controller = Controller(compiled(one.mechanism), one.mechanism)
    assert controller.initialise(one.robot.parameters) == OK
    return SerialPair(one, controller)
