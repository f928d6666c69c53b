"""Planted faults: each makes the test fail that is named for it, and the unchanged text does not."""

import inspect
from collections.abc import Callable
from dataclasses import replace
from importlib import import_module

import pytest
from softkin import KinematicsError

from tests.catalogue.loop_machines import LoopMachine, loop_machines_of
from tests.catalogue.loops.crossings import Crossing, crossing_of
from tests.catalogue.loops.planted import FAULTS, Fault


def the_test(fault: Fault) -> Callable[[tuple[LoopMachine, ...]], None]:
    """The test that is to fail, ready to be given machines."""
    module, _, name = fault.noticed_by.partition(".")
    folder = "catalogue.loops" if module in ("test_type2", "test_margins", "test_reach") else "catalogue"
    function = getattr(import_module(f"tests.{folder}.{module}"), name)
    wanted = inspect.signature(function).parameters

    def run(machines: tuple[LoopMachine, ...]) -> None:
        given = {"machines": machines, "mechanism": machines[0].mechanism}
        if "crossings" in wanted:
            given["crossings"] = crossings_given_to(machines)
        function(**{key: value for key, value in given.items() if key in wanted})

    return run


def crossings_given_to(machines: tuple[LoopMachine, ...]) -> list[Crossing]:
    """The ways that machines without a fault find, for these to go: none is found by a machine that takes both modes
    for one.
    """
    ways = zip(machines, map(crossing_of, loop_machines_of(machines[0].mechanism)), strict=True)
    found = [(machine, way) for machine, way in ways if way is not None]
    if not found:
        raise LookupError("no way leads through the singularity")  # not an assertion: it is the test that must notice
    return [
        replace(
            way,
            machine=machine,
            unlimited=type(machine.robot)(**way.unlimited.parameters),
            other=type(machine.robot)(**way.other.parameters),
        )
        for machine, way in found
    ]


@pytest.mark.parametrize("what", FAULTS)
def test_a_wrong_formula_is_noticed(what: str) -> None:
    machines = FAULTS[what].machines()
    with pytest.raises((AssertionError, KinematicsError)):
        the_test(FAULTS[what])(machines)


@pytest.mark.parametrize("what", {f.noticed_by: name for name, f in FAULTS.items()}.values())
def test_the_same_text_unchanged_passes(what: str) -> None:
    """The test fails because of the fault, and not because the text is loaded from elsewhere."""
    fault = FAULTS[what]
    same = tuple((right, right) for right, _ in fault.elsewhere)
    unchanged = Fault(fault.mechanism, fault.right, fault.right, fault.noticed_by, same)
    the_test(fault)(unchanged.machines())
