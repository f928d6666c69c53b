"""Every test of this folder that asks for a machine runs for each of them."""

import pytest

from tests.catalogue.hexapod.machines import NAMES, Machine, machines

OTHERS = ("inch", "lopsided", "hanging, with a tool", "sideways")


@pytest.fixture(params=[pytest.param(name, marks=pytest.mark.long if name in OTHERS else ()) for name in NAMES])
def machine(request: pytest.FixtureRequest) -> Machine:
    return machines()[request.param]
