"""The function block of every machine, called as a controller calls it."""

from functools import cache

from derive.mechanisms.kin_hexapod import MECHANISM
from tests.catalogue.hexapod.machines import Machine, machines
from tests.harness.library import Library
from tests.text.controller import OK, Controller
from tests.text.units import compiled


@cache
def controller(name: str) -> Controller:
    return made(machines()[name], compiled(MECHANISM))


def made(machine: Machine, library: Library, **more: float) -> Controller:
    """A block of its own for a machine, from a library."""
    block = Controller(library, MECHANISM)
    assert block.initialise({**machine.given, **more}) == OK
    return block
