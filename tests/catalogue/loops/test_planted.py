"""These tests would notice: each planted fault makes the test fail that is named for it, and the unchanged text does not."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from importlib import import_module

import pytest
from softkin import KinematicsError

from tests.catalogue.loop_machines import LoopMachine
from tests.catalogue.loops.crossings import crossing_of
from tests.catalogue.loops.planted import FAULTS, Fault


def the_test(fault: Fault) -> Callable[[tuple[LoopMachine, ...]], None]:
    """The test that is to fail, ready to be given machines."""
    module, _, name = fault.noticed_by.partition(".")
    folder = "loops" if module in ("test_type2", "test_margins", "test_bounds", "test_reach") else "mechanisms"
    function = getattr(import_module(f"tests.{folder}.{module}"), name)
    wanted = inspect.signature(function).parameters

    def run(machines: tuple[LoopMachine, ...]) -> None:
        given = {"machines": machines, "mechanism": machines[0].mechanism}
        if "crossings" in wanted:
            given["crossings"] = [c for c in map(crossing_of, machines) if c is not None]
            assert given["crossings"], "no way leads through the singularity"
        function(**{key: value for key, value in given.items() if key in wanted})

    return run


@pytest.mark.parametrize("what", FAULTS)
def test_a_wrong_formula_is_noticed(what: str) -> None:
    machines = FAULTS[what].machines()
    with pytest.raises((AssertionError, KinematicsError)):
        the_test(FAULTS[what])(machines)


@pytest.mark.parametrize("what", {f.noticed_by: name for name, f in FAULTS.items()}.values())
def test_the_same_text_unchanged_passes(what: str) -> None:
    """It is the fault that is noticed, and not that the text was loaded from elsewhere."""
    fault = FAULTS[what]
    unchanged = Fault(fault.mechanism, fault.right, fault.right, fault.noticed_by)
    the_test(fault)(unchanged.machines())
